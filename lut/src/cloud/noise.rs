//! The bytes that clouds are cut from: tiles of noise that repeat in all directions.
//!
//! A texel's byte stands for [0, 1] and for the noise at the texel's centre. The bytes themselves are the definition:
//! the device computes them with the same whole numbers, and both sides interpolate them linearly.

use std::sync::OnceLock;
use std::thread;

use super::fixed_noise::{ONE, Worley, hash, perlin_octaves};
use super::sampling::trilinear;

/// Texels along each side of the shape's volume.
pub const SHAPE_SIZE: usize = 128;
/// Texels along each side of the erosion's volume.
pub const EROSION_SIZE: usize = 32;
/// Texels along each side of the weather map.
pub const WEATHER_SIZE: usize = 512;
/// Texels along each side of the curl map.
pub const CURL_SIZE: usize = 128;

/// What the weather map's four bytes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WeatherChannel {
    /// Where convection gathers matter into cells.
    Cellular = 0,
    /// Where matter lies in sheets.
    Sheet = 1,
    /// How high a column reaches.
    Thickness = 2,
    /// How far a column has developed along its type.
    Development = 3,
}

/// All tiles.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CloudNoise {
    /// Perlin-Worley noise joined with finer Worley noise, x first, then y, then z.
    pub shape: Vec<u8>,
    /// Fine Worley noise, likewise.
    pub erosion: Vec<u8>,
    /// A flow without sources: east and north, 128 is rest.
    pub curl: Vec<[u8; 2]>,
    /// [`WeatherChannel`]s.
    pub weather: &'static [[u8; 4]],
}

/// The one weather map, made when it is first asked for.
pub fn weather_map() -> &'static [[u8; 4]] {
    static SHARED: OnceLock<Vec<[u8; 4]>> = OnceLock::new();
    SHARED.get_or_init(weather)
}

impl CloudNoise {
    /// The one set of tiles, made when it is first asked for: seconds of work.
    pub fn shared() -> &'static Self {
        static SHARED: OnceLock<CloudNoise> = OnceLock::new();
        SHARED.get_or_init(|| Self {
            shape: shape(),
            erosion: erosion(),
            curl: filled([CURL_SIZE, CURL_SIZE, 1], |[x, y, _]| curl([x, y])),
            weather: weather_map(),
        })
    }

    /// The shape at a place in tiles, in [0, 1].
    pub fn shape_at(&self, tiles: [f64; 3]) -> f64 {
        trilinear(SHAPE_SIZE, tiles, &self.shape)
    }

    /// The erosion at a place in tiles, in [0, 1].
    pub fn erosion_at(&self, tiles: [f64; 3]) -> f64 {
        trilinear(EROSION_SIZE, tiles, &self.erosion)
    }
}

/// Where along an axis a seed begins in a tile, in [0, 1[; different salts have nothing to do with each other.
pub(crate) fn noise_place(salt: i32, axis: i32, seed: u32) -> f64 {
    f64::from(hash(salt, axis, 0, seed)) / 4_294_967_296.0
}

/// A texel's centre in 256ths of a cell, with so many cells in a tile of so many texels.
fn centre(texel: usize, cells: i32, texels: usize) -> i32 {
    (2 * texel as i32 + 1) * cells * 128 / texels as i32
}

fn position(texel: [usize; 3], cells: i32, texels: usize) -> [i32; 3] {
    texel.map(|i| centre(i, cells, texels))
}

/// From a value, of which `low` becomes 0 and `high` 255.
fn byte(value: i32, low: i32, high: i32) -> u8 {
    ((value.clamp(low, high) - low) * 255 / (high - low)) as u8
}

/// Octaves of Worley noise, each with twice the cells of the one before.
struct WorleyOctaves<const N: usize> {
    cells: i32,
    octaves: [Worley; N],
}

impl<const N: usize> WorleyOctaves<N> {
    fn new(cells: i32, seed: u32) -> Self {
        Self { cells, octaves: std::array::from_fn(|o| Worley::new(cells << o, seed + o as u32)) }
    }

    fn at(&self, texel: [usize; 3], texels: usize) -> [i32; N] {
        std::array::from_fn(|o| self.octaves[o].at(position(texel, self.cells << o, texels)))
    }
}

/// The sum of three octaves.
fn joined([first, second, third]: [i32; 3]) -> i32 {
    (5 * first + 2 * second + third) / 8
}

/// Perlin noise that is cut into billows by Worley noise (Schneider 2015), then carved by the next finer octaves.
fn shape() -> Vec<u8> {
    let worley = WorleyOctaves::<4>::new(4, 11);
    filled([SHAPE_SIZE; 3], |texel| {
        let noise = perlin_octaves(position(texel, 4, SHAPE_SIZE), 4, 4, 31);
        let smooth = (ONE / 2 + noise * 3 / 4).clamp(0, ONE);
        let [a, b, c, d] = worley.at(texel, SHAPE_SIZE);
        let (billows, carving) = (joined([a, b, c]), joined([b, c, d]));
        let whole = billows + ((smooth * (ONE - billows)) >> 12);
        byte((whole - carving + ONE) * ONE / (2 * ONE - carving), 2300, 3900)
    })
}

fn erosion() -> Vec<u8> {
    let worley = WorleyOctaves::new(4, 41);
    filled([EROSION_SIZE; 3], |texel| byte(joined(worley.at(texel, EROSION_SIZE)), 900, 3500))
}

/// Differences of one potential across two texels: what flows in flows out.
fn curl([x, y]: [usize; 2]) -> [u8; 2] {
    let potential = |dx: usize, dy: usize| {
        let texel = [(x + dx) % CURL_SIZE, (y + dy) % CURL_SIZE, 0];
        perlin_octaves(position(texel, 8, CURL_SIZE), 8, 3, 51)
    };
    let before = CURL_SIZE - 1;
    [
        byte(potential(0, 1) - potential(0, before), -1024, 1024),
        byte(potential(before, 0) - potential(1, 0), -1024, 1024),
    ]
}

fn weather() -> Vec<[u8; 4]> {
    let worley = WorleyOctaves::new(32, 61);
    filled([WEATHER_SIZE, WEATHER_SIZE, 1], |texel| {
        let octaves = |cells, octaves, seed| {
            let noise = perlin_octaves(position(texel, cells, WEATHER_SIZE), cells, octaves, seed);
            (ONE / 2 + noise * 3 / 4).clamp(0, ONE)
        };
        let convection = joined(worley.at(texel, WEATHER_SIZE));
        let cellular = (octaves(4, 4, 71) + 2 * convection) / 3;
        [cellular, octaves(8, 6, 81), octaves(32, 3, 91), octaves(8, 3, 101)].map(|value| byte(value, 0, ONE))
    })
}

/// A tile of values, filled in parallel.
fn filled<T: Copy + Default + Send>([width, height, depth]: [usize; 3], at: impl Fn([usize; 3]) -> T + Sync) -> Vec<T> {
    let mut values = vec![T::default(); width * height * depth];
    let rows = (height * depth).div_ceil(thread::available_parallelism().map_or(1, usize::from));
    thread::scope(|scope| {
        for (block, values) in values.chunks_mut(rows * width).enumerate() {
            let at = &at;
            scope.spawn(move || {
                for (i, value) in values.iter_mut().enumerate() {
                    let row = block * rows + i / width;
                    *value = at([i % width, row % height, row / height]);
                }
            });
        }
    });
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread(bytes: impl Iterator<Item = u8>) -> [f64; 2] {
        let values: Vec<f64> = bytes.map(f64::from).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / values.len() as f64;
        [mean, square.sqrt()]
    }

    #[test]
    fn every_tile_uses_its_bytes() {
        let noise = CloudNoise::shared();
        let mut tiles = vec![spread(noise.shape.iter().copied()), spread(noise.erosion.iter().copied())];
        tiles.extend((0..2).map(|axis| spread(noise.curl.iter().map(|v| v[axis]))));
        tiles.extend((0..4).map(|channel| spread(noise.weather.iter().map(|v| v[channel]))));
        // Neither clipped nor flat: a mean in the middle half, and a deviation of more than a tenth of the range.
        for [mean, deviation] in &tiles {
            assert!((64.0..192.0).contains(mean) && (20.0..90.0).contains(deviation), "{tiles:?}");
        }
    }
}
