#define_import_path welkin::cloud_daylight
// Light from outside the clouds: what reaches them through the air, and what they leave of it for air, ground and hills.

#import welkin::atmosphere::{atmosphere, PI}
#import welkin::cloud_field::{cloud_layers, CLOUD_LAYER_COUNT}
#import welkin::cloud_grid::{column_sample, grid_sample, local_direction, Part}
#import welkin::cloud_matter::cloud_matter
#import welkin::geometry::horizon_mu
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::sky::multiple_scattering_table
#import welkin::tables::{mean_field, optical_depth_to_top, table_sampler}

// Optical depths to each light, to the layer's top and to its base.
@group(1) @binding(9) var cloud_light_image: texture_3d<f32>;
// What each layer leaves of light around a column: left_by_layer's means.
@group(1) @binding(14) var cloud_cover_image: texture_3d<f32>;

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

// What a layer leaves of light at the depths to the first light and straight up: of a beam's flux through a horizontal
// plane all that passes, in any direction, and what passes nearly straight; of the sky's light. By two streams in
// the similar medium (Joseph, Wiscombe & Weinman 1976): of a beam with cosine mu
// ((2/3 + mu) + (2/3 - mu) e^(-q tau)) / (4/3 + (1 - g) mu tau), of diffuse light 1 / (1 + 3/4 (1 - g) tau).
fn left_by_layer(layer: u32, mu: f32, to_light: f32, above: f32) -> vec3<f32> {
    let matter = cloud_matter[layer];
    let straight = exp(-matter.similarity * to_light);
    let through = (2.0 / 3.0 + mu + (2.0 / 3.0 - mu) * straight) / (4.0 / 3.0 + matter.backward * mu * to_light);
    return vec3<f32>(max(through, straight), straight, 1.0 / (1.0 + 0.75 * matter.backward * above));
}

// Of a light's beam, what passes all layers straight or nearly so to a point of the air or the ground.
fn straight_left(light: u32, map: vec2<f32>, altitude_m: f32) -> f32 {
    let toward = local_direction(map, observer.lights[light].direction);
    var straight = 1.0;
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let up_m = altitude_m - cloud_layers[layer].base_m;
        if up_m > cloud_layers[layer].thickness_m {
            continue;
        }
        // Below the base the light is followed up to it.
        let along_m = max(-up_m, 0.0) / max(toward.z, 0.02);
        let height = max(up_m, 0.0) / cloud_layers[layer].thickness_m;
        let at = map + toward.xy * along_m;
        let depth = grid_sample(cloud_light_image, table_sampler, Part(light, LIGHT_COUNT), layer, at, height).x;
        straight = min(straight, exp(-cloud_matter[layer].similarity * depth));
    }
    return straight;
}

// What clouds do to the first light and the sky's light around a point.
struct Cover {
    // Left by those above it: of the beam's flux, of its part that is nearly straight, of the sky's light.
    through: f32,
    straight: f32,
    diffuse: f32,
    // Sent up by those below it: of the flux of the beam that reaches them, of the sky's light.
    back_beam: f32,
    back_sky: f32,
    // Left on the ground: of the beam's flux, of its part that is nearly straight, of the sky's light.
    ground_beam: f32,
    ground_straight: f32,
    ground_sky: f32,
}

fn cover_at(map: vec2<f32>, altitude_m: f32) -> Cover {
    var above = vec3<f32>(1.0);
    var ground = vec3<f32>(1.0);
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        let height = saturate((altitude_m - cloud_layers[layer].base_m) / cloud_layers[layer].thickness_m);
        let left = column_sample(cloud_cover_image, table_sampler, layer, map).xyz;
        ground = min(ground, left);
        above = min(above, mix(left, vec3<f32>(1.0), height));
    }
    // What reaches the point and not the ground goes back up from between.
    let kept = above - ground;
    return Cover(above.x, above.y, above.z, kept.x, kept.z, ground.x, ground.y, ground.z);
}

// A light's fluxes through a horizontal plane in clear air: its beam, the sky's light from above and what comes
// from below, over the sum of the last two.
struct ClearFluxes {
    beam: vec3<f32>,
    sky: vec3<f32>,
    below: vec3<f32>,
}

fn fluxes_of(around: Surroundings, beam: vec3<f32>, mu_s: f32) -> ClearFluxes {
    let diffuse = max(around.above + around.below, vec3<f32>(1e-20));
    return ClearFluxes(max(mu_s, 0.0) / PI * beam / diffuse, around.above / diffuse, around.below / diffuse);
}

fn clear_fluxes(altitude_m: f32, mu_s: f32) -> ClearFluxes {
    return fluxes_of(surroundings(altitude_m, mu_s, observer.lights[0].irradiance), light_in_air(0u, altitude_m, mu_s), mu_s);
}

// Of what falls on the ground, what comes back up.
fn returned(clear: ClearFluxes) -> vec3<f32> {
    return clear.below / max(clear.beam + clear.sky, vec3<f32>(1e-20));
}

// Diffuse light at a point, downwards and upwards, relative to both together in clear air: what is left of the sky's, what clouds make of the
// beam above and below, and the ground's, which follows what reaches it and is thrown to and fro below the clouds.
struct DiffuseFluxes {
    downward: vec3<f32>,
    upward: vec3<f32>,
}

fn diffuse_fluxes(cover: Cover, clear: ClearFluxes) -> DiffuseFluxes {
    let albedo = returned(clear);
    let on_ground = (cover.ground_beam * clear.beam + cover.ground_sky * clear.sky)
        / (1.0 - (1.0 - cover.ground_sky) * albedo);
    let passed = 1.0 - cover.back_sky;
    let upward = passed * albedo * on_ground + cover.back_beam * clear.beam + cover.back_sky * clear.sky;
    let downward = (cover.through - cover.straight) * clear.beam + cover.diffuse * clear.sky;
    return DiffuseFluxes(downward + (1.0 - cover.diffuse) * upward, upward);
}

fn diffuse_share(cover: Cover, clear: ClearFluxes) -> vec3<f32> {
    let fluxes = diffuse_fluxes(cover, clear);
    return fluxes.downward + fluxes.upward;
}

// The diffuse field of the air at a place among clouds, of a light. What they leave of the light is that of the first.
fn surroundings_among_clouds(light: u32, map: vec2<f32>, altitude_m: f32, mu_s: f32) -> Surroundings {
    let around = surroundings(altitude_m, mu_s, observer.lights[light].irradiance);
    let both = around.above + around.below;
    let fluxes = diffuse_fluxes(cover_at(map, altitude_m), fluxes_of(around, light_in_air(light, altitude_m, mu_s), mu_s));
    return Surroundings(both * fluxes.downward, both * fluxes.upward);
}

// What is left on the ground of the first light's flux and of the sky's light; between clouds and ground, light is thrown
// to and fro.
fn left_on_ground(straight: f32, cover: Cover, clear: ClearFluxes) -> vec2<f32> {
    let back = (1.0 - cover.ground_sky) * dot(returned(clear), vec3<f32>(1.0 / 3.0));
    let scattered = (cover.ground_beam - cover.ground_straight + back * cover.ground_straight) / (1.0 - back);
    return vec2<f32>(straight + scattered, cover.ground_sky / (1.0 - back));
}
