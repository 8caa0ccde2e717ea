//! The density of clouds, fog and volumes is one field: made on the device it is the field that the reference sees.

mod common;

use std::sync::OnceLock;

use welkin::gpu::{Gpu, GpuImage, ImageFormat, ImageShape, Resource, Work};
use welkin::passes::blocks::{AngularFields, LocalLists, lamps, volume_blocks};
use welkin::plan::{Facts, Outputs, Quality, Settings};
use welkin::probe::Orders;
use welkin::scene::Scene;
use welkin_lut::cloud::{
    CURL_SIZE, CloudField, CloudKind, CloudLayer, CloudNoise, CloudParameters, EROSION_SIZE, SHAPE_SIZE, WEATHER_SIZE,
    to_map,
};
use welkin_lut::volume::{VolumeField, VolumeParameters};
use welkin_shaders::{Definition, Definitions, Shader, Sources};

const RADIUS_M: f64 = 6_371_000.0;

/// The density of one layer at points given by their place in the local frame and their altitude.
const PASS: &str = "
#import welkin::cloud_field::{layer_density, to_map}

@group(0) @binding(0) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> found: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&points) {
        found[id.x] = layer_density(0u, to_map(6371000.0, points[id.x].xyz), points[id.x].w);
    }
}
";

/// The tiles as passes make them.
struct Tiles {
    shape: GpuImage,
    erosion: GpuImage,
    weather: GpuImage,
    curl: GpuImage,
}

impl Tiles {
    fn new(gpu: &Gpu) -> Self {
        let cube = |size: usize| ImageShape::D3(size as u32, size as u32, size as u32);
        let square = |size: usize| ImageShape::D2(size as u32, size as u32);
        let image = |name, shape| gpu.image(name, shape, ImageFormat::Rgba8Unorm).unwrap();
        let tiles = Self {
            shape: image("shape", cube(SHAPE_SIZE)),
            erosion: image("erosion", cube(EROSION_SIZE)),
            weather: image("weather", square(WEATHER_SIZE)),
            curl: image("curl", square(CURL_SIZE)),
        };
        let (shape, erosion) = (("cloud_shape_volume", &tiles.shape), ("cloud_erosion_volume", &tiles.erosion));
        let (weather, curl) = (("cloud_weather_map", &tiles.weather), ("cloud_curl_map", &tiles.curl));
        let mut commands = gpu.record("cloud noise").unwrap();
        for (pass, written) in
            [("cloud_shape", vec![shape]), ("cloud_erosion", vec![erosion]), ("cloud_weather", vec![weather, curl])]
        {
            let pipeline = gpu.pipeline(&welkin_shaders::compile(pass, &Definitions::new()).unwrap()).unwrap();
            let extent = written[0].1.shape().extent();
            let bound: Vec<_> = written.into_iter().map(|(name, image)| (name, Resource::Image(image))).collect();
            commands.dispatch(&pipeline, &bound, Work::Invocations(extent)).unwrap();
        }
        commands.submit_and_wait().unwrap();
        tiles
    }
}

/// A texel of a volume with the four neighbours that its texels hold.
fn quads(bytes: &[u8], size: usize) -> impl Iterator<Item = [u8; 4]> + '_ {
    (0..bytes.len()).map(move |i| {
        let (x, y, slice) = (i % size, i / size % size, i / (size * size) * size * size);
        let at = |dx: usize, dy: usize| bytes[slice + (y + dy) % size * size + (x + dx) % size];
        [at(0, 0), at(1, 0), at(0, 1), at(1, 1)]
    })
}

/// How many texels differ from the host's.
fn differing(found: &[[u8; 4]], expected: impl Iterator<Item = [u8; 4]>) -> usize {
    let pairs: Vec<_> = found.iter().zip(expected).collect();
    assert_eq!(pairs.len(), found.len());
    pairs.into_iter().filter(|(a, b)| **a != *b).count()
}

/// Every texel, to the last bit.
fn assert_same_noise(gpu: &Gpu, tiles: &Tiles) {
    let noise = CloudNoise::shared();
    let read = |image: &GpuImage| gpu.read_image::<[u8; 4]>(image).unwrap();
    assert_eq!(differing(&read(&tiles.shape), quads(&noise.shape, SHAPE_SIZE)), 0);
    assert_eq!(differing(&read(&tiles.erosion), quads(&noise.erosion, EROSION_SIZE)), 0);
    assert_eq!(differing(&read(&tiles.weather), noise.weather.iter().copied()), 0);
    let curl = (0..CURL_SIZE * CURL_SIZE).map(|i| {
        let next = i / CURL_SIZE * CURL_SIZE + (i + 1) % CURL_SIZE;
        let ([a, b], [c, d]) = (noise.curl[i], noise.curl[next]);
        [a, b, c, d]
    });
    assert_eq!(differing(&read(&tiles.curl), curl), 0);
    // Negative control: one bit of one byte.
    let mut perturbed = noise.shape.clone();
    perturbed[123_456] ^= 1;
    assert_eq!(differing(&read(&tiles.shape), quads(&perturbed, SHAPE_SIZE)), 4);
}

/// Points in the layer up to 60 km from the origin: (east, north, up, altitude) in the local frame.
fn points(layer: &CloudLayer) -> Vec<[f64; 4]> {
    let part = |i: usize, factor: f64| (i as f64 * factor).fract();
    (0..80_000)
        .map(|i| {
            let [x, y] = [0.754_877_666, 0.569_840_291].map(|factor| 1.2e5 * (part(i, factor) - 0.5));
            // Beyond both boundaries too.
            let share = 1.1 * part(i, 0.438_579_021) - 0.05;
            let altitude_m = layer.base_m + share * (layer.top_m - layer.base_m);
            let r = RADIUS_M + altitude_m;
            [x, y, (r * r - x * x - y * y).sqrt() - RADIUS_M, altitude_m]
        })
        .collect()
}

fn on_device(gpu: &Gpu, tiles: &Tiles, layer: &CloudParameters, points: &[[f64; 4]]) -> Vec<f32> {
    static SHADER: OnceLock<Shader> = OnceLock::new();
    let shader = SHADER.get_or_init(|| {
        let sources = Sources::embedded().with("density.wgsl", PASS);
        let definitions = Definitions::from([
            ("CLOUD_LAYER_COUNT".to_owned(), Definition::U32(1)),
            ("CLOUD_ANVIL".to_owned(), Definition::Bool(true)),
        ]);
        Shader::from_sources(&sources, "density", &definitions).unwrap()
    });
    let pipeline = gpu.pipeline(shader).unwrap();
    let narrow: Vec<[f32; 4]> = points.iter().map(|p| p.map(|x| x as f32)).collect();
    let points = gpu.storage_buffer_of("points", &narrow).unwrap();
    let found = gpu.storage_buffer_of("found", &vec![0.0_f32; narrow.len()]).unwrap();
    let layers = gpu.storage_buffer_of("layers", &layer.to_array()).unwrap();
    let mut commands = gpu.record("density").unwrap();
    let bound = [
        ("points", Resource::Buffer(&points)),
        ("found", Resource::Buffer(&found)),
        ("cloud_layers", Resource::Buffer(&layers)),
        ("cloud_shape_volume", Resource::Image(&tiles.shape)),
        ("cloud_erosion_volume", Resource::Image(&tiles.erosion)),
        ("cloud_weather_map", Resource::Image(&tiles.weather)),
        ("cloud_curl_map", Resource::Image(&tiles.curl)),
    ];
    commands.dispatch(&pipeline, &bound, Work::Invocations([narrow.len() as u32, 1, 1])).unwrap();
    commands.submit_and_wait().unwrap();
    gpu.read_buffer(&found).unwrap()
}

/// The largest difference from the host's field, and the share of points inside clouds.
fn compare(found: &[f32], parameters: CloudParameters, points: &[[f64; 4]]) -> (f64, f64) {
    let field = CloudField { noise: CloudNoise::shared(), parameters };
    let (mut worst, mut inside) = (0.0_f64, 0);
    for (&found, &[x, y, z, altitude_m]) in found.iter().zip(points) {
        let expected = field.density(to_map(RADIUS_M, [x, y, z]), altitude_m);
        worst = worst.max((f64::from(found) - expected).abs());
        inside += usize::from(expected > 0.0);
    }
    (worst, inside as f64 / points.len() as f64)
}

/// The whole chain, of every kind.
fn assert_same_density(gpu: &Gpu, tiles: &Tiles) {
    const BOUND: f64 = 1.0 / 255.0;
    for kind in CloudKind::ALL {
        let layer = CloudLayer { wind_m_per_s: [8.0, 3.0], seed: 3, ..CloudLayer::of_kind(kind) };
        let parameters = CloudParameters::new(&layer, 500.0);
        let points = points(&layer);
        let found = on_device(gpu, tiles, &parameters, &points);
        let (worst, inside) = compare(&found, parameters, &points);
        println!("{kind:?}: worst difference {worst:.2e}, {inside:.3} of the points in cloud");
        assert!(inside > 0.002, "{kind:?}: hardly a point is in a cloud");
        assert!(worst <= BOUND, "{kind:?}: {worst}");
        // Negative control: a hundredth of a tile is noticed.
        let mut moved = parameters;
        moved.shape_offset[0] += 0.01;
        assert!(compare(&found, moved, &points).0 > BOUND, "{kind:?}: the comparison sees nothing");
    }
}

/// The density of the first volume at the same points.
const VOLUME_PASS: &str = "
#import welkin::cloud_field::to_map
#import welkin::volume_field::{volume_density, Place}

@group(0) @binding(0) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> found: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&points) {
        let p = points[id.x];
        found[id.x] = volume_density(0u, Place(p.xyz, p.w, to_map(6371000.0, p.xyz)));
    }
}
";

/// Two kinds of fog and two local volumes, each alone, with billows.
const VOLUMES: [&str; 4] = [
    "fog = [{ extinction_per_m = 1, profile.exponential.scale_height_m = 60, NOISE }]",
    "fog = [{ extinction_per_m = 1, profile.layer = { top_m = 90, edge = 0.4 }, NOISE }]",
    "volumes = [{ name = \"a\", shape = \"box\", centre_m = [9, 5, 30], size_m = [90, 70, 60], turn_deg = 33, edge = 0.3, absorption_per_m = 1, NOISE }]",
    "volumes = [{ name = \"a\", shape = \"ellipsoid\", centre_m = [9, 5, 30], size_m = [90, 70, 60], absorption_per_m = 1, NOISE }]",
];

fn volumes_on_device(gpu: &Gpu, tiles: &Tiles, scene: &Scene, points: &[[f32; 4]]) -> Vec<f32> {
    let facts = Facts::new(scene, Settings::of(Quality::Low), Orders::All, Outputs::default()).unwrap();
    let sources = Sources::embedded().with("volume_density.wgsl", VOLUME_PASS);
    let definitions = Definitions::from([
        ("CLOUD_LAYER_COUNT".to_owned(), Definition::U32(0)),
        ("CONSTITUENT_COUNT".to_owned(), Definition::U32(0)),
        ("VOLUME_COUNT".to_owned(), Definition::U32(1)),
        ("FOG_COUNT".to_owned(), Definition::U32(facts.fog_count())),
        ("VOLUME_NOISE".to_owned(), Definition::Bool(true)),
    ]);
    let mut all = welkin::passes::definitions(&facts);
    all.extend(definitions);
    let pipeline = gpu.pipeline(&Shader::from_sources(&sources, "volume_density", &all).unwrap()).unwrap();
    let blocks = volume_blocks(&facts, &LocalLists::new(&facts, &lamps(&facts)), &AngularFields::default());
    let volumes = gpu.storage_buffer_of("volumes", &blocks).unwrap();
    let points = gpu.storage_buffer_of("points", points).unwrap();
    let found = gpu.storage_buffer("found", points.bytes() / 4).unwrap();
    let mut commands = gpu.record("volume density").unwrap();
    let bound = [
        ("points", Resource::Buffer(&points)),
        ("found", Resource::Buffer(&found)),
        ("volumes", Resource::Buffer(&volumes)),
        ("cloud_shape_volume", Resource::Image(&tiles.shape)),
        ("cloud_erosion_volume", Resource::Image(&tiles.erosion)),
    ];
    commands.dispatch(&pipeline, &bound, Work::Invocations([(points.bytes() / 16) as u32, 1, 1])).unwrap();
    commands.submit_and_wait().unwrap();
    gpu.read_buffer(&found).unwrap()
}

fn assert_same_volumes(gpu: &Gpu, tiles: &Tiles) {
    const BOUND: f64 = 1.0 / 255.0;
    let part = |i: usize, factor: f64| (i as f64 * factor).fract() as f32;
    let points: Vec<[f32; 4]> = (0..20_000)
        .map(|i| {
            let up_m = 110.0 * part(i, 0.438_579_021) - 5.0;
            [120.0 * part(i, 0.754_877_666) - 60.0, 120.0 * part(i, 0.569_840_291) - 60.0, up_m, up_m]
        })
        .collect();
    for text in VOLUMES {
        let noise = "noise = { size_m = 20, strength = 0.8, seed = 2, wind_m_per_s = [3, -1] }";
        let rest = "preset = \"earth\"\ntime_s = 40\nsun = { elevation_deg = 9, azimuth_deg = 0 }\n\
            camera = { altitude_m = 2, elevation_deg = 0, azimuth_deg = 0 }\n";
        let scene = format!("{rest}{}", text.replace("NOISE", noise));
        let scene = Scene::parse(&scene, "volumes.toml".as_ref()).unwrap();
        let found = volumes_on_device(gpu, tiles, &scene, &points);
        let differs = |parameters: VolumeParameters| {
            let field = VolumeField::new(&scene.volumes[0], parameters);
            let pairs = found.iter().zip(&points);
            pairs.fold((0.0_f64, 0), |(worst, inside), (&found, p)| {
                let [x, y, z, altitude_m] = p.map(f64::from);
                let expected = field.density([x, y, z], to_map(RADIUS_M, [x, y, z]), altitude_m);
                (worst.max((f64::from(found) - expected).abs()), inside + usize::from(expected > 0.0))
            })
        };
        let parameters = VolumeParameters::new(&scene.volumes[0], scene.time_s);
        let (worst, inside) = differs(parameters);
        println!("{text}: worst difference {worst:.2e}, {inside} points inside");
        assert!(inside > 2000, "{text}: hardly a point is inside");
        assert!(worst <= BOUND, "{text}: {worst}");
        // Negative control: a hundredth of a tile is noticed.
        let mut moved = parameters;
        moved.noise_offset[0] += 0.01;
        assert!(differs(moved).0 > BOUND, "{text}: the comparison sees nothing");
    }
}

#[test]
fn densities_on_the_device_are_the_hosts_in_every_texel_and_at_any_point() {
    common::with_gpu(|gpu| {
        let tiles = Tiles::new(gpu);
        assert_same_noise(gpu, &tiles);
        assert_same_density(gpu, &tiles);
        assert_same_volumes(gpu, &tiles);
    });
}
