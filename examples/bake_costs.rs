//! What packs of a scene take at each quality: size and processor time, on the device and on the CPU, for docs/tables.md.
//!
//! `cargo run --release --example bake_costs -- [SCENE [QUALITY...]]`. Times are of the process, lavapipe's included; those
//! of a GPU would be of the host alone. Only the tables are timed, without their measured errors and without writing.

use std::path::PathBuf;

use anyhow::Context as _;
use cpu_time::ProcessTime;
use welkin::bake::{air_of, bake_on_device};
use welkin::gpu::DeviceRequest;
use welkin::plan::{Quality, bake_settings};
use welkin::renderer::Renderer;
use welkin::scene::Scene;
use welkin_lut::bake::Baked;

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let path = arguments.next().unwrap_or_else(|| "scenes/noon.toml".into());
    let quality =
        |name: PathBuf| name.to_str().context("not a quality")?.parse::<Quality>().map_err(anyhow::Error::from);
    let mut qualities = arguments.map(quality).collect::<anyhow::Result<Vec<_>>>()?;
    if qualities.is_empty() {
        qualities = Quality::ALL.to_vec();
    }
    let scene = Scene::read(&path)?;
    let air = air_of(&scene)?;
    println!("| quality | `scattering` | all tables in f16 | device | CPU backend | CPU / device |");
    println!("|---|---|---|---|---|---|");
    for quality in qualities {
        let settings = bake_settings(quality);
        let mut renderer = Renderer::new(&DeviceRequest::default())?;
        // Pipelines are compiled once in an engine's life; the second bake is without that.
        drop(bake_on_device(&mut renderer, &scene, &air, settings)?);
        let started = ProcessTime::now();
        renderer.forget();
        let baked = bake_on_device(&mut renderer, &scene, &air, settings)?;
        let device_s = started.elapsed().as_secs_f64();
        let set = baked.tables().set();
        let tables = [&set.transmittance, &set.irradiance, &set.multiple_scattering, &set.scattering];
        let texels: usize = tables.iter().map(|table| table.texels().len()).sum();
        let [width, height, depth] = set.scattering.size();
        let started = ProcessTime::now();
        drop(Baked::new(&air, settings, &|_| {}));
        let cpu_s = started.elapsed().as_secs_f64();
        let megabytes = 8.0 * texels as f64 / 1e6;
        println!(
            "| {quality} | {width} x {height} x {depth} | {megabytes:.1} MB | {device_s:.2} s | {cpu_s:.2} s | {:.1} |",
            cpu_s / device_s
        );
    }
    Ok(())
}
