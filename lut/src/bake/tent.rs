//! Optical depth of constituents whose density is a tent, in closed form: as in the shaders' `tent.wgsl`, in f64.
//!
//! A tent is three ramps, (h - h₀)⁺ - 2 (h - h₁)⁺ + (h - h₂)⁺ over half its width. Along a stretch of ray that only rises or
//! only falls, h grows from a ramp's foot like a parabola.

use crate::{BAND_COUNT, Bands};

use super::Air;

/// A stretch of ray on which altitude only rises or only falls.
pub(super) struct Stretch {
    pub(super) length_m: f64,
    /// Of its ends from the ray's lowest point, in either order.
    pub(super) distances_m: [f64; 2],
    /// Of one end, the middle in v and the other end.
    pub(super) altitudes_m: [f64; 3],
}

/// Optical depth of all tents along a stretch of the ray that starts at an altitude along μ.
pub(super) fn optical_depth_of_tents(air: &Air, altitude_m: f64, mu: f64, stretch: &Stretch) -> Bands {
    let radius_m = air.planet().radius_m;
    let [one_m, middle_m, other_m] = stretch.altitudes_m;
    let high_m = stretch.distances_m[0].max(stretch.distances_m[1]);
    let b = (radius_m + altitude_m) * mu;
    let sine = (radius_m + altitude_m) / (radius_m + middle_m) * (1.0 - mu * mu).max(0.0).sqrt();
    let curvature_per_m = sine * sine / (radius_m + middle_m);
    // ∫ (h - kink)⁺ along the stretch.
    let ramp = |kink_m: f64| {
        let gap = (kink_m - altitude_m) * (2.0 * radius_m + kink_m + altitude_m);
        let above_m = (high_m - (b * b + gap).max(0.0).sqrt()).clamp(0.0, stretch.length_m);
        let ends_m = (one_m - kink_m).max(0.0) + (other_m - kink_m).max(0.0);
        above_m * (0.5 * ends_m - curvature_per_m / 12.0 * above_m * above_m)
    };
    let mut tau = [0.0; BAND_COUNT];
    for (centre_m, half_width_m, extinction_per_m) in air.tents() {
        let ramps = ramp(centre_m - half_width_m) - 2.0 * ramp(centre_m) + ramp(centre_m + half_width_m);
        let dense_m = (ramps / half_width_m).max(0.0);
        tau.iter_mut().zip(extinction_per_m).for_each(|(tau, c)| *tau += dense_m * c);
    }
    tau
}
