//! The shaders' functions in f32 against the host's in f64, on dense grids, in units of the last place.
//!
//! A result that is a small difference of large terms cannot be better than the rounding of the largest of them: errors
//! are counted in the last place (2⁻²³ relative) of the result or of that term, whichever is larger, as each case says.

mod common;

use welkin::gpu::{Gpu, Resource, Work};
use welkin_lut::geometry;
use welkin_lut::mapping::OpticalDepthMapping;
use welkin_shaders::{Definition, Definitions, Shader, Sources};

/// Four inputs a row; the functions' values in columns.
const PASS: &str = "
#import welkin::cluster
#import welkin::geometry
#import welkin::mapping

@group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> outputs: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&inputs) {
        return;
    }
    let x = inputs[id.x];
    outputs[id.x] = FUNCTION;
}
";

const EARTH_M: f64 = 6_360_000.0;
const TOP_M: f64 = 100_000.0;

/// A function with its value in f64, the largest term in it, and the last places that it may be off.
struct Function {
    name: &'static str,
    wgsl: &'static str,
    /// Value and largest term from the inputs.
    host: fn([f64; 4]) -> (f64, f64),
    inputs: fn() -> Vec<[f32; 4]>,
    /// Counted from the roundings on the way.
    last_places: f64,
}

fn steps(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| i as f64 / (count - 1) as f64)
}

/// Altitudes from 1 mm to 100 km and at 0.
fn altitudes_m() -> Vec<f64> {
    std::iter::once(0.0).chain(steps(60).map(|x| 10_f64.powf(-3.0 + 8.0 * x))).collect()
}

/// (radius, altitude, cosine, distance): cosines crowd around the horizontal.
fn rays() -> Vec<[f32; 4]> {
    let mut rays = Vec::new();
    for altitude_m in altitudes_m() {
        for x in steps(161) {
            let mu = (2.0 * x - 1.0).powi(3);
            for distance_m in [1.0, 1e3, 5e4] {
                rays.push([EARTH_M, altitude_m, mu, distance_m].map(|value| value as f32));
            }
        }
    }
    rays
}

/// Rays that meet the ground, by 1e-3 rad at least.
fn rays_down() -> Vec<[f32; 4]> {
    let meets = |ray: &[f32; 4]| {
        let [radius_m, altitude_m, mu, _] = ray.map(f64::from);
        altitude_m > 0.0 && mu < geometry::horizon_mu(radius_m, altitude_m) - 1e-3
    };
    rays().into_iter().filter(meets).collect()
}

fn functions() -> Vec<Function> {
    vec![
        Function {
            name: "horizon_mu",
            wgsl: "geometry::horizon_mu(x.x, x.y)",
            host: |[r, h, _, _]| (geometry::horizon_mu(r, h), 0.0),
            inputs: rays,
            // A sum, a product, a root, a sum, a quotient of at most 2.5.
            last_places: 5.0,
        },
        Function {
            name: "altitude_along",
            wgsl: "geometry::altitude_along(x.x, x.y, x.z, x.w)",
            // h + d (d + 2 r μ) / (r' + r): the terms d² / 2r and d μ cancel where the ray passes its lowest point.
            host: |[r, h, mu, d]| {
                (geometry::altitude_along(r, h, mu, d), h + d * (d + 2.0 * (r + h) * mu.abs()) / (2.0 * (r + h)))
            },
            inputs: rays,
            last_places: 6.0,
        },
        Function {
            name: "distance_to_shell_from_below",
            wgsl: "geometry::distance_to_shell_from_below(x.x, x.y, x.z, 100000.0)",
            // √(b² + gap) ∓ b in the form that does not cancel. H - h is exact to the last place of H.
            host: |[r, h, mu, _]| {
                let value = geometry::distance_to_shell_from_below(r, h, mu, TOP_M);
                (value, value * TOP_M / (TOP_M - h).max(1e-3 * TOP_M))
            },
            inputs: rays,
            last_places: 8.0,
        },
        Function {
            name: "distance_to_shell_from_above",
            wgsl: "geometry::distance_to_shell_from_above(x.x, x.y, x.z, 0.0)",
            // gap / (√(b² - gap) - b): roundings of b² = r² μ² under the root grow by b² / (b² - gap).
            host: |[r, h, mu, _]| {
                let value = geometry::distance_to_shell_from_above(r, h, mu, 0.0).unwrap_or(f64::NAN);
                let (b, gap) = ((r + h) * mu, h * (2.0 * r + h));
                let root = (b * b - gap).max(0.0).sqrt();
                (value, value * (1.0 + b * b / (root * (root - b))))
            },
            inputs: rays_down,
            last_places: 8.0,
        },
        Function {
            name: "optical_depth_to_unit().y",
            wgsl: "mapping::optical_depth_to_unit(x.y, x.z, x.x, 100000.0).y",
            host: |[r, h, _, _]| (OpticalDepthMapping { radius_m: r, top_m: TOP_M }.unit(h, 1.0)[1], 0.0),
            inputs: rays,
            last_places: 4.0,
        },
        Function {
            name: "asinh, of the light's place in tables",
            wgsl: "asinh(34.0 * mapping::sun_height(x.z))",
            // Vulkan leaves asinh the error of ln(x + √(x² + 1)), whose sum is a difference where x < 0.
            host: |[_, _, mu, _]| {
                let x = 34.0 * mu / (1.0 + (1.0 - mu).max(0.0).sqrt());
                let value = x.asinh();
                (value, value.abs() + 1.0 + (x.abs() / (x + (x * x + 1.0).sqrt())).min(1e4))
            },
            inputs: rays,
            last_places: 8.0,
        },
        Function {
            name: "exp of minus optical depth",
            wgsl: "exp(-(x.y * 1e-4))",
            // Vulkan: 3 + 2 |x| last places; the argument's own rounding, twice half a place, counts |x| times.
            host: |[_, h, _, _]| {
                let depth = h * f64::from(1e-4_f32);
                ((-depth).exp(), (-depth).exp() * (1.0 + depth))
            },
            inputs: rays,
            last_places: 3.5,
        },
    ]
}

/// The largest error in last places, and the inputs it is found at.
fn worst(function: &Function, inputs: &[[f32; 4]], values: &[f32]) -> (f64, [f32; 4]) {
    let mut worst = (0.0, [0.0; 4]);
    for (input, value) in inputs.iter().zip(values) {
        let (exact, term) = (function.host)(input.map(f64::from));
        let place = exact.abs().max(term).max(f64::from(f32::MIN_POSITIVE)) * f64::from(f32::EPSILON);
        let error = (f64::from(*value) - exact).abs() / place;
        if error.is_nan() || error > worst.0 {
            worst = (error, *input);
        }
    }
    worst
}

fn evaluate(gpu: &Gpu, wgsl: &str, inputs: &[[f32; 4]]) -> Vec<f32> {
    let sources = Sources::embedded().with("evaluate.wgsl", PASS.replace("FUNCTION", wgsl));
    let counts = ["VOLUME_COUNT", "FOG_COUNT", "LOCAL_LIGHT_COUNT", "CLUSTER_COLUMNS"];
    let definitions: Definitions = counts.iter().map(|name| ((*name).to_owned(), Definition::U32(1))).collect();
    let pipeline = gpu.pipeline(&Shader::from_sources(&sources, "evaluate", &definitions).unwrap()).unwrap();
    let given = gpu.storage_buffer_of("inputs", inputs).unwrap();
    let found = gpu.storage_buffer_of("outputs", &vec![0.0_f32; inputs.len()]).unwrap();
    let mut commands = gpu.record("evaluate").unwrap();
    let resources = [("inputs", Resource::Buffer(&given)), ("outputs", Resource::Buffer(&found))];
    commands.dispatch(&pipeline, &resources, Work::Invocations([inputs.len() as u32, 1, 1])).unwrap();
    commands.submit_and_wait().unwrap();
    gpu.read_buffer(&found).unwrap()
}

#[test]
fn functions_in_single_precision_are_off_by_their_roundings_and_no_more() {
    common::with_gpu(|gpu| {
        for function in functions() {
            let inputs = (function.inputs)();
            let (error, at) = worst(&function, &inputs, &evaluate(gpu, function.wgsl, &inputs));
            println!("| {} | {} | {error:.2} | {} | {at:?} |", function.name, inputs.len(), function.last_places);
            assert!(error <= function.last_places, "{}: {error} last places at {at:?}", function.name);
        }
    });
}

#[test]
fn the_horizon_from_squares_of_radii_is_off_by_millions_of_last_places() {
    common::with_gpu(|gpu| {
        let naive = "-sqrt(max((x.x + x.y) * (x.x + x.y) - x.x * x.x, 0.0)) / (x.x + x.y)";
        let function = &functions()[0];
        let inputs = rays();
        let (error, at) = worst(function, &inputs, &evaluate(gpu, naive, &inputs));
        println!("naive: {error:e} at {at:?}");
        assert!(error > 1e6, "{error} at {at:?}");
    });
}

/// How far ahead `wgsl` finds the end of a slice, as a share of the distance, from places at and around all ends.
fn slice_ends_ahead(gpu: &Gpu, wgsl: &str) -> Vec<f32> {
    let places = (0..22).flat_map(|slice| {
        let end_m = (4.0 * (f64::from(slice) * 0.584_962_5).exp2()) as f32;
        (-64_i32..=64).map(move |places| [f32::from_bits((end_m.to_bits() as i32 + places) as u32), 0.0, 0.0, 0.0])
    });
    evaluate(gpu, wgsl, &places.collect::<Vec<_>>())
}

#[test]
fn a_ray_that_has_come_to_the_end_of_a_slice_has_the_next_before_it() {
    common::with_gpu(|gpu| {
        let ahead = slice_ends_ahead(gpu, "(cluster::slice_end_m(cluster::slice_beyond(x.x)) - x.x) / x.x");
        assert!(ahead.iter().all(|share| *share > 0.0 && *share < 0.51), "{ahead:?}");
        // Light and matter behind such places were missing from single pixels.
        let rounded = slice_ends_ahead(gpu, "(cluster::slice_end_m(cluster::slice_of(x.x)) - x.x) / x.x");
        assert!(rounded.iter().any(|share| *share <= 0.0), "the control finds no place");
    });
}
