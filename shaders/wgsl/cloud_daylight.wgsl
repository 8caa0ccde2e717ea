#define_import_path welkin::cloud_daylight
// Light from outside the clouds: what reaches them through the air, and what they leave of it for air, ground and hills.

#import welkin::atmosphere::{atmosphere, PI}
#import welkin::cloud_field::{cloud_layers, CLOUD_LAYER_COUNT}
#import welkin::cloud_grid::{grid_sample, local_direction, Part}
#import welkin::cloud_matter::cloud_matter
#import welkin::geometry::horizon_mu
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::sky::multiple_scattering_table
#import welkin::tables::{mean_field, optical_depth_to_top, table_sampler}

// Optical depths to each light, to the layer's top and to its base.
@group(1) @binding(9) var cloud_light_image: texture_3d<f32>;

// Irradiance of a light above the clouds at a point: attenuated by the air, hidden by the planet.
fn light_in_air(light: u32, altitude_m: f32, mu_s: f32) -> vec3<f32> {
    if mu_s < horizon_mu(atmosphere.radius_m, altitude_m) {
        return vec3<f32>(0.0);
    }
#ifdef AIR
    return observer.lights[light].irradiance * exp(-optical_depth_to_top(altitude_m, mu_s));
#else
    return observer.lights[light].irradiance;
#endif
}

// The diffuse field of the air at an altitude: radiance from above and from below, each as the mean of its half.
struct Surroundings {
    above: vec3<f32>,
    below: vec3<f32>,
}

fn surroundings(altitude_m: f32, mu_s: f32, irradiance: vec3<f32>) -> Surroundings {
    var around: Surroundings;
#ifdef MULTIPLE_SCATTERING
    let field = mean_field(multiple_scattering_table, altitude_m, mu_s);
    // Over a half sphere the first zonal harmonic's mean is half its value at the pole: √3 / 2 in units of the mean.
    let tilt = 0.866025404 * field.tilt;
    around.above = irradiance * field.radiance * max(1.0 + tilt, vec3<f32>(0.0));
    around.below = irradiance * field.radiance * max(1.0 - tilt, vec3<f32>(0.0));
#endif
    return around;
}

// What clouds leave of the light above them at a point of the air or the ground.
struct Daylight {
    // Of the first light's beam, what passes straight or nearly so.
    straight: f32,
    // Of the beam's flux through a horizontal plane, all that passes, in any direction.
    through: f32,
    // Of the sky's light.
    diffuse: f32,
}

// By two streams in the similar medium (Joseph, Wiscombe & Weinman 1976): of a beam with cosine mu
// ((2/3 + mu) + (2/3 - mu) e^(-q tau)) / (4/3 + (1 - g) mu tau), of diffuse light 1 / (1 + 3/4 (1 - g) tau).
fn daylight_of(light: u32, map: vec2<f32>, altitude_m: f32) -> Daylight {
    let toward = local_direction(map, observer.lights[light].direction);
    let mu = max(toward.z, 0.0);
    var day = Daylight(1.0, 1.0, 1.0);
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let up_m = altitude_m - cloud_layers[layer].base_m;
        if up_m > cloud_layers[layer].thickness_m {
            continue;
        }
        // Below the base the light is followed up to it.
        let along_m = max(-up_m, 0.0) / max(toward.z, 0.02);
        let height = max(up_m, 0.0) / cloud_layers[layer].thickness_m;
        let part = Part(light, LIGHT_COUNT);
        let beam = grid_sample(cloud_light_image, table_sampler, part, layer, map + toward.xy * along_m, height).x;
        let above = grid_sample(cloud_light_image, table_sampler, part, layer, map, height).y;
        let matter = cloud_matter[layer];
        let straight = exp(-matter.similarity * beam);
        let through = (2.0 / 3.0 + mu + (2.0 / 3.0 - mu) * straight) / (4.0 / 3.0 + matter.backward * mu * beam);
        day.straight = min(day.straight, straight);
        day.through = min(day.through, max(through, straight));
        day.diffuse = min(day.diffuse, 1.0 / (1.0 + 0.75 * matter.backward * above));
    }
    return day;
}

// Of the first light.
fn daylight(map: vec2<f32>, altitude_m: f32) -> Daylight {
    return daylight_of(0u, map, altitude_m);
}

// The first light's fluxes through a horizontal plane in clear air: its beam, the sky's light from above and what comes
// from below, over the sum of the last two.
struct ClearFluxes {
    beam: vec3<f32>,
    sky: vec3<f32>,
    below: vec3<f32>,
}

fn clear_fluxes(altitude_m: f32, mu_s: f32) -> ClearFluxes {
    let around = surroundings(altitude_m, mu_s, observer.lights[0].irradiance);
    let diffuse = max(PI * (around.above + around.below), vec3<f32>(1e-20));
    let beam = max(mu_s, 0.0) * light_in_air(0u, altitude_m, mu_s);
    return ClearFluxes(beam / diffuse, PI * around.above / diffuse, PI * around.below / diffuse);
}

// Diffuse light relative to that in clear air: what is left of the sky's, what clouds make of the beam, and the ground's,
// which follows both.
fn diffuse_share(day: Daylight, clear: ClearFluxes) -> vec3<f32> {
    let on_ground = (day.through * clear.beam + day.diffuse * clear.sky) / max(clear.beam + clear.sky, vec3<f32>(1e-20));
    return day.diffuse * clear.sky + (day.through - day.straight) * clear.beam + on_ground * clear.below;
}
