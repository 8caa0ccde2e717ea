//! Fluxes of a homogeneous plane-parallel slab over a Lambertian surface: the problem that every textbook tabulates.
//!
//! A code path of its own: walks run with the light, where those of [`super::path`] run against it. Every collision is
//! forced to happen inside the slab and the part of the light that leaves is counted by its expected value, so a walk
//! contributes at every step. The transmittance of thick slabs has walks of its own, guided to the bottom.

mod asymptotic;
mod deep;
pub mod families;
mod forward;
mod radiance;

use deep::Deep;
pub use radiance::{Exit, Side};
use welkin_lut::PhaseFunction;

/// Independent batches behind the standard errors.
const BATCHES: u64 = 64;
/// Optical thickness from which the transmittance has walks of its own.
const DEEP: f64 = 3.0;
/// Walks of the first round, from which the number still needed is estimated.
const PILOT_WALKS: u64 = 4096;
/// Most steps that a result may take, whatever error is asked for: tens of seconds on one core.
const MOST_STEPS: f64 = 1e9;

/// A slab with vacuum above and a Lambertian surface directly below, lit by a parallel beam from above.
#[derive(Debug, Clone, PartialEq)]
pub struct Slab {
    /// τ of the whole slab, measured vertically; above 0.
    pub optical_thickness: f64,
    /// W = b/c, in [0, 1].
    pub albedo: f64,
    /// P.
    pub phase: PhaseFunction,
    /// Cosine of the beam's angle to the vertical, in ]0, 1].
    pub mu0: f64,
    /// Reflectance of the surface, in [0, 1].
    pub surface_albedo: f64,
}

/// A mean and one standard error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measured {
    /// Mean over the walks.
    pub value: f64,
    /// One standard error of the mean.
    pub standard_error: f64,
}

/// Where the light of the beam ends, as fractions of its flux through a horizontal plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlabFluxes {
    /// Upward at the top.
    pub reflectance: Measured,
    /// Downward at the bottom after at least one scattering or reflection.
    pub diffuse_transmittance: Measured,
    /// Downward at the bottom without any: e^(-τ/μ₀), exact.
    pub direct_transmittance: f64,
    /// Upward just above the surface.
    pub upward_at_bottom: Measured,
    /// Lost in the slab.
    pub absorbed: Measured,
    /// reflectance + (1 - surface albedo)(diffuse + direct transmittance) + absorbed: 1 up to its own standard error.
    pub balance: Measured,
}

impl Slab {
    /// Traces `photons` walks (rounded up to whole batches) with random numbers selected by `seed`, and as many again
    /// for the transmittance of a thick slab.
    pub fn fluxes(&self, photons: u64, seed: u64) -> SlabFluxes {
        let forward = forward::batches(self, photons, seed);
        let deep = self.deep().map(|deep| deep.batches(photons, seed));
        self.gather(&forward, deep.as_deref())
    }

    /// Traces as many walks as bring one standard error of reflectance and of diffuse transmittance below
    /// `relative_error` of themselves, but no more than some 10⁹ steps: the errors of the result say whether that was
    /// enough. The numbers come from a first round that is thrown away.
    pub fn fluxes_to(&self, relative_error: f64, seed: u64) -> SlabFluxes {
        let pilot_seed = !seed;
        let forward = forward::batches(self, PILOT_WALKS, pilot_seed);
        let deep = self.deep();
        let pilot = deep.as_ref().map(|deep| deep.batches(PILOT_WALKS, pilot_seed));
        let first = self.gather(&forward, pilot.as_deref());
        let excess = |m: Measured| if m.value > 0.0 { m.standard_error / (relative_error * m.value) } else { 0.0 };
        let transmitted = excess(first.diffuse_transmittance);
        let reflected = excess(first.reflectance);
        let mean = |steps: &mut dyn Iterator<Item = f64>| steps.sum::<f64>() / BATCHES as f64;
        let forward_steps = mean(&mut forward.iter().map(|s| s.steps));
        let Some((deep, pilot)) = deep.zip(pilot) else {
            return self.gather(&forward::batches(self, count(reflected.max(transmitted), forward_steps), seed), None);
        };
        let deep_steps = mean(&mut pilot.iter().map(|s| s.steps));
        let forward = forward::batches(self, count(reflected, forward_steps), seed);
        self.gather(&forward, Some(&deep.batches(count(transmitted, deep_steps), seed)))
    }

    fn deep(&self) -> Option<Deep<'_>> {
        (self.optical_thickness > DEEP).then(|| Deep::new(self))
    }

    fn gather(&self, forward: &[forward::Sums], deep: Option<&[deep::Transmitted]>) -> SlabFluxes {
        let direct = (-self.optical_thickness / self.mu0).exp();
        let a = self.surface_albedo;
        let down: Vec<f64> = match deep {
            Some(deep) => deep.iter().map(|s| s.down).collect(),
            None => forward.iter().map(|s| s.down).collect(),
        };
        let with_down = |of: &dyn Fn(&forward::Sums, f64) -> f64| -> Vec<f64> {
            forward.iter().zip(&down).map(|(sums, &down)| of(sums, down)).collect()
        };
        SlabFluxes {
            reflectance: measure(&with_down(&|s, _| s.up)),
            diffuse_transmittance: measure(&down),
            direct_transmittance: direct,
            upward_at_bottom: measure(&with_down(&|_, down| a * (down + direct))),
            absorbed: measure(&with_down(&|s, _| s.absorbed)),
            balance: measure(&with_down(&|s, down| s.up + (1.0 - a) * (down + direct) + s.absorbed)),
        }
    }
}

/// Walks that bring an error `excess` times too large after the first round, of so many `steps` a walk, where it should be.
fn count(excess: f64, steps: f64) -> u64 {
    // The errors of this round and of the result are themselves uncertain by 9 % each, and a round that has missed the
    // rare walks by more: with 1.25 in the place of 1.6 one result in fifty was not good enough.
    let wanted = PILOT_WALKS as f64 * (1.6 * excess).powi(2).max(1.0);
    wanted.min(MOST_STEPS / steps.max(1.0)).max(1.0) as u64
}

/// The cosine to the vertical after scattering by an angle with the cosine `cos_theta`, at azimuth 2π`u`.
fn turn(mu: f64, cos_theta: f64, u: f64) -> f64 {
    let sines = ((1.0 - mu * mu) * (1.0 - cos_theta * cos_theta)).max(0.0).sqrt();
    let turned = mu * cos_theta + sines * (std::f64::consts::TAU * u).cos();
    // A walk along the layer would never leave it.
    if turned == 0.0 { f64::MIN_POSITIVE } else { turned.clamp(-1.0, 1.0) }
}

fn measure(values: &[f64]) -> Measured {
    let count = values.len() as f64;
    let value = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|v| (v - value).powi(2)).sum();
    Measured { value, standard_error: (squares / (count * (count - 1.0))).sqrt() }
}
