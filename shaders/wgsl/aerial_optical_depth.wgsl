// Pass: optical depth from the observer to each slice of the froxels, for every zenith angle; and the light that the air
// up to there gives off by itself.
//
// Both are the same in all azimuths. Optical depth is kept relative to that of the whole ray at constant density,
// emission over the share of the way; see welkin::aerial.
//
// Definitions: EMISSION (the air gives off light of its own), and those of welkin::emission.

#import welkin::atmosphere::{extinction_at, extinction_without_tents_at}
#import welkin::emission::source_at
#import welkin::mapping
#import welkin::march::{altitude_at, leg_end_m, tents_between, view_ray, AirRay, LEG_COUNT}
#import welkin::observer::observer

#ifdef HALF_TABLES
@group(0) @binding(30) var froxel_optical_depth_image: texture_storage_2d<rgba16float, write>;
#else
@group(0) @binding(30) var froxel_optical_depth_image: texture_storage_2d<rgba32float, write>;
#endif
#ifdef EMISSION
@group(0) @binding(31) var froxel_emission_image: texture_storage_2d<rgba32float, write>;
#endif

// Panels of Simpson's rule between two slices.
const PANEL_COUNT: u32 = 2u;

// Along the way so far.
struct Sum {
    tau: vec3<f32>,
    emission: vec3<f32>,
}

// Extinction without tents at a point of a panel whose middle lies elsewhere: at its end a layer may end too, so a little inside.
fn extinction_within(ray: AirRay, at_m: f32, middle_m: f32) -> vec3<f32> {
#ifdef LAYERS
    return extinction_without_tents_at(altitude_at(ray, mix(at_m, middle_m, 1e-3)));
#else
    return extinction_without_tents_at(altitude_at(ray, at_m));
#endif
}

fn add_stretch(sum: ptr<function, Sum>, ray: AirRay, start_m: f32, end_m: f32) {
    let panel_m = (end_m - start_m) / f32(PANEL_COUNT);
    if panel_m <= 0.0 {
        return;
    }
    var before = extinction_within(ray, start_m, start_m + 0.5 * panel_m);
    for (var i = 0u; i < PANEL_COUNT; i++) {
        let from_m = start_m + f32(i) * panel_m;
        let middle_m = from_m + 0.5 * panel_m;
        let middle_altitude_m = altitude_at(ray, middle_m);
        let middle = extinction_without_tents_at(middle_altitude_m);
        let after = extinction_within(ray, from_m + panel_m, middle_m);
        let ends_m = vec2<f32>(from_m, from_m + panel_m);
        let altitudes_m = vec2<f32>(altitude_at(ray, ends_m.x), altitude_at(ray, ends_m.y));
        let tents = tents_between(ray, ends_m, panel_m, altitudes_m, middle_altitude_m);
        let tau = panel_m / 6.0 * (before + 4.0 * middle + after) + tents;
#ifdef EMISSION
        let source = source_at(ray, middle_m, middle_altitude_m);
        (*sum).emission += panel_m * exp(-(*sum).tau - 0.5 * tau) * source;
#endif
        (*sum).tau += tau;
        before = after;
    }
}

// Adds a slice. No panel straddles the ray's lowest point, where air is densest, or a layer's bounds.
fn add_slice(sum: ptr<function, Sum>, ray: AirRay, slices: mapping::Slices, slice: u32, step: f32) -> f32 {
    let start_m = mapping::slice_distance_m(f32(slice - 1u) * step, slices);
    let end_m = mapping::slice_distance_m(f32(slice) * step, slices);
    var from_m = start_m;
    for (var cut = 0u; cut < LEG_COUNT; cut++) {
        let to_m = clamp(leg_end_m(ray, cut), from_m, end_m);
        add_stretch(sum, ray, from_m, to_m);
        from_m = to_m;
    }
    return end_m;
}

// x: half of the view sphere; y: zenith angle.
@compute @workgroup_size(2, 32)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(froxel_optical_depth_image);
    let rows = size.y / 2u;
    if id.x > 1u || id.y >= rows {
        return;
    }
    let below_horizon = id.x == 1u;
    let unit = mapping::unit_from_texel(vec2<u32>(0u, id.y), vec2<f32>(1.0, f32(rows)));
    let mu = cos(mapping::sky_view_from_unit(unit, below_horizon, observer.view).zenith_rad);
    let ray = view_ray(observer.altitude_m, mu, 1.0, mu, below_horizon);
    // A ray that only touches the air has a length yet, so that its neighbours have something to interpolate with.
    let length_m = max(ray.length_m, 1e-3);
    let slices = mapping::slices_of(length_m, ray.tangent_m);
    let step = 1.0 / f32(size.x - 1u);
    var whole: Sum;
    for (var slice = 1u; slice < size.x; slice++) {
        _ = add_slice(&whole, ray, slices, slice, step);
    }
    let whole_tau = max(whole.tau, vec3<f32>(1e-30));
    let row = id.y + id.x * rows;
    let first = extinction_at(altitude_at(ray, 0.0)) * length_m / whole_tau;
    textureStore(froxel_optical_depth_image, vec2<u32>(0u, row), vec4<f32>(first, 0.0));
#ifdef EMISSION
    let source = source_at(ray, 0.0, altitude_at(ray, 0.0));
    textureStore(froxel_emission_image, vec2<u32>(0u, row), vec4<f32>(length_m * source, 0.0));
#endif
    var sum: Sum;
    for (var slice = 1u; slice < size.x; slice++) {
        let share_of_way = add_slice(&sum, ray, slices, slice, step) / length_m;
        let relative = sum.tau / whole_tau / share_of_way;
        textureStore(froxel_optical_depth_image, vec2<u32>(slice, row), vec4<f32>(relative, 0.0));
#ifdef EMISSION
        textureStore(froxel_emission_image, vec2<u32>(slice, row), vec4<f32>(sum.emission / share_of_way, 0.0));
#endif
    }
}
