#define_import_path welkin::media_patch
// What media send and leave over a cell of pixels: each channel is a parabola through the cell's corners and its middle, if that will do.
//
// How it bends along rows tell the middles of three cells side by side, along columns what its own corners and middle then lack. Corners
// along its edges and middles above and below tell the same another way, and where they differ there is an edge or a kink.
//
// Legend
//   slot      a froxel's (welkin::media_froxels), or OWN: what was found up to where each pixel's ray ends
//
// Definitions: MEDIA_CELL; MEDIA_PERMILLE, thousandths by which interpolation may err; CLOUDS; MEDIA_FROXELS.

#import welkin::media_froxels::{froxel_layer, BEAM, CORNER, MIDDLE, OWN, RADIANCE, TRANSMITTANCE}
#import welkin::media_lattice::{centre_pixel, corner_pixel, TOLERANCE}

@group(1) @binding(50) var media_radiance_image: texture_storage_2d<rgba32float, read_write>;
@group(1) @binding(51) var media_transmittance_image: texture_storage_2d<rgba32float, read_write>;
@group(1) @binding(52) var media_beam_image: texture_storage_2d<rgba32float, read_write>;
@group(1) @binding(53) var media_diffuse_image: texture_storage_2d<rgba32float, read_write>;
#ifdef MEDIA_FROXELS
@group(1) @binding(55) var media_froxels: texture_3d<f32>;
#endif

// How far a parabola may rise over its chords, in tolerances: it is followed, but not trusted where it is steep.
const STEEPEST: f32 = 4.0;
// Below these transmittances and shares of light, errors count as if they were so large.
const LEAST_TRANSMITTANCE: f32 = 0.01;
const LEAST_SHARE: f32 = 0.05;

// What one image is in a cell.
struct Patch {
    upper_left: vec4<f32>,
    upper_right: vec4<f32>,
    lower_left: vec4<f32>,
    lower_right: vec4<f32>,
    along_row: vec4<f32>,
    along_column: vec4<f32>,
}

// One of the images, up to a slot.
struct Layer {
    image: u32,
    slot: u32,
}

fn load_pixel(image: u32, pixel: vec2<u32>) -> vec4<f32> {
    switch image {
        case RADIANCE: { return textureLoad(media_radiance_image, pixel); }
        case TRANSMITTANCE: { return textureLoad(media_transmittance_image, pixel); }
        case BEAM: { return textureLoad(media_beam_image, pixel); }
        default: { return textureLoad(media_diffuse_image, pixel); }
    }
}

fn at_part(layer: Layer, cell: vec2<u32>, part: u32) -> vec4<f32> {
#ifdef MEDIA_FROXELS
    if layer.slot != OWN {
        return textureLoad(media_froxels, vec3<u32>(cell, froxel_layer(layer.slot, part, layer.image)), 0);
    }
#endif
    return load_pixel(layer.image, select(corner_pixel(cell), centre_pixel(cell), part == MIDDLE));
}

fn at_corner(layer: Layer, cell: vec2<u32>) -> vec4<f32> {
    return at_part(layer, cell, CORNER);
}

fn at_middle(layer: Layer, cell: vec2<u32>) -> vec4<f32> {
    return at_part(layer, cell, MIDDLE);
}

// Errors of an image's channels count relative to these, where the channels are not larger.
fn least(image: u32) -> vec4<f32> {
    switch image {
        case RADIANCE: { return vec4<f32>(vec3<f32>(0.0), LEAST_SHARE); }
        case TRANSMITTANCE: { return vec4<f32>(vec3<f32>(LEAST_TRANSMITTANCE), LEAST_SHARE); }
        default: { return vec4<f32>(LEAST_TRANSMITTANCE); }
    }
}

fn allowed_error(image: u32, value: vec4<f32>) -> vec4<f32> {
    return TOLERANCE * max(abs(value), least(image));
}

// By how much a parabola through three middles rises over the chord of one cell.
fn rise(layer: Layer, middle: vec2<u32>, across: vec2<u32>) -> vec4<f32> {
    let outer = at_middle(layer, middle - across) + at_middle(layer, middle + across);
    return 0.125 * (2.0 * at_middle(layer, middle) - outer);
}

fn patch_of(layer: Layer, cell: vec2<u32>, middle: vec2<u32>) -> Patch {
    var found: Patch;
    found.upper_left = at_corner(layer, cell);
    found.upper_right = at_corner(layer, cell + vec2<u32>(1u, 0u));
    found.lower_left = at_corner(layer, cell + vec2<u32>(0u, 1u));
    found.lower_right = at_corner(layer, cell + 1u);
    found.along_row = rise(layer, vec2<u32>(middle.x, cell.y), vec2<u32>(1u, 0u));
    let mean = 0.25 * (found.upper_left + found.upper_right + found.lower_left + found.lower_right);
    found.along_column = at_middle(layer, cell) - mean - found.along_row;
    return found;
}

// The same for a parabola near four corners in a line, over the chord between the two in the middle.
fn rise_of_edge(layer: Layer, first: vec2<u32>, across: vec2<u32>) -> vec4<f32> {
    let chord = at_corner(layer, first) + at_corner(layer, first + across);
    return 0.0625 * (chord - at_corner(layer, first - across) - at_corner(layer, first + 2u * across));
}

// Whether a layer must not be interpolated in a cell. `middle` has neighbours on all sides.
fn is_rough(layer: Layer, cell: vec2<u32>, middle: vec2<u32>, found: Patch) -> bool {
    let right = vec2<u32>(1u, 0u);
    let down = vec2<u32>(0u, 1u);
    let above = rise_of_edge(layer, vec2<u32>(middle.x, cell.y), right);
    let below = rise_of_edge(layer, vec2<u32>(middle.x, cell.y) + down, right);
    let left_side = rise_of_edge(layer, vec2<u32>(cell.x, middle.y), down);
    let right_side = rise_of_edge(layer, vec2<u32>(cell.x, middle.y) + right, down);
    let along_column = rise(layer, vec2<u32>(cell.x, middle.y), down);
    let differ = max(
        max(abs(found.along_row - above), abs(found.along_row - below)),
        max(max(abs(found.along_column - left_side), abs(found.along_column - right_side)), abs(found.along_column - along_column)),
    );
    let height = abs(found.along_row) + max(abs(found.along_column), abs(along_column));
    let allowed = allowed_error(layer.image, at_middle(layer, cell));
    let is_steep = any(height > STEEPEST * allowed) || any(differ > allowed);
#ifdef CLOUDS
    // Their edges may lie between the lattice's pixels.
    return is_steep || (layer.image == BEAM && (height.a > 0.0 || found.upper_left.a + found.lower_right.a > 0.0));
#else
    return is_steep;
#endif
}

// In a share of the cell along rows and columns.
fn between(found: Patch, share: vec2<f32>) -> vec4<f32> {
    let chord = mix(
        mix(found.upper_left, found.upper_right, share.x), mix(found.lower_left, found.lower_right, share.x), share.y
    );
    let bend = 4.0 * share * (1.0 - share);
    let value = chord + bend.x * found.along_row + bend.y * found.along_column;
    // What is no number stays none, and is seen.
    return select(value, vec4<f32>(0.0), value < vec4<f32>(0.0));
}
