//! Takes the pictures of the window in `docs/images/`.
//!
//! `cargo build --release && cargo run --release --example window_pictures [-- FOLDER]`

#[path = "../tests/desktop/mod.rs"]
mod desktop;

use std::error::Error;
use std::path::{Path, PathBuf};

use desktop::{Desktop, until};

const SIZE: [u32; 2] = [1280, 720];

/// Walks a pixel of the truth.
const WALKS: u32 = 16;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pictures = std::env::args().nth(1).map_or(root.join("docs/images"), PathBuf::from);
    let (desktop, folder) = (Desktop::of_size(SIZE), tempfile::tempdir()?);
    std::fs::create_dir(folder.path().join("config"))?;
    let settings = "{\"size\": [1280, 720], \"aim\": \"error\", \"target_error\": 0.02, \"truth_scale\": 0.25}";
    std::fs::write(folder.path().join("config/window.json"), settings)?;
    std::fs::create_dir(folder.path().join("scenes"))?;
    std::fs::copy(root.join("scenes/golden-hour.toml"), folder.path().join("scenes/golden-hour.toml"))?;
    let program = desktop.open_with(folder.path(), "scenes/golden-hour.toml", |command| {
        command.env("WELKIN_CONFIG", folder.path().join("config")).env("WELKIN_LOG", "welkin=debug");
        command.env_remove("WELKIN_VALIDATION");
    });
    program.wait_for("settings for an error", 0);
    let chosen = program.stderr.text().len();
    program.wait_for("a picture at 1.000", chosen);
    // The panel is drawn after the picture.
    let drawn = program.stderr.text().len();
    program.wait_for("the panel", drawn);
    take(&desktop, &pictures.join("window.png"))?;
    program.key("t");
    until("the truth", || {
        let said = program.stderr.text();
        let walks = said
            .lines()
            .rev()
            .find_map(|line| line.split(" walks a pixel").next()?.split(' ').next_back()?.parse().ok());
        walks.filter(|walks: &u32| *walks >= WALKS)
    });
    let traced = program.stderr.text().len();
    program.wait_for("the panel", traced);
    take(&desktop, &pictures.join("window-truth.png"))?;
    program.key("ctrl+q");
    program.exit_code();
    Ok(())
}

fn take(desktop: &Desktop, path: &Path) -> Result<(), Box<dyn Error>> {
    let ([width, height], screen) = (SIZE, desktop.screen());
    let pixel = |x: u32, y: u32| image::Rgb(screen.pixel(x as usize, y as usize));
    image::RgbImage::from_fn(width, height, pixel).save(path)?;
    println!("{}", path.display());
    Ok(())
}
