// Pass: radiance and transmittance along single rays, read from the very tables that a picture is made of.
//
// Definitions: SURFACE (some rays end at a distance).

#import welkin::aerial::{air_radiance_before, reach_of}
#import welkin::observer::{light_mu_s, observer, LIGHT_COUNT}
#import welkin::sky::{air_radiance, emission_radiance, ground_radiance, view_transmittance, SkyDirection}

struct ProbeRay {
    zenith_rad: f32,
    // From the light's azimuth, in [0, pi].
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

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&rays) {
        return;
    }
    let ray = rays[id.x];
    let mu_s = light_mu_s(0u);
    let sines = sin(ray.zenith_rad) * sqrt(max(1.0 - mu_s * mu_s, 0.0));
    let nu = clamp(cos(ray.zenith_rad) * mu_s + sines * cos(ray.azimuth_rad), -1.0, 1.0);
    let direction = SkyDirection(ray.zenith_rad, ray.azimuth_rad, nu, ray.below_horizon != 0u);
#ifdef SURFACE
    let reach = reach_of(direction, ray.distance_m);
    let transmittance = reach.transmittance;
    var radiance = air_radiance_before(0u, direction, reach);
    let emission = reach.emission;
    let sees_ground = direction.below_horizon && reach.at_end;
#else
    let transmittance = view_transmittance(direction);
    var radiance = air_radiance(0u, direction);
    let emission = emission_radiance(direction);
    let sees_ground = direction.below_horizon;
#endif
    if sees_ground {
        radiance += transmittance * ground_radiance(0u, direction);
    }
    answers[id.x] = ProbeAnswer(observer.lights[0].irradiance * radiance + emission, transmittance);
}
