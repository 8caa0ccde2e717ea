#define_import_path welkin::mapping
// Where a physical parameter lies in a table: the same mappings as the host's welkin_lut::mapping.
//
// A table's coordinate in [0, 1] is inset so that 0 and 1 fall on the centres of the first and last texel.

#import welkin::geometry::horizon_mu

const PI: f32 = 3.14159265358979;

// From [0, 1] to a texture coordinate.
fn inset(x: vec2<f32>, size: vec2<f32>) -> vec2<f32> {
    return (x * (size - 1.0) + 0.5) / size;
}

// Keeps a filter inside its tile or block, of whose neighbours devices would take up to 1/256 at the edge.
const TILE_MARGIN: f32 = 0.002;

// From [0, 1] to a place in a tile, in texels from the centre of its first.
fn inside_tile(x: vec2<f32>, size: vec2<f32>) -> vec2<f32> {
    return clamp(x * (size - 1.0), vec2<f32>(TILE_MARGIN), size - 1.0 - TILE_MARGIN);
}

// From a texel's index to [0, 1].
fn unit_from_texel(texel: vec2<u32>, size: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(texel) / max(size - 1.0, vec2<f32>(1.0));
}

// --- Optical depth to the top: x = sqrt((mu - mu_h) / (1 - mu_h)), y = sqrt(h / top).

struct AltitudeCosine {
    altitude_m: f32,
    mu: f32,
}

fn optical_depth_from_unit(unit: vec2<f32>, radius_m: f32, top_m: f32) -> AltitudeCosine {
    let altitude_m = top_m * unit.y * unit.y;
    let mu_h = horizon_mu(radius_m, altitude_m);
    return AltitudeCosine(altitude_m, mu_h + (1.0 - mu_h) * unit.x * unit.x);
}

fn optical_depth_to_unit(altitude_m: f32, mu: f32, radius_m: f32, top_m: f32) -> vec2<f32> {
    let mu_h = horizon_mu(radius_m, altitude_m);
    let x2 = (mu - mu_h) / (1.0 - mu_h);
    return sqrt(clamp(vec2<f32>(x2, altitude_m / top_m), vec2<f32>(0.0), vec2<f32>(1.0)));
}

// --- Multiple scattering: x = asinh(k s) from its value at the lowest sun to that at the zenith, y = sqrt(h / top).
//
// s = 1 - sqrt(1 - mu_s) is the sun's height: near the horizon half of mu_s, near the zenith what is left of a right angle. Around a sun
// in the zenith light changes with the angle, of which mu_s has only the square.
// sun_warp: k, which is the larger the sooner night falls on the planet; the value at the lowest sun; and the range from
// there to the zenith's. The host's MultipleScatteringMapping has them.

// 1 - sqrt(1 - mu_s), without a difference.
fn sun_height(mu_s: f32) -> f32 {
    return mu_s / (1.0 + sqrt(max(1.0 - mu_s, 0.0)));
}

fn multiple_scattering_from_unit(unit: vec2<f32>, top_m: f32, sun_warp: vec3<f32>) -> AltitudeCosine {
    let height = sinh(sun_warp.y + sun_warp.z * unit.x) / sun_warp.x;
    return AltitudeCosine(top_m * unit.y * unit.y, clamp(height * (2.0 - height), -1.0, 1.0));
}

fn multiple_scattering_to_unit(altitude_m: f32, mu_s: f32, top_m: f32, sun_warp: vec3<f32>) -> vec2<f32> {
    let x = (asinh(sun_warp.x * sun_height(mu_s)) - sun_warp.y) / sun_warp.z;
    return clamp(vec2<f32>(x, sqrt(max(altitude_m, 0.0) / top_m)), vec2<f32>(0.0), vec2<f32>(1.0));
}

// --- Sky view: the two halves of the view sphere, above and below the horizon, each a table of its own, so that no
// filter reaches across the horizon. x = azimuth from the light / pi, y = sqrt(angle from the horizon / its range).

struct SkyViewRange {
    // Zenith angle that parts the halves, rad.
    horizon_rad: f32,
    // Where the sky half ends: the zenith, or the limb of the air seen from outside, rad.
    sky_end_rad: f32,
    // y there: less than 1 just above the top, where rows gather on the air only gradually.
    sky_end_y: f32,
    // Highest y at which the sky half's table is filled with a view of its own: rows beyond the limb look inside it.
    last_y: f32,
}

struct ZenithAzimuth {
    zenith_rad: f32,
    azimuth_rad: f32,
}

fn sky_view_from_unit(unit: vec2<f32>, below_horizon: bool, range: SkyViewRange) -> ZenithAzimuth {
    let end_rad = select(range.sky_end_rad, PI, below_horizon);
    let y = select(min(unit.y, range.last_y) / range.sky_end_y, unit.y, below_horizon);
    let zenith_rad = range.horizon_rad + (end_rad - range.horizon_rad) * y * y;
    return ZenithAzimuth(zenith_rad, PI * unit.x);
}

fn sky_view_to_unit(zenith_rad: f32, azimuth_rad: f32, below_horizon: bool, range: SkyViewRange) -> vec2<f32> {
    let end_rad = select(range.sky_end_rad, PI, below_horizon);
    let y = sqrt(clamp((zenith_rad - range.horizon_rad) / (end_rad - range.horizon_rad), 0.0, 1.0));
    return vec2<f32>(clamp(azimuth_rad / PI, 0.0, 1.0), y * select(range.sky_end_y, 1.0, below_horizon));
}

// --- Slices of the froxels along a ray: squares of distance from its lowest point on either side.

struct Slices {
    // The ray's length inside the air, m.
    length_m: f32,
    // Distance of its lowest point, in [0, length_m].
    lowest_m: f32,
    // Where that point lies in the coordinate.
    lowest_unit: f32,
}

fn slices_of(length_m: f32, tangent_m: f32) -> Slices {
    let lowest_m = clamp(tangent_m, 0.0, length_m);
    let descent = sqrt(lowest_m);
    return Slices(length_m, lowest_m, descent / max(descent + sqrt(length_m - lowest_m), 1e-20));
}

fn slice_distance_m(unit: f32, slices: Slices) -> f32 {
    if unit < slices.lowest_unit {
        let v = 1.0 - unit / slices.lowest_unit;
        return slices.lowest_m * (1.0 - v * v);
    }
    let v = (unit - slices.lowest_unit) / max(1.0 - slices.lowest_unit, 1e-20);
    return slices.lowest_m + (slices.length_m - slices.lowest_m) * v * v;
}

fn slice_unit(distance_m: f32, slices: Slices) -> f32 {
    if distance_m < slices.lowest_m {
        // 1 - sqrt(1 - x) without cancellation near the camera.
        let x = distance_m / slices.lowest_m;
        return slices.lowest_unit * x / (1.0 + sqrt(1.0 - x));
    }
    let rest = max(slices.length_m - slices.lowest_m, 1e-20);
    let v = sqrt(clamp((distance_m - slices.lowest_m) / rest, 0.0, 1.0));
    return slices.lowest_unit + (1.0 - slices.lowest_unit) * v;
}
