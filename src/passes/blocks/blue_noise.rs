//! Where marches begin their steps, pixel by pixel: numbers that are as unlike their neighbours' as can be, so that what noise there is has no
//! clumps and goes where pixels are averaged. Void and cluster (Ulichney 1993, SPIE 1913, 332).

use std::array;
use std::sync::LazyLock;

use rand_core::Rng as _;
use rand_pcg::Pcg32;

/// Side of the square tile: WGSL `NOISE_SIDE`.
const SIDE: usize = 64;
const PIXELS: usize = SIDE * SIDE;
/// How far points are felt: the best width by the original work, pixels, and where it is cut off.
const WIDTH: f32 = 1.5;
const REACH: i32 = 7;
/// Points of the pattern from which the ranking starts, as a part of all pixels.
const FIRST_PART: u32 = 10;

/// The tile: multiples of 1 / SIDE² from 0 on, each once, in rows.
pub fn blue_noise() -> &'static [f32] {
    static TILE: LazyLock<Vec<f32>> =
        LazyLock::new(|| ranks().iter().map(|&rank| rank as f32 / PIXELS as f32).collect());
    &TILE
}

/// Points on the tile, whose edges meet, and how crowded each pixel is by them.
#[derive(Clone)]
struct Pattern {
    is_set: Vec<bool>,
    crowding: Vec<f32>,
}

impl Pattern {
    fn set(&mut self, pixel: usize, to: bool) {
        self.is_set[pixel] = to;
        let sign = if to { 1.0 } else { -1.0 };
        let (x, y) = ((pixel % SIDE) as i32, (pixel / SIDE) as i32);
        for (dx, dy) in (-REACH..=REACH).flat_map(|dy| (-REACH..=REACH).map(move |dx| (dx, dy))) {
            let wrapped = |at: i32| at.rem_euclid(SIDE as i32) as usize;
            let felt = (-((dx * dx + dy * dy) as f32) / (2.0 * WIDTH * WIDTH)).exp();
            self.crowding[wrapped(y + dy) * SIDE + wrapped(x + dx)] += sign * felt;
        }
    }

    /// The most crowded point.
    fn tightest_cluster(&self) -> usize {
        self.best(true, |a, b| a > b)
    }

    /// The least crowded pixel without a point.
    fn largest_void(&self) -> usize {
        self.best(false, |a, b| a < b)
    }

    fn best(&self, set: bool, is_better: fn(f32, f32) -> bool) -> usize {
        let candidates = (0..PIXELS).filter(|&pixel| self.is_set[pixel] == set);
        let better = |a: usize, b: usize| if is_better(self.crowding[b], self.crowding[a]) { b } else { a };
        candidates.reduce(better).unwrap_or(0)
    }
}

/// In which order pixels would be filled so that every part of them lies evenly.
fn ranks() -> [usize; PIXELS] {
    let mut first = Pattern { is_set: vec![false; PIXELS], crowding: vec![0.0; PIXELS] };
    let mut random = Pcg32::new(1, 1);
    (0..PIXELS).filter(|_| random.next_u32().is_multiple_of(FIRST_PART)).for_each(|pixel| first.set(pixel, true));
    // Points go from clusters to voids until none would move.
    loop {
        let from = first.tightest_cluster();
        first.set(from, false);
        let to = first.largest_void();
        first.set(to, true);
        if from == to {
            break;
        }
    }
    let count = first.is_set.iter().filter(|set| **set).count();
    let mut ranks: [usize; PIXELS] = array::from_fn(|_| 0);
    let mut thinned = first.clone();
    for rank in (0..count).rev() {
        let pixel = thinned.tightest_cluster();
        thinned.set(pixel, false);
        ranks[pixel] = rank;
    }
    for rank in count..PIXELS {
        let pixel = first.largest_void();
        first.set(pixel, true);
        ranks[pixel] = rank;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean square of the means over squares of so many pixels a side, less 1/2.
    fn noise_of_means(tile: &[f32], side: usize) -> f64 {
        let means = (0..PIXELS / (side * side)).map(|i| {
            let (column, row) = (i % (SIDE / side) * side, i / (SIDE / side) * side);
            let square = (0..side * side).map(|j| f64::from(tile[(row + j / side) * SIDE + column + j % side]));
            square.sum::<f64>() / (side * side) as f64 - 0.5
        });
        means.map(|mean| mean * mean).sum::<f64>() / (PIXELS / (side * side)) as f64
    }

    #[test]
    fn every_multiple_is_there_once() {
        let mut sorted = blue_noise().to_vec();
        sorted.sort_by(f32::total_cmp);
        assert!(sorted.iter().enumerate().all(|(i, value)| *value == i as f32 / PIXELS as f32));
    }

    #[test]
    fn means_over_squares_are_far_less_noisy_than_those_of_white_noise() {
        // Independent numbers have 1/12 over the count; 256 squares of 4 x 4 know that to 9 %.
        let blue = noise_of_means(blue_noise(), 4) * 12.0 * 16.0;
        let mut random = Pcg32::new(2, 1);
        let white: Vec<f32> = (0..PIXELS).map(|_| random.next_u32() as f32 / 4_294_967_296.0).collect();
        let white = noise_of_means(&white, 4) * 12.0 * 16.0;
        println!("blue {blue:.3}, white {white:.3} of what independent numbers have");
        assert!(blue < 0.25, "{blue}");
        assert!((white - 1.0).abs() < 0.27, "the control: {white}");
    }
}
