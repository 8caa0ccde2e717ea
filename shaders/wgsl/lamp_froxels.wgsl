// Pass: light of local lights far from a place, for froxels before the camera: what every pixel's march would otherwise sum for
// every step.
//
// A node holds the mean over its slice along the ray through the corner of a tile, as the fog there scatters it towards the
// camera; in the last part, irradiance of the ground below the middle of the slice.
//
// Definitions: LAMP_FROXELS; FOG_COUNT.

#import welkin::atmosphere::atmosphere
#import welkin::camera::{camera, view_through}
#import welkin::cluster::{cluster_of, slice_of, TILE}
#import welkin::cluster_members::{lamps_of, next_member, NONE}
#import welkin::lamp_grid::{froxel_start_m, near_share_on_ground, tile_rad, GROUND, PARTS, SLICES}
#import welkin::lamp_source::{from_local_light, FAR}
#import welkin::local_light::{local_irradiance, local_lights}
#import welkin::observer::observer
#import welkin::volume_field::{place_of, volumes, Place}
#import welkin::volume_source::{Piece, Stretch}

@group(1) @binding(49) var lamp_froxels: texture_storage_3d<rgba32float, write>;

// How far a place that is interpolated from a node can lie above or below it, over the distance.
const NEIGHBOUR_RISE: f32 = 0.3;

fn on_ground(ground: Place, t_m: f32, cluster: u32) -> vec3<f32> {
    let up = normalize(vec3<f32>(ground.p.xy, ground.p.z + atmosphere.radius_m));
    var irradiance = vec3<f32>(0.0);
    var lamps = lamps_of(cluster);
    for (var light = next_member(&lamps); light != NONE; light = next_member(&lamps)) {
        let far = 1.0 - near_share_on_ground(t_m, distance(local_lights[light].position_m, ground.p));
        if far > 0.0 {
            irradiance += far * local_irradiance(light, ground, up);
        }
    }
    return irradiance;
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id >= textureDimensions(lamp_froxels)) {
        return;
    }
    let part = id.z / SLICES;
    let slice = id.z % SLICES;
    let start_m = froxel_start_m(slice);
    let end_m = froxel_start_m(slice + 1u);
    let middle_m = 0.5 * (start_m + end_m);
    let last_pixel = vec2<u32>(camera.size) - 1u;
    let cluster = cluster_of(min(id.xy * TILE, last_pixel), slice_of(middle_m));
    let view = view_through(vec2<f32>(id.xy * TILE));
    let origin = vec3<f32>(0.0, 0.0, observer.altitude_m);
    let place = place_of(origin + view * middle_m);
    // Half a slice up or down, and a tile above or below.
    let rise_m = (NEIGHBOUR_RISE * abs(view.z) + 1.5 * tile_rad()) * end_m;
    var light = vec3<f32>(0.0);
    if part == GROUND {
        if abs(place.altitude_m) <= rise_m {
            let below = place_of(place.p - vec3<f32>(0.0, 0.0, place.altitude_m));
            light = on_ground(Place(below.p, 0.0, below.map), middle_m, cluster);
        }
    } else if place.altitude_m <= volumes[part].top_m + rise_m && place.altitude_m >= max(volumes[part].bottom_m, 0.0) - rise_m {
        let stretch = Stretch(view, origin, start_m, end_m - start_m, vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0));
        let piece = Piece(part, 1.0, place);
        var lamps = lamps_of(cluster);
        for (var lamp = next_member(&lamps); lamp != NONE; lamp = next_member(&lamps)) {
            light += from_local_light(lamp, piece, stretch, FAR);
        }
    }
    textureStore(lamp_froxels, id, vec4<f32>(light, 0.0));
}
