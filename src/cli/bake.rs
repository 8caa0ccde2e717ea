//! `welkin bake`: packs of tables for other engines.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use welkin::bake::{air_of, bake_on_device, describe, shaders};
use welkin::plan::{Quality, bake_settings};
use welkin::scene::Scene;
use welkin_lut::bake::{Air, BakeSettings, Baked};
use welkin_lut::pack::{FileFormat, Manifest, PackError, PackOptions, Precision, verify, write_pack};

use super::backend::{failure, open_renderer};
use super::{Failure, stdout};

/// What computes tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TableBackend {
    /// A Vulkan device, in 32-bit floats
    Gpu,
    /// The CPU, in 64-bit floats
    Cpu,
}

/// Bake a pack of tables for another engine, or verify one
///
/// A pack is a folder: tables of transmittance, irradiance, multiple scattering and scattered light, the shader code that
/// reads them, manifest.json and probes.json. It appears whole or not at all.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file whose air is baked
    #[arg(required_unless_present = "verify", requires = "out")]
    scene: Option<PathBuf>,
    /// The folder that becomes the pack; an older pack there is replaced
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Containers of the tables: exr, ktx2, dds, raw; several with commas [default: ktx2]
    #[arg(long, value_name = "FORMATS", value_delimiter = ',')]
    format: Vec<FileFormat>,
    /// Numbers of the tables: f16, f32; both with a comma [default: f16]
    #[arg(long, value_name = "PRECISIONS", value_delimiter = ',')]
    precision: Vec<Precision>,
    /// Sizes of the tables: low, medium (default), high or ultra
    #[arg(long, value_name = "Q")]
    quality: Option<Quality>,
    /// What computes the tables
    #[arg(long, value_enum, default_value = "gpu")]
    backend: TableBackend,
    /// The gpu backend's device, by a part of its name or its index
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Read a pack anew and check it: hashes, every container against the others, and the probes
    #[arg(long, value_name = "DIR", exclusive = true)]
    verify: Option<PathBuf>,
}

/// Bakes, or verifies.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    match (&arguments.verify, &arguments.scene, &arguments.out) {
        (Some(folder), ..) => verify_pack(folder),
        (None, Some(scene), Some(out)) => bake(arguments, scene, out),
        _ => Err(Failure::Input(anyhow::anyhow!("name a scene and --out DIR, or --verify DIR"))),
    }
}

fn verify_pack(folder: &Path) -> Result<(), Failure> {
    let verified = verify(folder).map_err(|error| match error {
        PackError::NoPack { .. } | PackError::Version { .. } | PackError::File { .. } => Failure::Input(error.into()),
        broken => Failure::Check(broken.to_string()),
    })?;
    let (files, tables, probes) = (verified.files, verified.table_files, verified.probes);
    let text = format!("{files} files are as they were written; {tables} files of tables; {probes} values of probes");
    Ok(stdout::print(&text)?)
}

fn bake(arguments: &Arguments, path: &Path, out: &Path) -> Result<(), Failure> {
    if arguments.backend == TableBackend::Cpu && arguments.device.is_some() {
        let message = "--device says nothing to the cpu backend; leave it out or choose --backend gpu";
        return Err(Failure::Input(anyhow::anyhow!(message)));
    }
    let scene = Scene::read(path)?;
    let air = air_of(&scene)?;
    let settings = bake_settings(arguments.quality.unwrap_or_default());
    let shaders = shaders(&scene, &settings)?;
    let (baked, backend) = compute(arguments, &scene, &air, settings)?;
    let or = |given: &[_], default| if given.is_empty() { vec![default] } else { given.to_vec() };
    let precisions = if arguments.precision.is_empty() { vec![Precision::F16] } else { arguments.precision.clone() };
    let options = PackOptions { formats: or(&arguments.format, FileFormat::Ktx2), precisions };
    let description = describe(&scene, &air, &backend);
    let manifest = write_pack(out, &baked, &description, &options, &shaders)?;
    for what in &manifest.left_out {
        eprintln!("note: not in the pack: {what}");
    }
    Ok(stdout::print(summary(&manifest).trim_end())?)
}

/// The tables, and what has computed them.
fn compute<'a>(
    arguments: &Arguments,
    scene: &Scene,
    air: &'a Air,
    settings: BakeSettings,
) -> Result<(Baked<'a>, String), Failure> {
    if arguments.backend == TableBackend::Gpu {
        let mut renderer = open_renderer(arguments.device.as_deref())?;
        let baked = bake_on_device(&mut renderer, scene, air, settings).map_err(failure)?;
        return Ok((baked, renderer.gpu().info().name.clone()));
    }
    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("{msg:24} {wide_bar} {percent} % {eta}") {
        bar.set_style(style);
    }
    let baked = Baked::new(air, settings, &|progress| {
        bar.set_message(progress.stage);
        bar.set_position((1000.0 * progress.done) as u64);
    });
    bar.finish_and_clear();
    Ok((baked, "cpu".to_owned()))
}

/// Tables with sizes and errors, for people.
fn summary(manifest: &Manifest) -> String {
    let mut text = String::new();
    for table in &manifest.tables {
        let [width, height, depth] = table.size;
        text += &format!("{} {width} x {height} x {depth}\n", table.name);
        for file in &table.files {
            text += &format!("  {} {} bytes\n", file.file.path, file.file.bytes);
        }
        let mut precisions: Vec<_> = table.files.iter().collect();
        precisions.dedup_by_key(|file| file.precision);
        for file in precisions {
            for error in &file.errors {
                text += &format!(
                    "  {}: {}: median {:.2e}, 99 % below {:.2e}, maximum {:.2e}\n",
                    file.precision, error.of, error.median, error.p99, error.maximum
                );
            }
        }
    }
    text
}
