//! The table of multiply scattered light.

/// Cosine of the zenith angle of the lowest light that the table keeps, sin(-20°).
pub const LOWEST_MU_S: f64 = -0.342_020_143_3;

/// Slope of the warp at the horizon: half of the texels lie within 9° of it, where twilight changes fastest.
const SUN_WARP: f64 = 17.0;

/// (altitude, cosine of the light's zenith angle) <-> unit coordinates.
///
/// x grows as asinh(k μ_s), y = √(h / top).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MultipleScatteringMapping {
    /// Altitude of the atmosphere's top, m.
    pub top_m: f64,
}

impl MultipleScatteringMapping {
    fn bounds() -> (f64, f64) {
        ((SUN_WARP * LOWEST_MU_S).asinh(), SUN_WARP.asinh())
    }

    /// (altitude in m, μ_s) at unit coordinates.
    pub fn parameters(&self, unit: [f64; 2]) -> [f64; 2] {
        let (low, high) = Self::bounds();
        let mu_s = (low + (high - low) * unit[0]).sinh() / SUN_WARP;
        [self.top_m * unit[1] * unit[1], mu_s.clamp(LOWEST_MU_S, 1.0)]
    }

    /// Unit coordinates of an altitude in m and a μ_s, clamped to the table.
    pub fn unit(&self, altitude_m: f64, mu_s: f64) -> [f64; 2] {
        let (low, high) = Self::bounds();
        let x = ((SUN_WARP * mu_s).asinh() - low) / (high - low);
        [x.clamp(0.0, 1.0), (altitude_m / self.top_m).clamp(0.0, 1.0).sqrt()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mapping::tests::assert_round_trip;

    #[test]
    fn texels_come_back_to_themselves() {
        let mapping = MultipleScatteringMapping { top_m: 100_000.0 };
        assert_round_trip(|unit| mapping.parameters(unit), |[altitude_m, mu_s]| mapping.unit(altitude_m, mu_s));
    }
}
