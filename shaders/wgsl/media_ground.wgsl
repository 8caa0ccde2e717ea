#define_import_path welkin::media_ground
// What fog leaves of the light on the ground and on hills, and what local lights bring there.
//
// Definitions: FOG_COUNT, LOCAL_LIGHT_COUNT, LAMP_FROXELS.

#import welkin::atmosphere::{atmosphere, PI}
#import welkin::cloud_daylight::{light_in_air, surroundings}
#import welkin::cluster_members::{lamps_of, next_member, NONE}
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::slab_field::{slab_on_ground, slab_spot, slab_table}
#import welkin::tables::table_sampler
#import welkin::volume_field::{local_length_m, volumes, way_to_top_m, Place, FOG_COUNT, VOLUME_COUNT}
#import welkin::volume_grid::{block_uvw, spot_of}
#import welkin::volume_source::volume_sky_image
#if LOCAL_LIGHT_COUNT > 0
#import welkin::lamp_grid::{near_share_on_ground, GROUND}
#import welkin::local_light::{local_irradiance, local_lights}
#ifdef LAMP_FROXELS
#import welkin::far_lamps::from_far_lamps
#endif
#endif

// A lower sun counts as this high in a slab.
const LOWEST_SUN: f32 = 0.02;

// Share of the light on a horizontal plane, of which shares of the beam and of the sky reach the top of the fog.
fn fog_share(place: Place, above: vec2<f32>) -> f32 {
    if FOG_COUNT == 0u || place.altitude_m >= volumes[0].top_m {
        return 1.0;
    }
    let spot = spot_of(0u, place);
    let depths = textureSampleLevel(volume_sky_image, table_sampler, block_uvw(spot.block, spot.share, 0u, 1u), 0.0);
    let mu = observer.lights[0].direction.z;
    let beam = above.x * max(mu, 0.0) * light_in_air(0u, place.altitude_m, mu);
    let sky = above.y * PI * surroundings(place.altitude_m, mu, observer.lights[0].irradiance).above;
    let on_ground = slab_spot(depths.x, depths.z);
    let straight = exp(-depths.x / max(mu, LOWEST_SUN));
    let from_beam = beam * (straight + slab_on_ground(slab_table(0u, 0u), on_ground));
    let from_sky = sky * slab_on_ground(slab_table(0u, LIGHT_COUNT), on_ground);
    return ((from_beam + from_sky) / max(beam + sky, vec3<f32>(1e-20))).g;
}

// Points on the way through an uneven volume.
const SHADE_SAMPLES: u32 = 6u;

// Share of the first light's beam that local volumes let through to a place, straight or nearly so.
fn volume_share(place: Place) -> f32 {
    let toward = observer.lights[0].direction;
    let air_m = way_to_top_m(place, toward);
    var depth = 0.0;
    for (var i = FOG_COUNT; i < VOLUME_COUNT; i++) {
        let forward = (1.0 - volumes[i].similarity) * volumes[i].scattering_per_m.g;
        let length_m = local_length_m(i, place.p, toward, air_m, SHADE_SAMPLES);
        depth += (volumes[i].extinction_per_m.g - forward) * length_m;
    }
    return exp(-depth);
}

// Irradiance that the local lights of a cluster bring to a plane, W/m2/nm.
fn lit_by_lamps(place: Place, normal: vec3<f32>, cluster: u32) -> vec3<f32> {
    var irradiance = vec3<f32>(0.0);
#if LOCAL_LIGHT_COUNT > 0
    var lamps = lamps_of(cluster);
    for (var light = next_member(&lamps); light != NONE; light = next_member(&lamps)) {
        irradiance += local_irradiance(light, place, normal);
    }
#endif
    return irradiance;
}

// The same of smooth ground that a pixel sees at a distance.
fn ground_lit_by_lamps(place: Place, pixel: vec2<u32>, t_m: f32, cluster: u32) -> vec3<f32> {
    let up = normalize(vec3<f32>(place.p.xy, place.p.z + atmosphere.radius_m));
#ifdef LAMP_FROXELS
    var irradiance = from_far_lamps(GROUND, pixel, t_m);
    var lamps = lamps_of(cluster);
    for (var light = next_member(&lamps); light != NONE; light = next_member(&lamps)) {
        let near = near_share_on_ground(t_m, distance(local_lights[light].position_m, place.p));
        if near > 0.0 {
            irradiance += near * local_irradiance(light, place, up);
        }
    }
    return irradiance;
#else
    return lit_by_lamps(place, up, cluster);
#endif
}
