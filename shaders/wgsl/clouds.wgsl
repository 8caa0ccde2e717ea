// Pass: clouds along every pixel's ray: their light, what they let through, and how much of the air's light is left.
//
// The ray is cut where it crosses a layer's base or top; gaps are taken in one step, and inside layers steps skip what
// is certainly empty. In a step the light is integrated with its own attenuation, so that no step is too long for
// energy. Steps start at a place of their own in each pixel, by blue noise: the same picture every time.
//
// One pixel of every block of CLOUD_BLOCK x CLOUD_BLOCK is marched, another one each frame; the ray ends at a surface that
// stands before the camera.
//
// Definitions: CLOUD_DISTANCE (also write distances); FOLLOWED_CLOUDS (what they leave of other light is kept in half floats); CLOUD_BLOCK; CLOUD_MAX_STEPS; CLOUD_STEP_M, the shortest step; CLOUD_STEP_PERMILLE, a step's share of the distance.

#import welkin::atmosphere::atmosphere
#import welkin::attenuation::opacity
#import welkin::cloud_field::{to_map, CLOUD_LAYER_SLOTS}
#import welkin::cloud_frame::cloud_frame
#import welkin::cloud_source::{phases, PHASE_COUNT}
#import welkin::cloud_step::{
    bodies_at, extinction_of, from_clouds, gap_of_layers_m, is_any_above_zero, is_in_clouds, CloudStep,
}
#import welkin::media_march::{
    altitude_m, clear_air, follow_air, growth_behind, leave_air, left_on_surface, next_crossing_m, pass_air, place_in_step,
    position_m, ray_of, rise_at, through_air, Air, Ray, NEVER_M, OPAQUE,
}

// Light of the clouds at the observer, and their transmittance.
@group(1) @binding(10) var cloud_radiance_image: texture_storage_2d<rgba32float, write>;
// int T S dT_air to the end of the ray over int dT_air, the share that is left of the air's light: S is what clouds leave of
// the light that the air scatters, of the sun's beam and, in the second image, of diffuse light. Then what they leave on the
// ground there, of the beam and of the sky.
#ifdef FOLLOWED_CLOUDS
@group(1) @binding(11) var cloud_air_image: texture_storage_2d<rgba16float, write>;
@group(1) @binding(12) var cloud_diffuse_image: texture_storage_2d<rgba16float, write>;
#else
@group(1) @binding(11) var cloud_air_image: texture_storage_2d<rgba32float, write>;
@group(1) @binding(12) var cloud_diffuse_image: texture_storage_2d<rgba32float, write>;
#endif

#ifdef CLOUD_DISTANCE
// Mean distance of the clouds, weighted with what they hide.
@group(1) @binding(13) var cloud_distance_image: texture_storage_2d<r32float, write>;
const INFINITY_BITS: u32 = 0x7f800000u;
#endif

const BLOCK: u32 = #{CLOUD_BLOCK}u;
const MAX_STEPS: u32 = #{CLOUD_MAX_STEPS}u;
const STEP_M: f32 = #{CLOUD_STEP_M}.0;
// Behind it steps grow.
const SMOOTH_DEPTH: f32 = 2.0;
// Steps after which what lies beside is waited for.
const LOOKS: u32 = 16u;
// Air of a smaller optical depth sends nothing.
const CLEAR_DEPTH: f32 = 1e-9;
const STEP_GROWTH: f32 = #{CLOUD_STEP_PERMILLE}.0 * 0.001;

struct Sum {
    radiance: vec3<f32>,
    // Optical depth of clouds so far, and the share of the sky's light behind them that they scatter by small angles only.
    clouds: f32,
    passed: f32,
    // int t dT, m.
    weighted_m: f32,
}

// Where a march is.
struct March {
    t_m: f32,
    steps: u32,
    // The next crossing of a layer's base or top, and the last.
    boundary_m: f32,
    entered_m: f32,
    // The step from t_m: its length, the place that stands for it, and what is there before erosion and after.
    step_m: f32,
    at_m: f32,
    map: vec2<f32>,
    altitude: f32,
    bodies: array<f32, CLOUD_LAYER_SLOTS>,
    extinction: f32,
}

// Goes on to the next step with a cloud in it, behind an optical depth of clouds; returns whether there is one.
//
// Light is left to who asks, erosion to the outer loop and steps through what is empty to the inner: lanes that march beside each other
// do each together, however few of them meet a cloud at the same step (Aila & Laine 2009, Understanding the efficiency of ray
// traversal on GPUs).
fn find_cloud(march: ptr<function, March>, ray: ptr<function, Ray>, offset: f32, clouds: f32) -> bool {
    let growth = growth_behind(clouds, SMOOTH_DEPTH);
    while (*march).steps < MAX_STEPS && (*march).t_m < (*ray).end_m {
        let t_m = (*march).t_m;
        if t_m >= (*march).boundary_m {
            (*march).boundary_m = next_crossing_m(ray, t_m);
            (*march).entered_m = t_m;
        }
        let boundary_m = (*march).boundary_m;
        if boundary_m >= NEVER_M {
            return false;
        }
        // Between boundaries the middle tells which layers the ray is in.
        let middle = altitude_m(ray, 0.5 * (t_m + boundary_m));
        if !is_in_clouds(middle) {
            (*march).t_m = boundary_m;
            (*march).steps += 1u;
            continue;
        }
        if look_ahead(march, ray, offset, growth, middle) {
            var bodies = (*march).bodies;
            (*march).extinction = extinction_of(&bodies, (*march).map, (*march).altitude);
            if (*march).extinction > 0.0 {
                return true;
            }
            (*march).t_m += (*march).step_m;
        }
    }
    return false;
}

// Takes some steps through what is empty even before erosion, leaping over gaps between columns; returns whether it stands before a step
// that is not. The layers are those that hold the altitude `within`.
fn look_ahead(march: ptr<function, March>, ray: ptr<function, Ray>, offset: f32, growth: f32, within: f32) -> bool {
    let boundary_m = (*march).boundary_m;
    // Seen from far above, a layer still takes a few steps.
    let longest_m = max(0.125 * (boundary_m - (*march).entered_m), STEP_M);
    for (var i = 0u; i < LOOKS && (*march).t_m < boundary_m; i++) {
        let t_m = (*march).t_m;
        let step_m = min(min(growth * max(STEP_M, STEP_GROWTH * t_m), longest_m), boundary_m - t_m);
        let at_m = t_m + offset * step_m;
        let map = to_map(atmosphere.radius_m, position_m(ray, at_m));
        let altitude = altitude_m(ray, at_m);
        (*march).steps += 1u;
        let empty_m = gap_of_layers_m(map, altitude, rise_at(ray, at_m, altitude), within);
        if empty_m <= 0.0 {
            var bodies = bodies_at(map, altitude);
            if is_any_above_zero(&bodies) {
                (*march).step_m = step_m;
                (*march).at_m = at_m;
                (*march).map = map;
                (*march).altitude = altitude;
                (*march).bodies = bodies;
                return true;
            }
        }
        (*march).t_m = min(max(t_m + step_m, at_m + empty_m), boundary_m);
    }
    return false;
}

// Adds the light of the step that a march is at.
fn add_light(
    sum: ptr<function, Sum>, march: ptr<function, March>, ray: ptr<function, Ray>,
    phase: ptr<function, array<f32, PHASE_COUNT>>, air: ptr<function, Air>
) {
    let at_m = (*march).at_m;
    let p = position_m(ray, at_m);
    let up = normalize(vec3<f32>(p.xy, p.z + atmosphere.radius_m));
    let within = (*march).extinction * (*march).step_m;
    let step = CloudStep((*march).map, (*march).altitude, up, (*march).extinction, (*sum).clouds, within);
    let light = from_clouds(step, (*ray).direction, phase);
    (*sum).radiance += through_air(air, at_m) * light.radiance;
    (*sum).passed += light.passed;
    (*sum).weighted_m += at_m * (exp(-(*sum).clouds) - exp(-(*sum).clouds - within));
    (*sum).clouds += within;
}

// What clouds let pass of the light of the air behind them.
fn left_of_air(sum: Sum) -> vec3<f32> {
    return vec3<f32>(exp(-sum.clouds) + sum.passed);
}

// Of air that does nothing all is left.
fn share_of_air(left: vec3<f32>, depth: vec3<f32>) -> vec3<f32> {
    let is_clear = depth < vec3<f32>(CLEAR_DEPTH);
    return select(left / opacity(select(depth, vec3<f32>(1.0), is_clear)), vec3<f32>(1.0), is_clear);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(cloud_radiance_image)) {
        return;
    }
    let pixel = BLOCK * id.xy + cloud_frame.first_pixel;
    var ray = ray_of(pixel);
    var phase = phases(ray.direction);
    let offset = place_in_step(pixel, cloud_frame.jitter);
    var sum: Sum;
    var air = clear_air();
    var march: March;
    march.boundary_m = next_crossing_m(&ray, 0.0);
    loop {
        let is_found = sum.clouds < OPAQUE && find_cloud(&march, &ray, offset, sum.clouds);
        pass_air(&air, &ray, left_of_air(sum), march.t_m);
        if !is_found {
            break;
        }
        add_light(&sum, &march, &ray, &phase, &air);
        march.t_m += march.step_m;
        pass_air(&air, &ray, left_of_air(sum), march.t_m);
    }
    var ground = vec2<f32>(1.0);
    if ray.end_m < NEVER_M {
        pass_air(&air, &ray, left_of_air(sum), ray.end_m);
        follow_air(&air, &ray);
        let end = to_map(atmosphere.radius_m, position_m(&ray, ray.end_m));
        let altitude = max(altitude_m(&ray, ray.end_m), 0.0);
        ground = left_on_surface(&air, end, altitude);
    } else {
        leave_air(&air, &ray, left_of_air(sum));
    }
    let transmittance = select(exp(-sum.clouds), 0.0, sum.clouds >= OPAQUE);
#ifdef CLOUD_DISTANCE
    // Where nothing is hidden there is no such distance.
    let hidden = 1.0 - transmittance;
    let mean_m = select(bitcast<f32>(INFINITY_BITS), sum.weighted_m / hidden, hidden > 1e-4);
    textureStore(cloud_distance_image, id.xy, vec4<f32>(mean_m, 0.0, 0.0, 0.0));
#endif
    textureStore(cloud_radiance_image, id.xy, vec4<f32>(sum.radiance, transmittance));
    textureStore(cloud_air_image, id.xy, vec4<f32>(share_of_air(air.beam, air.depth), ground.x));
    textureStore(cloud_diffuse_image, id.xy, vec4<f32>(share_of_air(air.diffuse, air.depth), ground.y));
}
