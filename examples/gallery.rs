//! The picture of the README: scenes of `scenes/`, small, at high quality, side by side; and the horizon at twice its size.
//!
//! `cargo run --release --example gallery` writes docs/images/gallery.png and docs/images/horizon.png.

use std::error::Error;
use std::path::Path;

use image::RgbImage;
use image::imageops::{FilterType, crop_imm, replace, resize};
use welkin::gpu::DeviceRequest;
use welkin::output::{AtomicFile, write_png};
use welkin::plan::{Outputs, Quality, Settings};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

/// Pixels of each picture, 16:9 as the scenes' own, and of the gaps between them.
const WIDTH: u32 = 416;
const HEIGHT: u32 = 234;
const GAP: u32 = 8;

const COLUMNS: u32 = 3;

/// Each picture is rendered so many times larger and made smaller, so that edges are smooth.
const OVERSAMPLING: u32 = 2;

/// From the brightest to the darkest sky, then from higher up and further away.
const SCENES: [&str; 6] = ["noon", "golden-hour", "twilight", "airliner", "orbit", "mars"];

/// The horizon is looked at from these scenes' cameras, each a crop of a picture of 1280 x 720 pixels.
const HORIZONS: [&str; 3] = ["golden-hour", "twilight", "airliner"];
const CROP: [u32; 2] = [208, 160];

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut renderer = Renderer::new(&DeviceRequest::default())?;
    let rows = (SCENES.len() as u32).div_ceil(COLUMNS);
    let white = image::Rgb([255; 3]);
    let mut sheet = RgbImage::from_pixel(COLUMNS * (WIDTH + GAP) - GAP, rows * (HEIGHT + GAP) - GAP, white);
    for (index, name) in (0..).zip(SCENES) {
        let picture = picture(&mut renderer, &root.join(format!("scenes/{name}.toml")))?;
        let (column, row) = (index % COLUMNS, index / COLUMNS);
        replace(&mut sheet, &picture, (column * (WIDTH + GAP)).into(), (row * (HEIGHT + GAP)).into());
    }
    let path = root.join("docs/images/gallery.png");
    write_png(AtomicFile::create(&path)?, sheet.width(), sheet.height(), &sheet)?;
    println!("{}", path.display());
    let [width, height] = CROP.map(|pixels| 2 * pixels);
    let mut sheet = RgbImage::from_pixel(HORIZONS.len() as u32 * (width + GAP) - GAP, height, white);
    for (column, name) in (0..).zip(HORIZONS) {
        let crop = horizon(&mut renderer, &root.join(format!("scenes/{name}.toml")))?;
        replace(&mut sheet, &crop, (column * (width + GAP)).into(), 0);
    }
    let path = root.join("docs/images/horizon.png");
    write_png(AtomicFile::create(&path)?, sheet.width(), sheet.height(), &sheet)?;
    println!("{}", path.display());
    Ok(())
}

/// The middle of a picture whose camera looks at the horizon, each pixel four times.
fn horizon(renderer: &mut Renderer, path: &Path) -> Result<RgbImage, Box<dyn Error>> {
    let mut scene = Scene::read(path)?;
    (scene.camera.width, scene.camera.height) = (1280, 720);
    let mu = welkin_lut::geometry::horizon_mu(scene.planet.radius_m, scene.camera.altitude_m);
    scene.camera.direction.elevation_rad = mu.clamp(-1.0, 1.0).asin();
    let large = rendered(renderer, &scene)?;
    let [width, height] = CROP;
    let (x, y) = ((large.width() - width) / 2, (large.height() - height) / 2);
    let crop = crop_imm(&large, x, y, width, height).to_image();
    Ok(resize(&crop, 2 * width, 2 * height, FilterType::Nearest))
}

fn rendered(renderer: &mut Renderer, scene: &Scene) -> Result<RgbImage, Box<dyn Error>> {
    let outputs = Outputs { capture: false, picture: true };
    let rendered = renderer.render(scene, Settings::of(Quality::High), outputs)?;
    let bytes = rendered.picture.ok_or("no picture came back")?;
    Ok(RgbImage::from_raw(scene.camera.width, scene.camera.height, bytes).ok_or("pixels are missing")?)
}

/// What a scene's camera sees.
fn picture(renderer: &mut Renderer, path: &Path) -> Result<RgbImage, Box<dyn Error>> {
    let mut scene = Scene::read(path)?;
    (scene.camera.width, scene.camera.height) = (OVERSAMPLING * WIDTH, OVERSAMPLING * HEIGHT);
    let large = rendered(renderer, &scene)?;
    Ok(resize(&large, WIDTH, HEIGHT, FilterType::Triangle))
}
