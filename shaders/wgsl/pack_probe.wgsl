// Pass: what the functions for engines answer to probes; an importer compares it with the pack's probes.json.

#import welkin::pack

// The inputs of the functions, by the names of their legend.
struct Probe {
    altitude_m: f32,
    mu: f32,
    mu_s: f32,
    nu: f32,
}

// The answers of the functions of these names; w is 0.
struct ProbeAnswer {
    // From the observer towards the sun.
    transmittance_to_space: vec4<f32>,
    view_transmittance: vec4<f32>,
    sky_irradiance: vec4<f32>,
    sun_irradiance: vec4<f32>,
    sky_radiance: vec4<f32>,
    ground_radiance: vec4<f32>,
}

@group(0) @binding(5) var<storage, read> probes: array<Probe>;
@group(0) @binding(6) var<storage, read_write> answers: array<ProbeAnswer>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&probes) {
        return;
    }
    let probe = probes[id.x];
    let altitude_m = probe.altitude_m;
    var answer: ProbeAnswer;
    answer.transmittance_to_space = vec4<f32>(pack::transmittance_to_space(altitude_m, probe.mu_s), 0.0);
    answer.view_transmittance = vec4<f32>(pack::view_transmittance(altitude_m, probe.mu), 0.0);
    answer.sky_irradiance = vec4<f32>(pack::sky_irradiance(altitude_m, probe.mu_s), 0.0);
    answer.sun_irradiance = vec4<f32>(pack::sun_irradiance(altitude_m, probe.mu_s), 0.0);
    answer.sky_radiance = vec4<f32>(pack::sky_radiance(altitude_m, probe.mu, probe.mu_s, probe.nu), 0.0);
    answer.ground_radiance = vec4<f32>(pack::ground_radiance(altitude_m, probe.mu, probe.mu_s, probe.nu), 0.0);
    answers[id.x] = answer;
}
