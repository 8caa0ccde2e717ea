//! `welkin probe`: radiance along single rays.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use welkin::output::AtomicFile;
use welkin::probe::{Orders, Ray, RayRadiance, RayTable};
use welkin::reference::{self, Effort, Solver};
use welkin::scene::Scene;

use super::Failure;
use super::accuracy::Accuracy;
use super::backend::{Backend, failure, open_renderer};
use super::solver::{SolverArguments, check_sampling};

/// Share of the radiance that one standard error may be where `--samples` is not given.
const RELATIVE_ERROR: f64 = 0.005;

/// Compute the radiance along rays from a CSV file
///
/// The rays' columns are altitude_m, view_zenith_deg, view_azimuth_deg, sun_zenith_deg and sun_azimuth_deg, in any order;
/// others are kept. Where there is a column distance_m, a black surface stands at that distance and the result is the
/// light of the air before it; inf is a ray to the ground or to space. The result has the same rows and radiance_r,g,b (the sun's disc left out), transmittance_r,g,b and
/// stderr_r,g,b.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The scene file; its first directional light stands where each row says
    scene: PathBuf,
    /// The rays, CSV
    #[arg(long, value_name = "CSV")]
    rays: PathBuf,
    /// The result, CSV
    #[arg(long, value_name = "CSV")]
    out: PathBuf,
    /// What computes light
    #[arg(long, value_enum, default_value = "gpu")]
    backend: Backend,
    #[command(flatten)]
    accuracy: Accuracy,
    /// The gpu backend's device, by a part of its name or its index
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
    /// Walks (or marches) of the reference backend for each ray; by default as many as bring one standard error to 0.5 %
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    samples: Option<u64>,
    /// Which orders of scattering count
    #[arg(long, value_enum, default_value = "all")]
    orders: OrdersArgument,
    #[command(flatten)]
    solver: SolverArguments,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum OrdersArgument {
    /// All of them, and light from the ground
    All,
    /// Light scattered exactly once in the air
    Single,
}

/// Reads the rays, traces them and writes the result.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut options = vec![
        ("--quality", Backend::Gpu, arguments.accuracy.quality.is_some()),
        ("--multiple-scattering", Backend::Gpu, arguments.accuracy.multiple_scattering.is_some()),
        ("--device", Backend::Gpu, arguments.device.is_some()),
        ("--samples", Backend::Reference, arguments.samples.is_some()),
    ];
    options.extend(arguments.solver.options());
    arguments.backend.check_options(&options)?;
    let solver = arguments.solver.solver()?;
    check_sampling(&solver, &[("--samples", arguments.samples.is_some())])?;
    let scene = Scene::read(&arguments.scene)?;
    let table = RayTable::read(&arguments.rays, scene.planet.radius_m)?;
    let out = AtomicFile::create(&arguments.out)?;
    let answers = trace(arguments, solver, &scene, table.rays())?;
    Ok(out.write_all(&table.with_answers(&answers)?)?)
}

fn trace(arguments: &Arguments, solver: Solver, scene: &Scene, rays: &[Ray]) -> Result<Vec<RayRadiance>, Failure> {
    let orders = match arguments.orders {
        OrdersArgument::All => Orders::All,
        OrdersArgument::Single => Orders::Single,
    };
    match arguments.backend {
        Backend::Gpu => {
            let settings = arguments.accuracy.settings();
            let mut renderer = open_renderer(arguments.device.as_deref())?;
            renderer.probe(scene, settings, rays, orders).map_err(failure)
        }
        Backend::Reference => {
            let effort = arguments.samples.map_or(Effort::RelativeError(RELATIVE_ERROR), Effort::Walks);
            let answers = reference::probe_by(solver, scene, rays, orders, effort, 0)?;
            let first = match (solver, orders) {
                (Solver::Path, Orders::Single) => ", first order by quadrature where lights and matter allow it",
                _ => "",
            };
            eprintln!("solver: {solver}{first}");
            Ok(answers)
        }
    }
}
