// Pass: the march through the sum of all media where a scene has fog, local volumes or local lights: clouds are one more
// kind of matter in it.
//
// A ray is cut where it crosses a layer of clouds or fog, where it enters and leaves local volumes, and at the ends of
// clusters' slices. Between two cuts the same matter is there; steps are as long as its detail, and grow with the distance.
// In a step extinction is constant and the light is integrated with its own attenuation. Empty pieces are taken in one step.
//
// Fog and volumes take from the air's light and shade the ground; that they shade thin air is left out.
//
// Definitions: CLOUDS; VOLUME_GROWTH_PERMILLE, a step's share of the distance; VOLUME_MAX_STEPS; LOCAL_LIGHT_COUNT;
// LAMP_FROXELS; LOCAL_VOLUMES (some volume is no fog); MEDIA_LATTICE (only the pixels of the lattice, or of listed cells:
// welkin::media_lattice).

#import welkin::atmosphere::{atmosphere, PI}
#ifdef CLOUDS
#import welkin::attenuation::mean_transmittance
#endif
#ifdef MEDIA_LATTICE
#import welkin::cell_list::{cell_of_entry, CELL_TOTAL, LIST_HEADER, MOST_GROUPS}
#import welkin::media_lattice::{centre_pixel, corner_pixel, is_node, CELL}
#endif
#import welkin::cluster::{cluster_of, slice_of}
#import welkin::cluster_members::{next_member, volumes_of, NONE}
#import welkin::media_between::{between, next_boundary_m, Between}
#import welkin::fog_daylight::fog_share
#import welkin::media_ground::{ground_lit_by_lamps, volume_share}
#import welkin::media_march::{
    altitude_m, clear_air, follow_air, growth_behind, leave_air, left_on_surface, observer_position, pass_air, place_in_step,
    position_m, ray_of, rise_at, through_air, Air, Ray, NEVER_M, OPAQUE,
}
#import welkin::volume_field::{fog_density, place_of, volume_density, volumes, Place, FOG_COUNT, VOLUME_COUNT}
#import welkin::volume_source::{from_lights, seen_whole, Arriving, Piece, Stretch}
#if FOG_COUNT > 0
#import welkin::observer::observer
#import welkin::slab_field::LOWEST_SUN
#import welkin::volume_grid::spot_of
#import welkin::volume_source::similar_depths
#endif
#if LOCAL_LIGHT_COUNT > 0
#import welkin::cluster_members::{lamps_of, near_lamps_of}
#import welkin::lamp_source::{from_local_light, ALL, NEAR}
#ifdef LAMP_FROXELS
#import welkin::far_lamps::from_far_lamps
#endif
#endif
#ifdef CLOUDS
#import welkin::cloud_field::CLOUD_LAYER_COUNT
#import welkin::cloud_matter::cloud_matter
#import welkin::cloud_source::{phases, PHASE_COUNT}
#import welkin::cloud_step::{cloud_extinction, from_clouds, gap_of_layers_m, is_inside, layer_extinction, CloudStep}
#endif

// Light of clouds, fog and volumes at the observer, and what they leave of the beam on the surface at the end.
@group(1) @binding(50) var media_radiance_image: texture_storage_2d<rgba32float, write>;
// Their transmittance, and what they leave of the diffuse light there.
@group(1) @binding(51) var media_transmittance_image: texture_storage_2d<rgba32float, write>;
// int T S dT_air and T T_air at the end, as in the pass of the clouds: of the beam, and of diffuse light.
@group(1) @binding(52) var media_beam_image: texture_storage_2d<rgba32float, write>;
@group(1) @binding(53) var media_diffuse_image: texture_storage_2d<rgba32float, write>;

const MAX_STEPS: u32 = #{VOLUME_MAX_STEPS}u;
const FOG_SLOTS: u32 = max(FOG_COUNT, 1u);
const STEP_GROWTH: f32 = #{VOLUME_GROWTH_PERMILLE}.0 * 0.001;
// Longest step in optical depths, while little is hidden.
const STEP_DEPTH: f32 = 0.7;
// By how much the depth to a light may change within a step at the top of fog, and by which share of the depth to it farther down.
const BEAM_DEPTH: f32 = 0.3;
const BEAM_GROWTH: f32 = 0.3;
#ifdef CLOUDS
const CLOUD_STEP_M: f32 = #{CLOUD_STEP_M}.0;
const CLOUD_GROWTH: f32 = #{CLOUD_STEP_PERMILLE}.0 * 0.001;
#endif

struct Sum {
    radiance: vec3<f32>,
    // Light from behind that forward peaks pass on.
    passed: vec3<f32>,
    // Optical depth so far: of clouds, of fog and volumes.
    clouds: f32,
    local: vec3<f32>,
    // That of the medium similar to all of them: welkin::volume_source.
    similar: vec3<f32>,
}

fn add_light(sum: ptr<function, Sum>, air_leaves: vec3<f32>, sent: Arriving) {
    (*sum).radiance += air_leaves * sent.scattered;
    (*sum).passed += air_leaves * sent.passed;
}

fn greatest(v: vec3<f32>) -> f32 {
    return max(v.r, max(v.g, v.b));
}

#if LOCAL_LIGHT_COUNT > 0
// Radiance that local lights bring, per density and metre, before the air.
fn from_lamps(piece: Piece, stretch: Stretch, pixel: vec2<u32>, cluster: u32) -> vec3<f32> {
    var radiance = vec3<f32>(0.0);
    var asked = ALL;
    var lamps = lamps_of(cluster);
#ifdef LAMP_FROXELS
    if piece.index < FOG_COUNT {
        asked = NEAR;
        lamps = near_lamps_of(cluster);
        radiance = from_far_lamps(piece.index, pixel, stretch.from_m + 0.5 * stretch.step_m) * seen_whole(stretch);
    }
#endif
    for (var light = next_member(&lamps); light != NONE; light = next_member(&lamps)) {
        radiance += from_local_light(light, piece, stretch, asked);
    }
    return radiance;
}
#endif

// What one volume adds in a step, before the air.
fn from_volume(piece: Piece, stretch: Stretch, pixel: vec2<u32>, cluster: u32) -> Arriving {
    let own = piece.density * stretch.step_m;
    let emitted = own * volumes[piece.index].emission_per_m * seen_whole(stretch);
    if all(volumes[piece.index].scattering_per_m <= vec3<f32>(0.0)) {
        return Arriving(emitted, vec3<f32>(0.0));
    }
    var arriving = from_lights(piece, stretch);
#if LOCAL_LIGHT_COUNT > 0
    arriving.scattered += from_lamps(piece, stretch, pixel, cluster);
#endif
    let scattering = own * volumes[piece.index].scattering_per_m;
    return Arriving(emitted + scattering * arriving.scattered, scattering * arriving.passed);
}

#ifdef CLOUDS
#if LOCAL_LIGHT_COUNT > 0
// What clouds send of the local lights' light in a step, before the air. To a lamp a layer is matter like that of a volume, behind all of which
// its entry stands.
fn clouds_lit_by_lamps(place: Place, extinction: f32, stretch: Stretch, cluster: u32) -> vec3<f32> {
    var radiance = vec3<f32>(0.0);
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        if !is_inside(layer, place.altitude_m) {
            continue;
        }
#if CLOUD_LAYER_COUNT > 1
        let own = layer_extinction(layer, place.map, place.altitude_m);
#else
        let own = extinction;
#endif
        let piece = Piece(VOLUME_COUNT + layer, 1.0, place);
        var lamps = lamps_of(cluster);
        var arriving = vec3<f32>(0.0);
        for (var light = next_member(&lamps); light != NONE; light = next_member(&lamps)) {
            arriving += from_local_light(light, piece, stretch, ALL);
        }
        radiance += own * stretch.step_m * cloud_matter[layer].albedo * arriving;
    }
    return radiance;
}
#endif
#endif

// A step: the point that stands for it, and the extinction of fog and volumes there, 1/m.
struct Step {
    length_m: f32,
    place: Place,
    half_rise_m: f32,
    extinction: vec3<f32>,
    // Of the similar medium.
    similar_extinction: vec3<f32>,
    // Densities of the banks of fog.
    fog: array<f32, FOG_SLOTS>,
}

fn add_matter(step: ptr<function, Step>, index: u32, density: f32) {
    let own = volumes[index].extinction_per_m * density;
    (*step).extinction += own;
    (*step).similar_extinction += volumes[index].similar_extinction * own;
}

fn step_at(ray: ptr<function, Ray>, t_m: f32, length_m: f32, share: f32, cluster: u32) -> Step {
    var step: Step;
    step.length_m = length_m;
    step.place = place_of(position_m(ray, t_m + share * length_m));
    step.half_rise_m = 0.5 * (altitude_m(ray, t_m + length_m) - altitude_m(ray, t_m));
    // Fog is everywhere in a known number of banks: with an index that compilers foresee, a bank's numbers are read once for all pixels.
    for (var bank = 0u; bank < FOG_COUNT; bank++) {
        step.fog[bank] = fog_density(bank, step.place, step.half_rise_m);
        add_matter(&step, bank, step.fog[bank]);
    }
#ifdef LOCAL_VOLUMES
    var locals = volumes_of(cluster);
    for (var index = next_member(&locals); index != NONE; index = next_member(&locals)) {
        add_matter(&step, index, volume_density(index, step.place));
    }
#endif
    return step;
}

#if FOG_COUNT > 0
// The longest step in which light of the first light that fog has scattered changes little, m: it falls with the depth to that light, fastest
// where it is strong.
fn longest_in_beam_m(ray: ptr<function, Ray>, step: Step) -> f32 {
    let p = vec3<f32>(step.place.p.xy, step.place.p.z + atmosphere.radius_m);
    let mu_s = dot(normalize(p), observer.lights[0].direction);
    // Extinction over the cosine by which the ray climbs against the light.
    let slope_per_m = step.similar_extinction.g * abs(dot(normalize(p), (*ray).direction)) / max(mu_s, LOWEST_SUN);
    var longest_m = NEVER_M;
    for (var bank = 0u; bank < FOG_COUNT && mu_s > 0.0; bank++) {
        if step.place.altitude_m < volumes[bank].top_m && step.place.altitude_m > volumes[bank].bottom_m {
            // At that end of the step which is nearer to the light.
            let to_light = max(similar_depths(spot_of(bank, step.place)).x / max(mu_s, LOWEST_SUN) - 0.5 * slope_per_m * step.length_m, 0.0);
            longest_m = min(longest_m, (BEAM_DEPTH + BEAM_GROWTH * to_light) / max(slope_per_m, 1e-20));
        }
    }
    return longest_m;
}
#endif

// The longest step that detail, distance, the next boundary, what it would hide and how light changes in it allow.
fn next_step(ray: ptr<function, Ray>, t_m: f32, boundary_m: f32, here: Between, growth: f32, share: f32) -> Step {
    var length_m = growth * max(here.detail_m, STEP_GROWTH * t_m);
#ifdef CLOUDS
    if here.clouds {
        length_m = min(length_m, growth * max(CLOUD_STEP_M, CLOUD_GROWTH * t_m));
    }
#endif
    length_m = min(length_m, boundary_m - t_m);
    var step = step_at(ray, t_m, length_m, share, here.cluster);
    var longest_m = growth * STEP_DEPTH / max(greatest(step.extinction), 1e-20);
#if FOG_COUNT > 0
    longest_m = min(longest_m, growth * longest_in_beam_m(ray, step));
#endif
    if longest_m < length_m {
        step = step_at(ray, t_m, longest_m, share, here.cluster);
    }
    step.length_m = select(step.length_m, boundary_m - t_m, t_m + step.length_m >= boundary_m * 0.999999);
    return step;
}

#ifdef CLOUDS
// A distance in which there is nothing where there is nothing but clouds, m.
fn empty_ahead_m(ray: ptr<function, Ray>, t_m: f32, here: Between) -> f32 {
    if !here.clouds_alone {
        return 0.0;
    }
    let place = place_of(position_m(ray, t_m));
    return gap_of_layers_m(place.map, place.altitude_m, rise_at(ray, t_m, place.altitude_m), here.middle_altitude_m);
}
#endif

// The light that what the ray ends on receives: shares of the beam and of diffuse light in clear air.
fn ground_share(place: Place, air: ptr<function, Air>) -> vec2<f32> {
    var share = left_on_surface(air, place.map, place.altitude_m);
    share.x *= volume_share(place);
    return share * fog_share(place, share);
}

// Marches a pixel's ray.
fn march(pixel: vec2<u32>) {
    var ray = ray_of(pixel);
    let offset = place_in_step(pixel, 0.0);
#ifdef CLOUDS
    var phase = phases(ray.direction);
#endif
    var sum: Sum;
    var air = clear_air();
    var t_m = 0.0;
    var boundary_m = 0.0;
    var here: Between;
    for (var i = 0u; i < MAX_STEPS && t_m < ray.end_m; i++) {
        if t_m >= boundary_m {
            boundary_m = next_boundary_m(&ray, t_m);
            here = between(&ray, t_m, boundary_m);
        }
        if boundary_m >= NEVER_M {
            break;
        }
        let before = vec3<f32>(sum.clouds) + sum.local;
        if here.detail_m >= NEVER_M {
            follow_air(&air, &ray);
            pass_air(&air, &ray, exp(-before), boundary_m);
            t_m = boundary_m;
            continue;
        }
        if min(before.r, min(before.g, before.b)) >= OPAQUE {
            break;
        }
#ifdef CLOUDS
        let empty_m = empty_ahead_m(&ray, t_m, here);
        if empty_m > 0.0 {
            t_m = min(t_m + empty_m, boundary_m);
            pass_air(&air, &ray, exp(-before), t_m);
            continue;
        }
#endif
        let step = next_step(&ray, t_m, boundary_m, here, growth_behind(greatest(before)), select(0.5, offset, here.uneven));
        let own = step.extinction * step.length_m;
        var within = own;
        var similar_within = step.similar_extinction * step.length_m;
        let air_leaves = through_air(&air, t_m);
#ifdef CLOUDS
        let at = step.place;
        let cloudy = select(0.0, cloud_extinction(at.map, at.altitude_m), here.clouds);
        within += cloudy * step.length_m;
        // Droplets of all layers are taken to be those of the first.
        similar_within += cloud_matter[0].similarity * cloudy * step.length_m;
#endif
        let stretch = Stretch(ray.direction, observer_position(), t_m, step.length_m, before, within, sum.similar, similar_within);
#ifdef CLOUDS
        if cloudy > 0.0 {
            let up = normalize(vec3<f32>(at.p.xy, at.p.z + atmosphere.radius_m));
            let clouds = CloudStep(at.map, at.altitude_m, up, cloudy, sum.clouds, cloudy * step.length_m);
            let light = from_clouds(clouds, ray.direction, &phase);
            sum.radiance += air_leaves * exp(-sum.local) * mean_transmittance(own) * light;
#if LOCAL_LIGHT_COUNT > 0
            sum.radiance += air_leaves * clouds_lit_by_lamps(at, cloudy, stretch, here.cluster);
#endif
            sum.clouds += cloudy * step.length_m;
        }
#endif
        for (var bank = 0u; bank < FOG_COUNT; bank++) {
            if step.fog[bank] > 0.0 {
                let piece = Piece(bank, step.fog[bank], step.place);
                add_light(&sum, air_leaves, from_volume(piece, stretch, ray.pixel, here.cluster));
            }
        }
#ifdef LOCAL_VOLUMES
        var locals = volumes_of(here.cluster);
        for (var index = next_member(&locals); index != NONE; index = next_member(&locals)) {
            let density = volume_density(index, step.place);
            if density > 0.0 {
                let piece = Piece(index, density, step.place);
                add_light(&sum, air_leaves, from_volume(piece, stretch, ray.pixel, here.cluster));
            }
        }
#endif
        sum.local += own;
        sum.similar += similar_within;
        t_m += step.length_m;
        pass_air(&air, &ray, exp(-sum.clouds - sum.local), t_m);
    }
    // Less than nothing of the light from behind cannot pass. What is no number stays none, and is seen.
    sum.radiance += select(sum.passed, vec3<f32>(0.0), sum.passed < vec3<f32>(0.0));
    let transmittance = exp(-sum.clouds - sum.local);
    var ground = vec2<f32>(1.0);
    if ray.end_m < NEVER_M {
        pass_air(&air, &ray, transmittance, ray.end_m);
        follow_air(&air, &ray);
        let end = place_of(position_m(&ray, ray.end_m));
        let surface = Place(end.p, max(end.altitude_m, 0.0), end.map);
        ground = ground_share(surface, &air);
        if ray.meets_ground {
            let lit = ground_lit_by_lamps(surface, ray.pixel, ray.end_m, cluster_of(ray.pixel, slice_of(ray.end_m)));
            sum.radiance += transmittance * exp(-air.depth) * atmosphere.ground_albedo / PI * lit;
        }
    } else {
        leave_air(&air, &ray, transmittance);
    }
    let behind = transmittance * exp(-air.depth);
    textureStore(media_radiance_image, ray.pixel, vec4<f32>(sum.radiance, ground.x));
    textureStore(media_transmittance_image, ray.pixel, vec4<f32>(transmittance, ground.y));
    // The fourth channel tells the lattice where clouds are.
    textureStore(media_beam_image, ray.pixel, vec4<f32>(air.beam + behind, sum.clouds));
    textureStore(media_diffuse_image, ray.pixel, vec4<f32>(air.diffuse + behind, 0.0));
}

#ifdef MEDIA_LATTICE
// Cells whose pixels are marched one by one, and their number: none before those of the lattice are there.
@group(1) @binding(54) var<storage, read> exact_media_cells: array<u32>;

const GROUP_SIZE: u32 = 64u;

struct Asked {
    pixel: vec2<u32>,
    is_asked: bool,
}

// x, y: cell; z: 0 for the pixel in its corner, 1 for the one in its middle.
fn asked_of_lattice(id: vec3<u32>) -> Asked {
    let pixel = select(corner_pixel(id.xy), centre_pixel(id.xy), id.z == 1u);
    return Asked(pixel, all(pixel < textureDimensions(media_radiance_image)));
}

fn asked_of_list(index: u32) -> Asked {
    let cell = cell_of_entry(exact_media_cells[LIST_HEADER + index / (CELL * CELL)]);
    let pixel = corner_pixel(cell) + vec2<u32>(index % CELL, index / CELL % CELL);
    return Asked(pixel, all(pixel < textureDimensions(media_radiance_image)) && !is_node(pixel));
}

@compute @workgroup_size(8, 8)
fn main(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) first: u32,
) {
    let listed = CELL * CELL * exact_media_cells[CELL_TOTAL];
    var index = GROUP_SIZE * group.x + first;
    loop {
        var asked = asked_of_lattice(id);
        if listed > 0u {
            asked = asked_of_list(min(index, listed - 1u));
            asked.is_asked = asked.is_asked && index < listed;
        }
        if asked.is_asked {
            march(asked.pixel);
        }
        continuing {
            index += GROUP_SIZE * MOST_GROUPS;
            break if index >= listed;
        }
    }
}
#else
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if all(id.xy < textureDimensions(media_radiance_image)) {
        march(id.xy);
    }
}
#endif
