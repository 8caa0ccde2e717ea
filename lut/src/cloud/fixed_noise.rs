//! Gradient and cellular noise in whole numbers, so that every device makes the same bytes.
//!
//! Positions count 256ths of a cell, values 4096ths; no step exceeds 32 bits. The shaders' module `cloud_noise` has the
//! same functions.

/// The value that stands for 1.
pub const ONE: i32 = 4096;

/// 32 well-mixed bits of a cell: the multipliers of Teschner et al. 2003, then the finaliser `lowbias32` (Wellons 2018).
pub fn hash(x: i32, y: i32, z: i32, seed: u32) -> u32 {
    let cell = (x as u32).wrapping_mul(73_856_093)
        ^ (y as u32).wrapping_mul(19_349_663)
        ^ (z as u32).wrapping_mul(83_492_791)
        ^ seed.wrapping_mul(0x9e37_79b9);
    let mut h = cell;
    h = (h ^ (h >> 16)).wrapping_mul(0x7feb_352d);
    h = (h ^ (h >> 15)).wrapping_mul(0x846c_a68b);
    h ^ (h >> 16)
}

/// 6t⁵ - 15t⁴ + 10t³ (Perlin 2002) of t in 256ths.
fn fade(t: i32) -> i32 {
    let cube = (t * t * t) >> 12;
    let rest = (6 * t * t - 15 * 256 * t + 10 * 65_536) >> 4;
    (cube * rest) >> 12
}

fn lerp(a: i32, b: i32, weight: i32) -> i32 {
    a + (((b - a) * weight) >> 12)
}

/// The offset's component along one of Perlin's twelve gradients, four of them twice.
fn along_gradient(hash: u32, [x, y, z]: [i32; 3]) -> i32 {
    let h = hash & 15;
    let u = if h < 8 { x } else { y };
    let v = match h {
        0..4 => y,
        12 | 14 => x,
        _ => z,
    };
    let signed = |value: i32, minus: bool| if minus { -value } else { value };
    16 * (signed(u, h & 1 != 0) + signed(v, h & 2 != 0))
}

/// Gradient noise (Perlin 2002) that repeats after `cells`, a power of two; about -1 to 1.
pub fn perlin(position: [i32; 3], cells: i32, seed: u32) -> i32 {
    let wrap = cells - 1;
    let cell = position.map(|p| p >> 8);
    let share = position.map(|p| p & 255);
    let corner = |i: i32, j: i32, k: i32| {
        let bits = hash((cell[0] + i) & wrap, (cell[1] + j) & wrap, (cell[2] + k) & wrap, seed);
        along_gradient(bits, [share[0] - 256 * i, share[1] - 256 * j, share[2] - 256 * k])
    };
    let [wx, wy, wz] = share.map(fade);
    let along_x = |j: i32, k: i32| lerp(corner(0, j, k), corner(1, j, k), wx);
    let along_y = |k: i32| lerp(along_x(0, k), along_x(1, k), wy);
    lerp(along_y(0), along_y(1), wz)
}

/// Octaves of gradient noise, each with twice the cells and half the amplitude of the one before.
pub fn perlin_octaves(position: [i32; 3], cells: i32, octaves: u32, seed: u32) -> i32 {
    (0..octaves).map(|o| perlin(position.map(|p| p << o), cells << o, seed + o) >> o).sum()
}

/// The largest whole number whose square is at most `x`, for x below 2²⁸, where f64 is exact.
pub fn whole_root(x: i32) -> i32 {
    f64::from(x).sqrt() as i32
}

/// Cellular noise (Worley 1996) that repeats after `cells`, a power of two: 1 at a cell's point, falling to 0 at the
/// distance of one cell from the nearest.
#[derive(Debug, Clone)]
pub struct Worley {
    cells: i32,
    /// The point of each cell, in 256ths of it.
    points: Vec<[i32; 3]>,
}

impl Worley {
    /// One point in each cell.
    pub fn new(cells: i32, seed: u32) -> Self {
        let cell = |i: i32| [i % cells, i / cells % cells, i / (cells * cells)];
        let point = |[x, y, z]: [i32; 3]| {
            let bits = hash(x, y, z, seed) as i32;
            [bits & 255, (bits >> 8) & 255, (bits >> 16) & 255]
        };
        Self { cells, points: (0..cells * cells * cells).map(|i| point(cell(i))).collect() }
    }

    /// The noise at a position.
    pub fn at(&self, position: [i32; 3]) -> i32 {
        let (wrap, n) = (self.cells - 1, self.cells as usize);
        let cell = position.map(|p| p >> 8);
        let share = position.map(|p| p & 255);
        let square = |a: i32| a * a;
        let mut nearest = i32::MAX;
        for k in -1..=1 {
            let slice = ((cell[2] + k) & wrap) as usize * n;
            for j in -1..=1 {
                let row = (slice + ((cell[1] + j) & wrap) as usize) * n;
                for i in -1..=1 {
                    let point = self.points[row + ((cell[0] + i) & wrap) as usize];
                    let apart = square(256 * i + point[0] - share[0])
                        + square(256 * j + point[1] - share[1])
                        + square(256 * k + point[2] - share[2]);
                    nearest = nearest.min(apart);
                }
            }
        }
        // Distances are in 256ths: their squares times 256 have roots in 4096ths.
        (ONE - whole_root(nearest << 8)).max(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_continuous_and_repeats() {
        let worley = Worley::new(4, 7);
        for i in 0..1024 {
            let at = |x: i32| [x, 300, 511];
            let steps = [perlin(at(i), 4, 3) - perlin(at(i + 1), 4, 3), worley.at(at(i)) - worley.at(at(i + 1))];
            // A 256th of a cell: the steepest gradient of either is below 4 per cell.
            assert!(steps.iter().all(|step| step.abs() <= 4 * ONE / 256 + 4), "{i}: {steps:?}");
            assert_eq!(perlin(at(i), 4, 3), perlin(at(i + 1024), 4, 3));
            assert_eq!(worley.at(at(i)), worley.at(at(i + 1024)));
        }
    }

    #[test]
    fn gradient_noise_vanishes_at_the_corners_of_cells_and_is_even_around_zero() {
        assert!((0..64).all(|i| perlin([256 * i, 512, 0], 64, 1) == 0));
        let mean: f64 = (0..50_000).map(|i| f64::from(perlin([i * 37, i * 101, i * 13], 64, 1))).sum::<f64>() / 5e4;
        assert!(mean.abs() < 0.01 * f64::from(ONE), "{mean}");
    }

    #[test]
    fn roots_are_the_whole_part() {
        for x in (0..1 << 28).step_by(99_991).chain([0, 1, 3, 4, (1 << 28) - 1]) {
            let root = i64::from(whole_root(x));
            assert!(root * root <= i64::from(x) && (root + 1) * (root + 1) > i64::from(x));
        }
    }
}
