#define_import_path welkin::lamp_grid
// Froxels of the light that local lights far from a place bring there: nodes at the corners of clusters' tiles, and slices of distance.
//
// A lamp is far where its light changes little from one tile to the next: farther from the place than some tiles are
// wide there, and not in the forward peak of what one looks at. Between near and far shares go over into each other as the place and the
// view move, so that neither a tile nor a slice has a seam.
//
// Legend
//   part      a bank of fog, or after them the smooth ground
//   share     of a lamp's light, what is found sample by sample
//
// Definitions: FOG_COUNT; LAMP_FROXELS.

#import welkin::camera::camera
#import welkin::cluster::TILE
#import welkin::local_light::local_lights
#import welkin::volume_field::FOG_COUNT

const SLICES: u32 = 42u;
const PARTS: u32 = FOG_COUNT + 1u;
const GROUND: u32 = FOG_COUNT;
// Where the first slice begins, m, and how many there are to twice the distance: the last of them ends at 8 km.
const FIRST_M: f32 = 0.5;
const PER_OCTAVE: f32 = 3.0;
// All of a lamp's light is near within so many tiles, none beyond so many.
const ALL_NEAR_TILES: f32 = 1.0;
const NONE_NEAR_TILES: f32 = 3.0;
// The same on the ground, as shares of the distance from the camera: slices are that long there.
const ALL_NEAR_ON_GROUND: f32 = 0.35;
const NONE_NEAR_ON_GROUND: f32 = 0.7;

// Width of a tile, rad.
fn tile_rad() -> f32 {
    return 2.0 * camera.half_height / camera.size.y * f32(TILE);
}

fn froxel_start_m(slice: u32) -> f32 {
    return FIRST_M * exp2(f32(slice) / PER_OCTAVE);
}

// Share of a lamp's light at distance_m and in direction `toward` from a place t_m along the view ray.
fn near_share(light: u32, origin: vec3<f32>, view: vec3<f32>, t_m: f32, toward: vec3<f32>, distance_m: f32) -> f32 {
#ifdef LAMP_FROXELS
    let tile = tile_rad();
    let beside = 1.0 - smoothstep(ALL_NEAR_TILES, NONE_NEAR_TILES, distance_m / (tile * max(t_m, FIRST_M)));
    let offset = local_lights[light].position_m - origin;
    let aside = length(cross(view, offset)) / max(length(offset), 1e-6);
    let core_m = local_lights[light].core_reach_m;
    let core = smoothstep(0.0, 0.5, dot(view, toward))
        * (1.0 - smoothstep(ALL_NEAR_TILES, NONE_NEAR_TILES, aside / tile))
        * (1.0 - smoothstep(0.5 * core_m, core_m, distance_m));
    return max(beside, core);
#else
    return 1.0;
#endif
}

// Share of a lamp's light on the ground.
fn near_share_on_ground(t_m: f32, distance_m: f32) -> f32 {
#ifdef LAMP_FROXELS
    return 1.0 - smoothstep(ALL_NEAR_ON_GROUND, NONE_NEAR_ON_GROUND, distance_m / max(t_m, FIRST_M));
#else
    return 1.0;
#endif
}
