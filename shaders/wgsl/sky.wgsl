#define_import_path welkin::sky
// The sky in one direction, from the sky-view table, and the ground behind it.
//
// The table's layers, for each light and each half of the view sphere: the logarithms of multiply scattered radiance,
// then of each scatterer's single scattering without the phase function, over the share of air that is lit
// (welkin::shade). All for unit irradiance of the light, and over the length of air along the ray.
//
// Where the edge of the planet's shadow is in view the air's mean transmittance is left out as well: rows of the table pass
// limbs on which light falls steeply, and there the ozone's kinks would show.
//
// Definitions: AIR (there is any), LIT (a directional light shines on air that scatters), GROUND (light from the ground
// belongs in the picture), MULTIPLE_SCATTERING, EDGE_OF_SHADOW, EMISSION (the air gives off light of its own).

#import welkin::atmosphere::{atmosphere, phase_per_sr, PI, SCATTERER_COUNT}
#import welkin::disc::{beam_count, beam_mu_s, beam_weight, direct_irradiance_of_disc}
#import welkin::geometry::horizon_mu
#import welkin::mapping
#import welkin::march::{air_length_m, ground_mu_s, view_ray}
#import welkin::observer::{light_mu_s, observer}
#import welkin::shade::{ln_lit_share, View}
#import welkin::tables::{diffuse_ground_irradiance, sample_exactly, table_sampler}

@group(0) @binding(6) var multiple_scattering_table: texture_2d_array<f32>;
@group(0) @binding(7) var sky_view_table: texture_2d_array<f32>;
@group(0) @binding(14) var view_optical_depth_table: texture_2d<f32>;
#ifdef EMISSION
@group(0) @binding(15) var view_emission_table: texture_2d<f32>;
#endif

// One over the part of the horizon's depth in which it comes in.
const EDGE_FADE: f32 = 4.0;

const MULTIPLE_LAYER: u32 = 0u;
const SINGLE_LAYER: u32 = 1u;
const LAYER_COUNT: u32 = SINGLE_LAYER + SCATTERER_COUNT;

// Added to the table's logarithms: by day and over a length in metres they lie about -14, where a half float errs by up
// to 0.4 %; shifted to 0 it errs least where light is brightest.
#ifdef HALF_TABLES
const LN_SCALE: f32 = 13.815511;
#else
const LN_SCALE: f32 = 0.0;
#endif

// The first layer of a light's half sphere.
fn layer_of(light: u32, below_horizon: bool) -> u32 {
    return LAYER_COUNT * (2u * light + u32(below_horizon));
}

// A direction as the sky-view table knows it.
struct SkyDirection {
    zenith_rad: f32,
    // From the light's azimuth, in [0, pi].
    azimuth_rad: f32,
    // Cosine of the angle to the light.
    nu: f32,
    below_horizon: bool,
}

// Where a direction lies in a table that has a column for each half of the view sphere.
fn view_row_uv(direction: SkyDirection, size: vec2<f32>) -> vec2<f32> {
    let unit = mapping::sky_view_to_unit(direction.zenith_rad, 0.0, direction.below_horizon, observer.view);
    return mapping::inset(vec2<f32>(f32(direction.below_horizon), unit.y), size);
}

// Length of air along the ray, m.
fn length_m(direction: SkyDirection) -> f32 {
    return air_length_m(observer.altitude_m, cos(direction.zenith_rad), direction.below_horizon);
}

// Optical depth of the air to the ground or to space.
fn view_optical_depth(direction: SkyDirection) -> vec3<f32> {
#ifdef AIR
    let uv = view_row_uv(direction, vec2<f32>(textureDimensions(view_optical_depth_table)));
    return length_m(direction) * sample_exactly(view_optical_depth_table, uv);
#else
    return vec3<f32>(0.0);
#endif
}

// Transmittance of the air to the ground or to space.
fn view_transmittance(direction: SkyDirection) -> vec3<f32> {
    return exp(-view_optical_depth(direction));
}

// How much the air's mean transmittance is left out for a light, in [0, 1]: gradually, as the edge of its shadow comes into
// view.
fn edge_strength(light: u32) -> f32 {
    let depth = -horizon_mu(atmosphere.radius_m, observer.altitude_m);
    return clamp(EDGE_FADE * (1.0 - abs(light_mu_s(light)) / max(depth, 1e-9)), 0.0, 1.0);
}

// ln of how much the air along the ray lets through to the observer on average, if it shone evenly: of (1 - exp(-tau)) / tau,
// as far as it is left out.
fn ln_mean_transmittance(light: u32, direction: SkyDirection) -> vec3<f32> {
    let tau = max(view_optical_depth(direction), vec3<f32>(1e-20));
    return edge_strength(light) * select(log((1.0 - exp(-tau)) / tau), -0.5 * tau, tau < vec3<f32>(1e-3));
}

#ifdef EDGE_OF_SHADOW
// What a cubic through four rows adds to what is linear between two, at a place between rows: as rows pass a limb that light falls
// steeply on, a straight line would bend there. Rows go on evenly beyond the first and the last.
fn bend_between_rows(uv: vec2<f32>, layer: u32) -> vec3<f32> {
    let rows = f32(textureDimensions(sky_view_table).y);
    let place = clamp(uv.y * rows - 0.5, 0.0, rows - 1.0);
    let low = min(floor(place), rows - 2.0);
    let t = place - low;
    var row: array<vec3<f32>, 4>;
    for (var k = 0u; k < 4u; k++) {
        let v = (low + f32(k) - 0.5) / rows;
        row[k] = textureSampleLevel(sky_view_table, table_sampler, vec2<f32>(uv.x, v), layer, 0.0).rgb;
    }
    let before = select(row[0], 2.0 * row[1] - row[2], low == 0.0);
    let after = select(row[3], 2.0 * row[2] - row[1], low == rows - 2.0);
    // Catmull-Rom: second differences on both sides.
    let bend_low = before - 2.0 * row[1] + row[2];
    let bend_high = row[1] - 2.0 * row[2] + after;
    return -0.5 * t * (1.0 - t) * ((1.0 - t) * bend_low + t * bend_high);
}
#endif

// One layer of the sky view, over the length of air, 1/m: multiply scattered radiance, or a scatterer's light without
// its phase function.
fn sky_view(light: u32, layer: u32, direction: SkyDirection) -> vec3<f32> {
    let unit = mapping::sky_view_to_unit(
        direction.zenith_rad, direction.azimuth_rad, direction.below_horizon, observer.view
    );
    let uv = mapping::inset(unit, vec2<f32>(textureDimensions(sky_view_table)));
    let first = layer_of(light, direction.below_horizon);
    var ln_scale = vec3<f32>(-LN_SCALE);
#ifdef EDGE_OF_SHADOW
    ln_scale += ln_mean_transmittance(light, direction);
#endif
#ifdef SHADE
    if layer >= SINGLE_LAYER {
        let view = View(observer.altitude_m, direction.zenith_rad, direction.azimuth_rad, direction.below_horizon);
        ln_scale += ln_lit_share(light, view, layer - SINGLE_LAYER);
    }
#endif
    var logarithm = textureSampleLevel(sky_view_table, table_sampler, uv, first + layer, 0.0).rgb;
#ifdef EDGE_OF_SHADOW
    logarithm += edge_strength(light) * bend_between_rows(uv, first + layer);
#endif
    return exp(logarithm + ln_scale);
}

// What clouds leave of light that comes straight from a light, and of light that air or clouds have scattered before.
struct Shares {
    straight: vec3<f32>,
    diffuse: vec3<f32>,
}

const ALL: Shares = Shares(vec3<f32>(1.0), vec3<f32>(1.0));

// The same of the light of the air up to a place, from int T S dT_air + T T_air to there, T of what stands in the air and S what it leaves
// of the beam or of diffuse light at each point.
fn shares_before(beam: vec3<f32>, diffuse: vec3<f32>, transmittance: vec3<f32>, air_transmittance: vec3<f32>) -> Shares {
    let behind = transmittance * air_transmittance;
    let opacity = max(1.0 - air_transmittance, vec3<f32>(1e-6));
    return Shares(max((beam - behind) / opacity, vec3<f32>(0.0)), max((diffuse - behind) / opacity, vec3<f32>(0.0)));
}

// Light that the air along the ray has scattered once, by one scatterer, without its phase function: over unit irradiance
// of the light.
fn single_scattering(light: u32, scatterer: u32, direction: SkyDirection) -> vec3<f32> {
#ifdef LIT
    return length_m(direction) * sky_view(light, SINGLE_LAYER + scatterer, direction);
#else
    return vec3<f32>(0.0);
#endif
}

// Radiance that the air along the ray has scattered more than once, 1/sr: per unit irradiance of the light.
fn multiple_scattering(light: u32, direction: SkyDirection) -> vec3<f32> {
#ifdef MULTIPLE_SCATTERING
    return length_m(direction) * sky_view(light, MULTIPLE_LAYER, direction);
#else
    return vec3<f32>(0.0);
#endif
}

// Radiance of the air along the ray, 1/sr: per unit irradiance of the light.
fn air_radiance(light: u32, direction: SkyDirection) -> vec3<f32> {
    var radiance = multiple_scattering(light, direction);
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        radiance += phase_per_sr(c, direction.nu) * single_scattering(light, c, direction);
    }
    return radiance;
}

// Radiance that leaves the ground where a view ray meets it, 1/sr, per unit irradiance of the light: of light that
// reached the ground straight, and of light that air or clouds had scattered before.
struct GroundRadiance {
    straight: vec3<f32>,
    diffuse: vec3<f32>,
}

fn ground_radiance(light: u32, direction: SkyDirection) -> GroundRadiance {
    var ground: GroundRadiance;
#ifdef GROUND
    let mu = cos(direction.zenith_rad);
    let mu_s = ground_mu_s(view_ray(observer.altitude_m, mu, light_mu_s(light), direction.nu, true));
    let reflected_per_sr = atmosphere.ground_albedo / PI;
    ground.straight = reflected_per_sr * direct_irradiance_of_disc(light, mu_s);
#ifdef MULTIPLE_SCATTERING
    for (var beam = 0u; beam < beam_count(light); beam++) {
        let irradiance = diffuse_ground_irradiance(multiple_scattering_table, beam_mu_s(light, beam, mu_s));
        ground.diffuse += reflected_per_sr * beam_weight(light, beam) * irradiance;
    }
#endif
#endif
    return ground;
}

// Radiance that no directional light causes: the air's own, on its way to the observer and from the ground, W/m2/sr/nm.
fn emission_radiance(direction: SkyDirection) -> vec3<f32> {
#ifdef EMISSION
    let uv = view_row_uv(direction, vec2<f32>(textureDimensions(view_emission_table)));
    // In the ground's column, which holds light from the ground too, there is no limb to be exact at.
    let factor = select(length_m(direction), 1.0, direction.below_horizon);
    return factor * sample_exactly(view_emission_table, uv);
#else
    return vec3<f32>(0.0);
#endif
}
