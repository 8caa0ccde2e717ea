#define_import_path welkin::froxel_grid
// Froxels of a host's: columns over the picture, and slices at distances before the camera, the first of them at the camera itself.
//
// Legend
//   column    of froxels, (0, 0) at the picture's top left; it stands for the ray through its middle
//   slice     a distance along that ray, which grows from slice to slice evenly at first and by a factor in the end

#import welkin::camera::{camera, view_through}

struct FroxelGrid {
    // From spectral radiance, W/m2/sr/nm, to the host's colour.
    from_radiance: mat3x3<f32>,
    // Slice k lies at near_m (2^(k log_growth) - 1).
    near_m: f32,
    log_growth: f32,
    padding_a: f32,
    padding_b: f32,
}

@group(0) @binding(33) var<storage, read> froxel_grid: FroxelGrid;

fn slice_distance_m(slice: u32) -> f32 {
    return froxel_grid.near_m * (exp2(f32(slice) * froxel_grid.log_growth) - 1.0);
}

// The middle of a column, in pixels from the picture's top left corner.
fn column_place(column: vec2<u32>, columns: vec2<u32>) -> vec2<f32> {
    return (vec2<f32>(column) + 0.5) / vec2<f32>(columns) * camera.size;
}

fn column_direction(column: vec2<u32>, columns: vec2<u32>) -> vec3<f32> {
    return view_through(column_place(column, columns));
}
