#define_import_path welkin::lattice
// The lattice of directions between which the sky is interpolated: corners and centres of square cells of pixels.
//
// Centres tell how the light bends in a cell: their second differences along rows, and along columns what the corners then
// lack. Cells that bend too much for a parabola, and those that hold the horizon or a disc, are evaluated pixel by pixel.
//
// Definitions: LATTICE_CELL, pixels along a side of a cell; OVERLAY (clouds or local media take unlike shares of light of
// unlike origin, which is then kept apart); LATTICE_TRANSMITTANCE (somebody asks for it).

#import welkin::smooth_sky::{SmoothSky, SINGLE_COUNT}

const CELL: u32 = #{LATTICE_CELL}u;

// Layers of the lattice's image, for corners, and then again for centres. What no cloud takes apart shares a layer, and
// transmittance has none where nobody asks for it.
const DIFFUSE_LAYER: u32 = 0u;
const SINGLE_LAYER: u32 = 1u;
const END_OF_LIGHT: u32 = SINGLE_LAYER + SINGLE_COUNT;
#ifdef OVERLAY
const GROUND_STRAIGHT_LAYER: u32 = END_OF_LIGHT;
const GROUND_DIFFUSE_LAYER: u32 = END_OF_LIGHT + 1u;
const GLOW_LAYER: u32 = END_OF_LIGHT + 2u;
const TRANSMITTANCE_LAYER: u32 = END_OF_LIGHT + 3u;
#else
const TRANSMITTANCE_LAYER: u32 = END_OF_LIGHT;
#endif
#ifdef LATTICE_TRANSMITTANCE
const NODE_LAYERS: u32 = TRANSMITTANCE_LAYER + 1u;
#else
const NODE_LAYERS: u32 = TRANSMITTANCE_LAYER;
#endif

// A corner of cells, by the number of the cell to its lower right.
fn corner_node(nodes: texture_2d_array<f32>, corner: vec2<u32>) -> SmoothSky {
    return node(nodes, corner, 0u);
}

fn centre_node(nodes: texture_2d_array<f32>, cell: vec2<u32>) -> SmoothSky {
    return node(nodes, cell, NODE_LAYERS);
}

// welkin::cell_kind, in the fourth channel of its centre's diffuse light.
fn cell_kind(nodes: texture_2d_array<f32>, cell: vec2<u32>) -> f32 {
    return textureLoad(nodes, cell, NODE_LAYERS + DIFFUSE_LAYER, 0).a;
}

fn node(nodes: texture_2d_array<f32>, at: vec2<u32>, first: u32) -> SmoothSky {
    var sky: SmoothSky;
#ifdef LATTICE_TRANSMITTANCE
    sky.transmittance = textureLoad(nodes, at, first + TRANSMITTANCE_LAYER, 0).rgb;
#endif
    sky.diffuse = textureLoad(nodes, at, first + DIFFUSE_LAYER, 0).rgb;
#ifdef OVERLAY
    sky.ground_straight = textureLoad(nodes, at, first + GROUND_STRAIGHT_LAYER, 0).rgb;
    sky.ground_diffuse = textureLoad(nodes, at, first + GROUND_DIFFUSE_LAYER, 0).rgb;
    sky.glow = textureLoad(nodes, at, first + GLOW_LAYER, 0).rgb;
#endif
    for (var i = 0u; i < SINGLE_COUNT; i++) {
        sky.single[i] = textureLoad(nodes, at, first + SINGLE_LAYER + i, 0).rgb;
    }
    return sky;
}
