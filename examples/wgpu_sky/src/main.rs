//! `wgpu_sky PACK PICTURE.png [SUN_ELEVATION_DEG]`: the sky of a pack, seen from the ground towards north, the sun in the
//! south. The pack: `welkin bake scenes/noon.toml --out PACK --format raw`.

use std::path::PathBuf;

use anyhow::{Context as _, bail};
use welkin_wgpu_sky::{Camera, draw};

const SIZE: [u32; 2] = [640, 360];

fn main() -> anyhow::Result<()> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let (pack, picture, elevation_deg) = match arguments.as_slice() {
        [pack, picture] => (pack, picture, 60.0),
        [pack, picture, sun] => (pack, picture, sun.to_str().context("not a number")?.parse::<f32>()?),
        _ => bail!("usage: wgpu_sky PACK PICTURE.png [SUN_ELEVATION_DEG]"),
    };
    let radiance = draw(pack, &Camera::towards_north(20.0, elevation_deg), SIZE)?;
    // A simple exposure: a curve towards white, then sRGB.
    let encoded = |linear: f32| match 1.0 - (-4.0 * linear).exp() {
        dark if dark <= 0.003_130_8 => 12.92 * dark,
        bright => 1.055 * bright.powf(1.0 / 2.4) - 0.055,
    };
    let bytes: Vec<u8> = radiance.iter().flatten().map(|&linear| (255.0 * encoded(linear) + 0.5) as u8).collect();
    image::save_buffer(picture, &bytes, SIZE[0], SIZE[1], image::ColorType::Rgb8)
        .with_context(|| format!("cannot write '{}'", picture.display()))
}
