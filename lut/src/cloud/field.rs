//! From noise to density.

use super::noise::{CURL_SIZE, CloudNoise, WEATHER_SIZE, WeatherChannel};
use super::parameters::{ANVIL, CloudParameters};
use super::sampling::{bilinear, unit};

/// The density of one layer at one time, relative to its extinction. The shaders' module `cloud_field` is the same chain.
#[derive(Debug, Clone, Copy)]
pub struct CloudField<'a> {
    /// The tiles.
    pub noise: &'a CloudNoise,
    /// The layer.
    pub parameters: CloudParameters,
}

/// Tiles of the curl map along a tile of the weather map: a whole number, so that both repeat together.
const CURL_TILES: f64 = 16.0;

/// What the weather map says of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Column {
    /// Strength of the clouds, 0 to 1.
    pub coverage: f64,
    /// Strength of the anvil, 0 to 1.
    pub anvil: f64,
    /// Height of the clouds, share of the layer's.
    pub reach: f64,
}

fn clamp(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}

impl CloudField<'_> {
    /// Density at a point of the map (east, north, m) and an altitude (m), in [0, 1].
    pub fn density(&self, map_m: [f64; 2], altitude_m: f64) -> f64 {
        let p = &self.parameters;
        let up_m = altitude_m - f64::from(p.base_m);
        let height = up_m / f64::from(p.thickness_m);
        if !(0.0..=1.0).contains(&height) {
            return 0.0;
        }
        let [u, v] = self.along_and_across(map_m);
        let column = self.column([u, v]);
        let (gradient, anvil) = (self.gradient(height / column.reach), self.anvil_gradient(height));
        if column.coverage * gradient + column.anvil * anvil <= 0.0 {
            return 0.0;
        }
        let shape = self.shape([u, v, up_m]);
        let body = self.carved(shape, column, gradient, anvil);
        if body <= 0.0 {
            return 0.0;
        }
        let eaten = f64::from(p.erosion) * self.erosion([u, v, up_m], height);
        let density = clamp(f64::from(p.edge) * ((body - eaten) / (1.0 - eaten)).max(0.0));
        density * self.water(height)
    }

    /// The map's coordinates along the stretch and across it.
    pub(super) fn along_and_across(&self, [east, north]: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.parameters.along.map(f64::from);
        [x * east + y * north, x * north - y * east]
    }

    fn column(&self, [u, v]: [f64; 2]) -> Column {
        let p = &self.parameters;
        let scale = f64::from(p.weather_per_m);
        let [x, y] = p.weather_offset.map(f64::from);
        let at = [u * scale + x, v * scale + y];
        let weather =
            |channel: WeatherChannel| bilinear(WEATHER_SIZE, at, |texel| self.noise.weather[texel][channel as usize]);
        self.column_of([
            weather(WeatherChannel::Cellular),
            weather(WeatherChannel::Sheet),
            weather(WeatherChannel::Thickness),
            weather(WeatherChannel::Development),
        ])
    }

    /// The column from the map's four values; it grows with each of them.
    pub(super) fn column_of(&self, [cellular, sheet, thickness, development]: [f64; 4]) -> Column {
        let p = &self.parameters;
        let value = cellular + (sheet - cellular) * f64::from(p.sheet);
        let slope = f64::from(p.coverage_slope);
        let coverage = clamp((value - f64::from(p.coverage_from)) * slope);
        let anvil = clamp((value - f64::from(p.anvil_from)) * slope) * development;
        let reach = f64::from(p.reach);
        Column { coverage, anvil, reach: reach + (1.0 - reach) * coverage * (0.5 + 0.5 * thickness) }
    }

    fn gradient(&self, share: f64) -> f64 {
        let [from, rise, end, fall] = self.parameters.gradient.map(f64::from);
        clamp((share - from) * rise).min(clamp((end - share) * fall))
    }

    /// Zero for kinds without an anvil, because their columns have none.
    fn anvil_gradient(&self, height: f64) -> f64 {
        let [from, full, to, end] = ANVIL;
        clamp((height - from) / (full - from)).min(clamp((end - height) / (end - to)))
    }

    fn shape(&self, [u, v, up_m]: [f64; 3]) -> f64 {
        let p = &self.parameters;
        let at = |axis: usize, x: f64| x * f64::from(p.shape_per_m[axis]) + f64::from(p.shape_offset[axis]);
        self.noise.shape_at([at(0, u), at(1, v), at(2, up_m)])
    }

    /// What is left of the shape in a column, at least of cloud or anvil; not above 0 where nothing is.
    pub(super) fn carved(&self, shape: f64, column: Column, gradient: f64, anvil: f64) -> f64 {
        (shape * gradient + column.coverage).max(shape * anvil + column.anvil) - 1.0
    }

    /// Strength of the erosion, 0 to 1: wisps at the base, billows above.
    fn erosion(&self, [u, v, up_m]: [f64; 3], height: f64) -> f64 {
        let p = &self.parameters;
        let scale = f64::from(p.erosion_per_m);
        let [x, y, z] = p.erosion_offset.map(f64::from);
        let [weather_x, weather_y] = p.weather_offset.map(f64::from);
        let weather_scale = f64::from(p.weather_per_m);
        let at = [(u * weather_scale + weather_x) * CURL_TILES, (v * weather_scale + weather_y) * CURL_TILES];
        let flow = |axis: usize| 2.0 * bilinear(CURL_SIZE, at, |texel| self.noise.curl[texel][axis]) - 1.0;
        let shift_m = f64::from(p.curl_m) * (1.0 - height);
        let place = [(u + shift_m * flow(0)) * scale + x, (v + shift_m * flow(1)) * scale + y, up_m * scale + z];
        let billows = self.noise.erosion_at(place);
        let wisps = 1.0 - clamp(8.0 * height);
        1.0 - billows + (2.0 * billows - 1.0) * wisps
    }

    /// Water relative to the densest part: it grows with height.
    pub(super) fn water(&self, height: f64) -> f64 {
        let base = f64::from(self.parameters.water_at_base);
        base + (1.0 - base) * height
    }

    /// The largest value that a block of shape and a block of columns allow between two heights.
    pub(super) fn bound(&self, shape: u8, weather: [u8; 4], heights: [f64; 2]) -> f64 {
        let column = self.column_of(weather.map(unit));
        let inside = heights[0] <= column.reach * f64::from(self.parameters.gradient[2]);
        let gradient = if inside { 1.0 } else { 0.0 };
        let anvil = if heights[1] >= ANVIL[0] { 1.0 } else { 0.0 };
        let coverage = if inside { column.coverage } else { 0.0 };
        let body = self.carved(unit(shape), Column { coverage, ..column }, gradient, anvil);
        clamp(f64::from(self.parameters.edge) * body.max(0.0)) * self.water(heights[1].min(1.0))
    }
}
