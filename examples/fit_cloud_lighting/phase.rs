//! Phase functions with a factor on every asymmetry parameter.

use std::f64::consts::PI;

use welkin_lut::PhaseFunction;
use welkin_lut::phase::DropletFit;

fn draine(g: f64, alpha: f64, nu: f64) -> f64 {
    let norm = 4.0 * PI * (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
    (1.0 - g * g) * (1.0 + alpha * nu * nu) / norm * (1.0 + g * g - 2.0 * g * nu).powf(-1.5)
}

/// P with every g times `factor`, at a cosine of 1 for forward, 1/sr.
pub fn scaled(phase: &PhaseFunction, factor: f64, nu: f64) -> f64 {
    match *phase {
        PhaseFunction::HenyeyGreenstein { g } => draine(factor * g, 0.0, nu),
        PhaseFunction::CornetteShanks { g } => draine(factor * g, 1.0, nu),
        PhaseFunction::DoubleHenyeyGreenstein { weight, g1, g2 } => {
            weight * draine(factor * g1, 0.0, nu) + (1.0 - weight) * draine(factor * g2, 0.0, nu)
        }
        PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um } => {
            let fit = DropletFit::new(droplet_diameter_um);
            let sharp = (1.0 - fit.weight_draine) * draine(factor * fit.g_hg, 0.0, nu);
            sharp + fit.weight_draine * draine(factor * fit.g_draine, fit.alpha, nu)
        }
        _ => phase.value(nu),
    }
}
