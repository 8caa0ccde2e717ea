//! The slices of the froxels: how far along a ray each of them stands.

/// Distance along a ray <-> unit coordinate of its slices.
///
/// The ray is cut at its lowest point, where air is densest, and distances from there grow with the square of the
/// coordinate on either side. Where it is cut in the coordinate follows from the lengths: w_low = √l / (√l + √(D - l))
/// with l the distance of the lowest point and D the length of the ray. All of it changes smoothly from ray to ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliceMapping {
    /// The ray's length inside the air, above 0, m.
    pub length_m: f64,
    /// Distance of the ray's lowest point, from 0 to the length, m.
    pub lowest_m: f64,
}

impl SliceMapping {
    fn lowest_unit(&self) -> f64 {
        let (descent, ascent) = (self.lowest_m.sqrt(), (self.length_m - self.lowest_m).sqrt());
        descent / (descent + ascent)
    }

    /// Distance at a unit coordinate, m.
    pub fn distance_m(&self, unit: f64) -> f64 {
        let low = self.lowest_unit();
        if unit < low {
            let v = 1.0 - unit / low;
            return self.lowest_m * (1.0 - v * v);
        }
        let v = (unit - low) / (1.0 - low).max(f64::MIN_POSITIVE);
        self.lowest_m + (self.length_m - self.lowest_m) * v * v
    }

    /// Unit coordinate of a distance from 0 to the length, m.
    pub fn unit(&self, distance_m: f64) -> f64 {
        let low = self.lowest_unit();
        if distance_m < self.lowest_m {
            return low * (1.0 - (1.0 - distance_m / self.lowest_m).sqrt());
        }
        let rest = (self.length_m - self.lowest_m).max(f64::MIN_POSITIVE);
        low + (1.0 - low) * ((distance_m - self.lowest_m) / rest).clamp(0.0, 1.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_come_back_to_themselves_and_grow_with_the_coordinate() {
        for (length_m, lowest_m) in [(1e6, 0.0), (1e6, 1e6), (1.4e6, 3.6e5), (10.0, 0.1)] {
            let slices = SliceMapping { length_m, lowest_m };
            assert_eq!(slices.distance_m(0.0), 0.0);
            assert!((slices.distance_m(1.0) - length_m).abs() < 1e-9 * length_m);
            let mut before = -1.0;
            for i in 0..=100 {
                let unit = f64::from(i) / 100.0;
                let distance_m = slices.distance_m(unit);
                assert!(distance_m > before && (slices.unit(distance_m) - unit).abs() < 1e-7);
                before = distance_m;
            }
        }
    }

    #[test]
    fn slices_crowd_at_the_lowest_point() {
        let slices = SliceMapping { length_m: 1e6, lowest_m: 3e5 };
        let step = |distance_m: f64| slices.distance_m(slices.unit(distance_m) + 0.01) - distance_m;
        assert!(step(3e5) < 0.1 * step(1e5) && step(3e5) < 0.1 * step(7e5));
    }
}
