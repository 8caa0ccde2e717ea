//! Hills and mountains: a height above the sphere at every point of the ground, from integer-hashed noise.
//!
//! Octaves of value noise (Ebert et al. 2003, "Texturing and Modeling", chapter 2), folded into ridges and made weaker
//! where the ground is low, as in Musgrave's multifractals (the same, chapter 16). A point of the ground is named by
//! its (east, north) coordinates: those of the point of the smooth sphere below it, seen from straight above, in the
//! local frame. The shaders hold the same field in f32.

/// Octaves end where they are finer than this, m.
const FINEST_M: f64 = 6.0;
/// Most octaves.
const MOST_OCTAVES: u32 = 14;
/// Each octave turns by this cosine and sine against the one before, so that lattices do not line up.
const TURN: [f64; 2] = [0.8, 0.6];
/// Strength of an octave over that of the one before.
const GAIN: f64 = 0.5;
/// Least weight of an octave in low ground, and how fast it grows with height.
const SMOOTH_VALLEYS: [f64; 2] = [0.1, 1.3];
/// Mean of a folded octave: what stands for it where it is too fine to be seen.
pub const RIDGE_MEAN: f64 = 0.4467;
/// Slopes seldom exceed this times height over wavelength: 1 of 10⁴ points, sampled.
const SLOPE: f64 = 8.0;

/// One octave of noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Octave {
    /// From (east, north), m, to lattice cells: a matrix, row by row, 1/m.
    pub to_cells: [f64; 4],
    /// The lattice point of the origin.
    pub cell: [i32; 2],
    /// Where the origin lies in that cell, each in [0, 1[.
    pub fraction: [f64; 2],
    /// Size of a cell, m.
    pub wavelength_m: f64,
    /// Share of the field's height; all add up to 1.
    pub share: f64,
    /// Tells octaves and seeds apart.
    pub key: u32,
}

/// A height field.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightField {
    /// No point is higher than this above the sphere, nor lower than the sphere, m.
    pub height_m: f64,
    /// Distance between the largest hills, m.
    pub wavelength_m: f64,
    /// From the coarsest to the finest.
    pub octaves: Vec<Octave>,
}

/// Permuted congruential hash (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering", JCGT 9(3)).
fn hash(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// In [0, 1[, at a lattice point.
fn lattice_value(x: i32, y: i32, key: u32) -> f64 {
    let hashed = hash((x as u32).wrapping_add(hash((y as u32).wrapping_add(key))));
    f64::from(hashed >> 8) / f64::from(1 << 24)
}

/// A polynomial from 0 to 1 whose first and second derivatives vanish at both ends (Perlin 2002).
fn fade(x: f64) -> f64 {
    x * x * x * (x * (6.0 * x - 15.0) + 10.0)
}

/// How much of a wave is seen where one sample covers `footprint_m`: all of it from four samples a wave on, nothing
/// below two.
pub fn visible_share(wavelength_m: f64, footprint_m: f64) -> f64 {
    let octaves = (0.5 * wavelength_m / footprint_m.max(1e-9)).log2().clamp(0.0, 1.0);
    octaves * octaves * (3.0 - 2.0 * octaves)
}

impl HeightField {
    /// A field below `height_m` with its largest hills `wavelength_m` apart, of which the point `position_m` (east,
    /// north) lies at the origin.
    pub fn new(height_m: f64, wavelength_m: f64, seed: u32, position_m: [f64; 2]) -> Self {
        let count = ((wavelength_m / FINEST_M).log2().floor() as u32 + 1).clamp(1, MOST_OCTAVES);
        let all: f64 = (0..count).map(|i| GAIN.powi(i as i32)).sum();
        let mut rows = [1.0 / wavelength_m, 0.0, 0.0, 1.0 / wavelength_m];
        let mut octaves = Vec::new();
        for i in 0..count {
            let [a, b, c, d] = rows;
            let origin = [a * position_m[0] + b * position_m[1], c * position_m[0] + d * position_m[1]];
            octaves.push(Octave {
                to_cells: rows,
                cell: origin.map(|x| x.floor() as i64 as i32),
                fraction: origin.map(|x| x - x.floor()),
                wavelength_m: wavelength_m / f64::from(1 << i),
                share: GAIN.powi(i as i32) / all,
                key: hash(seed.wrapping_add(i)),
            });
            let [cosine, sine] = TURN;
            rows = [
                2.0 * (cosine * a - sine * c),
                2.0 * (cosine * b - sine * d),
                2.0 * (sine * a + cosine * c),
                2.0 * (sine * b + cosine * d),
            ];
        }
        Self { height_m, wavelength_m, octaves }
    }

    /// Height above the sphere at (east, north), in [0, `height_m`], m, as seen by samples that cover `footprint_m`:
    /// hills too small for them have their mean height, and where the largest are too small the sphere is smooth.
    pub fn height_at(&self, [east_m, north_m]: [f64; 2], footprint_m: f64) -> f64 {
        let (mut sum, mut strongest, mut weight) = (0.0, 0.0, 1.0);
        for octave in &self.octaves {
            let share = visible_share(octave.wavelength_m, footprint_m);
            let ridge = if share > 0.0 { octave.ridge(east_m, north_m) } else { 0.0 };
            sum += octave.share * weight * (RIDGE_MEAN + (ridge - RIDGE_MEAN) * share);
            strongest += octave.share;
            let [least, growth] = SMOOTH_VALLEYS;
            weight = least + (1.0 - least) * (growth * sum / strongest).min(1.0);
        }
        self.height_m * sum * visible_share(self.wavelength_m, footprint_m)
    }

    /// Slopes that hardly any point exceeds: how fast the ground may rise along a ray.
    pub fn steepest_slope(&self) -> f64 {
        SLOPE * self.height_m / self.wavelength_m
    }

    /// Gradient (towards east, towards north) by central differences over a distance.
    pub fn gradient_at(&self, [east_m, north_m]: [f64; 2], footprint_m: f64) -> [f64; 2] {
        let half = 0.5 * footprint_m;
        let difference = |east: f64, north: f64| {
            let ahead = self.height_at([east_m + east, north_m + north], footprint_m);
            (ahead - self.height_at([east_m - east, north_m - north], footprint_m)) / footprint_m
        };
        [difference(half, 0.0), difference(0.0, half)]
    }
}

impl Octave {
    /// Folded noise in [0, 1]: 1 on ridges.
    fn ridge(&self, east_m: f64, north_m: f64) -> f64 {
        let [a, b, c, d] = self.to_cells;
        let (x, y) = (a * east_m + b * north_m + self.fraction[0], c * east_m + d * north_m + self.fraction[1]);
        let (i, j) = (x.floor(), y.floor());
        let (u, v) = (fade(x - i), fade(y - j));
        let (i, j) = (self.cell[0].wrapping_add(i as i32), self.cell[1].wrapping_add(j as i32));
        let corner = |di: i32, dj: i32| lattice_value(i.wrapping_add(di), j.wrapping_add(dj), self.key);
        let low = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * u;
        let high = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * u;
        let folded = 1.0 - (2.0 * (low + (high - low) * v) - 1.0).abs();
        folded * folded
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(count: u32) -> impl Iterator<Item = [f64; 2]> {
        let coordinate = |i: u32| f64::from(hash(i) >> 8) / f64::from(1 << 24) * 4e5 - 2e5;
        (0..count).map(move |i| [coordinate(2 * i), coordinate(2 * i + 1)])
    }

    #[test]
    fn heights_keep_their_bounds_and_reach_well_into_them() {
        let field = HeightField::new(3000.0, 16_000.0, 3, [0.0; 2]);
        let heights: Vec<f64> = points(20_000).map(|at| field.height_at(at, 1.0)).collect();
        assert!(heights.iter().all(|height| (0.0..=3000.0).contains(height)));
        assert!(heights.iter().any(|height| *height > 2400.0) && heights.iter().any(|height| *height < 150.0));
    }

    #[test]
    fn slopes_steeper_than_stated_are_rarer_than_one_in_a_thousand() {
        let field = HeightField::new(3000.0, 16_000.0, 3, [0.0; 2]);
        let slope = |at: [f64; 2]| {
            let [east, north] = field.gradient_at(at, 2.0);
            east.hypot(north)
        };
        let steep = points(5000).filter(|&at| slope(at) > field.steepest_slope()).count();
        assert!(steep <= 5, "{steep} of 5000");
        assert!(points(5000).any(|at| slope(at) > 0.4 * field.steepest_slope()), "a bound that says something");
    }

    #[test]
    fn the_camera_moves_over_one_and_the_same_field() {
        let here = HeightField::new(2000.0, 9000.0, 11, [0.0; 2]);
        let there = HeightField::new(2000.0, 9000.0, 11, [-12_345.0, 6789.0]);
        for [east, north] in points(100) {
            let height = here.height_at([east, north], 1.0);
            let same = there.height_at([east + 12_345.0, north - 6789.0], 1.0);
            assert!((height - same).abs() < 1e-6, "{height} against {same}");
            // Negative control: a metre aside the height is another.
            assert!((height - here.height_at([east + 1.0, north], 1.0)).abs() > 1e-6);
        }
    }

    #[test]
    fn coarse_samples_see_the_mean_and_the_coarsest_a_smooth_sphere() {
        let field = HeightField::new(3000.0, 16_000.0, 3, [0.0; 2]);
        let mean = |footprint_m: f64| points(4000).map(|at| field.height_at(at, footprint_m)).sum::<f64>() / 4000.0;
        assert!((mean(1000.0) / mean(1.0) - 1.0).abs() < 0.1, "{} against {}", mean(1000.0), mean(1.0));
        assert_eq!(mean(1e5), 0.0);
    }
}
