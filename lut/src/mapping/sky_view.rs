//! The table of the sky seen from one point.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::Planet;

/// Half of the view sphere: each is a table of its own, so that no filter reaches across the horizon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SkyHalf {
    /// Directions that end in space.
    Sky,
    /// Directions that end on the ground.
    Ground,
}

/// (zenith angle, azimuth from the light) <-> unit coordinates, seen from one altitude.
///
/// x = azimuth / π: the sky is symmetric about the light's plane. y = √(angle from the horizon / its range) crowds texels
/// at the horizon from both sides. Seen from space the sky half ends at the limb of the air, not at the zenith. Within
/// the air y is stretched a little, so that the horizontal, where paths near the top have a kink, falls on a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkyViewMapping {
    /// Zenith angle of the horizon, rad.
    pub horizon_rad: f64,
    /// Zenith angle at which the sky half ends: 0, or that of the air's limb, rad.
    pub sky_end_rad: f64,
    /// Where the horizontal lies in the sky half before and after the stretch, both in ]0, 1[.
    pub horizontal_y: [f64; 2],
}

impl SkyViewMapping {
    /// The view from an altitude ≥ 0, m, in a table of so many rows.
    pub fn new(planet: &Planet, altitude_m: f64, rows: u32) -> Self {
        // Seen from r, a sphere of radius s has the angular radius asin(s / r) about the nadir; in the form of an
        // arc tangent it keeps its digits when s is close to r.
        let angular_radius = |shell_m: f64| {
            let (r, s) = (planet.radius_m + altitude_m, planet.radius_m + shell_m);
            let leg = ((altitude_m - shell_m) * (r + s)).max(0.0).sqrt();
            s.atan2(leg)
        };
        let outside = altitude_m > planet.atmosphere_height_m;
        let sky_end_rad = if outside { PI - angular_radius(planet.atmosphere_height_m) } else { 0.0 };
        let horizon_rad = PI - angular_radius(0.0);
        let horizontal = ((horizon_rad - FRAC_PI_2) / horizon_rad).max(0.0).sqrt();
        let last_row = f64::from(rows - 1);
        let snapped = (horizontal * last_row).round() / last_row;
        // From the ground the horizontal is the horizon; from space it is not in the table.
        let has_horizontal = !outside && snapped > 0.0 && snapped < 1.0;
        let horizontal_y = if has_horizontal { [horizontal, snapped] } else { [0.5; 2] };
        Self { horizon_rad, sky_end_rad, horizontal_y }
    }

    /// Which half a direction belongs to.
    pub fn half(&self, zenith_rad: f64) -> SkyHalf {
        if zenith_rad > self.horizon_rad { SkyHalf::Ground } else { SkyHalf::Sky }
    }

    fn end_rad(&self, half: SkyHalf) -> f64 {
        match half {
            SkyHalf::Sky => self.sky_end_rad,
            SkyHalf::Ground => PI,
        }
    }

    /// (zenith angle, azimuth from the light), rad, at unit coordinates.
    pub fn parameters(&self, unit: [f64; 2], half: SkyHalf) -> [f64; 2] {
        let [natural, snapped] = self.horizontal_y;
        let y = match half {
            SkyHalf::Sky => stretched(unit[1], snapped, natural),
            SkyHalf::Ground => unit[1],
        };
        let zenith_rad = self.horizon_rad + (self.end_rad(half) - self.horizon_rad) * y * y;
        [zenith_rad, PI * unit[0]]
    }

    /// Unit coordinates of a zenith angle and an azimuth from the light, rad, clamped to the table.
    pub fn unit(&self, zenith_rad: f64, azimuth_rad: f64, half: SkyHalf) -> [f64; 2] {
        let y2 = (zenith_rad - self.horizon_rad) / (self.end_rad(half) - self.horizon_rad);
        let y = y2.clamp(0.0, 1.0).sqrt();
        let [natural, snapped] = self.horizontal_y;
        let y = match half {
            SkyHalf::Sky => stretched(y, natural, snapped),
            SkyHalf::Ground => y,
        };
        [(azimuth_rad / PI).clamp(0.0, 1.0), y]
    }
}

/// [0, 1] onto itself, linear on both sides of `from`, which goes to `to`.
fn stretched(y: f64, from: f64, to: f64) -> f64 {
    if y < from { y * to / from } else { 1.0 - (1.0 - y) * (1.0 - to) / (1.0 - from) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mapping::tests::assert_round_trip;

    fn earth() -> Planet {
        Planet { radius_m: 6_360_000.0, atmosphere_height_m: 100_000.0, ground_albedo: [0.3; 3] }
    }

    #[test]
    fn texels_come_back_to_themselves_at_every_altitude() {
        for altitude_m in [0.0, 1e-3, 2.0, 500.0, 99_999.0, 100_001.0, 400_000.0, 3.8e8] {
            let mapping = SkyViewMapping::new(&earth(), altitude_m, 96);
            for half in [SkyHalf::Sky, SkyHalf::Ground] {
                assert_round_trip(
                    |unit| mapping.parameters(unit, half),
                    |[zenith_rad, azimuth_rad]| mapping.unit(zenith_rad, azimuth_rad, half),
                );
            }
        }
    }

    #[test]
    fn the_horizon_lies_at_ninety_degrees_on_the_ground_and_dips_with_altitude() {
        assert!((SkyViewMapping::new(&earth(), 0.0, 96).horizon_rad - PI / 2.0).abs() < 1e-15);
        let mapping = SkyViewMapping::new(&earth(), 400_000.0, 96);
        let exact = PI - (6_360_000.0_f64 / 6_760_000.0).asin();
        assert!((mapping.horizon_rad - exact).abs() < 1e-12);
        assert!(mapping.sky_end_rad < mapping.horizon_rad);
    }

    #[test]
    fn high_in_the_air_a_row_looks_exactly_along_the_horizontal() {
        let rows = 96;
        let mapping = SkyViewMapping::new(&earth(), 99_999.0, rows);
        let row = mapping.unit(PI / 2.0, 0.0, SkyHalf::Sky)[1] * f64::from(rows - 1);
        assert!(row > 1.0 && (row - row.round()).abs() < 1e-9, "{row}");
    }
}
