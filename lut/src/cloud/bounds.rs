//! Upper bounds of a layer's density over blocks of space: majorants.
//!
//! The chain from noise to density grows with the shape and with the weather's values, and erosion only takes away. So
//! the largest bytes of a block of texels bound the density, wherever wind has carried them: the bounds belong to the
//! noise, and no time or layer changes them.

use super::field::CloudField;
use super::noise::{CloudNoise, SHAPE_SIZE, WEATHER_SIZE};

/// Texels along a block's side.
const BLOCK: usize = 8;
/// Blocks along each side of the shape's volume.
const SHAPE_BLOCKS: usize = SHAPE_SIZE / BLOCK;
/// Blocks along each side of the weather map.
const WEATHER_BLOCKS: usize = WEATHER_SIZE / BLOCK;
/// What a step may use of a block's length: rounding, and lengths that the map stretches by up to a tenth.
const MARGIN: f64 = 0.85;

/// The largest bytes around each block, a block's length to every side included.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CloudBounds {
    /// Of the shape, x first.
    pub shape: Vec<u8>,
    /// Of each channel of the weather map.
    pub weather: Vec<[u8; 4]>,
}

/// The largest value of `row` in each block, and in a block and the interpolated texel on either side.
fn largest(row: &[u8]) -> impl Iterator<Item = u8> + '_ {
    let n = row.len();
    (0..n / BLOCK).map(move |block| {
        let from = block * BLOCK + n - BLOCK - 1;
        (from..from + 3 * BLOCK + 2).map(|i| row[i % n]).fold(0, u8::max)
    })
}

/// Takes the maxima along one axis of a volume: that with this stride, of this length.
fn reduced(values: &[u8], stride: usize, length: usize) -> Vec<u8> {
    let blocks = length / BLOCK;
    let mut out = vec![0; values.len() / BLOCK];
    for outer in 0..values.len() / (stride * length) {
        for inner in 0..stride {
            let row: Vec<u8> = (0..length).map(|i| values[(outer * length + i) * stride + inner]).collect();
            for (block, most) in largest(&row).enumerate() {
                out[(outer * blocks + block) * stride + inner] = most;
            }
        }
    }
    out
}

impl CloudBounds {
    /// Of the noise.
    pub fn new(noise: &CloudNoise) -> Self {
        let x = reduced(&noise.shape, 1, SHAPE_SIZE);
        let y = reduced(&x, SHAPE_BLOCKS, SHAPE_SIZE);
        let shape = reduced(&y, SHAPE_BLOCKS * SHAPE_BLOCKS, SHAPE_SIZE);
        let mut weather = vec![[0; 4]; WEATHER_BLOCKS * WEATHER_BLOCKS];
        for channel in 0..4 {
            let bytes: Vec<u8> = noise.weather.iter().map(|texel| texel[channel]).collect();
            let most = reduced(&reduced(&bytes, 1, WEATHER_SIZE), WEATHER_BLOCKS, WEATHER_SIZE);
            weather.iter_mut().zip(most).for_each(|(texel, most)| texel[channel] = most);
        }
        Self { shape, weather }
    }

    /// A distance from a point of the map and an altitude, m, within which a bound of the density holds in every
    /// direction: (distance, bound).
    pub fn around(&self, field: &CloudField, map_m: [f64; 2], altitude_m: f64) -> (f64, f64) {
        let p = &field.parameters;
        let [u, v] = field.along_and_across(map_m);
        let up_m = altitude_m - f64::from(p.base_m);
        let block = |tiles: f64, blocks: usize| ((tiles - tiles.floor()) * blocks as f64) as usize % blocks;
        let weather_at = |x: f64, axis: usize| {
            block(x * f64::from(p.weather_per_m) + f64::from(p.weather_offset[axis]), WEATHER_BLOCKS)
        };
        let weather = self.weather[weather_at(v, 1) * WEATHER_BLOCKS + weather_at(u, 0)];
        let weather_m = MARGIN / (f64::from(p.weather_per_m) * WEATHER_BLOCKS as f64);
        let heights = |reach_m: f64| [-1.0, 1.0].map(|side| (up_m + side * reach_m) / f64::from(p.thickness_m));
        if field.bound(u8::MAX, weather, heights(weather_m)) == 0.0 {
            return (weather_m, 0.0);
        }
        let shape_at = |x: f64, axis: usize| {
            block(x * f64::from(p.shape_per_m[axis]) + f64::from(p.shape_offset[axis]), SHAPE_BLOCKS)
        };
        let shape = (shape_at(up_m, 2) * SHAPE_BLOCKS + shape_at(v, 1)) * SHAPE_BLOCKS + shape_at(u, 0);
        let finest =
            p.shape_per_m.iter().copied().fold(p.weather_per_m * WEATHER_BLOCKS as f32 / SHAPE_BLOCKS as f32, f32::max);
        let reach_m = MARGIN / (f64::from(finest) * SHAPE_BLOCKS as f64);
        (reach_m, field.bound(self.shape[shape], weather, heights(reach_m)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CloudKind, CloudLayer, CloudParameters};
    use super::*;

    /// Points of a lattice whose coordinates have no common period.
    fn scattered(i: usize) -> [f64; 3] {
        let part = |factor: f64| (i as f64 * factor).fract();
        [part(0.754_877_666), part(0.569_840_291), part(0.438_579_021)]
    }

    #[test]
    fn no_density_near_a_point_exceeds_its_bound_and_some_come_close() {
        let noise = CloudNoise::shared();
        let bounds = CloudBounds::new(noise);
        for kind in CloudKind::ALL {
            let layer = CloudLayer { wind_m_per_s: [7.0, -3.0], seed: 5, ..CloudLayer::of_kind(kind) };
            let field = CloudField { noise, parameters: CloudParameters::new(&layer, 1234.5) };
            let (mut closest, mut empty) = (0.0_f64, 0);
            for i in 0..20_000 {
                let [x, y, z] = scattered(i);
                let (map, altitude) = ([9e4 * x, 9e4 * y], layer.base_m + z * (layer.top_m - layer.base_m));
                let (reach_m, bound) = bounds.around(&field, map, altitude);
                empty += usize::from(bound == 0.0);
                for j in 0..6 {
                    let [a, b, c] = scattered(7 * i + j).map(|s| (2.0 * s - 1.0) * reach_m / 3_f64.sqrt());
                    let density = field.density([map[0] + a, map[1] + b], altitude + c);
                    assert!(density <= bound + 1e-12, "{kind:?}: {density} above {bound}");
                    closest = closest.max(if bound > 0.0 { density / bound } else { 0.0 });
                }
            }
            assert!(closest > 0.8, "{kind:?}: the bounds are never nearly reached: {closest}");
            let separate = ![CloudKind::Stratus, CloudKind::Stratocumulus].contains(&kind);
            assert!(!separate || empty > 800, "{kind:?}: only {empty} of 20000 points are known to be empty");
        }
    }
}
