#define_import_path welkin::volume_source
// Light that matter in fog and local volumes sends towards the observer.
//
// Legend
//   term      one summand of a light's part: P_k(nu) int b e^(-a_k (tau_light + tau_view)) ds. Bands of near-forward light as
//             in welkin::cloud_source; a_k per band, as a coloured volume absorbs
//   stretch   what a step does to light: depth before it and in it, of all media
//
// Light scattered many times is that of an even slab in fog (welkin::slab_field); in a local volume what is scattered once
// escapes with the probability 1 / (1 + x), x its mean chord in optical depths (Wigner's rational approximation), or is
// scattered again.
//
// Local lights are welkin::lamp_source.
//
// Definitions: VOLUME_TERM_COUNT, VOLUME_ORDERS (light scattered more than once belongs in the picture), LIT, LIGHT_COUNT.

#import welkin::atmosphere::{atmosphere, PI}
#import welkin::attenuation::mean_transmittance
#import welkin::cloud_daylight::{light_in_air, surroundings, Surroundings}
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::phase::{lobe_per_sr, PhaseLobe}
#import welkin::slab_field::{slab_light, slab_spot, slab_table}
#import welkin::tables::table_sampler
#import welkin::volume_field::{volumes, Place, FOG_COUNT}
#import welkin::volume_grid::{block_uvw, spot_of}

const TERM_COUNT: u32 = #{VOLUME_TERM_COUNT}u;
const TERM_STRIDE: u32 = TERM_COUNT + 1u;
const TERM_LOBES: u32 = 4u;
const FOUR_PI: f32 = 12.5663706;

struct VolumeTerm {
    // a_k.
    attenuation: vec3<f32>,
    padding: f32,
    // P_k; scales may be negative.
    lobes: array<PhaseLobe, TERM_LOBES>,
}

// Volume by volume: terms, then the phase function itself, of local lights.
@group(1) @binding(47) var<storage, read> volume_terms: array<VolumeTerm>;
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
}

// Matter of one volume in a step: the point that stands for it, and its density there.
struct Piece {
    index: u32,
    density: f32,
    place: Place,
}

fn term_per_sr(index: u32, term: u32, nu: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < TERM_LOBES; i++) {
        sum += lobe_per_sr(volume_terms[index * TERM_STRIDE + term].lobes[i], nu);
    }
    return sum;
}

// The phase function itself.
fn lamp_phase_per_sr(index: u32, nu: f32) -> f32 {
    return term_per_sr(index, TERM_COUNT, clamp(nu, -1.0, 1.0));
}

// Mean of e^(-a tau) over a step.
fn seen(stretch: Stretch, attenuation: vec3<f32>) -> vec3<f32> {
    return exp(-attenuation * stretch.before) * mean_transmittance(attenuation * stretch.within);
}

// What media leave of the sky above and below a place in a local volume.
fn sky_share(depths: vec4<f32>) -> vec2<f32> {
    return 1.0 / (1.0 + 0.75 * depths.yw);
}

#ifdef VOLUME_ORDERS
// Radiance times b of light that a directional light and the sky have sent into a volume and that has been scattered since.
fn diffuse_source(piece: Piece, light: u32, view: vec3<f32>, arriving: vec3<f32>, around: Surroundings, mu_s: f32, depths: vec4<f32>, beam: vec4<f32>) -> vec3<f32> {
    let volume = volumes[piece.index];
    if piece.index < FOG_COUNT {
        let spot = slab_spot(depths.x, depths.z);
        let of_beam = slab_light(slab_table(piece.index, light), spot);
        let of_sky = slab_light(slab_table(piece.index, LIGHT_COUNT), spot);
        let beam_flux = max(mu_s, 0.0) * exp(-beam.a) * arriving;
        let sky_flux = PI * around.above;
        let mean = beam_flux * of_beam.mean_radiance + sky_flux * of_sky.mean_radiance;
        let upward = beam_flux * of_beam.upward + sky_flux * of_sky.upward;
        // Light goes on as it went: more of it comes from where the net flux comes from.
        let forward = volume.reduced_cosine * 3.0 / FOUR_PI * upward * -view.z;
        return max(mean + forward, vec3<f32>(0.0)) * volume.similarity;
    }
    let mean_depth = dot(beam.rgb, vec3<f32>(1.0 / 3.0));
    let left = exp(-beam.a) / (1.0 + 0.75 * volume.backward * mean_depth);
    let share = sky_share(depths);
    let from_sky = 0.5 * (around.above * share.x + around.below * share.y);
    return volume.similarity * (volume.again * arriving * left / FOUR_PI + from_sky);
}
#endif

// Radiance that directional lights and the sky bring, per density and metre, before the air.
fn from_lights(piece: Piece, stretch: Stretch) -> vec3<f32> {
    let spot = spot_of(piece.index, piece.place);
    let up = normalize(vec3<f32>(piece.place.p.xy, piece.place.p.z + atmosphere.radius_m));
    let depths = textureSampleLevel(volume_sky_image, table_sampler, block_uvw(spot.block, spot.share, 0u, 1u), 0.0);
    var radiance = vec3<f32>(0.0);
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let uvw = block_uvw(spot.block, spot.share, light, LIGHT_COUNT);
        let beam = textureSampleLevel(volume_light_image, table_sampler, uvw, 0.0);
        let mu_s = dot(up, observer.lights[light].direction);
        let arriving = light_in_air(light, piece.place.altitude_m, mu_s);
        let nu = clamp(dot(stretch.view, observer.lights[light].direction), -1.0, 1.0);
        for (var k = 0u; k < TERM_COUNT; k++) {
            let a = volume_terms[piece.index * TERM_STRIDE + k].attenuation;
            radiance += term_per_sr(piece.index, k, nu) * arriving * exp(-a * beam.rgb - beam.a) * seen(stretch, a);
        }
#ifdef VOLUME_ORDERS
        let around = surroundings(piece.place.altitude_m, mu_s, observer.lights[light].irradiance);
        let q = volumes[piece.index].similar_extinction;
        let source = diffuse_source(piece, light, stretch.view, arriving, around, mu_s, depths, beam);
        radiance += source * seen(stretch, q);
        // Light from behind that is scattered by small angles only, over the albedo, by which scattering is the extinction's.
        let behind = select(around.below, around.above, dot(stretch.view, up) > 0.0);
        let per_albedo = volumes[piece.index].extinction_per_m / max(volumes[piece.index].scattering_per_m, vec3<f32>(1e-30));
        radiance += behind * per_albedo * (seen(stretch, vec3<f32>(1.0)) - q * seen(stretch, q));
#endif
    }
    return radiance;
}
