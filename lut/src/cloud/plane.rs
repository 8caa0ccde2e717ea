//! Where a point above a sphere lies on the flat map that clouds are drawn on.
//!
//! The map is Lambert's azimuthal equal-area projection around the local frame's origin: a point whose radius makes
//! the angle θ with the origin's lies at the distance 2R sin(θ/2) from the map's centre, in its own direction. Near the
//! origin that is east and north in metres; areas, and so the share of the sky that is covered, are kept as far as the
//! antipode. Lengths grow by at most 1 / cos(θ/2): 2 % at 2200 km, the horizon from 400 km.

/// East and north on the map, m, of a point (east, north, up from the origin) above a sphere of this radius.
pub fn to_map(radius_m: f64, [x, y, z]: [f64; 3]) -> [f64; 2] {
    let up = radius_m + z;
    let r = (x * x + y * y + up * up).sqrt();
    if r == 0.0 {
        return [0.0; 2];
    }
    // √(2 / (1 + cos θ)) = 1 / cos(θ/2), times sin θ.
    let scale = radius_m * (2.0 / (r * (r + up)).max(f64::MIN_POSITIVE)).sqrt();
    [x * scale, y * scale]
}

#[cfg(test)]
mod tests {
    use super::*;

    const EARTH_M: f64 = 6_371_000.0;

    #[test]
    fn near_the_origin_the_map_is_metres_on_the_ground() {
        let [east, north] = to_map(EARTH_M, [3000.0, -4000.0, -2.0]);
        assert!((east - 3000.0).abs() < 0.01 && (north + 4000.0).abs() < 0.01, "{east} {north}");
    }

    #[test]
    fn areas_are_kept_and_a_column_is_one_point() {
        for angle in [0.01_f64, 0.3, 1.5, 3.0] {
            let at = |r: f64, angle: f64| to_map(EARTH_M, [r * angle.sin(), 0.0, r * angle.cos() - EARTH_M])[0];
            // A zone's area 2πR² (1 - cos θ) is a disc's on the map.
            let radius = at(EARTH_M, angle);
            let zone = 2.0 * EARTH_M * EARTH_M * (1.0 - angle.cos());
            assert!((radius * radius / zone - 1.0).abs() < 1e-9, "{angle}");
            assert!((at(EARTH_M + 8000.0, angle) / radius - 1.0).abs() < 1e-9);
        }
    }
}
