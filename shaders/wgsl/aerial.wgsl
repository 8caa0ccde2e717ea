#define_import_path welkin::aerial
// Aerial perspective: the air between the observer and a point at a distance, in any direction.
//
//   let reach = aerial::reach_of(direction, distance_m);
//   colour = colour * reach.transmittance + irradiance * aerial::air_radiance_before(light, direction, reach);
//
// Froxels lie on the view sphere, with azimuths and zenith angles as those of the sky view, and slices along the ray.
// They hold what changes little from one to the next: how much brighter the air up to a slice is than the air of the
// whole ray, each over its own opacity; as a logarithm. Times the sky view and the opacities this is in-scattered light that vanishes
// with the distance, and that is the sky's, exactly, where the ray ends. Optical depth is kept alike, in a table of its
// own with more rows: relative to that of the whole ray at constant density.
//
// Where a ray starts in the planet's shadow, light that was scattered once begins at its edge. Its slices therefore divide
// the lit part of the ray alone, and what they hold is over the lit share of the way too. A ray that enters the shadow
// later needs no such care: light has faded before it, and where the edge lies, if at all, depends on the direction too
// steeply for froxels to hold what is relative to it.
//
// Definitions: AIR (there is any), LIT, MULTIPLE_SCATTERING, EMISSION; see welkin::sky.

#import welkin::atmosphere::{atmosphere, phase_per_sr, SCATTERER_COUNT}
#import welkin::attenuation::opacity
#import welkin::geometry::shadow_interval_m
#import welkin::mapping
#import welkin::march::{view_ray, AirRay}
#import welkin::observer::{light_mu_s, observer, LIGHT_COUNT}
#import welkin::sky::{
    emission_radiance, length_m, sky_view, view_optical_depth, Shares, SkyDirection, ALL, LAYER_COUNT, MULTIPLE_LAYER,
    SINGLE_LAYER,
}
#import welkin::tables::{sample_exactly, table_sampler}

// x: azimuth of each light; y: zenith angle of the sky half, then of the ground half; z: slices of each layer of the
// sky view.
@group(0) @binding(30) var froxel_light: texture_3d<f32>;
// x: slice; y as above.
@group(0) @binding(31) var froxel_optical_depth: texture_2d<f32>;

#ifdef EMISSION
// As froxel_optical_depth.
@group(0) @binding(32) var froxel_emission: texture_2d<f32>;
#endif

// A point before the observer, as the froxels know it.
struct Reach {
    // Of the air up to the point.
    transmittance: vec3<f32>,
    // Opacity up to the point over that of the whole ray.
    opacity_share: vec3<f32>,
    // Light that the air before the point gives off by itself, W/m2/sr/nm.
    emission: vec3<f32>,
    // The slices' unit coordinate.
    slice: f32,
    // From where the ray enters the air, m.
    along_m: f32,
    // Whether the point lies where the ray leaves the air or meets the planet, or behind.
    at_end: bool,
}

// One opacity over another; of air that does nothing, the share of the way.
fn opacity_ratio(part: vec3<f32>, whole: vec3<f32>, share_of_way: f32) -> vec3<f32> {
    let clear = whole < vec3<f32>(1e-12);
    let ratio = opacity(part) / select(opacity(whole), vec3<f32>(1.0), clear);
    return select(ratio, vec3<f32>(share_of_way), clear);
}

// Texture coordinate of a unit coordinate in one of `parts` equal parts of an axis.
fn part_coordinate(unit: f32, part: u32, parts: u32, size: u32) -> f32 {
    let texels = f32(size / parts);
    return (f32(part) * texels + 0.5 + unit * (texels - 1.0)) / f32(size);
}

// Where a distance along a ray lies in the table of optical depth.
fn optical_depth_uv(direction: SkyDirection, slice: f32) -> vec2<f32> {
    let unit = mapping::sky_view_to_unit(direction.zenith_rad, 0.0, direction.below_horizon, observer.view);
    let size = textureDimensions(froxel_optical_depth);
    return vec2<f32>(
        part_coordinate(slice, 0u, 1u, size.x),
        part_coordinate(unit.y, u32(direction.below_horizon), 2u, size.y),
    );
}

fn reach_of(direction: SkyDirection, distance_m: f32) -> Reach {
    var reach = Reach(vec3<f32>(1.0), vec3<f32>(1.0), emission_radiance(direction), 1.0, 0.0, true);
#ifdef AIR
    let ray = view_ray(
        observer.altitude_m, cos(direction.zenith_rad), light_mu_s(0u), direction.nu, direction.below_horizon
    );
    let whole = view_optical_depth(direction);
    let along_m = clamp(distance_m - ray.start_m, 0.0, ray.length_m);
    reach.along_m = along_m;
    reach.at_end = distance_m - ray.start_m >= ray.length_m;
    if reach.at_end {
        reach.transmittance = exp(-whole);
        return reach;
    }
    reach.slice = mapping::slice_unit(along_m, mapping::slices_of(ray.length_m, ray.tangent_m));
    let uv = optical_depth_uv(direction, reach.slice);
    let share_of_way = along_m / ray.length_m;
    let tau = share_of_way * whole * textureSampleLevel(froxel_optical_depth, table_sampler, uv, 0.0).rgb;
    reach.transmittance = exp(-tau);
    reach.opacity_share = opacity_ratio(tau, whole, share_of_way);
#ifdef EMISSION
    reach.emission = share_of_way * sample_exactly(froxel_emission, uv);
#endif
#endif
    return reach;
}

// A ray without the part of the planet's shadow that it starts in.
struct LitWay {
    // Where that shadow ends, m; 0 for a ray that starts in the light.
    start_m: f32,
    // Length of the rest, m.
    rest_m: f32,
    slices: mapping::Slices,
}

fn lit_way(ray: AirRay) -> LitWay {
    let shadow_m = shadow_interval_m(
        atmosphere.radius_m, ray.altitude_m, ray.mu, ray.mu_s, ray.nu, ray.length_m
    );
    let start_m = select(0.0, shadow_m.y, shadow_m.x <= 0.0 && shadow_m.y > 0.0);
    // A dark ray has a length yet, so that its neighbours have something to interpolate with.
    let rest_m = max(ray.length_m - start_m, 1e-3);
    return LitWay(start_m, rest_m, mapping::slices_of(rest_m, ray.tangent_m - start_m));
}

// How much more of the lit way than of the whole way lies before a point.
fn lit_share(distance_m: f32, ray_length_m: f32, way: LitWay) -> f32 {
    return max(distance_m - way.start_m, 0.0) / way.rest_m * ray_length_m / max(distance_m, 1e-3);
}

// A layer of the sky view, over the length of air, as far as it comes from before a point.
fn sky_view_before(light: u32, layer: u32, direction: SkyDirection, reach: Reach) -> vec3<f32> {
    let whole = sky_view(light, layer, direction);
    if reach.at_end {
        return whole;
    }
    var slice = reach.slice;
    var share = reach.opacity_share;
    if layer >= SINGLE_LAYER {
        let mu = cos(direction.zenith_rad);
        let ray = view_ray(observer.altitude_m, mu, light_mu_s(light), direction.nu, direction.below_horizon);
        let way = lit_way(ray);
        slice = mapping::slice_unit(max(reach.along_m - way.start_m, 0.0), way.slices);
        share *= lit_share(reach.along_m, ray.length_m, way);
    }
    let unit = mapping::sky_view_to_unit(
        direction.zenith_rad, direction.azimuth_rad, direction.below_horizon, observer.view
    );
    let size = textureDimensions(froxel_light);
    let uvw = vec3<f32>(
        part_coordinate(unit.x, light, LIGHT_COUNT, size.x),
        part_coordinate(unit.y, u32(direction.below_horizon), 2u, size.y),
        part_coordinate(slice, layer, LAYER_COUNT, size.z),
    );
    return whole * share * exp(textureSampleLevel(froxel_light, table_sampler, uvw, 0.0).rgb);
}

// Radiance that the air before a point sends to the observer, 1/sr: per unit irradiance of the light.
fn air_radiance_before(light: u32, direction: SkyDirection, reach: Reach) -> vec3<f32> {
    return air_radiance_before_of(light, direction, reach, ALL);
}

// The same of shares of its light.
fn air_radiance_before_of(light: u32, direction: SkyDirection, reach: Reach, shares: Shares) -> vec3<f32> {
    var radiance = vec3<f32>(0.0);
#ifdef LIT
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        radiance += phase_per_sr(c, direction.nu) * sky_view_before(light, SINGLE_LAYER + c, direction, reach);
    }
    radiance *= shares.straight;
#ifdef MULTIPLE_SCATTERING
    radiance += shares.diffuse * sky_view_before(light, MULTIPLE_LAYER, direction, reach);
#endif
    radiance *= length_m(direction);
#endif
    return radiance;
}
