//! The directions of the tabulated source function, on the device: they fill the sphere, and each lies where it is read.

mod common;

use std::f64::consts::PI;

use welkin::gpu::{ImageFormat, ImageShape, Resource, Work};
use welkin::passes::blocks::grid_nodes;
use welkin::plan::{Quality, Settings, SourceGrid};
use welkin_shaders::{Definition, Definitions, Shader, Sources};

/// For each direction: its row and column of tiles, its cosine, and its solid angle.
const PASS: &str = "
#import welkin::source_grid::{column_coordinate, direction_of, row_coordinate, DIRECTION_COUNT}

@group(0) @binding(0) var<uniform> place: vec4<f32>;
@group(0) @binding(1) var found: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= DIRECTION_COUNT {
        return;
    }
    let direction = direction_of(id.x, place.x, place.y);
    let row = row_coordinate(direction.mu, place.x, place.y);
    let column = column_coordinate(cos(direction.phi_rad));
    textureStore(found, id.xy, vec4<f32>(row, column, direction.mu, direction.solid_angle_sr));
}
";

fn definitions(grid: SourceGrid) -> Definitions {
    let numbers = [
        ("GRID_GROUND_COUNT", grid.ground),
        ("GRID_LOW_COUNT", grid.low),
        ("GRID_HIGH_COUNT", grid.high),
        ("GRID_AZIMUTH_COUNT", grid.azimuths),
        ("GRID_MU_S_COUNT", 1),
        ("GRID_ALTITUDE_COUNT", 1),
    ];
    // What the modules that it imports ask for, with numbers of no meaning here.
    let unused = ["CONSTITUENT_COUNT", "SCATTERING_EXPONENTIAL_END", "SCATTERING_TENT_END", "SCATTERER_COUNT"];
    let more = ["ABSORBING_EXPONENTIAL_END", "ABSORBING_TENT_END", "LOBE_COUNT", "PROFILE_GROUP_COUNT"];
    let march = ["NODE_COUNT", "FINE_PANELS"];
    let ones = unused.into_iter().chain(more).chain(march).map(|name| (name, 1));
    numbers.into_iter().chain(ones).map(|(name, value)| (name.to_owned(), Definition::U32(value))).collect()
}

/// How far a coordinate may be off, in tiles: Vulkan lets inverse trigonometric functions err by 4096 units in the last
/// place, and two of them in a row make 3e-3 of eight tiles.
const TOLERANCE: f32 = 4e-3;

/// Checks the directions at a place: (row, column, cosine, solid angle) of each.
fn check(texels: &[[f32; 4]], grid: SourceGrid, [mu_h, mu_s]: [f32; 2]) {
    let mut sphere_sr = 0.0;
    for (index, [row, column, mu, solid_angle_sr]) in (0_u32..).zip(texels) {
        sphere_sr += f64::from(*solid_angle_sr);
        let (tile_row, tile_column) = (index / grid.azimuths, index % grid.azimuths);
        assert_eq!(*mu < mu_h, tile_row < grid.ground, "direction {index}");
        assert!((column - tile_column as f32 - 0.5).abs() < TOLERANCE, "column {column} of direction {index}");
        // With the light at the zenith, the high sky is one point.
        if mu_s < 1.0 || tile_row < grid.ground + grid.low {
            assert!((row - tile_row as f32 - 0.5).abs() < TOLERANCE, "row {row} of direction {index}");
        }
    }
    assert!((sphere_sr / (4.0 * PI) - 1.0).abs() < 1e-5, "{sphere_sr} sr");
}

#[test]
fn every_direction_lies_where_it_is_read_and_all_of_them_fill_the_sphere() {
    common::with_gpu(|gpu| {
        let settings = Settings::of(Quality::Medium);
        let grid = settings.source_grid;
        let sources = Sources::embedded().with("directions_found.wgsl", PASS);
        let shader = Shader::from_sources(&sources, "directions_found", &definitions(grid)).unwrap();
        let pipeline = gpu.pipeline(&shader).unwrap();
        let nodes = grid_nodes(grid);
        // Horizons from the ground and from 100 km; light at the zenith, at half height, at the horizon and below it.
        for place in [[0.0, 1.0], [0.0, 0.5], [0.0, 0.0], [-0.174, 0.02], [-0.174, -0.3]] {
            let found = gpu.image("found", ImageShape::D2(grid.count(), 1), ImageFormat::Rgba32Float).unwrap();
            let padded = [place[0], place[1], 0.0, 0.0];
            let resources = [
                ("place", Resource::Data(bytemuck::cast_slice(&padded))),
                ("grid_nodes", Resource::Data(bytemuck::cast_slice(&nodes))),
                ("found", Resource::Image(&found)),
            ];
            let mut commands = gpu.record("directions").unwrap();
            commands.dispatch(&pipeline, &resources, Work::Invocations([grid.count(), 1, 1])).unwrap();
            commands.submit_and_wait().unwrap();
            check(&gpu.read_image(&found).unwrap(), grid, place);
        }
    });
}
