// Pass: what changes little from pixel to pixel, at the corners and centres of cells of pixels: see welkin::lattice.

#import welkin::camera::view_through
#import welkin::cell_kind::{kind_of_cell, MIXED_CELL}
#import welkin::lattice::{CELL, DIFFUSE_LAYER, NODE_LAYERS, SINGLE_LAYER}
#ifdef LATTICE_TRANSMITTANCE
#import welkin::lattice::TRANSMITTANCE_LAYER
#endif
#ifdef OVERLAY
#import welkin::lattice::{GLOW_LAYER, GROUND_DIFFUSE_LAYER, GROUND_STRAIGHT_LAYER}
#endif
#import welkin::observer::observer
#import welkin::smooth_sky::{smooth_sky, SINGLE_COUNT}

@group(0) @binding(8) var sky_lattice_image: texture_storage_2d_array<rgba32float, write>;

fn put(at: vec2<u32>, layer: u32, light: vec3<f32>) {
    textureStore(sky_lattice_image, at, layer, vec4<f32>(light, 0.0));
}

// x, y: cell; z: 0 for the corner at its upper left, 1 for its centre.
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(sky_lattice_image)) {
        return;
    }
    let is_centre = id.z == 1u;
    let place = f32(CELL) * (vec2<f32>(id.xy) + select(0.0, 0.5, is_centre));
    let view = view_through(place);
    let zenith_rad = atan2(length(view.xy), view.z);
    let sky = smooth_sky(view, zenith_rad, zenith_rad > observer.view.horizon_rad);
    var kind = MIXED_CELL;
    if is_centre {
        kind = kind_of_cell(place, 0.5 * f32(CELL), view, zenith_rad);
    }
    let first = NODE_LAYERS * id.z;
    var diffuse = sky.diffuse;
#ifdef OVERLAY
    put(id.xy, first + GROUND_STRAIGHT_LAYER, sky.ground_straight);
    put(id.xy, first + GROUND_DIFFUSE_LAYER, sky.ground_diffuse);
    put(id.xy, first + GLOW_LAYER, sky.glow);
#else
    diffuse += sky.ground_straight + sky.ground_diffuse + sky.glow;
#endif
    textureStore(sky_lattice_image, id.xy, first + DIFFUSE_LAYER, vec4<f32>(diffuse, kind));
#ifdef LATTICE_TRANSMITTANCE
    put(id.xy, first + TRANSMITTANCE_LAYER, sky.transmittance);
#endif
    for (var i = 0u; i < SINGLE_COUNT; i++) {
        put(id.xy, first + SINGLE_LAYER + i, sky.single[i]);
    }
}
