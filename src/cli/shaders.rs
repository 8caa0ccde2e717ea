//! `welkin shaders`: the shader code for other engines.

use std::path::{Path, PathBuf};

use clap::Args;
use welkin::output::{AtomicFile, OutputError};
use welkin::plan::{Facts, Outputs, Quality, Settings, bake_settings};
use welkin::probe::Orders;
use welkin::scene::Scene;
use welkin::shader_export::shader_files;
use welkin_shaders::Language;

use super::{Failure, stdout};

/// The air that passes bake where nobody names another; the camera says nothing to them.
const EARTH: &str = "preset = \"earth\"\n[sun]\nelevation_deg = 45\nazimuth_deg = 180\n\
                     [camera]\naltitude_m = 2\nelevation_deg = 0\nazimuth_deg = 0\n";

/// Write the shader code that reads a pack's tables, and the passes that bake them
///
/// Files: sky, functions to include; sky_probe, which answers a pack's probes with them; bake_*, compute passes that make
/// the tables, specialised for the air of a scene; interface.json, entry points and bindings.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The language: wgsl, glsl, hlsl, msl or spirv
    #[arg(long, value_name = "LANGUAGE")]
    language: Language,
    /// The folder to write to; made if it is missing
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// A scene whose air the bake_* passes are for [default: the Earth's]
    #[arg(long, value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// The quality of the bake_* passes: low, medium (default), high or ultra
    #[arg(long, value_name = "Q")]
    quality: Option<Quality>,
}

/// Writes the files.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = match &arguments.scene {
        Some(path) => Scene::read(path)?,
        None => Scene::parse(EARTH, Path::new("earth.toml"))?,
    };
    let settings = Settings::for_bake(&bake_settings(arguments.quality.unwrap_or_default()));
    let facts = Facts::new(&scene, settings, Orders::All, Outputs::default())?;
    let files = shader_files(arguments.language, &facts)?;
    let folder = &arguments.out;
    std::fs::create_dir_all(folder).map_err(|source| OutputError::Write { path: folder.clone(), source })?;
    for file in &files {
        AtomicFile::create(&folder.join(&file.name))?.write_all(&file.bytes)?;
    }
    let names: Vec<_> = files.iter().map(|file| file.name.as_str()).collect();
    Ok(stdout::print(&names.join("\n"))?)
}
