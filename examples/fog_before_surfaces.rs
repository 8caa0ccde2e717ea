//! What froxels of fog gain and cost before a host's surfaces: a wood in fog, of which every pixel is marched and of which those are that
//! nothing tells.
//!
//!     cargo run --release --example fog_before_surfaces [-- PICTURE.png]

use std::error::Error;
use std::path::Path;

use welkin::foreground::{Depth, Foreground};
use welkin::gpu::DeviceRequest;
use welkin::output::{AtomicFile, write_png};
use welkin::plan::{Outputs, Quality, Settings, VolumeSettings};
use welkin::renderer::{Rendered, Renderer};
use welkin::scene::Scene;

const WOOD: &str = "
preset = \"earth\"
[[fog]]
extinction_per_m = 0.008
profile.exponential.scale_height_m = 60
[sun]
elevation_deg = 20
azimuth_deg = 35
[camera]
altitude_m = 2
elevation_deg = 3
azimuth_deg = 0
vertical_field_of_view_deg = 50
width = 640
height = 360
";
const TREES: usize = 120;
const LEAVES: usize = 150;
/// Of the nearest and the farthest tree, m.
const NEAREST_M: f64 = 15.0;
const FARTHEST_M: f64 = 600.0;

/// Numbers from 0 to 1 that are the same every time (Marsaglia 2003, xorshift).
struct Random(u32);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        f64::from(self.0) / f64::from(u32::MAX)
    }

    fn between(&mut self, first: f64, last: f64) -> f64 {
        first + (last - first) * self.next()
    }
}

/// Distances that a camera sees, m.
struct View {
    width: usize,
    height: usize,
    distance_m: Vec<f32>,
}

impl View {
    fn fill(
        &mut self,
        [left, right]: [f64; 2],
        [top, bottom]: [f64; 2],
        distance_m: f64,
        is_in: impl Fn(f64, f64) -> bool,
    ) {
        let clamp = |at: f64, size: usize| at.clamp(0.0, size as f64) as usize;
        for row in clamp(top, self.height)..clamp(bottom, self.height) {
            for column in clamp(left, self.width)..clamp(right, self.width) {
                let nearest_m = &mut self.distance_m[row * self.width + column];
                if is_in(column as f64, row as f64) {
                    *nearest_m = nearest_m.min(distance_m as f32);
                }
            }
        }
    }

    /// A trunk with balls of leaves, `pixels_per_m` in size.
    fn plant(&mut self, random: &mut Random, middle: f64, distance_m: f64) {
        let pixels_per_m = self.height as f64 / (0.9 * distance_m);
        let foot = 0.55 * self.height as f64 + 1.7 * pixels_per_m;
        let half = 0.25 * pixels_per_m;
        self.fill([middle - half, middle + half], [foot - 4.0 * pixels_per_m, foot], distance_m, |_, _| true);
        for _ in 0..LEAVES {
            let x = middle + pixels_per_m * random.between(-2.0, 2.0);
            let y = foot - pixels_per_m * random.between(3.0, 8.0);
            let radius = pixels_per_m * random.between(0.1, 0.35);
            let at_m = distance_m + random.between(-1.5, 1.5);
            let is_in = |column: f64, row: f64| (column - x).hypot(row - y) < radius;
            self.fill([x - radius, x + radius], [y - radius, y + radius], at_m, is_in);
        }
    }
}

fn wood(scene: &Scene) -> Result<Foreground, Box<dyn Error>> {
    let [width, height] = [scene.camera.width, scene.camera.height].map(|pixels| pixels as usize);
    let mut view = View { width, height, distance_m: vec![f32::INFINITY; width * height] };
    let mut random = Random(7);
    for _ in 0..TREES {
        let middle = random.between(0.0, width as f64);
        let distance_m = NEAREST_M * (FARTHEST_M / NEAREST_M).powf(random.next());
        view.plant(&mut random, middle, distance_m);
    }
    let bark = vec![[1e-4; 3]; width * height];
    Ok(Foreground::new(&scene.camera, Depth::Distance, &view.distance_m, Some(&bark))?)
}

fn milliseconds(rendered: &Rendered) -> f64 {
    ["surface_cells", "local_media", "media_interpolation"]
        .iter()
        .filter_map(|name| rendered.timings.milliseconds.get(*name))
        .sum()
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::parse(WOOD, Path::new("wood.toml"))?;
    let foreground = wood(&scene)?;
    let mut renderer = Renderer::new(&DeviceRequest::default())?;
    let medium = Settings::of(Quality::Medium);
    let marched = Settings { volumes: VolumeSettings { lattice_permille: 0, ..medium.volumes }, ..medium };
    let capture = Outputs { capture: true, picture: true };
    // The first of each pays for what the others find done.
    let mut of = |settings: Settings| renderer.render_over(&scene, settings, capture, &foreground);
    let [first, second] = [of(marched)?, of(medium)?];
    for turn in 0..3 {
        let [all, some] = [marched, medium].map(|settings| of(settings).map(|rendered| milliseconds(&rendered)));
        println!("turn {turn}: all pixels marched {:.0} ms, with froxels {:.0} ms", all?, some?);
    }
    let pairs = second.frame.radiance.iter().zip(&first.frame.radiance);
    let off = |(found, exact): (&[f32; 3], &[f32; 3])| {
        (0..3).map(|c| f64::from((found[c] / exact[c] - 1.0).abs())).fold(0.0, f64::max)
    };
    let mut errors: Vec<f64> = pairs.map(off).collect();
    errors.sort_by(f64::total_cmp);
    let count = errors.len() as f64;
    let rms = (errors.iter().map(|error| error * error).sum::<f64>() / count).sqrt();
    let same = errors.iter().filter(|&&error| error == 0.0).count() as f64 / count;
    let at = |share: f64| errors[((share * count) as usize).min(errors.len() - 1)];
    let [same, rms, most, largest] = [same, rms, at(0.99), at(1.0)].map(|share| 100.0 * share);
    println!("{same:.1} % of the pixels are the same; RMS {rms:.3} %, 99 % within {most:.2} %, largest {largest:.1} %");
    if let (Some(path), Some(picture)) = (std::env::args_os().nth(1), &second.picture) {
        write_png(AtomicFile::create(path.as_ref())?, scene.camera.width, scene.camera.height, picture)?;
    }
    Ok(())
}
