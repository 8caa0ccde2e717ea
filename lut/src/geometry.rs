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

/// Length of a view ray's part below the shell at `shell_m`, also when it starts above; `hits_ground` says whether the
/// ray meets the ground.
pub fn air_length_m(radius_m: f64, shell_m: f64, altitude_m: f64, mu: f64, hits_ground: bool) -> f64 {
    let sine = (radius_m + altitude_m) / (radius_m + shell_m) * (1.0 - mu * mu).max(0.0).sqrt();
    let in_space = altitude_m > shell_m;
    if in_space && (mu >= 0.0 || sine >= 1.0) {
        return 0.0;
    }
    let start_m = altitude_m.min(shell_m);
    let start_mu = if in_space { -(1.0 - sine * sine).max(0.0).sqrt() } else { mu };
    match hits_ground {
        true => grazing_distance_m(radius_m, start_m, start_mu, 0.0),
        false => distance_to_shell_from_below(radius_m, start_m, start_mu, shell_m),
    }
}

/// Distance to the nearer intersection with a sphere below the ray's start, which the caller knows that the ray meets: a
/// discriminant that rounding made negative counts as grazing.
pub fn grazing_distance_m(radius_m: f64, altitude_m: f64, mu: f64, shell_m: f64) -> f64 {
    let gap = (altitude_m - shell_m) * (2.0 * radius_m + shell_m + altitude_m);
    let b = (radius_m + altitude_m) * mu;
    let discriminant = (b * b - gap).max(0.0);
    gap / (discriminant.sqrt() - b).max(gap.max(0.0).sqrt()).max(f64::MIN_POSITIVE)
}

/// The part of a ray on the side of the planet's centre away from the light, where r mu_s + t nu < 0, as distances [start, end]
/// of the whole line, m; `r` is the distance of its start from the centre. A ray across the light stays on its side.
fn side_away_m(r: f64, mu_s: f64, nu: f64) -> [f64; 2] {
    let crossing_m = -r * mu_s / if nu.abs() < 1e-20 { 1e-20 } else { nu };
    if nu > -1e-20 { [f64::NEG_INFINITY, crossing_m] } else { [crossing_m, f64::INFINITY] }
}

/// The part of a ray inside the planet's shadow in parallel light, as distances (start, end) in [0, length]; start ≥ end
/// where it is lit all along. `mu_s` is the cosine of the light's zenith angle, `nu` that of the angle to the light.
///
/// The shadow is a half-infinite cylinder, a convex set: a ray meets it in one interval, whose ends solve
/// |p_perp(t)|² = R² with p_perp the position's part normal to the light.
pub fn shadow_interval_m(radius_m: f64, altitude_m: f64, [mu, mu_s, nu]: [f64; 3], length_m: f64) -> [f64; 2] {
    const LIT: [f64; 2] = [1.0, 0.0];
    let r = radius_m + altitude_m;
    let sin2_nu = 1.0 - nu * nu;
    let half_b = r * (mu - nu * mu_s);
    let c = altitude_m * (2.0 * radius_m + altitude_m) - r * r * mu_s * mu_s;
    if sin2_nu < 1e-12 {
        // Along the light's axis: all of the ray is inside the cylinder or none.
        return if c < 0.0 && mu_s < 0.0 { [0.0, length_m] } else { LIT };
    }
    let discriminant = half_b * half_b - sin2_nu * c;
    if discriminant <= 0.0 {
        return LIT;
    }
    // Stable quadratic roots: the smaller in magnitude through the product of both.
    let q = -(half_b + discriminant.sqrt().copysign(half_b));
    let first = q / sin2_nu;
    let second = if q == 0.0 { first } else { c / q };
    let (mut start, mut end) = (first.min(second), first.max(second));
    let [dark_from, dark_to] = side_away_m(r, mu_s, nu);
    (start, end) = (start.max(dark_from), end.min(dark_to));
    [start.max(0.0), end.min(length_m)]
}

/// Distance at which a ray passes closest to the axis of the planet's shadow on the side away from the light, m, in [0, length];
/// an end of the ray where none of it lies there.
pub fn closest_to_shadow_m(radius_m: f64, altitude_m: f64, [mu, mu_s, nu]: [f64; 3], length_m: f64) -> f64 {
    let r = radius_m + altitude_m;
    let closest_m = r * (nu * mu_s - mu) / (1.0 - nu * nu).max(1e-12);
    let [dark_from, dark_to] = side_away_m(r, mu_s, nu);
    closest_m.clamp(dark_from, dark_to).clamp(0.0, length_m)
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

    #[test]
    fn rays_that_miss_the_shadow_are_farther_from_its_axis_before_and_after_they_are_closest() {
        let (altitude_m, [mu, mu_s, nu], length_m) = (105_600.0, [-0.16, -0.1045, 0.2], 2e6);
        assert_eq!(shadow_interval_m(EARTH_M, altitude_m, [mu, mu_s, nu], length_m), [1.0, 0.0]);
        let closest_m = closest_to_shadow_m(EARTH_M, altitude_m, [mu, mu_s, nu], length_m);
        // Squared distance from the axis: r² less the part along the light.
        let axis_m2 = |t: f64| {
            let r = EARTH_M + altitude_m;
            r * r + t * t + 2.0 * r * t * mu - (r * mu_s + t * nu).powi(2)
        };
        assert!(closest_m > 0.0 && closest_m < length_m);
        assert!([-1e4, 1e4].iter().all(|way_m| axis_m2(closest_m + way_m) > axis_m2(closest_m)));
        // Towards the light nothing is behind the planet.
        assert_eq!(closest_to_shadow_m(EARTH_M, 0.0, [0.0, 0.5, 0.8], length_m), 0.0);
    }

    #[test]
    fn where_a_ray_is_closest_to_the_shadow_does_not_jump_as_the_sun_sets() {
        // Half away from the sun, downwards past the limb, from 62 km.
        let (altitude_m, view_rad, length_m) = (62_000.0, 97f64.to_radians(), 1.5e6);
        let closest_m = |sun_deg: f64| {
            let sun_rad = sun_deg.to_radians();
            let nu = view_rad.cos() * sun_rad.cos() + view_rad.sin() * sun_rad.sin() * 120f64.to_radians().cos();
            let directions = [view_rad.cos(), sun_rad.cos(), nu];
            closest_to_shadow_m(EARTH_M, altitude_m, directions, length_m)
        };
        let suns_deg: Vec<_> = (0..=1000).map(|step| 80.0 + 0.02 * f64::from(step)).collect();
        let at_m: Vec<_> = suns_deg.iter().map(|sun| closest_m(*sun)).collect();
        // The terminator moves by the radius times the sun's step, and along a ray that is aslant to it a few times as far; where
        // only rays count that are closest behind it, the place jumps by half of the planet's radius.
        let step_m = 0.02f64.to_radians() * (EARTH_M + altitude_m);
        assert!(at_m.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 4.0 * step_m), "{at_m:?}");
        assert!(at_m[0] == length_m && at_m[500] < 0.8 * length_m, "the place moves: {} {}", at_m[0], at_m[500]);
    }
}
