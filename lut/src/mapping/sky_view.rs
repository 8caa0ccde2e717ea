//! The table of the sky seen from one point.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::Planet;

/// Share of the air's height above its top over which rows gather on the air.
const SPREAD: f64 = 0.3;

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
/// at the horizon from both sides.
///
/// Seen from space the sky half ends at the limb of the air, not at the zenith. Just above the top the limb lies where
/// the horizontal lay just below it, and from there rows gather on the air as the observer climbs: nothing jumps where
/// the observer crosses the top. Rows beyond the limb look half a row inside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkyViewMapping {
    /// Zenith angle of the horizon, rad.
    pub horizon_rad: f64,
    /// Zenith angle at which the sky half ends: 0, or that of the air's limb, rad.
    pub sky_end_rad: f64,
    /// y at `sky_end_rad`; 1 from within the air.
    pub sky_end_y: f64,
    /// Highest y at which the sky half's table is filled with a view of its own.
    pub last_y: f64,
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
        let top_m = planet.atmosphere_height_m;
        let horizon_rad = PI - angular_radius(0.0);
        if altitude_m <= top_m {
            return Self::within_air(horizon_rad);
        }
        // At the top: the horizon's dip over its zenith angle.
        let dip_rad = (planet.radius_m / (planet.radius_m + top_m)).acos();
        let crossing_y = (dip_rad / (FRAC_PI_2 + dip_rad)).sqrt();
        let spread = -((top_m - altitude_m) / (SPREAD * top_m)).exp_m1();
        let sky_end_y = crossing_y + (1.0 - crossing_y) * spread;
        let last_y = sky_end_y - 0.5 / f64::from(rows - 1);
        Self { horizon_rad, sky_end_rad: PI - angular_radius(top_m), sky_end_y, last_y }
    }

    /// The view of an observer in the air whose horizon has this zenith angle, rad.
    pub fn within_air(horizon_rad: f64) -> Self {
        Self { horizon_rad, sky_end_rad: 0.0, sky_end_y: 1.0, last_y: 1.0 }
    }

    /// Which half a direction belongs to.
    pub fn half(&self, zenith_rad: f64) -> SkyHalf {
        if zenith_rad > self.horizon_rad { SkyHalf::Ground } else { SkyHalf::Sky }
    }

    /// Zenith angle at which a half ends, and y there.
    fn end(&self, half: SkyHalf) -> (f64, f64) {
        match half {
            SkyHalf::Sky => (self.sky_end_rad, self.sky_end_y),
            SkyHalf::Ground => (PI, 1.0),
        }
    }

    /// (zenith angle, azimuth from the light), rad, at unit coordinates.
    pub fn parameters(&self, unit: [f64; 2], half: SkyHalf) -> [f64; 2] {
        let (end_rad, end_y) = self.end(half);
        let last_y = if half == SkyHalf::Sky { self.last_y } else { 1.0 };
        let y = unit[1].min(last_y) / end_y;
        [self.horizon_rad + (end_rad - self.horizon_rad) * y * y, PI * unit[0]]
    }

    /// Unit coordinates of a zenith angle and an azimuth from the light, rad, clamped to the table.
    pub fn unit(&self, zenith_rad: f64, azimuth_rad: f64, half: SkyHalf) -> [f64; 2] {
        let (end_rad, end_y) = self.end(half);
        let y2 = (zenith_rad - self.horizon_rad) / (end_rad - self.horizon_rad);
        [(azimuth_rad / PI).clamp(0.0, 1.0), end_y * y2.clamp(0.0, 1.0).sqrt()]
    }
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
                let last_y = if half == SkyHalf::Sky { mapping.last_y } else { 1.0 };
                // Rows beyond the limb stand for the last view inside it.
                assert_round_trip(
                    |unit| mapping.parameters([unit[0], unit[1] * last_y], half),
                    |[zenith_rad, azimuth_rad]| {
                        let unit = mapping.unit(zenith_rad, azimuth_rad, half);
                        [unit[0], unit[1] / last_y]
                    },
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
    fn rows_stay_where_they_are_as_the_observer_crosses_the_top() {
        let rows_at = |altitude_m: f64| {
            let mapping = SkyViewMapping::new(&earth(), altitude_m, 96);
            [95.0, 92.0, 91.0].map(|zenith_deg: f64| mapping.unit(zenith_deg.to_radians(), 0.0, SkyHalf::Sky)[1])
        };
        let (below, above) = (rows_at(100_000.0), rows_at(100_000.1));
        for (below, above) in below.into_iter().zip(above) {
            // The limb lies √(2 d / R) below the horizontal, 0.01 degrees for these 0.1 m.
            assert!((below - above).abs() < 1e-3, "{below} and {above}");
        }
        // Negative control: from far above the air has nearly all rows.
        assert!((rows_at(400_000.0)[0] - below[0]).abs() > 0.1);
    }
}
