//! The least that passes of the sky could take on this machine, beside what they take; prints Markdown.
//!
//! `cargo run --release --example pass_floors -- [--quality NAME] [--rounds N]`
//!
//! Three small shaders measure what a filtered read of a texel, an exponential and a write of a pixel (16 bytes) cost. For each
//! pass its reads, transcendental operations and writes are counted by hand from the settings, one leg a ray and nothing
//! else: geometry, mixing and control flow are what is above the floor.

use std::path::Path;

use clap::Parser;
use welkin::bench::{Series, pass_costs};
use welkin::gpu::{
    AddressMode, Clock, DeviceKind, DeviceRequest, Filter, Gpu, GpuError, ImageFormat, ImageShape, Resource, Work,
};
use welkin::passes::ShaderSources;
use welkin::plan::{NamedSettings, Settings};
use welkin::scene::Scene;
use welkin_shaders::{Definition, Definitions, Shader};

#[derive(Parser)]
struct Arguments {
    /// Settings whose passes are measured.
    #[arg(long, default_value = "medium")]
    quality: NamedSettings,
    /// How often each thing is measured.
    #[arg(long, default_value_t = 5)]
    rounds: u32,
}

const SIZE: [u32; 2] = [1280, 720];

const READS: &str = "
@group(0) @binding(0) var table: texture_2d<f32>;
@group(0) @binding(1) var table_sampler: sampler;
@group(0) @binding(2) var picture: texture_storage_2d<rgba32float, write>;
@compute @workgroup_size(32, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    var sum = vec4<f32>(0.0);
    var place = vec2<f32>(id.xy) / 720.0;
    for (var i = 0u; i < #{REPEATS}u; i++) {
        sum += textureSampleLevel(table, table_sampler, place, 0.0);
        place += 0.01;
    }
    textureStore(picture, id.xy, sum);
}
";

const EXPONENTIALS: &str = "
@group(0) @binding(2) var picture: texture_storage_2d<rgba32float, write>;
@compute @workgroup_size(32, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    var power = vec4<f32>(vec2<f32>(id.xy), vec2<f32>(id.yx)) / 1280.0;
    for (var i = 0u; i < #{REPEATS}u; i++) {
        power = exp2(power - 1.0);
    }
    textureStore(picture, id.xy, power);
}
";

/// What single operations cost, ns.
struct Rates {
    read_ns: f64,
    transcendental_ns: f64,
    write_ns: f64,
}

impl Rates {
    fn measure(gpu: &Gpu, rounds: u32) -> Result<Self, GpuError> {
        let table = gpu.image("table", ImageShape::D2(64, 64), ImageFormat::Rgba32Float)?;
        gpu.write_image(&table, &[[0.5_f32; 4]; 64 * 64])?;
        let picture = gpu.image("picture", ImageShape::D2(SIZE[0], SIZE[1]), ImageFormat::Rgba32Float)?;
        let sampler = gpu.sampler(Filter::Linear, [AddressMode::Clamp; 3])?;
        let all = [
            ("table", Resource::Image(&table)),
            ("table_sampler", Resource::Sampler(&sampler)),
            ("picture", Resource::Image(&picture)),
        ];
        let time = |text: &'static str, repeats: u32| -> Result<f64, GpuError> {
            let sources = ShaderSources::default().with("rate.wgsl", text);
            let definitions = Definitions::from([("REPEATS".to_owned(), Definition::U32(repeats))]);
            let shader = Shader::from_sources(&sources, "rate", &definitions).unwrap_or_else(|error| panic!("{error}"));
            let pipeline = gpu.pipeline(&shader)?;
            let asked = |(name, _): &&(&str, Resource)| pipeline.bindings().iter().any(|binding| binding.name == *name);
            let bound: Vec<_> = all.iter().filter(asked).copied().collect();
            let clock = if gpu.info().kind == DeviceKind::Cpu { Clock::Processor } else { Clock::of(gpu.info()) };
            let mut series = Series::default();
            for round in 0..=rounds {
                let mut commands = gpu.record_timed_by("rate", clock)?;
                commands.dispatch(&pipeline, &bound, Work::Invocations([SIZE[0], SIZE[1], 1]))?;
                let times = commands.submit_and_wait()?.times;
                // The first round compiles.
                if round > 0 {
                    series.values.push(times[0].milliseconds);
                }
            }
            Ok(1e6 * series.median() / f64::from(SIZE[0] * SIZE[1]))
        };
        let per =
            |text, of_each: f64| -> Result<f64, GpuError> { Ok((time(text, 40)? - time(text, 8)?) / (32.0 * of_each)) };
        Ok(Self {
            read_ns: per(READS, 1.0)?,
            transcendental_ns: per(EXPONENTIALS, 4.0)?,
            write_ns: time(EXPONENTIALS, 0)?,
        })
    }
}

/// Operations of a pass.
struct Count {
    pass: &'static str,
    /// What they are counted for, and how many of these there are.
    unit: &'static str,
    units: f64,
    reads: f64,
    transcendentals: f64,
    writes: f64,
}

/// Constituents of the scene whose density is an exponential, and those that scatter; coefficients of multiply scattered light.
struct Air {
    exponentials: f64,
    scatterers: f64,
    coefficients: f64,
}

fn counts(settings: &Settings, air: &Air) -> Vec<Count> {
    let area = |size: [u32; 2]| f64::from(size[0]) * f64::from(size[1]);
    let nodes = f64::from(settings.nodes_per_leg);
    let directions = settings.directions;
    let (cosines, azimuths) = (f64::from(directions.cosines()), f64::from(directions.azimuths));
    // At a node: densities there, and extinction there and half way; three bands of transmittance.
    let node = 3.0 * air.exponentials + 3.0;
    // Towards the light: one read, three bands.
    let (light_reads, light) = (1.0, 3.0);
    // Multiply scattered light: each coefficient; the sun's coordinate and three bands of the mean.
    let (source_reads, source) = (air.coefficients, 4.0);
    let cells = (f64::from(SIZE[0] / 8) + 1.0) * (f64::from(SIZE[1].div_ceil(8)) + 1.0);
    let layers = 1.0 + air.scatterers;
    let table = area(settings.multiple_scattering_size);
    vec![
        Count {
            pass: "optical_depth",
            unit: "texel",
            units: area(settings.optical_depth_size),
            reads: 0.0,
            transcendentals: 2.0 * f64::from(settings.optical_depth_panels) * air.exponentials,
            writes: 1.0,
        },
        Count {
            pass: "isotropic_series",
            unit: "ray",
            units: table * cosines,
            reads: nodes * azimuths * light_reads,
            transcendentals: nodes * (node + azimuths * light),
            writes: 2.0 / cosines,
        },
        Count {
            pass: "first_order",
            unit: "ray",
            units: table * cosines * azimuths,
            reads: nodes * light_reads,
            transcendentals: nodes * (node + light),
            writes: (air.coefficients + 1.0) / (cosines * azimuths),
        },
        Count {
            pass: "higher_order",
            unit: "ray",
            units: table * cosines * azimuths * f64::from(settings.orders - 1),
            reads: nodes * source_reads,
            transcendentals: nodes * (node + source),
            writes: (air.coefficients + 1.0) / (cosines * azimuths),
        },
        Count {
            pass: "sky_view",
            unit: "texel",
            units: 2.0 * area(settings.sky_view_size),
            reads: nodes * (light_reads + source_reads),
            // Four columns share a walk.
            transcendentals: nodes * (node / 4.0 + light + source),
            writes: layers,
        },
        Count {
            pass: "sky_lattice",
            unit: "node",
            units: 2.0 * cells,
            reads: 1.0 + layers,
            transcendentals: 3.0 + 3.0 * layers + 3.0,
            writes: layers,
        },
        Count {
            pass: "interpolate",
            unit: "pixel",
            units: area(SIZE),
            reads: 16.0 / 64.0,
            transcendentals: 1.0 + air.scatterers,
            writes: 1.0,
        },
    ]
}

fn main() {
    let arguments = Arguments::parse();
    let gpu = Gpu::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/bevy/sky.toml");
    let mut scene = Scene::read(&path).unwrap_or_else(|error| panic!("{error}"));
    [scene.camera.width, scene.camera.height] = SIZE;
    let settings = arguments.quality.settings();
    let rates = Rates::measure(&gpu, arguments.rounds).unwrap_or_else(|error| panic!("{error}"));
    let costs = pass_costs(&gpu, &ShaderSources::embedded(), &scene, settings, arguments.rounds)
        .unwrap_or_else(|error| panic!("{error}"));
    println!(
        "{}: {:.1} ns a filtered read, {:.2} ns an exponential, {:.1} ns a write of 16 bytes; {}.\n",
        gpu.info().driver_version,
        rates.read_ns,
        rates.transcendental_ns,
        rates.write_ns,
        arguments.quality,
    );
    println!(
        "| pass | per | reads | transcendental | writes | at least, ms | takes, ms | ratio |\n|---|---|---|---|---|---|---|---|"
    );
    let is_series = costs.iter().any(|cost| cost.name == "isotropic_series");
    let air = Air { exponentials: 2.0, scatterers: 2.0, coefficients: if is_series { 1.0 } else { 6.0 } };
    for count in counts(&settings, &air) {
        let Some(cost) = costs.iter().find(|cost| cost.name == count.pass) else { continue };
        let unit_ns = count.reads * rates.read_ns
            + count.transcendentals * rates.transcendental_ns
            + count.writes * rates.write_ns;
        let (least, takes) = (1e-6 * count.units * unit_ns, cost.milliseconds.median());
        println!(
            "| `{}` | {} | {:.1} | {:.0} | {:.2} | {least:.2} | {takes:.2} | {:.1} |",
            count.pass,
            count.unit,
            count.reads,
            count.transcendentals,
            count.writes,
            takes / least,
        );
    }
}
