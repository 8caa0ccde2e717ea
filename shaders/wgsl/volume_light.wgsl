// Pass: optical depth from each cell of the grids of fog and local volumes to each light, through the sum of all media, and
// straight up and down through the fog: what a march would otherwise find again for every sample of every frame.
//
// Definitions: CLOUDS; SURFACE_HILLS (hills may stand before the lights); VOLUME_LIGHT_SAMPLES;
// VOLUME_BLOCKS, in use.

#import welkin::atmosphere::atmosphere
#import welkin::cloud_grid::local_direction
#ifdef CLOUDS
#import welkin::cloud_daylight::straight_left
#endif
#ifdef SURFACE_HILLS
#import welkin::height_field::{height_below, height_field}
#endif
#import welkin::local_lists::local_lists
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::volume_field::{
    fog_length_m, local_length_m, place_of, volumes, way_to_top_m, Place, FOG_COUNT,
}
#import welkin::volume_grid::{place_in_block, CELLS, COLUMNS, FOG_LEVELS}

// Optical depth of fog and volumes in the bands, and in the last component what dims the light besides: clouds and hills, and where other
// matter lies before it what the similar medium of that matter dims it by beyond the share that the volume's own has of it.
@group(1) @binding(42) var volume_light_image: texture_storage_3d<rgba16float, write>;
// Straight up and down through fog and the volume itself: depths of the similar medium, and depths times the share that
// turns light back.
@group(1) @binding(43) var volume_sky_image: texture_storage_3d<rgba16float, write>;

const SAMPLES: u32 = #{VOLUME_LIGHT_SAMPLES}u;
const BLOCKS: u32 = #{VOLUME_BLOCKS}u;
const FOG_BLOCKS: u32 = FOG_COUNT * FOG_LEVELS;
const FARTHEST_M: f32 = 60000.0;
// Beyond the range of half floats nothing is seen.
const DARK: f32 = 60000.0;

#ifdef SURFACE_HILLS
const HILL_STEPS: u32 = 48u;
// How far a light's edge reaches into the shadow, rad.
const PENUMBRA_RAD: f32 = 0.02;

// What hills leave of a light, as an optical depth.
fn behind_hills(place: Place, local: vec3<f32>, footprint_m: f32) -> f32 {
    let length_m = min((height_field.height_m - place.altitude_m) / max(local.z, 1e-3), FARTHEST_M);
    var visible = 1.0;
    for (var i = 0u; i < HILL_STEPS && length_m > 0.0; i++) {
        let share = (f32(i) + 0.5) / f32(HILL_STEPS);
        let t_m = length_m * share * share;
        let altitude_m = place.altitude_m + t_m * (local.z + 0.5 * t_m / atmosphere.radius_m);
        let gap_m = altitude_m - height_below(place.map + local.xy * t_m, footprint_m, altitude_m);
        visible = min(visible, 0.5 + 0.5 * gap_m / max(PENUMBRA_RAD * t_m, footprint_m));
    }
    return -log(clamp(visible, 1e-6, 1.0));
}
#endif

// A volume's optical depth, and how much of it the similar medium has beyond the share that another volume's has of its own. Where it has less
// the light is dimmed by that share all the same: a difference of two large depths would not survive half floats.
fn counted_for(index: u32, other: u32, length_m: f32) -> vec4<f32> {
    let depth = volumes[other].extinction_per_m * length_m;
    let beyond = (volumes[other].similar_extinction - volumes[index].similar_extinction) * depth;
    return vec4<f32>(depth, dot(max(beyond, vec3<f32>(0.0)), vec3<f32>(1.0 / 3.0)));
}

fn depth_to_light(index: u32, place: Place, light: u32) -> vec4<f32> {
    let toward = observer.lights[light].direction;
    let local = local_direction(place.map, toward);
    var depth = vec4<f32>(0.0);
    for (var i = 0u; i < FOG_COUNT; i++) {
        depth += counted_for(index, i, fog_length_m(i, place, local, FARTHEST_M, SAMPLES));
    }
    let air_m = way_to_top_m(place, toward);
    for (var i = 0u; i < volumes[index].occluder_count; i++) {
        let other = local_lists[volumes[index].occluders_first + i];
        depth += counted_for(index, other, local_length_m(other, place.p, toward, air_m, SAMPLES));
    }
    return depth;
}

// Extinction that turns light from its line or takes it away, and that which turns it back, as means of the bands, 1/m.
fn shares(index: u32) -> vec2<f32> {
    let extinction_per_m = volumes[index].extinction_per_m;
    let turns_per_m = volumes[index].similar_extinction * extinction_per_m;
    return vec2<f32>(dot(turns_per_m, vec3<f32>(1.0 / 3.0)), volumes[index].backward * dot(extinction_per_m, vec3<f32>(1.0 / 3.0)));
}

fn vertical(index: u32, place: Place, upward: f32) -> vec2<f32> {
    let direction = vec3<f32>(0.0, 0.0, upward);
    var depths = vec2<f32>(0.0);
    for (var i = 0u; i < FOG_COUNT; i++) {
        depths += shares(i) * fog_length_m(i, place, direction, FARTHEST_M, SAMPLES);
    }
    if index >= FOG_COUNT {
        depths += shares(index) * local_length_m(index, place.p, direction, FARTHEST_M, SAMPLES);
    }
    return depths;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    let block = texel.y / CELLS * COLUMNS + texel.x / CELLS;
    if any(texel >= textureDimensions(volume_light_image)) || block >= BLOCKS {
        return;
    }
    let is_fog = block < FOG_BLOCKS;
    var index = block / FOG_LEVELS;
    if !is_fog {
        // The first list is that of the volumes whose light is kept.
        index = local_lists[block - FOG_BLOCKS];
    }
    let light = texel.z / CELLS;
    let share = (vec3<f32>(texel % CELLS) + 0.5) / f32(CELLS);
    var place = place_in_block(index, block % FOG_LEVELS, share);
    if !is_fog {
        place = place_of(place.p);
    }
    var depth = vec4<f32>(0.0);
    // Without a light the image has one slot all the same.
    if light < LIGHT_COUNT {
#ifdef CLOUDS
        depth.a -= log(max(straight_left(light, place.map, place.altitude_m), 1e-20));
#endif
#ifdef SURFACE_HILLS
        let local = local_direction(place.map, observer.lights[light].direction);
        depth.a += behind_hills(place, local, 20.0);
#endif
        depth += depth_to_light(index, place, light);
    }
    textureStore(volume_light_image, texel, min(depth, vec4<f32>(DARK)));
    if light == 0u {
        let depths = vec4<f32>(vertical(index, place, 1.0), vertical(index, place, -1.0));
        textureStore(volume_sky_image, texel, min(depths, vec4<f32>(DARK)));
    }
}
