// Pass: what each layer of clouds leaves of the first light and of the sky's light around each column of its grids.
//
// Light that clouds have scattered comes from all sides: a place below a gap sees the clouds around it. With H the height of
// the layer, a point of its base at a distance r counts in proportion to H² / (H² + r²)², as the irradiance of the ground
// below has it. Slices of the image: the slabs of the grids.

#import welkin::cloud_daylight::{cloud_light_image, left_by_layer}
#import welkin::cloud_field::{cloud_layers, CLOUD_LAYER_COUNT}
#import welkin::cloud_grid::{cell_of, grid_sample, local_direction, Part, GRID_SLICES}
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::tables::table_sampler

// Of the beam's flux all that passes, and what passes nearly straight; of the sky's light.
@group(1) @binding(14) var cloud_cover_image: texture_storage_3d<rgba16float, write>;

const SAMPLES: u32 = 64u;
// Share of the whole irradiance that comes from within the farthest sample.
const WIDEST: f32 = 0.95;
// π (3 - √5): directions that never repeat.
const GOLDEN_ANGLE_RAD: f32 = 2.39996323;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) texel: vec3<u32>) {
    if any(texel >= textureDimensions(cloud_cover_image)) {
        return;
    }
    let cell = cell_of(vec3<u32>(texel.xy, texel.z * GRID_SLICES));
    let height_m = cloud_layers[cell.layer].base_m + 0.5 * cloud_layers[cell.layer].thickness_m;
    var left = vec3<f32>(0.0);
    for (var i = 0u; i < SAMPLES; i++) {
        let within = WIDEST * (f32(i) + 0.5) / f32(SAMPLES);
        let distance_m = height_m * sqrt(within / (1.0 - within));
        let angle_rad = GOLDEN_ANGLE_RAD * f32(i);
        let map = cell.map + distance_m * vec2<f32>(cos(angle_rad), sin(angle_rad));
        let depths = grid_sample(cloud_light_image, table_sampler, Part(0u, LIGHT_COUNT), cell.layer, map, 0.0);
        let mu = max(local_direction(map, observer.lights[0].direction).z, 0.0);
        left += left_by_layer(cell.layer, mu, depths.x, depths.y);
    }
    textureStore(cloud_cover_image, texel, vec4<f32>(left / f32(SAMPLES), 0.0));
}
