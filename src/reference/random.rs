//! Random numbers for walks: a few evenly spread dimensions first, then an ordinary generator.

use rand_core::Rng as _;
use rand_pcg::Pcg64;

/// How many numbers of each walk come from the lattice.
const LATTICE_DIMENSIONS: usize = 8;

/// The numbers that one walk consumes.
///
/// The first ones are points of a Kronecker lattice with the generalised golden ratio (M. Roberts 2018, "The
/// unreasonable effectiveness of quasirandom sequences"), shifted at random for every batch (Cranley & Patterson
/// 1976): each point is uniform, so the estimate stays unbiased, and the points of a batch share the cube evenly.
#[derive(Debug, Clone)]
pub struct Draw {
    generator: Pcg64,
    shift: [u64; LATTICE_DIMENSIONS],
    step: [u64; LATTICE_DIMENSIONS],
    point: [u64; LATTICE_DIMENSIONS],
    used: usize,
}

impl Draw {
    /// An independent stream for each (seed, stream, batch), whatever thread runs it.
    pub fn new(seed: u64, stream: u64, batch: u64) -> Self {
        // PCG's increment selects the sequence; the state is spread over it by a burn-in of its own multiplier.
        let state = (u128::from(seed) << 64) | u128::from(mix(seed ^ mix(batch)));
        let mut generator = Pcg64::new(state, (u128::from(stream) << 64) | u128::from(batch));
        let shift = std::array::from_fn(|_| generator.next_u64());
        Self { generator, shift, step: lattice_steps(), point: shift, used: LATTICE_DIMENSIONS }
    }

    /// Begins walk number `index` of the batch.
    pub fn start(&mut self, index: u64) {
        let n = index + 1;
        self.point = std::array::from_fn(|i| self.shift[i].wrapping_add(self.step[i].wrapping_mul(n)));
        self.used = 0;
    }

    /// Uniform in [0, 1[.
    pub fn uniform(&mut self) -> f64 {
        let bits = if self.used < LATTICE_DIMENSIONS {
            self.used += 1;
            self.point[self.used - 1]
        } else {
            self.generator.next_u64()
        };
        (bits >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// Exponentially distributed with mean 1.
    pub fn exponential(&mut self) -> f64 {
        // Exact up to the logarithm: uniform numbers are multiples of 2⁻⁵³, and so are their differences from 1.
        -(1.0 - self.uniform()).ln()
    }
}

/// A bijection that spreads nearby integers (SplitMix64's finaliser, Steele et al. 2014).
fn mix(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Fractional parts of φ⁻¹, φ⁻², … as 64-bit fractions, where φ^(d+1) = φ + 1.
fn lattice_steps() -> [u64; LATTICE_DIMENSIONS] {
    let mut phi = 2.0_f64;
    for _ in 0..60 {
        phi = (1.0 + phi).powf(1.0 / (LATTICE_DIMENSIONS as f64 + 1.0));
    }
    std::array::from_fn(|i| (phi.powi(-(i as i32 + 1)) * 2.0_f64.powi(64)) as u64)
}

#[cfg(test)]
mod tests {
    use super::Draw;

    #[test]
    fn streams_repeat_by_seed_and_differ_by_stream_and_batch() {
        let first = |seed, stream, batch| {
            let mut draw = Draw::new(seed, stream, batch);
            draw.start(0);
            (0..20).map(|_| draw.uniform()).collect::<Vec<_>>()
        };
        assert_eq!(first(1, 2, 3), first(1, 2, 3));
        for other in [first(2, 2, 3), first(1, 3, 3), first(1, 2, 4)] {
            assert!(first(1, 2, 3).iter().zip(&other).all(|(a, b)| a != b));
        }
    }

    #[test]
    fn lattice_points_estimate_a_smooth_integral_better_than_random_points() {
        // ∫ over the 4-cube of the product of 2x is 1; the variance of the random mean over n points is known.
        let n = 4096;
        let mut draw = Draw::new(7, 0, 0);
        let (mut lattice, mut random) = (0.0, 0.0);
        for i in 0..n {
            draw.start(i);
            lattice += (0..4).map(|_| 2.0 * draw.uniform()).product::<f64>();
            draw.used = super::LATTICE_DIMENSIONS;
            random += (0..4).map(|_| 2.0 * draw.uniform()).product::<f64>();
        }
        let standard_error = (((4.0_f64 / 3.0).powi(4) - 1.0) / n as f64).sqrt();
        assert!((lattice / n as f64 - 1.0).abs() < 0.3 * standard_error);
        assert!((random / n as f64 - 1.0).abs() < 4.0 * standard_error);
    }
}
