#define_import_path welkin::media_light
// Light that each kind of matter adds in a step of the march through the sum of all media.
//
// Definitions: CLOUDS; LOCAL_LIGHT_COUNT; LAMP_FROXELS.

#import welkin::volume_field::{volumes, Place, FOG_COUNT, VOLUME_COUNT}
#import welkin::volume_source::{from_lights, seen_whole, Arriving, Piece, Stretch}
#if LOCAL_LIGHT_COUNT > 0
#import welkin::cluster_members::{lamps_of, near_lamps_of, next_member, NONE}
#import welkin::lamp_source::{from_local_light, ALL, NEAR}
#ifdef LAMP_FROXELS
#import welkin::far_lamps::from_far_lamps
#endif
#endif
#ifdef CLOUDS
#import welkin::cloud_field::CLOUD_LAYER_COUNT
#import welkin::cloud_matter::cloud_matter
#import welkin::cloud_step::{is_inside, layer_extinction}
#endif

#if LOCAL_LIGHT_COUNT > 0
// Radiance that local lights bring, per density and metre, before the air.
fn from_lamps(piece: Piece, stretch: Stretch, pixel: vec2<u32>, cluster: u32) -> vec3<f32> {
    var radiance = vec3<f32>(0.0);
    var asked = ALL;
    var lamps = lamps_of(cluster);
#ifdef LAMP_FROXELS
    if piece.index < FOG_COUNT {
        asked = NEAR;
        lamps = near_lamps_of(cluster);
        radiance = from_far_lamps(piece.index, pixel, stretch.from_m + 0.5 * stretch.step_m) * seen_whole(stretch);
    }
#endif
    for (var light = next_member(&lamps); light != NONE; light = next_member(&lamps)) {
        radiance += from_local_light(light, piece, stretch, asked);
    }
    return radiance;
}
#endif

// What one volume adds in a step, before the air.
fn from_volume(piece: Piece, stretch: Stretch, pixel: vec2<u32>, cluster: u32) -> Arriving {
    let own = piece.density * stretch.step_m;
    let emitted = own * volumes[piece.index].emission_per_m * seen_whole(stretch);
    if all(volumes[piece.index].scattering_per_m <= vec3<f32>(0.0)) {
        return Arriving(emitted, vec3<f32>(0.0));
    }
    var arriving = from_lights(piece, stretch);
#if LOCAL_LIGHT_COUNT > 0
    arriving.scattered += from_lamps(piece, stretch, pixel, cluster);
#endif
    let scattering = own * volumes[piece.index].scattering_per_m;
    return Arriving(emitted + scattering * arriving.scattered, scattering * arriving.passed);
}

#ifdef CLOUDS
#if LOCAL_LIGHT_COUNT > 0
// What clouds send of the local lights' light in a step, before the air. To a lamp a layer is matter like that of a volume, behind all of which
// its entry stands.
fn clouds_lit_by_lamps(place: Place, extinction: f32, stretch: Stretch, cluster: u32) -> vec3<f32> {
    var radiance = vec3<f32>(0.0);
    for (var layer = 0u; layer < CLOUD_LAYER_COUNT; layer++) {
        if !is_inside(layer, place.altitude_m) {
            continue;
        }
#if CLOUD_LAYER_COUNT > 1
        let own = layer_extinction(layer, place.map, place.altitude_m);
#else
        let own = extinction;
#endif
        let piece = Piece(VOLUME_COUNT + layer, 1.0, place);
        var lamps = lamps_of(cluster);
        var arriving = vec3<f32>(0.0);
        for (var light = next_member(&lamps); light != NONE; light = next_member(&lamps)) {
            arriving += from_local_light(light, piece, stretch, ALL);
        }
        radiance += own * stretch.step_m * cloud_matter[layer].albedo * arriving;
    }
    return radiance;
}
#endif
#endif
