#define_import_path welkin::atmosphere
// What the air is made of, and what it does to light at an altitude.
//
// Legend
//   extinction, scattering   c = a + b and b, 1/m, one component per spectral band
//   density                  of a constituent, relative to the value its coefficients are given for
//
// Definitions (set by the scene, so that an absent profile leaves no instruction behind)
//   CONSTITUENT_COUNT   all constituents; the array is sorted: those that scatter, then those that only absorb, and
//                       within both by profile: exponential, tent, layer
//   SCATTERING_EXPONENTIAL_END, SCATTERING_TENT_END, SCATTERER_COUNT,
//   ABSORBING_EXPONENTIAL_END, ABSORBING_TENT_END   where each group ends in the array
//   LOBE_COUNT          lobes of the most complex phase function
//   PROFILE_GROUP_COUNT groups of scatterers that share a density profile
//   LAYERS              some constituent's density is a layer; OMIT_LAYERS: such constituents do not count

#import welkin::phase::{lobe_per_sr, PhaseLobe}

const PI: f32 = 3.14159265358979;
const CONSTITUENT_COUNT: u32 = #{CONSTITUENT_COUNT}u;
const SCATTERING_EXPONENTIAL_END: u32 = #{SCATTERING_EXPONENTIAL_END}u;
const SCATTERING_TENT_END: u32 = #{SCATTERING_TENT_END}u;
const SCATTERER_COUNT: u32 = #{SCATTERER_COUNT}u;
const ABSORBING_EXPONENTIAL_END: u32 = #{ABSORBING_EXPONENTIAL_END}u;
const ABSORBING_TENT_END: u32 = #{ABSORBING_TENT_END}u;
// WGSL has no empty arrays: vacuum keeps one slot, which no loop visits.
const CONSTITUENT_SLOTS: u32 = max(CONSTITUENT_COUNT, 1u);
const SCATTERER_SLOTS: u32 = max(SCATTERER_COUNT, 1u);
const LOBE_COUNT: u32 = #{LOBE_COUNT}u;
const MAX_LOBES: u32 = 2u;
const PROFILE_GROUP_COUNT: u32 = #{PROFILE_GROUP_COUNT}u;
const SCATTERING_LAYER_COUNT: u32 = SCATTERER_COUNT - SCATTERING_TENT_END;
const LAYER_COUNT: u32 = SCATTERING_LAYER_COUNT + CONSTITUENT_COUNT - ABSORBING_TENT_END;
const SCATTERING_TENT_COUNT: u32 = SCATTERING_TENT_END - SCATTERING_EXPONENTIAL_END;
const TENT_COUNT: u32 = SCATTERING_TENT_COUNT + ABSORBING_TENT_END - ABSORBING_EXPONENTIAL_END;
const TENT_SLOTS: u32 = max(TENT_COUNT, 1u);

struct Constituent {
    scattering_per_m: vec3<f32>,
    // exponential: -1 / (scale height ln 2); tent: centre; layer: bottom
    profile_a: f32,
    extinction_per_m: vec3<f32>,
    // exponential: unused; tent: 1 / half width; layer: top
    profile_b: f32,
    lobes: array<PhaseLobe, MAX_LOBES>,
    // Of scatterers: which of the groups that share a density profile.
    profile_group: u32,
    padding_a: u32,
    padding_b: u32,
    padding_c: u32,
}

struct Atmosphere {
    ground_albedo: vec3<f32>,
    radius_m: f32,
    // How tables of multiply scattered light are spread over the suns: see welkin::mapping.
    sun_warp: vec3<f32>,
    // Altitude of the shell above which there is vacuum.
    top_m: f32,
    constituents: array<Constituent, CONSTITUENT_SLOTS>,
}

@group(0) @binding(0) var<uniform> atmosphere: Atmosphere;

// Relative density by the two numbers of a profile, as `Constituent` documents them.
fn exponential_density(profile_a: f32, altitude_m: f32) -> f32 {
    return exp2(altitude_m * profile_a);
}

fn tent_density(profile_a: f32, profile_b: f32, altitude_m: f32) -> f32 {
    return max(1.0 - abs(altitude_m - profile_a) * profile_b, 0.0);
}

fn layer_density(profile_a: f32, profile_b: f32, altitude_m: f32) -> f32 {
    return select(0.0, 1.0, altitude_m >= profile_a && altitude_m <= profile_b);
}

fn exponential_constituent(i: u32, altitude_m: f32) -> f32 {
    return exponential_density(atmosphere.constituents[i].profile_a, altitude_m);
}

fn tent_constituent(i: u32, altitude_m: f32) -> f32 {
    return tent_density(atmosphere.constituents[i].profile_a, atmosphere.constituents[i].profile_b, altitude_m);
}

fn layer_constituent(i: u32, altitude_m: f32) -> f32 {
    return layer_density(atmosphere.constituents[i].profile_a, atmosphere.constituents[i].profile_b, altitude_m);
}

// Relative density of each constituent at an altitude.
fn densities(altitude_m: f32) -> array<f32, CONSTITUENT_SLOTS> {
    let h = max(altitude_m, 0.0);
    var density: array<f32, CONSTITUENT_SLOTS>;
    for (var i = 0u; i < SCATTERING_EXPONENTIAL_END; i++) {
        density[i] = exponential_constituent(i, h);
    }
    for (var i = SCATTERING_EXPONENTIAL_END; i < SCATTERING_TENT_END; i++) {
        density[i] = tent_constituent(i, h);
    }
#ifndef OMIT_LAYERS
    for (var i = SCATTERING_TENT_END; i < SCATTERER_COUNT; i++) {
        density[i] = layer_constituent(i, h);
    }
#endif
    for (var i = SCATTERER_COUNT; i < ABSORBING_EXPONENTIAL_END; i++) {
        density[i] = exponential_constituent(i, h);
    }
    for (var i = ABSORBING_EXPONENTIAL_END; i < ABSORBING_TENT_END; i++) {
        density[i] = tent_constituent(i, h);
    }
#ifndef OMIT_LAYERS
    for (var i = ABSORBING_TENT_END; i < CONSTITUENT_COUNT; i++) {
        density[i] = layer_constituent(i, h);
    }
#endif
    return density;
}

// The constituent of a layer, counted from 0.
fn constituent_of_layer(layer: u32) -> u32 {
    if layer < SCATTERING_LAYER_COUNT {
        return SCATTERING_TENT_END + layer;
    }
    return ABSORBING_TENT_END + layer - SCATTERING_LAYER_COUNT;
}

// Bottom and top of a layer, m.
fn layer_bounds_m(layer: u32) -> vec2<f32> {
    let i = constituent_of_layer(layer);
    return vec2<f32>(atmosphere.constituents[i].profile_a, atmosphere.constituents[i].profile_b);
}

// The constituent of a tent, counted from 0.
fn constituent_of_tent(tent: u32) -> u32 {
    if tent < SCATTERING_TENT_COUNT {
        return SCATTERING_EXPONENTIAL_END + tent;
    }
    return ABSORBING_EXPONENTIAL_END + tent - SCATTERING_TENT_COUNT;
}

// c at an altitude, 1/m.
fn extinction_at(altitude_m: f32) -> vec3<f32> {
    let density = densities(altitude_m);
    var extinction = vec3<f32>(0.0);
    for (var i = 0u; i < CONSTITUENT_COUNT; i++) {
        extinction += density[i] * atmosphere.constituents[i].extinction_per_m;
    }
    return extinction;
}

// The same without tents, whose kinks a quadrature would have to find: welkin::tent has their optical depth.
fn extinction_without_tents_at(altitude_m: f32) -> vec3<f32> {
    let density = densities(altitude_m);
    var extinction = vec3<f32>(0.0);
    for (var i = 0u; i < CONSTITUENT_COUNT; i++) {
        let scattering_tent = i >= SCATTERING_EXPONENTIAL_END && i < SCATTERING_TENT_END;
        let absorbing_tent = i >= ABSORBING_EXPONENTIAL_END && i < ABSORBING_TENT_END;
        if !scattering_tent && !absorbing_tent {
            extinction += density[i] * atmosphere.constituents[i].extinction_per_m;
        }
    }
    return extinction;
}

// P(nu) of a constituent, 1/sr; nu = 1 is forward.
fn phase_per_sr(constituent: u32, nu: f32) -> f32 {
    var phase = 0.0;
    for (var i = 0u; i < LOBE_COUNT; i++) {
        phase += lobe_per_sr(atmosphere.constituents[constituent].lobes[i], nu);
    }
    return phase;
}

// 1 where a constituent throws most light forwards, -1 where backwards.
fn peak_side(constituent: u32) -> f32 {
    return select(1.0, -1.0, phase_per_sr(constituent, -1.0) > phase_per_sr(constituent, 1.0));
}
