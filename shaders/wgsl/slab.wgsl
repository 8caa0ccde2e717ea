#define_import_path welkin::slab
// Diffuse light in a layer that is wide and even, such as fog: Eddington's approximation of a slab on ground that reflects,
// under a beam and a sky, in closed form and for any albedo. The similar medium (Joseph, Wiscombe & Weinman 1976) stands for
// one that scatters forward.
//
// Legend
//   depth      optical depth of the similar medium from the top;  whole: that of all of it
//   g, w       mean cosine and single-scattering albedo of the similar medium
//   beam       flux of the sunlight through a horizontal plane above, mu that of its cosine
//
// The slab above a depth and the slab below it are joined there (adding). Each is that of Meador & Weaver (1980), whose
// gamma_1 ... gamma_4 these are, with numerator and denominator divided by k: nothing is lost where a medium absorbs nothing
// and k is 0.

struct Slab {
    beam: vec3<f32>,
    mu: f32,
    sky: vec3<f32>,
    g: f32,
    ground_albedo: vec3<f32>,
    whole: f32,
    w: vec3<f32>,
}

struct SlabLight {
    mean_radiance: vec3<f32>,
    // Net flux of diffuse light upwards.
    upward: vec3<f32>,
}

// What a slab without ground makes of light: shares of diffuse light, and of a beam's flux at its top.
struct Layer {
    reflected: vec3<f32>,
    passed: vec3<f32>,
    beam_up: vec3<f32>,
    beam_down: vec3<f32>,
    beam_left: f32,
}

const PI: f32 = 3.14159265;
// Where the beam falls as diffuse light does, k mu = 1, both parts are infinite and cancel; a little beside it they are what
// they are there.
const APART: f32 = 0.02;

fn layer(depth: f32, slab: Slab) -> Layer {
    let mu = slab.mu;
    let lost = 1.0 - slab.w;
    let turned = 1.0 - slab.w * slab.g;
    let gamma_1 = 0.75 * turned + lost;
    let gamma_2 = 0.75 * turned - lost;
    let gamma_3 = 0.5 - 0.75 * slab.g * mu;
    let gamma_4 = 1.0 - gamma_3;
    let alpha_1 = gamma_1 * gamma_4 + gamma_2 * gamma_3;
    let alpha_2 = gamma_1 * gamma_3 + gamma_2 * gamma_4;
    let k2 = 3.0 * lost * turned;
    let left = exp(-sqrt(k2) * depth);
    let left2 = left * left;
    // (1 - e^(-2 k t)) / k.
    let x = 2.0 * sqrt(k2) * depth;
    let grown = 2.0 * depth * select((1.0 - left2) / max(x, vec3<f32>(1e-20)), 1.0 - x * (0.5 - x / 6.0), x < vec3<f32>(1e-2));
    let per_whole = 1.0 / (1.0 + left2 + gamma_1 * grown);
    let beam_left = exp(-depth / mu);
    let apart = 1.0 - k2 * mu * mu;
    let per_apart = slab.w * per_whole / select(min(apart, vec3<f32>(-APART)), max(apart, vec3<f32>(APART)), apart >= vec3<f32>(0.0));
    let up = gamma_3 - alpha_2 * mu;
    let down = gamma_4 + alpha_1 * mu;
    let beam_up = (alpha_2 - k2 * mu * gamma_3) * grown + up * (1.0 + left2 - 2.0 * left * beam_left);
    let beam_down = (alpha_1 + k2 * mu * gamma_4) * grown * beam_left + down * ((1.0 + left2) * beam_left - 2.0 * left);
    return Layer(gamma_2 * grown * per_whole, 2.0 * left * per_whole, per_apart * beam_up, -per_apart * beam_down, beam_left);
}

// Fluxes at a depth: of diffuse light downwards and upwards, and of the beam.
struct Fluxes {
    down: vec3<f32>,
    up: vec3<f32>,
    beam: vec3<f32>,
}

fn fluxes(slab: Slab, depth: f32) -> Fluxes {
    let above = layer(depth, slab);
    let below = layer(slab.whole - depth, slab);
    let beam = slab.beam * above.beam_left;
    // The slab below with the ground under it.
    let returned = slab.ground_albedo * below.passed / (1.0 - slab.ground_albedo * below.reflected);
    let reflected = below.reflected + below.passed * returned;
    let from_beam = beam * (below.beam_up + returned * (below.beam_down + below.beam_left));
    let arriving = slab.sky * above.passed + slab.beam * above.beam_down + above.reflected * from_beam;
    let down = arriving / (1.0 - above.reflected * reflected);
    return Fluxes(down, reflected * down + from_beam, beam);
}

fn slab_light(slab: Slab, depth: f32) -> SlabLight {
    let light = fluxes(slab, depth);
    return SlabLight((light.up + light.down) / (2.0 * PI), light.up - light.down);
}

// Flux downwards at a depth, of beam and diffuse light.
fn downward(slab: Slab, depth: f32) -> vec3<f32> {
    let light = fluxes(slab, depth);
    return light.down + light.beam;
}
