#define_import_path welkin::pack
// The sky from a pack's tables, for engines: what `welkin bake` writes, read with one linear, clamped sampler.
//
// Legend: SI units and linear values throughout. All light is for unit irradiance of the sun above the air: multiply by
// your sun's. There is no up axis here, only cosines: your engine's up axis is the planet's radius at the observer.
//   altitude_m   height of the observer above the ground, m; also above the air
//   mu           cosine of the zenith angle of the view direction: dot(view, up)
//   mu_s         the same for the direction to the sun: dot(sun, up)
//   nu           cosine of the angle between the two: dot(view, sun)
//
// Tables hold logarithms, or optical depth; y = 0 is the first row in memory, z = 0 the first slice.

#import welkin::geometry::{air_length_m, distance_to_shell_from_above, horizon_mu, precise_acos}
#import welkin::mapping::{
    inset, inside_tile, multiple_scattering_to_unit, optical_depth_to_unit, sky_view_to_unit, SkyViewRange, PI
}
#import welkin::phase::{lobe_per_sr, PhaseLobe}

const MAX_SCATTERERS: u32 = 8u;
const LOBES: u32 = 2u;

// The sum of its lobes.
struct PhaseFunction {
    lobes: array<PhaseLobe, LOBES>,
}

struct SkyParameters {
    // Lambertian reflectance of the ground.
    ground_albedo: vec3<f32>,
    // Of the planet, m.
    radius_m: f32,
    // How tables are spread over heights of the sun: see welkin::mapping.
    sun_warp: vec3<f32>,
    // Altitude of the air's top, m.
    top_m: f32,
    scatterer_count: u32,
    // Of scattering_table: tiles along x, one for each azimuth.
    azimuth_count: u32,
    // Of scattering_table: slices of each block along z.
    altitude_count: u32,
    padding: u32,
    phase_functions: array<PhaseFunction, MAX_SCATTERERS>,
}

@group(0) @binding(0) var<uniform> sky: SkyParameters;
// Linear between texels, clamped to the edge on all axes, no mip levels.
@group(0) @binding(1) var table_sampler: sampler;
// Optical depth from (altitude, mu) to the top of the air.
@group(0) @binding(2) var transmittance_table: texture_2d<f32>;
// ln of the sky's irradiance on a horizontal plane.
@group(0) @binding(3) var irradiance_table: texture_2d<f32>;
// ln of scattered light over the length of air: blocks along z for (half of the view sphere, layer), in each of them
// altitudes; elevations along y; tiles along x for azimuths, in each of them heights of the sun. Layer 0 is multiply
// scattered radiance, the others are each scatterer's single scattering without its phase function.
@group(0) @binding(4) var scattering_table: texture_3d<f32>;

// Where a view ray's way through the air begins: at the observer, or where the ray from space enters the air.
struct AirEntry {
    altitude_m: f32,
    mu: f32,
    mu_s: f32,
    hits_ground: bool,
    meets_air: bool,
}

fn air_entry(altitude_m: f32, mu: f32, mu_s: f32, nu: f32) -> AirEntry {
    let h = max(altitude_m, 0.0);
    let hits_ground = mu < horizon_mu(sky.radius_m, h);
    if h <= sky.top_m {
        return AirEntry(h, mu, mu_s, hits_ground, true);
    }
    let r = sky.radius_m + h;
    let r_top = sky.radius_m + sky.top_m;
    let sine = r / r_top * sqrt(max(1.0 - mu * mu, 0.0));
    if mu >= 0.0 || sine >= 1.0 {
        return AirEntry(sky.top_m, 1.0, mu_s, false, false);
    }
    let distance_m = distance_to_shell_from_above(sky.radius_m, h, mu, sky.top_m);
    let entry_mu_s = clamp((r * mu_s + distance_m * nu) / r_top, -1.0, 1.0);
    return AirEntry(sky.top_m, -sqrt(max(1.0 - sine * sine, 0.0)), entry_mu_s, hits_ground, true);
}

// Optical depth of the air from a point along a direction that does not meet the ground, to space.
fn optical_depth_to_space(altitude_m: f32, mu: f32) -> vec3<f32> {
    let unit = optical_depth_to_unit(altitude_m, mu, sky.radius_m, sky.top_m);
    let uv = inset(unit, vec2<f32>(textureDimensions(transmittance_table)));
    return textureSampleLevel(transmittance_table, table_sampler, uv, 0.0).rgb;
}

// Share of light that comes from space, from the direction mu, to a point in the air; 0 where the planet is in the way.
fn transmittance_to_space(altitude_m: f32, mu: f32) -> vec3<f32> {
    let h = clamp(altitude_m, 0.0, sky.top_m);
    return select(exp(-optical_depth_to_space(h, mu)), vec3<f32>(0.0), mu < horizon_mu(sky.radius_m, h));
}

// Optical depth from where a ray enters the air to where it leaves it or meets the ground.
fn entry_optical_depth(entry: AirEntry) -> vec3<f32> {
    if !entry.meets_air {
        return vec3<f32>(0.0);
    }
    if !entry.hits_ground {
        return optical_depth_to_space(entry.altitude_m, entry.mu);
    }
    // The same ray walked upwards: from the ground to space, less the part above the observer.
    let length_m = distance_to_shell_from_above(sky.radius_m, entry.altitude_m, entry.mu, 0.0);
    let ground_mu = ((sky.radius_m + entry.altitude_m) * entry.mu + length_m) / sky.radius_m;
    let whole = optical_depth_to_space(0.0, clamp(-ground_mu, 0.0, 1.0));
    return max(whole - optical_depth_to_space(entry.altitude_m, -entry.mu), vec3<f32>(0.0));
}

// Transmittance of a view ray's air, to space or to the ground, whichever it meets.
fn view_transmittance(altitude_m: f32, mu: f32) -> vec3<f32> {
    return exp(-entry_optical_depth(air_entry(altitude_m, mu, 0.0, 0.0)));
}

// Irradiance of the sky, without the sun itself, on a horizontal plane that faces up.
fn sky_irradiance(altitude_m: f32, mu_s: f32) -> vec3<f32> {
    let unit = multiple_scattering_to_unit(altitude_m, mu_s, sky.top_m, sky.sun_warp);
    let uv = inset(unit, vec2<f32>(textureDimensions(irradiance_table)));
    return exp(textureSampleLevel(irradiance_table, table_sampler, uv, 0.0).rgb);
}

// Irradiance of the sun itself on a horizontal plane that faces up.
fn sun_irradiance(altitude_m: f32, mu_s: f32) -> vec3<f32> {
    return max(mu_s, 0.0) * transmittance_to_space(altitude_m, mu_s);
}

// Where a ray lies in scattering_table, in texels from the centre of the first.
struct ScatteringPlace {
    // In the tiles of the azimuths on either side, and how far towards the second.
    x_low: f32,
    x_high: f32,
    share: f32,
    y: f32,
    // In a block.
    z: f32,
    // The first block of the half sphere.
    block: u32,
}

fn scattering_place(entry: AirEntry, nu: f32) -> ScatteringPlace {
    let size = vec3<f32>(textureDimensions(scattering_table));
    let sines = sqrt(max((1.0 - entry.mu * entry.mu) * (1.0 - entry.mu_s * entry.mu_s), 0.0));
    let cos_phi = clamp((nu - entry.mu * entry.mu_s) / max(sines, 1e-6), -1.0, 1.0);
    let horizon_rad = precise_acos(horizon_mu(sky.radius_m, entry.altitude_m));
    let range = SkyViewRange(horizon_rad, 0.0, 1.0, 1.0);
    let view = sky_view_to_unit(precise_acos(entry.mu), precise_acos(cos_phi), entry.hits_ground, range);
    let light = multiple_scattering_to_unit(entry.altitude_m, entry.mu_s, sky.top_m, sky.sun_warp);
    let azimuths = f32(sky.azimuth_count);
    let suns = size.x / azimuths;
    let azimuth = view.x * (azimuths - 1.0);
    let low = clamp(floor(azimuth), 0.0, azimuths - 2.0);
    let inside = inside_tile(light, vec2<f32>(suns, f32(sky.altitude_count)));
    var place: ScatteringPlace;
    place.x_low = low * suns + inside.x;
    place.x_high = place.x_low + suns;
    place.share = azimuth - low;
    place.y = view.y * (size.y - 1.0);
    place.z = inside.y;
    place.block = u32(entry.hits_ground) * (1u + sky.scatterer_count);
    return place;
}

// One layer of scattering_table over the length of air, 1/m.
fn scattering_layer(place: ScatteringPlace, layer: u32) -> vec3<f32> {
    let size = vec3<f32>(textureDimensions(scattering_table));
    let z = f32((place.block + layer) * sky.altitude_count) + place.z;
    let low = (vec3<f32>(place.x_low, place.y, z) + 0.5) / size;
    let high = (vec3<f32>(place.x_high, place.y, z) + 0.5) / size;
    let before = textureSampleLevel(scattering_table, table_sampler, low, 0.0).rgb;
    let after = textureSampleLevel(scattering_table, table_sampler, high, 0.0).rgb;
    return exp(mix(before, after, place.share));
}

// P(nu) of a scatterer, 1/sr.
fn phase_per_sr(scatterer: u32, nu: f32) -> f32 {
    var phase = 0.0;
    for (var i = 0u; i < LOBES; i++) {
        phase += lobe_per_sr(sky.phase_functions[scatterer].lobes[i], nu);
    }
    return phase;
}

// Radiance of the air along a view ray, to space or to the ground, 1/sr: sunlight scattered once and many times, and
// what the ground gives back to the air; without the sun's disc and without the ground behind the air.
fn sky_radiance(altitude_m: f32, mu: f32, mu_s: f32, nu: f32) -> vec3<f32> {
    let entry = air_entry(altitude_m, mu, mu_s, nu);
    if !entry.meets_air {
        return vec3<f32>(0.0);
    }
    let place = scattering_place(entry, nu);
    var radiance_per_m = scattering_layer(place, 0u);
    for (var c = 0u; c < min(sky.scatterer_count, MAX_SCATTERERS); c++) {
        radiance_per_m += phase_per_sr(c, nu) * scattering_layer(place, 1u + c);
    }
    return radiance_per_m * air_length_m(sky.radius_m, sky.top_m, entry.altitude_m, entry.mu, entry.hits_ground);
}

// Radiance of the ground through the air before it, 1/sr; 0 along rays that do not meet the ground.
fn ground_radiance(altitude_m: f32, mu: f32, mu_s: f32, nu: f32) -> vec3<f32> {
    let entry = air_entry(altitude_m, mu, mu_s, nu);
    if !entry.hits_ground {
        return vec3<f32>(0.0);
    }
    let length_m = distance_to_shell_from_above(sky.radius_m, entry.altitude_m, entry.mu, 0.0);
    let r = sky.radius_m + entry.altitude_m;
    let ground_mu_s = clamp((r * entry.mu_s + length_m * nu) / sky.radius_m, -1.0, 1.0);
    let irradiance = sun_irradiance(0.0, ground_mu_s) + sky_irradiance(0.0, ground_mu_s);
    return exp(-entry_optical_depth(entry)) * sky.ground_albedo / PI * irradiance;
}
