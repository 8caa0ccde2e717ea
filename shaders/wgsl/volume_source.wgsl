#define_import_path welkin::volume_source
// Light that matter in fog and local volumes sends towards the observer.
//
// Legend
//   peak      what of the phase function rises above a ceiling: light that only peaks scatter stays in its beam, while its directions
//             spread (welkin_lut::forward_peak). What is below turns light away
//   similar   the medium in which peaks count as nothing: of each kind of matter q times its optical depth
//   stretch   what a step does to light: depth before it and in it, of all media
//
// Light that is turned away twice or more is that of an even slab in fog (welkin::slab_field); in a local volume what is scattered once
// escapes with the probability 1 / (1 + x), x its mean chord in optical depths (Wigner's rational approximation), or is
// scattered again.
//
// Local lights are welkin::lamp_source.
//
// Definitions: VOLUME_ORDERS (light scattered more than once belongs in the picture), CLOUDS, LIGHT_COUNT.

#import welkin::atmosphere::{atmosphere, PI}
#import welkin::attenuation::mean_between
#ifdef VOLUME_ORDERS
#import welkin::beam_field::{ceiling_per_sr, peak_again_per_sr}
#endif
#import welkin::cloud_daylight::{light_in_air, Surroundings}
#ifdef CLOUDS
#import welkin::cloud_daylight::surroundings_among_clouds
#else
#import welkin::cloud_daylight::surroundings
#endif
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::phase::{lobe_per_sr, PhaseLobe}
#import welkin::slab_field::{beam_table, scattered_of_beam, scattered_of_sky, sky_table, slab_spot, slab_way, LOWEST_SUN}
#import welkin::tables::table_sampler
#import welkin::volume_field::{volumes, Place, FOG_COUNT}
#import welkin::volume_grid::{block_uvw, spot_of, Spot}

const VOLUME_LOBES: u32 = 2u;
const FOUR_PI: f32 = 12.5663706;

struct VolumePhase {
    lobes: array<PhaseLobe, VOLUME_LOBES>,
}

// Volume by volume, and behind them the layers of clouds.
@group(1) @binding(47) var<storage, read> volume_phases: array<VolumePhase>;
@group(1) @binding(42) var volume_light_image: texture_3d<f32>;
@group(1) @binding(43) var volume_sky_image: texture_3d<f32>;

// A step along a view ray.
struct Stretch {
    view: vec3<f32>,
    origin: vec3<f32>,
    from_m: f32,
    step_m: f32,
    // Optical depth of all media but the air before the step, and in it.
    before: vec3<f32>,
    within: vec3<f32>,
    // That of what is similar to them.
    similar_before: vec3<f32>,
    similar_within: vec3<f32>,
}

// Matter of one volume in a step: the point that stands for it, and its density there.
struct Piece {
    index: u32,
    density: f32,
    place: Place,
}

fn phase_per_sr(index: u32, nu: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < VOLUME_LOBES; i++) {
        sum += lobe_per_sr(volume_phases[index].lobes[i], clamp(nu, -1.0, 1.0));
    }
    return sum;
}

// What of its sources' light a step sends on, in the mean: of light that is dimmed by the whole depth.
fn seen_whole(stretch: Stretch) -> vec3<f32> {
    return mean_between(stretch.before, stretch.before + stretch.within);
}

// The same of light that peaks do not dim.
fn seen_similar(stretch: Stretch) -> vec3<f32> {
    return mean_between(stretch.similar_before, stretch.similar_before + stretch.similar_within);
}

// Optical depth from a light to the beginning of a step and to its end.
struct ToLight {
    first: vec3<f32>,
    last: vec3<f32>,
}

// What is left of a light's beam on its way to a step and, dimmed by the whole depth, from there to the observer, in the mean.
fn lit_whole(stretch: Stretch, to_light: ToLight) -> vec3<f32> {
    return mean_between(to_light.first + stretch.before, to_light.last + stretch.before + stretch.within);
}

// How the depth to a light changes from the beginning of a step to its end: in even fog it falls as the ray climbs. Less than to
// nothing it cannot. Elsewhere a step's point stands for all of it.
fn along_step(piece: Piece, stretch: Stretch, up: vec3<f32>, mu_s: f32, depth: vec3<f32>) -> ToLight {
    if piece.index >= FOG_COUNT || volumes[piece.index].noise_strength > 0.0 {
        return ToLight(depth, depth);
    }
    let climbs_m = dot(stretch.view, up) * stretch.step_m;
    let change = volumes[piece.index].extinction_per_m * (piece.density * -climbs_m / max(mu_s, LOWEST_SUN));
    let half = clamp(0.5 * change, -depth, depth);
    return ToLight(depth - half, depth + half);
}

// Radiance of a light's beam that matter scatters once, or turns away once, per irradiance, b and metre.
fn from_beam(piece: Piece, stretch: Stretch, nu: f32, depth: vec3<f32>, to_light: ToLight) -> vec3<f32> {
    let phase = phase_per_sr(piece.index, nu);
    let whole = lit_whole(stretch, to_light);
#ifdef VOLUME_ORDERS
    let q = volumes[piece.index].similar_extinction;
    let field = volumes[piece.index].beam_field;
    let turning = min(phase, ceiling_per_sr(field));
    let similar = ToLight(q * to_light.first, q * to_light.last);
    let seen = mean_between(similar.first + stretch.similar_before, similar.last + stretch.similar_before + stretch.similar_within);
    return turning * seen + (phase - turning) * whole + peak_again_per_sr(field, depth, nu) * lit_whole(stretch, similar);
#else
    return phase * whole;
#endif
}

// The diffuse light of the air at a place.
fn air_around(light: u32, place: Place, mu_s: f32) -> Surroundings {
#ifdef CLOUDS
    return surroundings_among_clouds(light, place.map, place.altitude_m, mu_s);
#else
    return surroundings(place.altitude_m, mu_s, observer.lights[light].irradiance);
#endif
}

// What media leave of the sky above and below a place in a local volume.
fn sky_share(depths: vec4<f32>) -> vec2<f32> {
    return 1.0 / (1.0 + 0.75 * depths.yw);
}

#ifdef VOLUME_ORDERS
// How directional lights and a view ray stand at a place: cosines of light and ray with the vertical, and of the ray with the light.
struct Standing {
    mu_s: f32,
    mu_view: f32,
    nu: f32,
}

// Cosine of the azimuth between a view ray and a light.
fn cos_azimuth(standing: Standing) -> f32 {
    let sines = (1.0 - standing.mu_s * standing.mu_s) * (1.0 - standing.mu_view * standing.mu_view);
    return (standing.nu - standing.mu_s * standing.mu_view) / sqrt(max(sines, 1e-12));
}

// Radiance times b of light that a directional light and the sky have sent into a volume and that has been scattered since.
fn diffuse_source(piece: Piece, light: u32, standing: Standing, arriving: vec3<f32>, around: Surroundings, depths: vec4<f32>, beam: vec4<f32>) -> vec3<f32> {
    let volume = volumes[piece.index];
    if piece.index < FOG_COUNT {
        let spot = slab_spot(depths.x, depths.z);
        let way = slab_way(-standing.mu_view, cos_azimuth(standing));
        let beam_flux = max(standing.mu_s, 0.0) * exp(-beam.a) * arriving;
        let scattered = beam_flux * scattered_of_beam(beam_table(piece.index, light), spot, way)
            + PI * around.above * scattered_of_sky(sky_table(piece.index), spot, way);
        // A few moments may ring below nothing. What is no number stays none.
        return volume.similarity * select(scattered, vec3<f32>(0.0), scattered < vec3<f32>(0.0));
    }
    let mean_depth = dot(beam.rgb, vec3<f32>(1.0 / 3.0));
    let left = exp(-beam.a) / (1.0 + 0.75 * volume.backward * mean_depth);
    let share = sky_share(depths);
    let from_sky = 0.5 * (around.above * share.x + around.below * share.y);
    return volume.similarity * (volume.again * arriving * left / FOUR_PI + from_sky);
}
#endif

// Radiance per density and metre, before the air. What peaks pass on of light from behind is a difference, of what all scattering and what
// turning away leaves: step by step it may be below nothing, and where that light changes from step to step so may its sum.
struct Arriving {
    scattered: vec3<f32>,
    passed: vec3<f32>,
}

// Depths straight up and down from a spot in a volume: of the similar medium and, beside each, of what turns light back.
fn similar_depths(spot: Spot) -> vec4<f32> {
    return textureSampleLevel(volume_sky_image, table_sampler, block_uvw(spot.block, spot.share, 0u, 1u), 0.0);
}

// What directional lights and the sky bring.
fn from_lights(piece: Piece, stretch: Stretch) -> Arriving {
    let spot = spot_of(piece.index, piece.place);
    let up = normalize(vec3<f32>(piece.place.p.xy, piece.place.p.z + atmosphere.radius_m));
    let depths = similar_depths(spot);
#ifdef VOLUME_ORDERS
    let q = volumes[piece.index].similar_extinction;
    let similar = seen_similar(stretch);
    // Light from behind that is scattered by small angles only, over the albedo, by which scattering is the extinction's.
    let per_albedo = volumes[piece.index].extinction_per_m / max(volumes[piece.index].scattering_per_m, vec3<f32>(1e-30));
    let passed = per_albedo * (seen_whole(stretch) - q * similar);
#endif
    var arriving = Arriving(vec3<f32>(0.0), vec3<f32>(0.0));
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let uvw = block_uvw(spot.block, spot.share, light, LIGHT_COUNT);
        let beam = textureSampleLevel(volume_light_image, table_sampler, uvw, 0.0);
        let mu_s = dot(up, observer.lights[light].direction);
        let beam_in_air = light_in_air(light, piece.place.altitude_m, mu_s);
        let nu = clamp(dot(stretch.view, observer.lights[light].direction), -1.0, 1.0);
        let to_light = along_step(piece, stretch, up, mu_s, beam.rgb);
        arriving.scattered += beam_in_air * exp(-beam.a) * from_beam(piece, stretch, nu, beam.rgb, to_light);
#ifdef VOLUME_ORDERS
        let around = air_around(light, piece.place, mu_s);
        let standing = Standing(mu_s, dot(stretch.view, up), nu);
        arriving.scattered += similar * diffuse_source(piece, light, standing, beam_in_air, around, depths, beam);
        arriving.passed += passed * select(around.below, around.above, standing.mu_view > 0.0);
#endif
    }
    return arriving;
}
