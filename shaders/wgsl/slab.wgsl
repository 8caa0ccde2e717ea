#define_import_path welkin::slab
// Diffuse light in a layer that is wide and even, such as fog: Eddington's approximation of a slab on ground that reflects,
// under a beam and a sky, in closed form. Scattering takes no light here; the similar medium (Joseph, Wiscombe & Weinman
// 1976) stands for one that scatters forward.
//
// Legend
//   depth      optical depth of the similar medium from the top;  whole: that of all of it
//   g          mean cosine in the similar medium
//   beam       flux of the sunlight through a horizontal plane above, mu that of its cosine
//   F          net flux of diffuse light upwards, J its mean radiance
//
// F(t) = F(0) - beam (1 - e^(-t/mu)), as what leaves the beam becomes diffuse; and 4 pi / 3 dJ/dt = (1 - g) F + g beam e^(-t/mu).
// At the top the diffuse flux downwards is the sky's, at the bottom the ground reflects what comes down.

struct Slab {
    beam: vec3<f32>,
    mu: f32,
    sky: vec3<f32>,
    g: f32,
    albedo: vec3<f32>,
    whole: f32,
}

struct SlabLight {
    mean_radiance: vec3<f32>,
    // Net flux of diffuse light upwards.
    upward: vec3<f32>,
}

const PI: f32 = 3.14159265;

fn lost(slab: Slab, depth: f32) -> vec3<f32> {
    return slab.beam * (1.0 - exp(-depth / slab.mu));
}

// pi (J(t) - J(0)) for F(0) = 0, and the factor on F(0).
fn risen(slab: Slab, depth: f32) -> vec3<f32> {
    return 0.75 * (slab.mu * lost(slab, depth) - (1.0 - slab.g) * depth * slab.beam);
}

fn upward_at_top(slab: Slab) -> vec3<f32> {
    let lost_below = lost(slab, slab.whole);
    let arriving = slab.albedo * (slab.beam - lost_below);
    let free = slab.sky + risen(slab, slab.whole);
    let known = arriving + 0.5 * (1.0 + slab.albedo) * lost_below - (1.0 - slab.albedo) * free;
    return known / ((1.0 - slab.albedo) * (0.5 + 0.75 * (1.0 - slab.g) * slab.whole) + 0.5 * (1.0 + slab.albedo));
}

fn slab_light(slab: Slab, depth: f32) -> SlabLight {
    let top = upward_at_top(slab);
    let rise = risen(slab, depth) + 0.75 * (1.0 - slab.g) * depth * top;
    let mean = (slab.sky + 0.5 * top + rise) / PI;
    return SlabLight(max(mean, vec3<f32>(0.0)), top - lost(slab, depth));
}

// Flux downwards at a depth, of beam and diffuse light.
fn downward(slab: Slab, depth: f32) -> vec3<f32> {
    let light = slab_light(slab, depth);
    return max(PI * light.mean_radiance - 0.5 * light.upward, vec3<f32>(0.0)) + slab.beam - lost(slab, depth);
}
