// Pass: mean extinction of each cell of the clouds' grids, 1/m.

#import welkin::cloud_field::{cloud_layers, layer_density}
#import welkin::cloud_grid::{cell_m, cell_of, GRID_SLICES}

@group(0) @binding(0) var cloud_density_image: texture_storage_3d<r32float, write>;

// Points along each side of a cell at which it is looked at.
const POINTS: u32 = 2u;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    if any(texel >= textureDimensions(cloud_density_image)) {
        return;
    }
    let cell = cell_of(texel);
    let size_m = vec3<f32>(vec2<f32>(cell_m(cell.level)), cloud_layers[cell.layer].thickness_m / f32(GRID_SLICES));
    var sum = 0.0;
    for (var i = 0u; i < POINTS * POINTS * POINTS; i++) {
        let place = vec3<f32>(vec3<u32>(i, i / POINTS, i / (POINTS * POINTS)) % vec3<u32>(POINTS));
        let offset_m = ((place + 0.5) / f32(POINTS) - 0.5) * size_m;
        sum += layer_density(cell.layer, cell.map + offset_m.xy, cell.altitude_m + offset_m.z);
    }
    let extinction_per_m = cloud_layers[cell.layer].extinction_per_m * sum / f32(POINTS * POINTS * POINTS);
    textureStore(cloud_density_image, texel, vec4<f32>(extinction_per_m, 0.0, 0.0, 0.0));
}
