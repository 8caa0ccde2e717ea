// Pass: mountains before the sky: how far away, and what light they send to the camera.
//
// Each pixel's ray is marched through the height field on the sphere, in steps that the steepest slope allows, until it
// is below the ground; then it is halved between the last two steps. Waves shorter than a pixel are left out, and far
// away, where a pixel holds whole hills, the field goes over into the smooth sphere.
//
// What a point sends is Lambertian: the lights through air and past other hills, with penumbras, and the diffuse light
// of welkin::surface_light. Clouds dim the first light, and what they scatter down of it comes from all of the sky; fog dims both, and
// local lights add theirs.
//
// Definitions: CLOUDS, LOCAL_MEDIA.

#import welkin::atmosphere::{atmosphere, PI}
#import welkin::camera::{view_direction, pixel_angle_rad}
#ifdef CLOUDS
#import welkin::cloud_daylight::{clear_fluxes, cover_at, left_on_ground, straight_left}
#import welkin::cloud_field::to_map
#endif
#import welkin::geometry
#import welkin::height_field::{gradient_at, height_below, height_field, relief_share}
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::surface_light::{diffuse_irradiance, light_transmittance}
#ifdef LOCAL_MEDIA
#import welkin::cluster::{cluster_of, slice_of}
#import welkin::fog_daylight::fog_share
#import welkin::media_ground::lit_by_lamps
#import welkin::volume_field::place_of
#endif

@group(0) @binding(30) var terrain_image: texture_storage_2d<rgba32float, write>;

const NO_SURFACE_M: f32 = 1e30;
const VIEW_STEPS: u32 = 400u;
const SHADOW_STEPS: u32 = 64u;
const HALVINGS: u32 = 8u;
// Smallest step over the footprint.
const FINEST_STEP: f32 = 0.4;

// A straight ray from a point of the local frame.
struct Ray {
    // East and north of its start, m.
    start: vec2<f32>,
    altitude_m: f32,
    // Zenith cosine at the start.
    mu: f32,
    // East and north of its direction.
    direction: vec2<f32>,
}

fn ray_altitude_m(ray: Ray, distance_m: f32) -> f32 {
    return geometry::altitude_along(atmosphere.radius_m, ray.altitude_m, ray.mu, distance_m);
}

// Foot of a point of the ray on the sphere.
fn foot(ray: Ray, distance_m: f32, altitude_m: f32) -> vec2<f32> {
    let shrink = atmosphere.radius_m / (atmosphere.radius_m + altitude_m);
    return (ray.start + distance_m * ray.direction) * shrink;
}

// Height of the ray over the ground, m: high above it, at least half of that.
fn clearance_m(ray: Ray, distance_m: f32, footprint_m: f32) -> f32 {
    let altitude_m = ray_altitude_m(ray, distance_m);
    return altitude_m - height_below(foot(ray, distance_m, altitude_m), footprint_m, altitude_m);
}

// How fast a ray may come nearer to the ground per metre.
fn approach(ray: Ray, distance_m: f32) -> f32 {
    let r = atmosphere.radius_m + ray.altitude_m;
    let mu = (r * ray.mu + distance_m) / (atmosphere.radius_m + max(ray_altitude_m(ray, distance_m), 0.0));
    return max(height_field.steepest_slope - mu, 0.1);
}

// Distances between which the ray may meet the ground; the second is below the first when it cannot.
fn reach(ray: Ray, below_horizon: bool) -> vec2<f32> {
    let radius_m = atmosphere.radius_m;
    let top_m = height_field.height_m;
    var start_m = 0.0;
    if ray.altitude_m > top_m {
        let impact_m = (radius_m + ray.altitude_m) * sqrt(max(1.0 - ray.mu * ray.mu, 0.0));
        if ray.mu >= 0.0 || impact_m >= radius_m + top_m {
            return vec2<f32>(0.0, -1.0);
        }
        start_m = geometry::distance_to_shell_from_above(radius_m, ray.altitude_m, ray.mu, top_m);
    }
    if below_horizon {
        return vec2<f32>(start_m, geometry::distance_to_shell_from_above(radius_m, ray.altitude_m, ray.mu, 0.0));
    }
    if ray.altitude_m > top_m {
        // Out of the shell again on the other side of the lowest point.
        let lowest_m = -(radius_m + ray.altitude_m) * ray.mu;
        return vec2<f32>(start_m, 2.0 * lowest_m - start_m);
    }
    return vec2<f32>(0.0, geometry::distance_to_shell_from_below(radius_m, ray.altitude_m, ray.mu, top_m));
}

// Distance at which the ray meets the ground, m.
fn trace(ray: Ray, below_horizon: bool, pixel_rad: f32) -> f32 {
    let limits = reach(ray, below_horizon);
    if limits.y < limits.x {
        return NO_SURFACE_M;
    }
    var before_m = limits.x;
    var at_m = limits.x;
    for (var i = 0u; i < VIEW_STEPS; i++) {
        let footprint_m = at_m * pixel_rad;
        let gap_m = clearance_m(ray, at_m, footprint_m);
        if gap_m <= 0.0 {
            return halved(ray, before_m, at_m, pixel_rad);
        }
        if at_m >= limits.y {
            break;
        }
        before_m = at_m;
        // Late steps are longer, so that a ray along the ground ends.
        let finest_m = max(FINEST_STEP * footprint_m, 0.02) * (1.0 + 0.02 * f32(i));
        at_m = min(at_m + max(gap_m / approach(ray, at_m), finest_m), limits.y);
    }
    // The smooth sphere is below all hills.
    return select(NO_SURFACE_M, limits.y, below_horizon);
}

fn halved(ray: Ray, above_m: f32, below_m: f32, pixel_rad: f32) -> f32 {
    var ends = vec2<f32>(above_m, below_m);
    for (var i = 0u; i < HALVINGS; i++) {
        let middle_m = 0.5 * (ends.x + ends.y);
        let is_below = clearance_m(ray, middle_m, middle_m * pixel_rad) <= 0.0;
        ends = select(vec2<f32>(middle_m, ends.y), vec2<f32>(ends.x, middle_m), is_below);
    }
    return ends.y;
}

// Share of a light's disc that the hills leave free.
fn visibility(ray: Ray, radius_rad: f32, footprint_m: f32) -> f32 {
    var visible = 1.0;
    var at_m = 0.5 * footprint_m;
    for (var i = 0u; i < SHADOW_STEPS; i++) {
        let width_m = radius_rad * at_m;
        let gap_m = clearance_m(ray, at_m, max(footprint_m, width_m));
        visible = min(visible, 0.5 + 0.5 * gap_m / max(width_m, 0.25 * footprint_m));
        if visible <= 0.0 || ray_altitude_m(ray, at_m) > height_field.height_m {
            break;
        }
        at_m += max(abs(gap_m) / approach(ray, at_m), max(0.5 * footprint_m, 0.02 * at_m));
    }
    let share = clamp(visible, 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

// Snow lies above its line, less where it is steep.
fn albedo_at(height_m: f32, slope: f32, relief: f32) -> vec3<f32> {
    let depth = (height_m - height_field.snow_line_m) / (0.08 * height_field.height_m) - 1.5 * slope;
    let snow = smoothstep(-0.5, 0.5, depth);
    let ground = mix(height_field.albedo, height_field.snow_albedo, snow);
    return mix(atmosphere.ground_albedo, ground, relief);
}

// What clouds leave of the light on a point of the ground: of a beam straight and scattered, and of the sky's light.
struct Left {
    straight: f32,
    scattered: f32,
    diffuse: f32,
}

fn left_by_clouds(point: vec3<f32>, altitude_m: f32) -> Left {
#ifdef CLOUDS
    let map = to_map(atmosphere.radius_m, point);
    let straight = straight_left(0u, map, altitude_m);
    let clear = clear_fluxes(altitude_m, observer.lights[0].direction.z);
    let left = left_on_ground(straight, cover_at(map, altitude_m), clear);
    return Left(straight, left.x - straight, left.y);
#else
    return Left(1.0, 0.0, 1.0);
#endif
}

// Radiance that a point of the ground sends, of all lights, W/m2/sr/nm.
fn radiance_at(pixel: vec2<u32>, view_ray: Ray, view_z: f32, distance_m: f32, footprint_m: f32) -> vec3<f32> {
    let altitude_m = max(ray_altitude_m(view_ray, distance_m), 0.0);
    let place = view_ray.start + distance_m * view_ray.direction;
    let up = normalize(vec3<f32>(place, atmosphere.radius_m + view_ray.altitude_m + distance_m * view_z));
    let at = foot(view_ray, distance_m, altitude_m);
    let gradient = gradient_at(at, max(footprint_m, 0.05));
    let east = normalize(vec3<f32>(1.0, 0.0, 0.0) - up * up.x);
    let north = cross(up, east);
    let normal = normalize(up - gradient.x * east - gradient.y * north);
    let relief = relief_share(footprint_m);
    let reflectance = albedo_at(altitude_m, length(gradient), relief) / PI;
    let left = left_by_clouds(vec3<f32>(place, view_ray.altitude_m + distance_m * view_z), altitude_m);
    var radiance = vec3<f32>(0.0);
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let toward = observer.lights[light].direction;
        let mu_s = dot(up, toward);
        let mu = dot(up, normal);
        let sines = sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 0.0));
        let cos_phi = clamp((dot(normal, toward) - mu * mu_s) / max(sines, 1e-6), -1.0, 1.0);
        var irradiance = left.diffuse * diffuse_irradiance(altitude_m, mu_s, mu, cos_phi);
        let cosine = dot(normal, toward);
        let radius_rad = max(observer.lights[light].angular_radius_rad, 1e-3);
        let beam = light_transmittance(altitude_m, mu_s, radius_rad);
        if cosine > 0.0 && beam.r + beam.g + beam.b > 0.0 {
            // A little above the ground, so that its own facets do not shade it.
            let raised_m = altitude_m + 0.25 * footprint_m + 0.01;
            let shadow_ray = Ray(place, raised_m, mu_s, toward.xy);
            irradiance += left.straight * cosine * beam * visibility(shadow_ray, radius_rad, footprint_m);
        }
        // Evenly from the half sphere above, of which a slope sees a part.
        irradiance += left.scattered * max(mu_s, 0.0) * beam * 0.5 * (1.0 + mu);
        radiance += observer.lights[light].irradiance * reflectance * irradiance;
    }
#ifdef LOCAL_MEDIA
    let lit = place_of(vec3<f32>(place, view_ray.altitude_m + distance_m * view_z));
    let lamps = lit_by_lamps(lit, normal, cluster_of(pixel, slice_of(distance_m)));
    radiance = radiance * fog_share(lit, vec2<f32>(1.0)) + reflectance * lamps;
#endif
    return radiance;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if any(pixel.xy >= textureDimensions(terrain_image)) {
        return;
    }
    let view = view_direction(pixel.xy);
    let pixel_rad = pixel_angle_rad(view);
    let ray = Ray(vec2<f32>(0.0), observer.altitude_m, view.z, view.xy);
    let below_horizon = atan2(length(view.xy), view.z) > observer.view.horizon_rad;
    let distance_m = trace(ray, below_horizon, pixel_rad);
    var surface = vec4<f32>(0.0, 0.0, 0.0, NO_SURFACE_M);
    if distance_m < NO_SURFACE_M {
        let footprint_m = max(distance_m * pixel_rad, 0.02);
        surface = vec4<f32>(radiance_at(pixel.xy, ray, view.z, distance_m, footprint_m), distance_m);
    }
    textureStore(terrain_image, pixel.xy, surface);
}
