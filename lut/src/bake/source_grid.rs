//! The directions in which the source function is tabulated at each (altitude, μ_s), and where others lie between them:
//! the shaders' `source_grid.wgsl`, in f64.
//!
//! Zenith angles are cut at the horizon, where radiance has a kink, and at the light, around which there is a glow:
//! ground, low sky, high sky. So both stay where they are on the grid while altitude and μ_s change. Within each part, and
//! on half a turn of azimuth, nodes crowd at both ends, as Fejér's rule has them.

use std::f64::consts::PI;

use crate::Planet;
use crate::quadrature::{GaussNode, fejer};

/// How far the Earth's air of 100 km reaches beyond the horizon, rad.
const EARTHS_REACH_RAD: f64 = 0.177;
/// So many times more directions in the low sky the largest planet gets.
const MOST_LOW_DIRECTIONS: f64 = 2.0;

/// The low sky spans at least this much of μ above the horizon, however low the light.
const LEAST_LOW_SKY: f64 = 0.1;

/// Irradiance, mean and five harmonics (`shaders/wgsl/source_grid.wgsl`).
const MOMENT_TILES: u32 = 7;

/// Directions in which the source function is tabulated: cosines in each part of the sphere, and azimuths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SourceGrid {
    /// Below the horizon.
    pub ground: u32,
    /// From the horizon to the light.
    pub low: u32,
    /// From the light to the zenith.
    pub high: u32,
    /// On half a turn.
    pub azimuths: u32,
}

impl SourceGrid {
    /// All cosines.
    pub fn cosines(&self) -> u32 {
        self.ground + self.low + self.high
    }

    /// All directions.
    pub fn count(&self) -> u32 {
        self.cosines() * self.azimuths
    }

    /// Columns and rows of tiles in the table: one tile for each direction, and a row for the moments of the field, which may
    /// be longer than the others.
    pub fn tiles(&self) -> [u32; 2] {
        [self.azimuths.max(MOMENT_TILES), self.cosines() + 1]
    }

    /// The same for a planet. Twilight glows within a few degrees of the horizon, the fewer the larger the planet is against
    /// its air; directions lie at distances from the horizon that go as one over the square of their number.
    pub fn on(self, planet: &Planet) -> Self {
        let more = (EARTHS_REACH_RAD / planet.reach_rad()).sqrt().clamp(1.0, MOST_LOW_DIRECTIONS);
        Self { low: (f64::from(self.low) * more).round() as u32, ..self }
    }
}

/// A direction of the grid, or of a cell around one.
#[derive(Debug, Clone, Copy)]
pub(super) struct GridDirection {
    pub(super) mu: f64,
    pub(super) phi_rad: f64,
    /// What the direction stands for, both of its mirror images counted, sr.
    pub(super) solid_angle_sr: f64,
    pub(super) hits_ground: bool,
}

/// A part of the sphere between two cosines, and the rows of directions in it.
struct Part {
    low_mu: f64,
    high_mu: f64,
    first_row: u32,
    rows: u32,
}

/// The grid at one altitude under one light.
#[derive(Debug, Clone, Copy)]
pub(super) struct GridAt<'a> {
    nodes: &'a GridNodes,
    horizon_mu: f64,
    /// Where the low sky ends and the high sky begins.
    split_mu: f64,
    pub(super) mu_s: f64,
}

/// A grid with its nodes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GridNodes {
    pub(super) grid: SourceGrid,
    /// Of the three parts, one after the other.
    cosines: Vec<GaussNode>,
    azimuths: Vec<GaussNode>,
}

impl GridNodes {
    pub(super) fn new(grid: SourceGrid) -> Self {
        let parts = [grid.ground, grid.low, grid.high];
        let cosines = parts.into_iter().flat_map(|n| fejer(n as usize)).collect();
        Self { grid, cosines, azimuths: fejer(grid.azimuths as usize) }
    }

    pub(super) fn at(&self, horizon_mu: f64, mu_s: f64) -> GridAt<'_> {
        let split_mu = mu_s.max(horizon_mu + LEAST_LOW_SKY).min(1.0);
        GridAt { nodes: self, horizon_mu, split_mu, mu_s }
    }
}

/// Where a share of a cell lies in [0, 1] of its part, of so many cells, and what a unit of the share stands for there.
fn in_cell(cell: u32, share: f64, cells: u32) -> [f64; 2] {
    let angle_rad = PI * (f64::from(cell) + share) / f64::from(cells);
    [(0.5 * angle_rad).sin().powi(2), 0.5 * PI / f64::from(cells) * angle_rad.sin()]
}

/// The inverse of sin²(π y / 2) on [0, 1].
fn even(x: f64) -> f64 {
    x.clamp(0.0, 1.0).sqrt().asin() * 2.0 / PI
}

impl GridAt<'_> {
    fn part_of(&self, row: u32) -> Part {
        let SourceGrid { ground, low, high, .. } = self.nodes.grid;
        if row < ground {
            return Part { low_mu: -1.0, high_mu: self.horizon_mu, first_row: 0, rows: ground };
        }
        if row < ground + low {
            return Part { low_mu: self.horizon_mu, high_mu: self.split_mu, first_row: ground, rows: low };
        }
        Part { low_mu: self.split_mu, high_mu: 1.0, first_row: ground + low, rows: high }
    }

    /// A direction by its number: azimuths of the first row, and so on.
    pub(super) fn direction(&self, index: u32) -> GridDirection {
        let (row, column) = (index / self.nodes.grid.azimuths, index % self.nodes.grid.azimuths);
        let (node, azimuth) = (self.nodes.cosines[row as usize], self.nodes.azimuths[column as usize]);
        let Part { low_mu, high_mu, .. } = self.part_of(row);
        GridDirection {
            mu: low_mu + (high_mu - low_mu) * node.abscissa,
            phi_rad: PI * azimuth.abscissa,
            solid_angle_sr: (high_mu - low_mu) * node.weight * 2.0 * PI * azimuth.weight,
            hits_ground: row < self.nodes.grid.ground,
        }
    }

    /// One of many directions that fill the cell around a direction of the grid, by its shares of the cell's height and
    /// width in ]0, 1[; its solid angle is per unit of both shares.
    pub(super) fn direction_in_cell(&self, index: u32, shares: [f64; 2]) -> GridDirection {
        let (row, column) = (index / self.nodes.grid.azimuths, index % self.nodes.grid.azimuths);
        let Part { low_mu, high_mu, first_row, rows } = self.part_of(row);
        let [height, d_height] = in_cell(row - first_row, shares[0], rows);
        let [width, d_width] = in_cell(column, shares[1], self.nodes.grid.azimuths);
        GridDirection {
            mu: low_mu + (high_mu - low_mu) * height,
            phi_rad: PI * width,
            solid_angle_sr: (high_mu - low_mu) * d_height * 2.0 * PI * d_width,
            hits_ground: row < self.nodes.grid.ground,
        }
    }

    /// The row of a direction, nodes at halves.
    fn row_coordinate(&self, mu: f64) -> f64 {
        let SourceGrid { ground, low, high, .. } = self.nodes.grid;
        let [ground, low, high] = [ground, low, high].map(f64::from);
        if mu < self.horizon_mu {
            return ground * even((mu + 1.0) / (self.horizon_mu + 1.0));
        }
        if mu < self.split_mu {
            return ground + low * even((mu - self.horizon_mu) / (self.split_mu - self.horizon_mu));
        }
        ground + low + high * even((mu - self.split_mu) / (1.0 - self.split_mu).max(1e-6))
    }

    /// The numbers of the four directions around one, and the weight of each.
    pub(super) fn corners(&self, mu: f64, cos_phi: f64) -> [(u32, f64); 4] {
        let SourceGrid { azimuths, .. } = self.nodes.grid;
        let (last_row, last_column) = (f64::from(self.nodes.grid.cosines() - 1), f64::from(azimuths - 1));
        let row = self.row_coordinate(mu) - 0.5;
        let column_coordinate = f64::from(azimuths) * even(cos_phi.clamp(-1.0, 1.0).acos() / PI) - 0.5;
        std::array::from_fn(|corner| {
            let (upper, right) = (corner / 2, corner % 2);
            let at_row = row.floor() + upper as f64;
            // Beyond the zenith or the nadir the grid goes on on the other side.
            let across = at_row < 0.0 || at_row > last_row;
            let column = if across { last_column - column_coordinate } else { column_coordinate };
            let (row_share, column_share) = (row - row.floor(), column - column.floor());
            let at_column = (column.floor() + right as f64).clamp(0.0, last_column);
            let weight = |share: f64, second: usize| if second == 1 { share } else { 1.0 - share };
            let index = at_row.clamp(0.0, last_row) as u32 * azimuths + at_column as u32;
            (index, weight(row_share, upper) * weight(column_share, right))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: SourceGrid = SourceGrid { ground: 5, low: 6, high: 5, azimuths: 10 };

    #[test]
    fn the_low_sky_of_a_large_planet_gets_more_directions_and_that_of_the_earth_what_settings_say() {
        let on = |radius_m| GRID.on(&Planet { radius_m, atmosphere_height_m: 1e5, ground_albedo: [0.0; 3] });
        assert_eq!((on(1e5), on(6.36e6)), (GRID, GRID));
        assert_eq!(on(7e7), SourceGrid { low: 11, ..GRID });
        assert_eq!(on(1e12), SourceGrid { low: 12, ..GRID });
    }

    #[test]
    fn directions_and_the_cells_around_them_fill_the_sphere() {
        let nodes = GridNodes::new(GRID);
        for (horizon_mu, mu_s) in [(0.0, 0.7), (-0.2, -0.3), (-0.01, 1.0)] {
            let grid = nodes.at(horizon_mu, mu_s);
            let whole: f64 = (0..GRID.count()).map(|i| grid.direction(i).solid_angle_sr).sum();
            assert!((whole - 4.0 * PI).abs() < 1e-12, "{whole}");
            // By midpoints in both shares.
            let points = 16;
            let share = |k: u32| (f64::from(k) + 0.5) / f64::from(points);
            let in_cell = |index: u32| -> f64 {
                let places = (0..points * points).map(|k| [share(k / points), share(k % points)]);
                let all: f64 = places.map(|shares| grid.direction_in_cell(index, shares).solid_angle_sr).sum();
                all / f64::from(points * points)
            };
            let cells: f64 = (0..GRID.count()).map(in_cell).sum();
            assert!((cells / whole - 1.0).abs() < 1e-3, "{cells}");
        }
    }

    #[test]
    fn a_direction_of_the_grid_is_its_own_corner() {
        let nodes = GridNodes::new(GRID);
        let grid = nodes.at(-0.03, 0.4);
        for index in 0..GRID.count() {
            let GridDirection { mu, phi_rad, .. } = grid.direction(index);
            let weights = grid.corners(mu, phi_rad.cos()).into_iter().filter(|(corner, _)| *corner == index);
            let weight: f64 = weights.map(|(_, weight)| weight).sum();
            assert!((weight - 1.0).abs() < 1e-6, "{index}: {weight}");
        }
    }
}
