//! The table of optical depth to the top of the atmosphere.

use crate::geometry::horizon_mu;

/// (altitude, cosine of the zenith angle) <-> unit coordinates.
///
/// x = √((μ - μ_h) / (1 - μ_h)) crowds texels at the horizon μ_h, where air mass grows fastest; y = √(h / top) crowds
/// them near the ground. Only directions above the horizon are stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpticalDepthMapping {
    /// The planet's radius, m.
    pub radius_m: f64,
    /// Altitude of the atmosphere's top, m.
    pub top_m: f64,
}

impl OpticalDepthMapping {
    /// (altitude in m, μ) at unit coordinates.
    pub fn parameters(&self, unit: [f64; 2]) -> [f64; 2] {
        let altitude_m = self.top_m * unit[1] * unit[1];
        let mu_h = horizon_mu(self.radius_m, altitude_m);
        [altitude_m, mu_h + (1.0 - mu_h) * unit[0] * unit[0]]
    }

    /// Unit coordinates of an altitude in m and a μ, clamped to the table.
    pub fn unit(&self, altitude_m: f64, mu: f64) -> [f64; 2] {
        let mu_h = horizon_mu(self.radius_m, altitude_m);
        let x = ((mu - mu_h) / (1.0 - mu_h)).clamp(0.0, 1.0).sqrt();
        [x, (altitude_m / self.top_m).clamp(0.0, 1.0).sqrt()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mapping::tests::assert_round_trip;

    #[test]
    fn texels_come_back_to_themselves() {
        let mapping = OpticalDepthMapping { radius_m: 6_360_000.0, top_m: 100_000.0 };
        assert_round_trip(|unit| mapping.parameters(unit), |[altitude_m, mu]| mapping.unit(altitude_m, mu));
    }
}
