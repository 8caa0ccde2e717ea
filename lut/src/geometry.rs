//! Altitude-first geometry: a point near a planet is its altitude h and a direction is the cosine μ of its zenith
//! angle, because r² - R² loses the metres near the ground in the rounding of r² while h(2R + h) does not.
//!
//! All lengths are metres. `radius_m` is the planet's R; a ray starts at altitude `h` ≥ 0 and travels along μ.

/// Cosine of the zenith angle of the horizon seen from altitude h: rays with smaller μ hit the ground.
pub fn horizon_mu(radius_m: f64, altitude_m: f64) -> f64 {
    let r = radius_m + altitude_m;
    -(altitude_m.max(0.0) * (2.0 * radius_m + altitude_m)).sqrt() / r
}

/// Altitude after a distance along a ray.
///
/// With r'² = r² + d² + 2rdμ the difference h' - h is (d² + 2rdμ) / (r' + r), in which no radii are subtracted.
pub fn altitude_along(radius_m: f64, altitude_m: f64, mu: f64, distance_m: f64) -> f64 {
    let r = radius_m + altitude_m;
    let growth = distance_m * (distance_m + 2.0 * r * mu);
    altitude_m + growth / ((r * r + growth).max(0.0).sqrt() + r)
}

/// Distance to a sphere at `shell_m` above the ground, seen from inside it: the one positive root.
///
/// A start above the shell counts as lying on it: zero upwards, the chord downwards.
pub fn distance_to_shell_from_below(radius_m: f64, altitude_m: f64, mu: f64, shell_m: f64) -> f64 {
    let r = radius_m + altitude_m;
    let gap = ((shell_m - altitude_m) * (2.0 * radius_m + shell_m + altitude_m)).max(0.0);
    let b = r * mu;
    let root = (b * b + gap).sqrt();
    // The form without cancellation on either side of the horizontal.
    if b > 0.0 { gap / (root + b) } else { root - b }
}

/// Distance to the nearer intersection with a sphere at `shell_m` below the ray's start, or `None` when it misses.
pub fn distance_to_shell_from_above(radius_m: f64, altitude_m: f64, mu: f64, shell_m: f64) -> Option<f64> {
    let r = radius_m + altitude_m;
    let gap = (altitude_m - shell_m) * (2.0 * radius_m + shell_m + altitude_m);
    let b = r * mu;
    let discriminant = b * b - gap;
    if b > 0.0 || discriminant < 0.0 {
        return None;
    }
    // gap / (√ - b) is the nearer root -b - √ without cancellation.
    Some(gap / (discriminant.sqrt() - b))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EARTH_M: f64 = 6_360_000.0;

    #[test]
    fn one_metre_above_the_ground_the_horizon_is_at_its_known_distance() {
        // d = √(h (2R + h)); the naive r² - R² in f32 is off by per cents here.
        let distance = distance_to_shell_from_above(EARTH_M, 1.0, horizon_mu(EARTH_M, 1.0) - 1e-15, 0.0).unwrap();
        let exact = (1.0 * (2.0 * EARTH_M + 1.0)).sqrt();
        assert!((distance / exact - 1.0).abs() < 1e-3, "{distance} against {exact}");
    }

    #[test]
    fn a_ray_that_reaches_a_shell_is_at_that_altitude() {
        for altitude in [0.0, 1e-3, 2.0, 500.0, 99_999.0] {
            for i in 0..=100 {
                let mu = horizon_mu(EARTH_M, altitude) * (1.0 - 1e-12) + f64::from(i) / 100.0;
                let distance = distance_to_shell_from_below(EARTH_M, altitude, mu.min(1.0), 100_000.0);
                let reached = altitude_along(EARTH_M, altitude, mu.min(1.0), distance);
                assert!((reached - 100_000.0).abs() < 1e-6, "from {altitude} along {mu}: {reached}");
            }
        }
    }

    #[test]
    fn straight_down_the_ground_is_as_far_as_the_altitude() {
        for altitude in [0.0, 1e-3, 1.0, 500.0, 400_000.0, 3.8e8] {
            let distance = distance_to_shell_from_above(EARTH_M, altitude, -1.0, 0.0).unwrap();
            assert!((distance - altitude).abs() <= 1e-12 * (EARTH_M + altitude), "{distance} from {altitude}");
        }
    }
}
