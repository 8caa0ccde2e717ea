//! Fluxes of a homogeneous plane-parallel slab over a Lambertian surface: the problem that every textbook tabulates.
//!
//! A code path of its own: walks run with the light, where those of [`super::path`] run against it. Every collision is
//! forced to happen inside the slab and the part of the light that leaves is counted by its expected value, so a walk
//! contributes at every step.

use rayon::prelude::*;
use welkin_lut::PhaseFunction;

use super::random::Draw;

/// Independent batches behind the standard errors.
const BATCHES: u64 = 64;
/// Weight below which a walk is played for its life.
const ROULETTE_BELOW: f64 = 0.1;

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

/// Sums of one batch.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    up: f64,
    down: f64,
    absorbed: f64,
}

impl Slab {
    /// Traces `photons` walks (rounded up to whole batches) with random numbers selected by `seed`.
    pub fn fluxes(&self, photons: u64, seed: u64) -> SlabFluxes {
        let walks = photons.div_ceil(BATCHES).max(1);
        let batches: Vec<Sums> = (0..BATCHES).into_par_iter().map(|batch| self.batch(walks, seed, batch)).collect();
        let direct = (-self.optical_thickness / self.mu0).exp();
        let a = self.surface_albedo;
        let measured = |of: &dyn Fn(&Sums) -> f64| measure(batches.iter().map(of));
        SlabFluxes {
            reflectance: measured(&|s| s.up),
            diffuse_transmittance: measured(&|s| s.down),
            direct_transmittance: direct,
            upward_at_bottom: measured(&|s| a * (s.down + direct)),
            absorbed: measured(&|s| s.absorbed),
            balance: measured(&|s| s.up + (1.0 - a) * (s.down + direct) + s.absorbed),
        }
    }

    /// Means over one batch.
    fn batch(&self, walks: u64, seed: u64, batch: u64) -> Sums {
        let mut draw = Draw::new(seed, 0, batch);
        let mut sums = Sums::default();
        for index in 0..walks {
            draw.start(index);
            self.walk(&mut draw, &mut sums);
        }
        let mean = |sum: f64| sum / walks as f64;
        Sums { up: mean(sums.up), down: mean(sums.down), absorbed: mean(sums.absorbed) }
    }

    fn walk(&self, draw: &mut Draw, sums: &mut Sums) {
        // Depth below the top in optical units, and the cosine to the downward vertical.
        let (mut depth, mut mu, mut weight) = (0.0, self.mu0, 1.0);
        let mut scattered = false;
        while weight > 0.0 {
            let to_boundary = if mu > 0.0 { (self.optical_thickness - depth) / mu } else { depth / -mu };
            let leaves = weight * (-to_boundary).exp();
            let collides = weight * -(-to_boundary).exp_m1();
            if mu < 0.0 {
                sums.up += leaves;
            } else if scattered {
                sums.down += leaves;
            }
            // Go on with one of the two that stay in play, with the weight of both.
            let reflected = if mu > 0.0 { leaves * self.surface_albedo } else { 0.0 };
            let survivors = collides * self.albedo;
            sums.absorbed += collides - survivors;
            weight = reflected + survivors;
            scattered = true;
            if draw.uniform() * weight < survivors {
                // Exponential step cut off at the boundary, by inversion.
                let step = -(draw.uniform() * (-to_boundary).exp_m1()).ln_1p();
                depth = (depth + step * mu).clamp(0.0, self.optical_thickness);
                mu = turn(mu, self.phase.sample(draw.uniform()), draw.uniform());
            } else {
                depth = self.optical_thickness;
                mu = -(1.0 - draw.uniform()).sqrt();
            }
            if weight < ROULETTE_BELOW {
                let survives = draw.uniform() * ROULETTE_BELOW < weight;
                weight = if survives { ROULETTE_BELOW } else { 0.0 };
            }
        }
    }
}

/// The cosine to the vertical after scattering by an angle with the cosine `cos_theta`, at azimuth 2π`u`.
fn turn(mu: f64, cos_theta: f64, u: f64) -> f64 {
    let sines = ((1.0 - mu * mu) * (1.0 - cos_theta * cos_theta)).max(0.0).sqrt();
    let turned = mu * cos_theta + sines * (std::f64::consts::TAU * u).cos();
    // A walk along the layer would never leave it.
    if turned == 0.0 { f64::MIN_POSITIVE } else { turned.clamp(-1.0, 1.0) }
}

fn measure(values: impl Iterator<Item = f64> + Clone) -> Measured {
    let count = BATCHES as f64;
    let value = values.clone().sum::<f64>() / count;
    let squares: f64 = values.map(|v| (v - value).powi(2)).sum();
    Measured { value, standard_error: (squares / (count * (count - 1.0))).sqrt() }
}
