//! The table of multiply scattered light.

use crate::Planet;

/// The lowest light that the table keeps and the slope of the warp at the horizon, in units of how far the air is seen to
/// reach beyond the horizon: on Earth 10.2°, so that the light comes down to -20° and half of the texels lie within 9°
/// of the horizon, where twilight changes fastest.
const LOWEST_MU_S_REACHES: f64 = 1.93;
const SUN_WARP_REACHES: f64 = 6.0;

/// (altitude, cosine of the light's zenith angle) <-> unit coordinates.
///
/// x grows as asinh(k s) with the light's height s = 1 - √(1 - μ_s), y = √(h / top). Near the horizon s is half of μ_s; near the zenith it
/// goes with the angle from there, and so does light that is scattered forward, of which μ_s would have only the square. Night falls
/// the sooner, the larger the planet is against its air: k and the lowest light follow the angle from the horizon at which the top
/// of the air is seen (`Planet::reach_rad`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MultipleScatteringMapping {
    /// Altitude of the atmosphere's top, m.
    pub top_m: f64,
    /// Cosine of the zenith angle of the lowest light that the table keeps.
    pub lowest_mu_s: f64,
    /// k.
    warp: f64,
}

impl MultipleScatteringMapping {
    /// That of a planet.
    pub fn new(planet: &Planet) -> Self {
        let reach = planet.reach_rad();
        Self {
            top_m: planet.atmosphere_height_m,
            lowest_mu_s: -(LOWEST_MU_S_REACHES * reach).min(1.0),
            warp: SUN_WARP_REACHES / reach,
        }
    }

    /// k, asinh(k s) of the lowest light, and the range from there to the light at the zenith: what the shaders need.
    pub fn sun_warp(&self) -> [f64; 3] {
        let low = (self.warp * height(self.lowest_mu_s)).asinh();
        [self.warp, low, self.warp.asinh() - low]
    }

    /// (altitude in m, μ_s) at unit coordinates.
    pub fn parameters(&self, unit: [f64; 2]) -> [f64; 2] {
        let [warp, low, range] = self.sun_warp();
        let height = (low + range * unit[0]).sinh() / warp;
        [self.top_m * unit[1] * unit[1], (height * (2.0 - height)).clamp(-1.0, 1.0)]
    }

    /// Unit coordinates of an altitude in m and a μ_s, clamped to the table.
    pub fn unit(&self, altitude_m: f64, mu_s: f64) -> [f64; 2] {
        let [warp, low, range] = self.sun_warp();
        let x = ((warp * height(mu_s)).asinh() - low) / range;
        [x.clamp(0.0, 1.0), (altitude_m / self.top_m).clamp(0.0, 1.0).sqrt()]
    }
}

/// 1 - √(1 - μ_s), without a difference.
fn height(mu_s: f64) -> f64 {
    mu_s / (1.0 + (1.0 - mu_s).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mapping::tests::assert_round_trip;

    fn mapping(radius_m: f64) -> MultipleScatteringMapping {
        MultipleScatteringMapping::new(&Planet { radius_m, atmosphere_height_m: 1e5, ground_albedo: [0.0; 3] })
    }

    #[test]
    fn texels_come_back_to_themselves() {
        for radius_m in [1e5, 6.36e6, 7e7] {
            let mapping = mapping(radius_m);
            assert_round_trip(|unit| mapping.parameters(unit), |[altitude_m, mu_s]| mapping.unit(altitude_m, mu_s));
        }
    }

    #[test]
    fn night_falls_sooner_on_larger_planets() {
        let lowest_deg = |radius_m: f64| mapping(radius_m).lowest_mu_s.asin().to_degrees();
        assert!((lowest_deg(6.36e6) + 20.0).abs() < 0.1, "on Earth the table ends at {}°", lowest_deg(6.36e6));
        assert!(lowest_deg(7e7) > -6.5);
        // Air as high as the planet is wide is lit all around.
        assert_eq!(lowest_deg(1e5), -90.0);
        // Of 48 texels the two next to the zenith are no farther apart than light that is scattered forward is wide.
        let [_, next] = mapping(6.36e6).parameters([46.0 / 47.0, 0.0]);
        assert!(next.acos().to_degrees() < 13.0);
        // Half of the texels lie where the sun is low.
        let [_, middle] = mapping(6.36e6).parameters([0.5, 0.0]);
        assert!(middle.asin().to_degrees().abs() < 9.0);
    }
}
