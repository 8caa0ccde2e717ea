//! How far the colours of a few wavelengths are from those of forty.
//!
//! `cargo run --release --example spectral_accuracy` renders scenes on the device with 3, 6, 9, 15, 21 and 40 wavelengths and
//! prints the table of docs/spectrum.md. Both sides use the same tables and nodes, so that what differs is the spectrum.

use std::error::Error;
use std::path::Path;

use palette::color_difference::Ciede2000;
use palette::white_point::D65;
use palette::{IntoColor, Lab, Xyz};
use welkin::frame::Frame;
use welkin::gpu::DeviceRequest;
use welkin::plan::{Outputs, Quality, Settings};
use welkin::renderer::Renderer;
use welkin::scene::{Scene, SpectrumRequest};
use welkin_lut::spectrum::{Channels, ColourSpace};

const COUNTS: [usize; 6] = [3, 6, 9, 15, 21, 40];

/// What the others are compared with.
const FINEST: usize = 40;

const SIZE: (u32, u32) = (64, 36);

/// Pixels darker than this share of the picture's mean are left out: space beside a planet.
const DARK: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut renderer = Renderer::new(&DeviceRequest::default())?;
    println!("| scene | wavelengths | median | 99 % | mean ΔE | largest ΔE |\n|---|---|---|---|---|---|");
    for (name, file, change) in CASES {
        let mut render = |wavelengths| frame(&mut renderer, file, change, wavelengths);
        let finest = render(FINEST)?;
        for wavelengths in COUNTS.into_iter().filter(|&wavelengths| wavelengths != FINEST) {
            let (mut relative, mut differences) = errors(&render(wavelengths)?, &finest);
            let mean = differences.iter().sum::<f64>() / differences.len() as f64;
            println!(
                "| {name} | {wavelengths} | {:.3} % | {:.3} % | {mean:.2} | {:.2} |",
                100.0 * quantile(&mut relative, 0.5),
                100.0 * quantile(&mut relative, 0.99),
                quantile(&mut differences, 1.0),
            );
        }
    }
    Ok(())
}

type Change = fn(&mut Scene);

/// A name, a scene file and what is changed of it.
const CASES: [(&str, &str, Change); 7] = [
    ("noon", "noon", |_| {}),
    ("golden hour", "golden-hour", |_| {}),
    ("zenith, sun at 0°", "golden-hour", |scene| {
        scene.camera.direction.elevation_rad = 90_f64.to_radians();
        move_sun(scene, 0.0);
    }),
    ("twilight, -4°", "twilight", |_| {}),
    ("10 km", "airliner", |_| {}),
    ("orbit", "orbit", |_| {}),
    ("Mars", "mars", |_| {}),
];

fn move_sun(scene: &mut Scene, elevation_deg: f64) {
    for light in &mut scene.lights {
        if let welkin::scene::Light::Directional(light) = light {
            light.direction.elevation_rad = elevation_deg.to_radians();
        }
    }
}

fn frame(renderer: &mut Renderer, file: &str, change: Change, wavelengths: usize) -> Result<Frame, Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{file}.toml"));
    let channels = Some(Channels::Colour(ColourSpace::LinearSrgb));
    let mut scene = Scene::read_with(&path, SpectrumRequest { wavelengths: Some(wavelengths), channels })?;
    (scene.camera.width, scene.camera.height) = SIZE;
    change(&mut scene);
    Ok(renderer.render(&scene, Settings::of(Quality::Low), Outputs { capture: true, picture: false })?.frame)
}

/// For each pixel that is not dark: the largest difference of a channel over the strongest channel of the finest; and
/// CIEDE2000, exposed so that the logarithmic mean luminance is middle grey.
fn errors(frame: &Frame, finest: &Frame) -> (Vec<f64>, Vec<f64>) {
    let luminance = |pixel: &[f32; 3]| f64::from(xyz(pixel)[1]);
    let mean = finest.radiance.iter().map(luminance).sum::<f64>() / finest.radiance.len() as f64;
    let lit: Vec<_> =
        frame.radiance.iter().zip(&finest.radiance).filter(|(_, finest)| luminance(finest) > DARK * mean).collect();
    let grey = (lit.iter().map(|(_, finest)| luminance(finest).ln()).sum::<f64>() / lit.len() as f64).exp() / 0.18;
    let relative = |(a, b): &(&[f32; 3], &[f32; 3])| {
        let strongest = b.iter().fold(0.0_f32, |strongest, &value| strongest.max(value));
        let largest = a.iter().zip(*b).map(|(a, b)| (a - b).abs()).fold(0.0_f32, f32::max);
        f64::from(largest / strongest)
    };
    let lab = |pixel: &[f32; 3]| -> Lab<D65, f64> {
        let [x, y, z] = xyz(pixel).map(|value| f64::from(value) / grey);
        Xyz::<D65, f64>::new(x, y, z).into_color()
    };
    let difference = |(a, b): &(&[f32; 3], &[f32; 3])| lab(a).difference(lab(b));
    (lit.iter().map(relative).collect(), lit.iter().map(difference).collect())
}

fn xyz(pixel: &[f32; 3]) -> [f32; 3] {
    let xyz = ColourSpace::LinearSrgb.to_xyz() * glam::DVec3::from_array(pixel.map(f64::from));
    xyz.as_vec3().to_array()
}

fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[((share * values.len() as f64).ceil() as usize).clamp(1, values.len()) - 1]
}
