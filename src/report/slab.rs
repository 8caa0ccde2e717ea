//! The families of methods on homogeneous slabs: error against time, from single scattering to the path tracer.

use std::time::Instant;

use schemars::JsonSchema;
use serde::Serialize;

use super::results::Spread;
use crate::reference::slab::Slab;
use crate::reference::slab::families::{self, DiscreteOrdinates, Fluxes, SlabMethod};
use welkin_lut::PhaseFunction;

/// Streams in each hemisphere of what counts as the truth: more than any method that is compared has.
const TRUTH: DiscreteOrdinates = DiscreteOrdinates { streams: 32 };
/// Repetitions of each time, of slow methods fewer.
const RUNS: usize = 7;
/// Time after which a method is not repeated, s.
const ENOUGH_S: f64 = 0.2;
/// Shortest time that is measured at once, s: quicker methods run several times.
const AT_ONCE_S: f64 = 2e-4;

/// A slab with what every family makes of it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SlabResults {
    /// The slab in words.
    pub slab: String,
    /// The families, from the simplest to the best.
    pub points: Vec<SlabPoint>,
}

/// One method on one slab.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SlabPoint {
    /// Its name.
    pub name: String,
    /// Relative error of the reflectance.
    pub reflectance_error: f64,
    /// Relative error of the diffuse transmittance.
    pub transmittance_error: f64,
    /// Time of both, ms, on all cores.
    pub milliseconds: Spread,
}

/// All families on a thin, a cloud-like and an absorbing slab,
/// with so many walks of the path tracer.
pub fn slab_results(walks: &[u64]) -> Vec<SlabResults> {
    let slab = |optical_thickness, albedo, g, mu0| Slab {
        optical_thickness,
        albedo,
        phase: PhaseFunction::HenyeyGreenstein { g },
        mu0,
        surface_albedo: 0.1,
    };
    [slab(0.3, 0.95, 0.7, 0.5), slab(16.0, 1.0, 0.85, 0.6), slab(4.0, 0.9, 0.85, 0.3)]
        .iter()
        .map(|slab| results(slab, walks))
        .collect()
}

fn results(slab: &Slab, walks: &[u64]) -> SlabResults {
    let truth = TRUTH.fluxes(slab);
    let mut points: Vec<SlabPoint> =
        families::all().iter().map(|method| point(method.name(), &truth, || method.fluxes(slab))).collect();
    points.extend(walks.iter().map(|&walks| {
        point(format!("path tracer, {walks} walks"), &truth, || {
            let fluxes = slab.fluxes(walks, walks);
            Fluxes { reflectance: fluxes.reflectance.value, diffuse_transmittance: fluxes.diffuse_transmittance.value }
        })
    }));
    let Slab { optical_thickness, albedo, mu0, surface_albedo, .. } = slab;
    let phase = slab.phase.mean_cosine();
    SlabResults {
        slab: format!(
            "optical thickness {optical_thickness}, albedo {albedo}, Henyey-Greenstein {phase}, beam at cosine {mu0}, over a \
             surface of albedo {surface_albedo}"
        ),
        points,
    }
}

fn point(name: String, truth: &Fluxes, find: impl Fn() -> Fluxes) -> SlabPoint {
    let started = Instant::now();
    let found = find();
    let times = (AT_ONCE_S / started.elapsed().as_secs_f64().max(1e-9)).ceil().max(1.0) as u32;
    let once = || {
        let started = Instant::now();
        for _ in 0..times {
            std::hint::black_box(find());
        }
        1e3 * started.elapsed().as_secs_f64() / f64::from(times)
    };
    let began = Instant::now();
    let mut runs = vec![once()];
    while runs.len() < RUNS && began.elapsed().as_secs_f64() < ENOUGH_S {
        runs.push(once());
    }
    let relative = |found: f64, truth: f64| (found / truth - 1.0).abs();
    SlabPoint {
        name,
        reflectance_error: relative(found.reflectance, truth.reflectance),
        transmittance_error: relative(found.diffuse_transmittance, truth.diffuse_transmittance),
        milliseconds: Spread::of(&runs),
    }
}
