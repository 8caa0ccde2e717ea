//! The numbers of one layer at one time, as the device has them.

use super::layer::CloudLayer;
use super::noise::{WeatherChannel, noise_place, weather_map};

/// Everything that the chain from noise to density needs of a layer. The numbers are those of the device, in 32 bits:
/// where the definition says a number, it is this one. Fields stand in the order of the shaders' struct.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct CloudParameters {
    /// (fade in from, 1 / its length, gone at, 1 / the length of the fade out), fractions of a column's height.
    pub gradient: [f32; 4],
    /// Tiles of the shape per metre: along the stretch, across it, upwards.
    pub shape_per_m: [f32; 3],
    /// Altitude of the base, m.
    pub base_m: f32,
    /// Where the shape's tile begins, tiles.
    pub shape_offset: [f32; 3],
    /// From base to top, m.
    pub thickness_m: f32,
    /// Where the erosion's tile begins, tiles.
    pub erosion_offset: [f32; 3],
    /// Tiles of the erosion per metre.
    pub erosion_per_m: f32,
    /// Where the weather map begins, tiles.
    pub weather_offset: [f32; 2],
    /// Unit vector of the stretch on the map: east, north.
    pub along: [f32; 2],
    /// Tiles of the weather map per metre.
    pub weather_per_m: f32,
    /// Share of the map's sheets in place of its cells.
    pub sheet: f32,
    /// Value of the map at which clouds begin.
    pub coverage_from: f32,
    /// How fast they grow above it.
    pub coverage_slope: f32,
    /// The same for the anvil; above 1 without one.
    pub anvil_from: f32,
    /// Height of the weakest columns, share of the thickness.
    pub reach: f32,
    /// Strength of the erosion.
    pub erosion: f32,
    /// Displacement of the erosion by the curl map at the base, m.
    pub curl_m: f32,
    /// Factor on density before it is cut at 1.
    pub edge: f32,
    /// Water at the base, relative to the top's.
    pub water_at_base: f32,
    /// Extinction where the density is 1, 1/m.
    pub extinction_per_m: f32,
    /// Keeps the size a multiple of 16 bytes.
    pub padding: f32,
}

/// Where an anvil is: fade in from, full from, full to, gone at, fractions of the layer's height.
pub(super) const ANVIL: [f64; 4] = [0.76, 0.84, 0.93, 1.0];

/// A map value that no byte reaches.
const NEVER: f32 = 2.0;

impl CloudParameters {
    /// Those of a layer at a time in seconds.
    pub fn new(layer: &CloudLayer, time_s: f64) -> Self {
        let form = layer.kind.form();
        let along = stretch_direction(layer);
        let drift_m = layer.wind_m_per_s.map(|speed| speed * time_s);
        let drift = [along[0] * drift_m[0] + along[1] * drift_m[1], along[0] * drift_m[1] - along[1] * drift_m[0]];
        let rise_m = layer.evolution_m_per_s * time_s;
        let offset = |salt: i32, axis: i32, moved_m: f64, per_m: f64| {
            (noise_place(salt, axis, layer.seed) - moved_m * per_m).rem_euclid(1.0) as f32
        };
        let shape_per_m = form.shape_tile_m.map(f64::recip);
        let (erosion_per_m, weather_per_m) = (form.erosion_tile_m.recip(), form.weather_tile_m.recip());
        let moved_m = [drift[0], drift[1], rise_m];
        let from = coverage_threshold(form.sheet, form.softness, layer.coverage);
        let [a, b, c, d] = form.gradient;
        Self {
            gradient: [a, 1.0 / (b - a), d, 1.0 / (d - c)].map(|x| x as f32),
            shape_per_m: shape_per_m.map(|x| x as f32),
            base_m: layer.base_m as f32,
            shape_offset: [0, 1, 2].map(|i| offset(1, i as i32, moved_m[i], shape_per_m[i])),
            thickness_m: (layer.top_m - layer.base_m) as f32,
            // Fine billows rise faster than the large ones that carry them.
            erosion_offset: [0, 1, 2].map(|i| offset(2, i as i32, moved_m[i] * [1.0, 1.0, 2.0][i], erosion_per_m)),
            erosion_per_m: erosion_per_m as f32,
            weather_offset: [0, 1].map(|i| offset(3, i as i32, moved_m[i], weather_per_m)),
            along: along.map(|x| x as f32),
            weather_per_m: weather_per_m as f32,
            sheet: form.sheet as f32,
            coverage_from: from as f32,
            coverage_slope: form.softness.recip() as f32,
            anvil_from: if form.anvil > 0.0 { (from - form.anvil) as f32 } else { NEVER },
            reach: form.reach as f32,
            erosion: form.erosion as f32,
            curl_m: form.curl_m as f32,
            edge: form.edge as f32,
            water_at_base: form.water_at_base as f32,
            extinction_per_m: layer.extinction_per_m() as f32,
            padding: 0.0,
        }
    }

    /// All numbers in the order of the shaders' struct.
    pub fn to_array(&self) -> [f32; 32] {
        let p = self;
        let rows = [
            p.gradient,
            with(p.shape_per_m, p.base_m),
            with(p.shape_offset, p.thickness_m),
            with(p.erosion_offset, p.erosion_per_m),
            [p.weather_offset[0], p.weather_offset[1], p.along[0], p.along[1]],
            [p.weather_per_m, p.sheet, p.coverage_from, p.coverage_slope],
            [p.anvil_from, p.reach, p.erosion, p.curl_m],
            [p.edge, p.water_at_base, p.extinction_per_m, p.padding],
        ];
        let mut numbers = [0.0; 32];
        numbers.chunks_exact_mut(4).zip(rows).for_each(|(four, row)| four.copy_from_slice(&row));
        numbers
    }

    /// Whether the kind has an anvil.
    pub fn has_anvil(&self) -> bool {
        self.anvil_from < NEVER
    }
}

fn with([x, y, z]: [f32; 3], w: f32) -> [f32; 4] {
    [x, y, z, w]
}

/// Streaks lie along the wind; in calm air, along the east.
fn stretch_direction(layer: &CloudLayer) -> [f64; 2] {
    let [east, north] = layer.wind_m_per_s;
    let speed = east.hypot(north);
    if speed > 0.0 { [east / speed, north / speed] } else { [1.0, 0.0] }
}

/// The map's value above which a share of its area lies; with full coverage, low enough for full strength everywhere.
fn coverage_threshold(sheet: f64, softness: f64, coverage: f64) -> f64 {
    let value = |texel: &[u8; 4]| {
        let [cellular, sheets] =
            [WeatherChannel::Cellular, WeatherChannel::Sheet].map(|c| f64::from(texel[c as usize]));
        (cellular + (sheets - cellular) * sheet) / 255.0
    };
    // Every fifth texel: a step that no row has in common with the next.
    let mut values: Vec<f64> = weather_map().iter().step_by(5).map(value).collect();
    let least = values.iter().copied().fold(f64::INFINITY, f64::min) - softness;
    let rank = ((1.0 - coverage) * (values.len() - 1) as f64).round() as usize;
    let from = *values.select_nth_unstable_by(rank, f64::total_cmp).1;
    // Towards full coverage the rim's softness, too, moves off the map.
    from + (least - from) * coverage.powi(8)
}
