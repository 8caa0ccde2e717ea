//! The shaders' table mappings, run on the device, against the host's in f64.

mod common;

use welkin::gpu::{ImageFormat, ImageShape, Resource, Work};
use welkin_lut::Planet;
use welkin_lut::mapping::{
    MultipleScatteringMapping, OpticalDepthMapping, SkyHalf, SkyViewMapping, SliceMapping, unit_from_texel,
};
use welkin_shaders::{Definitions, Shader, Sources};

/// Each texel holds the parameters it stands for, and the unit coordinates that these lead back to.
const PASS: &str = "
#import welkin::mapping

struct Geometry {
    radius_m: f32,
    top_m: f32,
    padding_a: f32,
    padding_b: f32,
    sun_warp: vec3<f32>,
    padding_c: f32,
    range: mapping::SkyViewRange,
}

@group(0) @binding(0) var<uniform> geometry: Geometry;
@group(0) @binding(1) var mapped: texture_storage_2d_array<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(mapped);
    if any(id.xy >= size) {
        return;
    }
    let unit = mapping::unit_from_texel(id.xy, vec2<f32>(size));
    let depth = mapping::optical_depth_from_unit(unit, geometry.radius_m, geometry.top_m);
    let depth_back = mapping::optical_depth_to_unit(depth.altitude_m, depth.mu, geometry.radius_m, geometry.top_m);
    textureStore(mapped, id.xy, 0, vec4<f32>(depth.altitude_m, depth.mu, depth_back));
    let light = mapping::multiple_scattering_from_unit(unit, geometry.top_m, geometry.sun_warp);
    let light_back = mapping::multiple_scattering_to_unit(light.altitude_m, light.mu, geometry.top_m, geometry.sun_warp);
    textureStore(mapped, id.xy, 1, vec4<f32>(light.altitude_m, light.mu, light_back));
    for (var half = 0u; half < 2u; half++) {
        let view = mapping::sky_view_from_unit(unit, half == 1u, geometry.range);
        let back = mapping::sky_view_to_unit(view.zenith_rad, view.azimuth_rad, half == 1u, geometry.range);
        textureStore(mapped, id.xy, 2 + half, vec4<f32>(view.zenith_rad, view.azimuth_rad, back));
    }
    // A ray of 100 km whose lowest point lies the farther away, the lower the row.
    let slices = mapping::slices_of(1e5, 1e5 * unit.y);
    let distance_m = mapping::slice_distance_m(unit.x, slices);
    textureStore(mapped, id.xy, 4, vec4<f32>(distance_m, unit.y, mapping::slice_unit(distance_m, slices), unit.y));
}
";

const SIZE: [u32; 2] = [61, 37];

struct Case {
    optical_depth: OpticalDepthMapping,
    multiple_scattering: MultipleScatteringMapping,
    sky_view: SkyViewMapping,
}

impl Case {
    fn parameters(&self, layer: usize, unit: [f64; 2]) -> [f64; 2] {
        match layer {
            0 => self.optical_depth.parameters(unit),
            1 => self.multiple_scattering.parameters(unit),
            2 => self.sky_view.parameters(unit, SkyHalf::Sky),
            3 => self.sky_view.parameters(unit, SkyHalf::Ground),
            _ => [SliceMapping { length_m: 1e5, lowest_m: 1e5 * unit[1] }.distance_m(unit[0]), unit[1]],
        }
    }
}

/// The largest difference from the host, over the size of each parameter, and the largest error of a round trip.
fn worst(case: &Case, texels: &[[f32; 4]]) -> (f64, f64) {
    let (mut against_host, mut round_trip): (f64, f64) = (0.0, 0.0);
    let layer_texels = (SIZE[0] * SIZE[1]) as usize;
    for (i, texel) in texels.iter().enumerate() {
        let (layer, i) = (i / layer_texels, (i % layer_texels) as u32);
        let unit = unit_from_texel([i % SIZE[0], i / SIZE[0]], SIZE);
        let host = case.parameters(layer, unit);
        for axis in 0..2 {
            let scale = if host[axis].abs() > 10.0 { 1e5 } else { 1.0 };
            against_host = against_host.max((f64::from(texel[axis]) - host[axis]).abs() / scale);
            // Rows beyond the limb of the air stand for the last view inside it.
            let stands_for = if layer == 2 && axis == 1 { unit[1].min(case.sky_view.last_y) } else { unit[axis] };
            round_trip = round_trip.max((f64::from(texel[2 + axis]) - stands_for).abs());
        }
    }
    (against_host, round_trip)
}

#[test]
fn texels_come_back_to_themselves_on_the_device_as_on_the_host() {
    common::with_gpu(|gpu| {
        let sources = Sources::embedded().with("round_trip.wgsl", PASS);
        let pipeline =
            gpu.pipeline(&Shader::from_sources(&sources, "round_trip", &Definitions::new()).unwrap()).unwrap();
        let planet = Planet { radius_m: 6_360_000.0, atmosphere_height_m: 100_000.0, ground_albedo: [0.0; 3] };
        for altitude_m in [0.0, 2.0, 10_000.0, 99_999.0, 400_000.0] {
            let case = Case {
                optical_depth: OpticalDepthMapping { radius_m: planet.radius_m, top_m: planet.atmosphere_height_m },
                multiple_scattering: MultipleScatteringMapping::new(&planet),
                sky_view: SkyViewMapping::new(&planet, altitude_m, SIZE[1]),
            };
            let range = case.sky_view;
            let numbers = [planet.radius_m, planet.atmosphere_height_m, 0.0, 0.0];
            let view = [range.horizon_rad, range.sky_end_rad, range.sky_end_y, range.last_y];
            let [k, low, span] = case.multiple_scattering.sun_warp();
            let block: Vec<f32> =
                numbers.into_iter().chain([k, low, span, 0.0]).chain(view).map(|value| value as f32).collect();
            let shape = ImageShape::D2Array(SIZE[0], SIZE[1], 5);
            let image = gpu.image("mapped", shape, ImageFormat::Rgba32Float).unwrap();
            let mut commands = gpu.record("round trip").unwrap();
            let resources =
                [("geometry", Resource::Data(bytemuck::cast_slice(&block))), ("mapped", Resource::Image(&image))];
            commands.dispatch(&pipeline, &resources, Work::Invocations(shape.extent())).unwrap();
            commands.submit_and_wait().unwrap();
            let texels: Vec<[f32; 4]> = gpu.read_image(&image).unwrap();
            let (against_host, round_trip) = worst(&case, &texels);
            // A few roundings of f32 at 1, or of an angle of pi.
            assert!(against_host < 1e-6, "{altitude_m} m: {against_host:e} from the host");
            // The square root in the warps turns a rounding δ next to the horizon into √δ: of 6e-8 into 2.5e-4, a
            // thirtieth of a texel in a table of 128.
            assert!(round_trip < 5e-4, "{altitude_m} m: a round trip is off by {round_trip:e}");
            // Negative control: half a texel is noticed.
            let shifted: Vec<[f32; 4]> =
                texels.iter().map(|[a, b, x, y]| [*a, *b, x + 0.5 / SIZE[0] as f32, *y]).collect();
            assert!(worst(&case, &shifted).1 > 5e-4);
        }
    });
}
