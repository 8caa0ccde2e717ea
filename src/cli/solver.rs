//! Choosing the reference's solver.

use clap::{Args, ValueEnum};
use welkin::reference::Solver;
use welkin::reference::marching::March;

use super::Failure;
use super::backend::Backend;

/// The solver and its settings.
#[derive(Debug, Args)]
pub struct SolverArguments {
    /// How the reference solves the light transport equation [default: path]
    #[arg(long, value_enum, value_name = "SOLVER")]
    solver: Option<Name>,
    /// Directions from which the marching solver gathers light at each step [default: 8]
    #[arg(long, value_name = "M", value_parser = clap::value_parser!(u32).range(1..=65536))]
    march_directions: Option<u32>,
    /// Orders of scattering that the marching solver adds to the first; its cost is exponential in them [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=16))]
    march_depth: Option<u32>,
    /// Fewest steps of the marching solver along a ray [default: 24]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1048576))]
    march_steps: Option<u32>,
    /// Largest optical depth of the marching solver's steps, which makes them short where matter is dense [default: 0.25]
    #[arg(long, value_name = "T", value_parser = step_depth)]
    march_step_depth: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Name {
    /// Quadrature of light after at most one event: scattered or reflected once
    Single,
    /// Recursive Monte Carlo ray marching, biased by its steps and its depth
    Marching,
    /// The unbiased path tracer, all orders
    Path,
}

fn step_depth(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("'{text}' is not a number"))?;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(format!("{value} does not lie in ]0, ∞[")) }
}

impl SolverArguments {
    /// The solver asked for.
    ///
    /// # Errors
    /// Settings of another solver than the one chosen.
    pub fn solver(&self) -> Result<Solver, Failure> {
        let solver = match self.solver.unwrap_or(Name::Path) {
            Name::Single => Solver::Single,
            Name::Path => Solver::Path,
            Name::Marching => Solver::Marching(March {
                directions: self.march_directions.unwrap_or(8) as usize,
                depth: self.march_depth.unwrap_or(1) as usize,
                step_optical_depth: self.march_step_depth.unwrap_or(0.25),
                fewest_steps: self.march_steps.unwrap_or(24) as usize,
            }),
        };
        match self.settings().iter().find(|(_, given)| *given && !matches!(solver, Solver::Marching(_))) {
            Some((option, _)) => Err(says_nothing(option, &solver, "choose --solver marching")),
            None => Ok(solver),
        }
    }

    fn settings(&self) -> [(&'static str, bool); 4] {
        [
            ("--march-directions", self.march_directions.is_some()),
            ("--march-depth", self.march_depth.is_some()),
            ("--march-steps", self.march_steps.is_some()),
            ("--march-step-depth", self.march_step_depth.is_some()),
        ]
    }

    /// The options, for [`Backend::check_options`].
    pub fn options(&self) -> impl Iterator<Item = (&'static str, Backend, bool)> {
        let all = std::iter::once(("--solver", self.solver.is_some())).chain(self.settings());
        all.map(|(name, given)| (name, Backend::Reference, given))
    }
}

/// Refuses options that only solvers with random numbers heed.
pub fn check_sampling(solver: &Solver, options: &[(&str, bool)]) -> Result<(), Failure> {
    let given = options.iter().find(|(_, given)| *given && matches!(solver, Solver::Single));
    given.map_or(Ok(()), |(option, _)| {
        Err(says_nothing(option, solver, "choose --solver path or marching, which draw at random"))
    })
}

fn says_nothing(option: &str, solver: &Solver, instead: &str) -> Failure {
    Failure::Input(anyhow::anyhow!("{option} says nothing to the {} solver; leave it out or {instead}", solver.name()))
}
