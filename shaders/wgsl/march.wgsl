#define_import_path welkin::march
// The quadrature along a view ray, shared by every pass that integrates through the air.
//
// A ray is cut where its integrand has a kink or a jump: at its tangent point, where it crosses the planet's shadow or
// comes closest to it, and at the bounds of layers. Each of the legs, at most four where there is no layer, is integrated
// by Gauss-Legendre in v, where distance grows with v² from the leg's low end, so that nodes crowd where the air is dense. Optical depth between
// nodes is Simpson's rule in v, which reuses the extinction at both nodes; that of tents, which have kinks, is in closed
// form (welkin::tent). Measured in docs/accuracy.md.
//
//   for (var i = 0u; i < counted(LEG_COUNT); i++) {
//       var leg = leg_of(ray, i);
//       if leg_is_empty(leg) { continue; }
//       for (var n = 0u; n < NODE_COUNT; n++) {
//           let node = leg_advance(&leg, ray, n, &optical_depth);
//           ...
//       }
//       leg_finish(&leg, ray, &optical_depth);
//   }
//
// Definitions: NODE_COUNT, nodes per leg, and FINE_PANELS; LAYERS (some constituent's density is a layer).

#import welkin::atmosphere::{
    atmosphere, extinction_without_tents_at, layer_bounds_m, LAYER_COUNT, TENT_SLOTS
}
#import welkin::geometry
#import welkin::loops::counted
#import welkin::tent::{distances_of_kinks_m, optical_depth_of_tents, Stretch}

const NODE_COUNT: u32 = #{NODE_COUNT}u;
// A ray crosses each bound of a layer twice at most.
const LEG_COUNT: u32 = 4u + 4u * LAYER_COUNT;

struct GaussNode {
    // In ]0, 1[.
    abscissa: f32,
    weight: f32,
    // v and weight on a leg that descends, whose nodes are walked from v = 1 to v = 0.
    descending_abscissa: f32,
    descending_weight: f32,
}

// Gauss-Legendre nodes on [0, 1], ascending.
@group(0) @binding(1) var<uniform> gauss_nodes: array<GaussNode, NODE_COUNT>;

// A ray's part inside the air.
struct AirRay {
    // Distance from the observer to the start; 0 unless the observer stands in space.
    start_m: f32,
    // At the start: altitude, cosines of the zenith angles of ray and light, and of the angle between the two.
    altitude_m: f32,
    mu: f32,
    mu_s: f32,
    nu: f32,
    length_m: f32,
    tangent_m: f32,
    // Where the planet hides the light; start >= end when nowhere, start = end where the ray comes closest to the shadow.
    shadow_m: vec2<f32>,
    // Ends of the legs in ascending order, those at bounds of layers left out.
    leg_ends_m: vec4<f32>,
    // Of the tents' kinks from the tangent point, on either side: see welkin::tent.
    kink_distances_m: array<vec3<f32>, TENT_SLOTS>,
}

struct Leg {
    start_m: f32,
    length_m: f32,
    descending: bool,
    // Whether the planet hides the light from this leg.
    dark: bool,
#ifdef LAYERS
    // What the leg lies between: no rounding carries a node across a jump.
    floor_m: f32,
    ceiling_m: f32,
#endif
    // Where the quadrature stands: v, altitude, and extinction without tents times v there.
    v: f32,
    altitude_m: f32,
    weighted_extinction_per_m: vec3<f32>,
}

struct Node {
    distance_m: f32,
    altitude_m: f32,
    // Quadrature weight: the length of ray that this node stands for.
    weight_m: f32,
}

// The ray from a point in the air until it leaves the air or meets the ground, whichever the caller knows it does.
// Cut at its tangent point only: enough for light that has no sharp shadow.
fn air_ray(altitude_m: f32, mu: f32, mu_s: f32, nu: f32, hits_ground: bool) -> AirRay {
    let radius_m = atmosphere.radius_m;
    var ray: AirRay;
    ray.altitude_m = altitude_m;
    ray.mu = mu;
    ray.mu_s = mu_s;
    ray.nu = nu;
    if hits_ground {
        ray.length_m = geometry::distance_to_shell_from_above(radius_m, altitude_m, mu, 0.0);
    } else {
        ray.length_m = geometry::distance_to_shell_from_below(radius_m, altitude_m, mu, atmosphere.top_m);
    }
    ray.tangent_m = -(radius_m + altitude_m) * mu;
    ray.shadow_m = vec2<f32>(1.0, 0.0);
    ray.leg_ends_m = sorted_leg_ends_m(ray);
    ray.kink_distances_m = distances_of_kinks_m(altitude_m, mu);
    return ray;
}

// The same ray, cut also where it enters and leaves the planet's shadow, or where it comes closest: beside the shadow light
// has grazed the ground and is nearly out, which nodes that know nothing of it pass over.
fn cut_at_shadow(ray: AirRay) -> AirRay {
    var cut = ray;
    let radius_m = atmosphere.radius_m;
    cut.shadow_m = geometry::shadow_interval_m(radius_m, ray.altitude_m, ray.mu, ray.mu_s, ray.nu, ray.length_m);
    if cut.shadow_m.x >= cut.shadow_m.y {
        cut.shadow_m = vec2<f32>(
            geometry::closest_to_shadow_m(radius_m, ray.altitude_m, ray.mu, ray.mu_s, ray.nu, ray.length_m)
        );
    }
    cut.leg_ends_m = sorted_leg_ends_m(cut);
    return cut;
}

// Whether that has given the ray another leg.
fn is_cut_by_shadow(ray: AirRay) -> bool {
    let is_cut = ray.shadow_m.x <= ray.shadow_m.y;
    return is_cut && ray.shadow_m.y > 0.0 && ray.shadow_m.x < ray.length_m;
}

// A view ray, whose observer may stand in space: then it starts where it enters the air, if it does.
fn view_ray(altitude_m: f32, mu: f32, mu_s: f32, nu: f32, hits_ground: bool) -> AirRay {
    let top_m = atmosphere.top_m;
    if altitude_m <= top_m {
        return air_ray(altitude_m, mu, mu_s, nu, hits_ground);
    }
    let r = atmosphere.radius_m + altitude_m;
    let r_top = atmosphere.radius_m + top_m;
    let impact_m = r * sqrt(max(1.0 - mu * mu, 0.0));
    if mu >= 0.0 || impact_m >= r_top {
        var missed: AirRay;
        missed.mu = 1.0;
        missed.shadow_m = vec2<f32>(1.0, 0.0);
        return missed;
    }
    let entry_m = geometry::distance_to_shell_from_above(atmosphere.radius_m, altitude_m, mu, top_m);
    let mu_entry = -sqrt(max(1.0 - (impact_m / r_top) * (impact_m / r_top), 0.0));
    let mu_s_entry = clamp((r * mu_s + entry_m * nu) / r_top, -1.0, 1.0);
    var ray = air_ray(top_m, mu_entry, mu_s_entry, nu, hits_ground);
    ray.start_m = entry_m;
    return ray;
}

// Length of a view ray's part inside the air, m: that of view_ray, without what only a quadrature needs.
fn air_length_m(altitude_m: f32, mu: f32, hits_ground: bool) -> f32 {
    return geometry::air_length_m(atmosphere.radius_m, atmosphere.top_m, altitude_m, mu, hits_ground);
}

// Where the tables of an observer are filled: some way off the ground and below the top, where rays that leave at once
// have a length that they can be divided by.
fn table_altitude_m(altitude_m: f32) -> f32 {
    let in_air_m = clamp(altitude_m, 1e-7 * atmosphere.top_m, (1.0 - 1e-5) * atmosphere.top_m);
    return select(altitude_m, in_air_m, altitude_m <= atmosphere.top_m);
}

fn sorted_leg_ends_m(ray: AirRay) -> vec4<f32> {
    let is_cut = ray.shadow_m.x <= ray.shadow_m.y;
    let shadow_m = select(vec2<f32>(0.0), ray.shadow_m, is_cut);
    let a = clamp(ray.tangent_m, 0.0, ray.length_m);
    let low = min(a, shadow_m.x);
    let high = max(a, shadow_m.y);
    // shadow_m is ordered, so the middle one is what min and max leave over.
    let middle = a + shadow_m.x + shadow_m.y - low - high;
    return vec4<f32>(low, middle, high, ray.length_m);
}

#ifdef LAYERS
// Where the leg that starts at a distance ends, m. Found anew for each leg: a sorted list of all of them would be an array,
// which devices keep far from the processor.
fn next_cut_m(ray: AirRay, start_m: f32) -> f32 {
    let known_m = select(vec4<f32>(ray.length_m), ray.leg_ends_m, ray.leg_ends_m > vec4<f32>(start_m));
    var end_m = min(min(known_m.x, known_m.y), min(known_m.z, known_m.w));
    for (var layer = 0u; layer < LAYER_COUNT; layer++) {
        let bounds_m = layer_bounds_m(layer);
        let bottom_m = geometry::shell_crossings_m(atmosphere.radius_m, ray.altitude_m, ray.mu, bounds_m.x);
        let top_m = geometry::shell_crossings_m(atmosphere.radius_m, ray.altitude_m, ray.mu, bounds_m.y);
        let cuts_m = vec4<f32>(bottom_m, top_m);
        let ahead_m = select(vec4<f32>(ray.length_m), cuts_m, cuts_m > vec4<f32>(start_m));
        end_m = min(end_m, min(min(ahead_m.x, ahead_m.y), min(ahead_m.z, ahead_m.w)));
    }
    return end_m;
}
#endif

// Where a leg ends, m.
fn leg_end_m(ray: AirRay, index: u32) -> f32 {
#ifdef LAYERS
    var end_m = 0.0;
    for (var i = 0u; i <= index; i++) {
        end_m = next_cut_m(ray, end_m);
    }
    return end_m;
#else
    return ray.leg_ends_m[index];
#endif
}

fn leg_of(ray: AirRay, index: u32) -> Leg {
    var leg: Leg;
    leg.start_m = select(leg_end_m(ray, max(index, 1u) - 1u), 0.0, index == 0u);
    leg.length_m = leg_end_m(ray, index) - leg.start_m;
    let middle_m = leg.start_m + 0.5 * leg.length_m;
    leg.descending = middle_m < ray.tangent_m;
    leg.dark = middle_m > ray.shadow_m.x && middle_m < ray.shadow_m.y;
    leg.v = select(0.0, 1.0, leg.descending);
#ifdef LAYERS
    leg.ceiling_m = atmosphere.top_m;
    let middle_altitude_m = altitude_at(ray, middle_m);
    for (var layer = 0u; layer < LAYER_COUNT; layer++) {
        let bounds_m = layer_bounds_m(layer);
        for (var side = 0u; side < 2u; side++) {
            let above = bounds_m[side] > middle_altitude_m;
            leg.ceiling_m = select(leg.ceiling_m, min(leg.ceiling_m, bounds_m[side]), above);
            leg.floor_m = select(max(leg.floor_m, bounds_m[side]), leg.floor_m, above);
        }
    }
#endif
    leg.altitude_m = leg_altitude_m(leg, ray, leg.start_m);
    // Ascending legs start at v = 0, where the weight vanishes.
    if leg.descending {
        leg.weighted_extinction_per_m = extinction_without_tents_at(leg.altitude_m);
    }
    return leg;
}

// Altitude at a distance within a leg.
fn leg_altitude_m(leg: Leg, ray: AirRay, distance_m: f32) -> f32 {
    let altitude_m = altitude_at(ray, distance_m);
#ifdef LAYERS
    // Three roundings inside the bounds.
    return clamp(altitude_m, leg.floor_m * (1.0 + 4e-7), leg.ceiling_m * (1.0 - 4e-7));
#else
    return altitude_m;
#endif
}

fn leg_is_empty(leg: Leg) -> bool {
    return leg.length_m <= 0.0;
}

fn altitude_at(ray: AirRay, distance_m: f32) -> f32 {
    return max(geometry::altitude_along(atmosphere.radius_m, ray.altitude_m, ray.mu, distance_m), 0.0);
}

// Distance from the ray's start at a leg's v: v = 0 is the leg's low end.
fn leg_distance_m(leg: Leg, v: f32) -> f32 {
    let along_m = leg.length_m * v * v;
    return leg.start_m + select(along_m, leg.length_m - along_m, leg.descending);
}

// Optical depth of the tents between two points that no lowest point lies between.
fn tents_between(ray: AirRay, distances_m: vec2<f32>, length_m: f32, altitudes_m: vec2<f32>, middle_m: f32) -> vec3<f32> {
    let from_lowest_m = abs(distances_m - ray.tangent_m);
    let r_middle = atmosphere.radius_m + middle_m;
    let sine = (atmosphere.radius_m + ray.altitude_m) / r_middle * sqrt(max(1.0 - ray.mu * ray.mu, 0.0));
    let high_m = max(from_lowest_m.x, from_lowest_m.y);
    let stretch = Stretch(length_m, high_m, altitudes_m, sine * sine / r_middle);
    return optical_depth_of_tents(stretch, ray.kink_distances_m);
}

// Moves to v and adds the optical depth of the way there.
fn leg_move(leg: ptr<function, Leg>, ray: AirRay, v: f32, altitude_m: f32, optical_depth: ptr<function, vec3<f32>>) {
    let v_middle = 0.5 * (leg.v + v);
    let middle_m = leg_altitude_m(*leg, ray, leg_distance_m(*leg, v_middle));
    let middle = extinction_without_tents_at(middle_m) * v_middle;
    let end = extinction_without_tents_at(altitude_m) * v;
    // dt = 2 length v dv, by Simpson's rule.
    let step = 2.0 * leg.length_m * abs(v - leg.v) / 6.0;
    *optical_depth += step * (leg.weighted_extinction_per_m + 4.0 * middle + end);
    let distances_m = vec2<f32>(leg_distance_m(*leg, leg.v), leg_distance_m(*leg, v));
    let way_m = 2.0 * leg.length_m * abs(v - leg.v) * v_middle;
    *optical_depth += tents_between(ray, distances_m, way_m, vec2<f32>(leg.altitude_m, altitude_m), middle_m);
    leg.v = v;
    leg.altitude_m = altitude_m;
    leg.weighted_extinction_per_m = end;
}

// Moves to the leg's next node; optical_depth becomes that from the ray's start to the node.
fn leg_advance(leg: ptr<function, Leg>, ray: AirRay, index: u32, optical_depth: ptr<function, vec3<f32>>) -> Node {
    let gauss = gauss_nodes[index];
    let v = select(gauss.abscissa, gauss.descending_abscissa, leg.descending);
    let weight = select(gauss.weight, gauss.descending_weight, leg.descending);
    var node: Node;
    node.distance_m = leg_distance_m(*leg, v);
    node.altitude_m = leg_altitude_m(*leg, ray, node.distance_m);
    node.weight_m = 2.0 * leg.length_m * v * weight;
    leg_move(leg, ray, v, node.altitude_m, optical_depth);
    return node;
}

// Moves to the end of the leg; optical_depth becomes that from the ray's start to there.
fn leg_finish(leg: ptr<function, Leg>, ray: AirRay, optical_depth: ptr<function, vec3<f32>>) {
    let v = select(1.0, 0.0, leg.descending);
    leg_move(leg, ray, v, leg_altitude_m(*leg, ray, leg_distance_m(*leg, v)), optical_depth);
}

// Directions at a node, in the frame of its own vertical, whose azimuth 0 points to the light.
struct LocalDirections {
    mu: f32,
    mu_s: f32,
    cos_phi: f32,
}

fn local_directions(ray: AirRay, node: Node) -> LocalDirections {
    let r_start = atmosphere.radius_m + ray.altitude_m;
    let r = atmosphere.radius_m + node.altitude_m;
    var local: LocalDirections;
    local.mu = clamp((r_start * ray.mu + node.distance_m) / r, -1.0, 1.0);
    local.mu_s = clamp((r_start * ray.mu_s + node.distance_m * ray.nu) / r, -1.0, 1.0);
    let sines = sqrt((1.0 - local.mu * local.mu) * (1.0 - local.mu_s * local.mu_s));
    // Where an azimuth is undefined every term that it enters has a factor of zero.
    local.cos_phi = clamp((ray.nu - local.mu * local.mu_s) / max(sines, 1e-6), -1.0, 1.0);
    return local;
}

// Cosine of the light's zenith angle where a ray meets the ground.
fn ground_mu_s(ray: AirRay) -> f32 {
    let r_start = atmosphere.radius_m + ray.altitude_m;
    return clamp((r_start * ray.mu_s + ray.length_m * ray.nu) / atmosphere.radius_m, -1.0, 1.0);
}

// Panels of Simpson's rule on each leg where only optical depth is asked for.
const FINE_PANELS: u32 = #{FINE_PANELS}u;

// Optical depth along the whole ray.
fn optical_depth_along(ray: AirRay) -> vec3<f32> {
    var optical_depth = vec3<f32>(0.0);
    for (var i = 0u; i < counted(LEG_COUNT); i++) {
        var leg = leg_of(ray, i);
        if leg_is_empty(leg) {
            continue;
        }
        for (var n = 1u; n <= FINE_PANELS; n++) {
            let share = f32(n) / f32(FINE_PANELS);
            let v = select(share, 1.0 - share, leg.descending);
            leg_move(&leg, ray, v, leg_altitude_m(leg, ray, leg_distance_m(leg, v)), &optical_depth);
        }
    }
    return optical_depth;
}
