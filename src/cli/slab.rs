//! `welkin slab`: how much light a homogeneous layer reflects, transmits and absorbs.

use clap::Args;
use welkin::reference::slab::{Measured, Slab, SlabFluxes};
use welkin_lut::PhaseFunction;

use super::limit::relative_error;
use super::{Failure, phase_argument, stdout};

/// The seed of the random numbers.
const SEED: u64 = 0;

/// Measure the reflectance, transmittance and absorption of a homogeneous layer
///
/// A parallel beam comes from above; below lies a Lambertian surface, above is vacuum. The reference traces it. All
/// results are fractions of the beam's flux through a horizontal plane: reflectance upward at the top (with what the
/// surface sends back), transmittance downward at the bottom, absorption in the layer.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Vertical optical thickness, above 0
    #[arg(long, value_name = "T", value_parser = thickness, allow_negative_numbers = true)]
    optical_thickness: f64,
    /// Single-scattering albedo, from 0 to 1
    #[arg(long, value_name = "W", value_parser = share, allow_negative_numbers = true)]
    albedo: f64,
    /// Phase function, such as henyey-greenstein:0.85, rayleigh or isotropic
    #[arg(long, value_parser = phase_argument::parse)]
    phase: PhaseFunction,
    /// Cosine of the beam's angle to the vertical, above 0 and at most 1
    #[arg(long, value_parser = cosine, allow_negative_numbers = true)]
    mu0: f64,
    /// Reflectance of the surface, from 0 to 1
    #[arg(long, value_name = "A", default_value = "0", value_parser = share, allow_negative_numbers = true)]
    surface_albedo: f64,
    /// Walks to trace, instead of as many as --max-error takes; the standard errors fall with their square root
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), conflicts_with = "max_error")]
    photons: Option<u64>,
    /// Standard error of reflectance and diffuse transmittance to reach, as a share of each
    #[arg(long, value_name = "E", default_value = "0.003", value_parser = relative_error)]
    max_error: f64,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

fn number(text: &str, allowed: &str, fits: impl Fn(f64) -> bool) -> Result<f64, String> {
    let value = text.parse().map_err(|_| format!("'{text}' is not a number"))?;
    if fits(value) { Ok(value) } else { Err(format!("it must lie in {allowed}")) }
}

fn thickness(text: &str) -> Result<f64, String> {
    number(text, "]0, ∞[", |t| t > 0.0 && t.is_finite())
}

fn share(text: &str) -> Result<f64, String> {
    number(text, "[0, 1]", |w| (0.0..=1.0).contains(&w))
}

fn cosine(text: &str) -> Result<f64, String> {
    number(text, "]0, 1]", |mu| mu > 0.0 && mu <= 1.0)
}

/// Traces the slab and prints what became of the light.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let slab = Slab {
        optical_thickness: arguments.optical_thickness,
        albedo: arguments.albedo,
        phase: arguments.phase.clone(),
        mu0: arguments.mu0,
        surface_albedo: arguments.surface_albedo,
    };
    let fluxes = match arguments.photons {
        Some(photons) => slab.fluxes(photons, SEED),
        None => slab.fluxes_to(arguments.max_error, SEED),
    };
    let text = if arguments.json { json(&fluxes) } else { table(&fluxes) };
    stdout::print(&text)?;
    match arguments.photons {
        Some(_) => Ok(()),
        None => check(&fluxes, arguments.max_error),
    }
}

/// The standard error is itself an estimate, uncertain by 9 %.
fn check(fluxes: &SlabFluxes, max_error: f64) -> Result<(), Failure> {
    let named = [("reflectance", fluxes.reflectance), ("diffuse transmittance", fluxes.diffuse_transmittance)];
    let worse = named.iter().find(|(_, m)| m.standard_error > 1.27 * max_error * m.value);
    worse.map_or(Ok(()), |(name, m)| {
        Err(Failure::Check(format!(
            "the standard error of the {name} is {:.2e} of it after the most steps that one run takes, above the \
             {max_error} asked for; the results are printed, --photons goes further",
            m.standard_error / m.value
        )))
    })
}

fn json(fluxes: &SlabFluxes) -> String {
    let object = serde_json::json!({
        "reflectance": fluxes.reflectance.value,
        "reflectance_stderr": fluxes.reflectance.standard_error,
        "diffuse_transmittance": fluxes.diffuse_transmittance.value,
        "diffuse_transmittance_stderr": fluxes.diffuse_transmittance.standard_error,
        "direct_transmittance": fluxes.direct_transmittance,
        "upward_at_bottom": fluxes.upward_at_bottom.value,
        "upward_at_bottom_stderr": fluxes.upward_at_bottom.standard_error,
        "absorbed": fluxes.absorbed.value,
        "absorbed_stderr": fluxes.absorbed.standard_error,
    });
    format!("{object:#}")
}

fn table(fluxes: &SlabFluxes) -> String {
    let line = |name: &str, m: Measured| match m.value {
        thin if thin > 0.0 && thin < 1e-3 => format!("{name:<22} {thin:.4e} ± {:.1e}", m.standard_error),
        value => format!("{name:<22} {value:.6} ± {:.6}", m.standard_error),
    };
    [
        line("reflectance", fluxes.reflectance),
        line("diffuse transmittance", fluxes.diffuse_transmittance),
        format!("{:<22} {:.6e} (exact)", "direct transmittance", fluxes.direct_transmittance),
        line("upward at the bottom", fluxes.upward_at_bottom),
        line("absorbed", fluxes.absorbed),
    ]
    .join("\n")
}
