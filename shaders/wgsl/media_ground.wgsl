#define_import_path welkin::media_ground
// What local volumes leave of the light on the ground, and what local lights bring there.
//
// Definitions: LOCAL_LIGHT_COUNT, LAMP_FROXELS.

#import welkin::atmosphere::atmosphere
#import welkin::cluster_members::{lamps_of, next_member, NONE}
#import welkin::observer::observer
#import welkin::volume_field::{local_length_m, volumes, way_to_top_m, Place, FOG_COUNT, VOLUME_COUNT}
#if LOCAL_LIGHT_COUNT > 0
#import welkin::lamp_grid::{near_share_on_ground, GROUND}
#import welkin::local_light::{local_irradiance, local_lights}
#ifdef LAMP_FROXELS
#import welkin::far_lamps::from_far_lamps
#endif
#endif

// Points on the way through an uneven volume.
const SHADE_SAMPLES: u32 = 6u;

// Depth by which a local volume dims the first light's beam to a place: what goes on nearly straight is not counted.
fn shading_depth(index: u32, place: Place) -> f32 {
    let toward = observer.lights[0].direction;
    let forward = (1.0 - volumes[index].similarity) * volumes[index].scattering_per_m.g;
    let length_m = local_length_m(index, place.p, toward, way_to_top_m(place, toward), SHADE_SAMPLES);
    return (volumes[index].extinction_per_m.g - forward) * length_m;
}

// Share of the first light's beam that local volumes let through to a place, straight or nearly so.
fn volume_share(place: Place) -> f32 {
    var depth = 0.0;
    for (var i = FOG_COUNT; i < VOLUME_COUNT; i++) {
        depth += shading_depth(i, place);
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
