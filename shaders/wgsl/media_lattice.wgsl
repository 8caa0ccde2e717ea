#define_import_path welkin::media_lattice
// The lattice of pixels between which marched media are interpolated: the first pixel of each square cell and the one in its middle.
// Cells that the picture cuts off have no far corners, and are never interpolated.
//
// Definitions: MEDIA_CELL, pixels along a side of a cell; MEDIA_PERMILLE, thousandths by which interpolation may err.

const CELL: u32 = #{MEDIA_CELL}u;
const TOLERANCE: f32 = #{MEDIA_PERMILLE}.0 * 0.001;

fn corner_pixel(cell: vec2<u32>) -> vec2<u32> {
    return CELL * cell;
}

fn centre_pixel(cell: vec2<u32>) -> vec2<u32> {
    return CELL * cell + CELL / 2u;
}

fn is_node(pixel: vec2<u32>) -> bool {
    let within = pixel % CELL;
    return all(within == vec2<u32>(0u)) || all(within == vec2<u32>(CELL / 2u));
}

// How many cells have all four corners in a picture.
fn whole_cells(size: vec2<u32>) -> vec2<u32> {
    return (size - 1u) / CELL;
}
