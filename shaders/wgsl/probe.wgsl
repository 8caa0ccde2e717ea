// Pass: radiance and transmittance along single rays under all lights, read from the very tables that a picture is made of.
//
// Definitions: SURFACE (some rays end at a distance).

#import welkin::aerial::{air_radiance_before, reach_of}
#import welkin::atmosphere::PI
#import welkin::observer::{light_mu_s, observer, LIGHT_COUNT}
#import welkin::sky::{air_radiance, emission_radiance, ground_radiance, view_transmittance, SkyDirection}

struct ProbeRay {
    zenith_rad: f32,
    // Clockwise from north.
    azimuth_rad: f32,
    below_horizon: u32,
    // Where a black surface ends the ray, m.
    distance_m: f32,
}

struct ProbeAnswer {
    radiance: vec3<f32>,
    transmittance: vec3<f32>,
}

@group(0) @binding(11) var<storage, read> rays: array<ProbeRay>;
@group(0) @binding(12) var<storage, read_write> answers: array<ProbeAnswer>;

// The ray's direction as the tables of a light know it.
fn direction_from(light: u32, ray: ProbeRay) -> SkyDirection {
    let turn_rad = abs(ray.azimuth_rad - observer.lights[light].azimuth_rad);
    let azimuth_rad = abs(turn_rad - 2.0 * PI * round(turn_rad / (2.0 * PI)));
    let mu_s = light_mu_s(light);
    let sines = sin(ray.zenith_rad) * sqrt(max(1.0 - mu_s * mu_s, 0.0));
    let nu = clamp(cos(ray.zenith_rad) * mu_s + sines * cos(azimuth_rad), -1.0, 1.0);
    return SkyDirection(ray.zenith_rad, azimuth_rad, nu, ray.below_horizon != 0u);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&rays) {
        return;
    }
    let ray = rays[id.x];
    // What is the same for every light.
    let view = direction_from(0u, ray);
#ifdef SURFACE
    let reach = reach_of(view, ray.distance_m);
    let transmittance = reach.transmittance;
    var radiance = reach.emission;
    let sees_ground = view.below_horizon && reach.at_end;
#else
    let transmittance = view_transmittance(view);
    var radiance = emission_radiance(view);
    let sees_ground = view.below_horizon;
#endif
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let direction = direction_from(light, ray);
#ifdef SURFACE
        var seen = air_radiance_before(light, direction, reach);
#else
        var seen = air_radiance(light, direction);
#endif
        if sees_ground {
            let ground = ground_radiance(light, direction);
            seen += transmittance * (ground.straight + ground.diffuse);
        }
        radiance += observer.lights[light].irradiance * seen;
    }
    answers[id.x] = ProbeAnswer(radiance, transmittance);
}
