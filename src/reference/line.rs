//! A straight ray over a planet or over a plane, as altitude against distance.

/// A ray from altitude h₀ along the zenith cosine μ. Distances are metres from its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Radius of the planet, m; infinite over a plane.
    radius_m: f64,
    /// h₀, m.
    altitude_m: f64,
    /// μ.
    cosine: f64,
    /// Signed distance from the point of closest approach to the start, (R + h₀) μ; unused over a plane.
    from_lowest_m: f64,
}

impl Line {
    /// A ray that starts at `altitude_m` and has the zenith cosine `cosine` there. `radius_m` may be infinite.
    pub fn new(radius_m: f64, altitude_m: f64, cosine: f64) -> Self {
        Self { radius_m, altitude_m, cosine, from_lowest_m: (radius_m + altitude_m) * cosine }
    }

    fn is_flat(&self) -> bool {
        self.radius_m == f64::INFINITY
    }

    /// Altitude after a distance, m.
    pub fn altitude(&self, t_m: f64) -> f64 {
        if self.is_flat() {
            return self.altitude_m + t_m * self.cosine;
        }
        let r = self.radius_m + self.altitude_m;
        let growth = t_m * (t_m + 2.0 * self.from_lowest_m);
        // r' - r = (r'² - r²) / (r' + r): no two radii are subtracted.
        self.altitude_m + growth / ((r * r + growth).max(0.0).sqrt() + r)
    }

    /// Distance to the point of closest approach when it lies ahead, else 0, m. Infinite for a descent over a plane.
    pub fn lowest(&self) -> f64 {
        match (self.is_flat(), self.cosine < 0.0) {
            (_, false) => 0.0,
            (true, true) => f64::INFINITY,
            (false, true) => -self.from_lowest_m,
        }
    }

    /// r_b² - r_lowest² for a shell at an altitude: the squared half chord inside it, negative when the line misses.
    fn half_chord_squared(&self, shell_m: f64) -> (f64, f64) {
        let gap = (shell_m - self.altitude_m) * (2.0 * self.radius_m + shell_m + self.altitude_m);
        (gap, self.from_lowest_m * self.from_lowest_m + gap)
    }

    /// Distance at which the line last crosses an altitude, on its way up; negative when that lies behind the start.
    /// `None` when the line never falls as low, infinite when it never rises as high.
    pub fn rise(&self, shell_m: f64) -> Option<f64> {
        if self.is_flat() {
            let t = (shell_m - self.altitude_m) / self.cosine;
            return Some(if self.cosine > 0.0 { t } else { f64::INFINITY });
        }
        let (gap, squared) = self.half_chord_squared(shell_m);
        if squared < 0.0 {
            return None;
        }
        let root = squared.sqrt();
        let b = self.from_lowest_m;
        Some(if b > 0.0 { gap / (root + b) } else { root - b })
    }

    /// Distance at which a descending line first crosses an altitude at or below its start. `None` when it rises or
    /// turns before.
    pub fn fall(&self, shell_m: f64) -> Option<f64> {
        if self.cosine >= 0.0 {
            return None;
        }
        if self.is_flat() {
            return Some((shell_m - self.altitude_m) / self.cosine);
        }
        let (gap, squared) = self.half_chord_squared(shell_m);
        (squared >= 0.0).then(|| -gap / (squared.sqrt() - self.from_lowest_m))
    }
}

#[cfg(test)]
mod tests {
    use super::Line;

    #[test]
    fn crossings_lie_on_the_altitude_they_were_asked_for() {
        for radius in [6.36e6, 1e5, f64::INFINITY] {
            for (start, cosine) in [(0.0, 0.3), (500.0, 1e-9), (5000.0, -0.002), (5000.0, -1.0), (99_999.0, -0.12)] {
                let line = Line::new(radius, start, cosine);
                for shell in [0.0, 1e-3, 4990.0, 20_000.0, 100_000.0] {
                    for t in [line.rise(shell), line.fall(shell)].into_iter().flatten().filter(|t| t.is_finite()) {
                        let reached = line.altitude(t);
                        assert!((reached - shell).abs() < 1e-7, "{radius} {start} {cosine}: {reached} for {shell}");
                    }
                }
            }
        }
    }
}
