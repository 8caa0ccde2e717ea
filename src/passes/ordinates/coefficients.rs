//! The numbers of the approximations, as functions of the droplets' phase function.
//!
//! Made by `cargo run --release --example fit_cloud_lighting -- fit`; docs/clouds.md says on what, and how well they do on
//! clouds that were not fitted.
//!
//! Light that was scattered by small angles only is taken for bands of sunlight that less than the whole optical depth
//! dims and that scatters once: E Σ P_k(ν) ∫ c e^(-a_k (τ_sun + τ_view)) ds with P_0 = P\[g\] - P\[0.6 g\], the peak, and
//! P_1 = P[0.6 g], where P[0.6 g] is the phase function with every asymmetry parameter scaled. All other light is the
//! field's.

use welkin_lut::PhaseFunction;

/// Asymmetry of the second band relative to the droplets'.
pub const BAND_ASYMMETRY: f64 = 0.6;

/// Degrees l at which 1 - W χ_l is the share of the optical depth that dims a band: what leaves the field's component of
/// that degree with each scattering.
const BAND_DEGREES: [f64; 2] = [9.9, 2.9];

/// Shares a_k of the optical depths that dim the two bands, for a single-scattering albedo W in [0, 1].
pub fn band_attenuations(phase: &PhaseFunction, albedo: f64) -> [f64; 2] {
    BAND_DEGREES.map(|degree| 1.0 - albedo * moment(phase, degree))
}

/// χ_l between whole degrees, geometrically.
pub fn moment(phase: &PhaseFunction, degree: f64) -> f64 {
    let low = degree.floor();
    let [a, b] = [low, low + 1.0].map(|l| phase.legendre_moment(l as usize).max(1e-9));
    a * (b / a).powf(degree - low)
}

/// f, the share of scattered light that the field takes for unscattered: χ₂.
pub fn forward_share(phase: &PhaseFunction) -> f64 {
    phase.legendre_moment(2).max(0.0)
}

/// g', the mean cosine of the rest.
pub fn reduced_cosine(phase: &PhaseFunction) -> f64 {
    let f = forward_share(phase);
    (phase.mean_cosine() - f) / (1.0 - f)
}

/// The a with which light in clouds falls about as 1 / (1 + a τ') with the similar medium's depth τ' to the sun, where a view
/// ray finds more detail than cells have. Twice that of diffusion through a slab, 3/4 (1 - g'): lumps lose light to all
/// sides. Of 3/4, 3/2 and 3 (1 - g'), the best on voxel clouds in cells of 128 and 256 m (`fit_cloud_lighting -- cells`).
pub fn falloff(reduced_cosine: f64) -> f64 {
    1.5 * (1.0 - reduced_cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_between_whole_degrees_are_those_of_a_power_where_the_phase_function_has_powers() {
        let phase = PhaseFunction::HenyeyGreenstein { g: 0.85 };
        assert!((moment(&phase, 2.65) - 0.85_f64.powf(2.65)).abs() < 1e-12);
        assert!((moment(&phase, 2.65) - 0.85_f64.powf(2.6)).abs() > 1e-3, "another degree is another share");
    }

    #[test]
    fn absorption_dims_a_band_by_the_whole_depth() {
        let phase = PhaseFunction::HenyeyGreenstein { g: 0.85 };
        assert_eq!(band_attenuations(&phase, 0.0), [1.0; 2]);
        let [sharp, wide] = band_attenuations(&phase, 1.0);
        assert!(0.0 < wide && wide < sharp && sharp < 1.0);
    }
}
