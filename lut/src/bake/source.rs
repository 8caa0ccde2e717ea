//! The source function as a table, and what it is computed from, order by order: the shaders' `source_table.wgsl`,
//! `first_source.wgsl` and `higher_source.wgsl`, in f64.

use rayon::prelude::*;

use crate::mapping::{MultipleScatteringMapping, inside_tile, unit_from_texel};
use crate::table::Table;
use crate::{BAND_COUNT, Bands};

use super::SourceGrid;
use super::convolution::{Field, Moments};
use super::glow::phases_towards;
use super::harmonics::HARMONIC_COUNT;
use super::light::{DARK, Light};
use super::ray::AirRay;
use super::source_grid::GridAt;

/// The largest ratio between orders that the series' rest believes.
const MAX_RATIO: f64 = 0.9;

/// Slices of the moments: ln I_00, I_lm / I_00, ln of the irradiance.
const MOMENT_COUNT: u32 = HARMONIC_COUNT as u32 + 2;
/// The mean over directions times this is I_00.
const MEAN_TO_I_00: f64 = 3.544_907_701_811_032;

/// For each group of scatterers that share a density profile, radiance averaged over directions as their phase functions
/// weigh them; and what the radiance field is as a whole.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceTable {
    /// Of each group, (sun, altitude, direction): ln Σ_c b_c ∫p_c I dω' / Σ_c b_c.
    groups: Vec<Table>,
    /// (sun, altitude, value): ln I_00, I_lm / I_00 in the order of (l, m), then ln of the irradiance.
    moments: Table,
}

/// The same of one texel, one order or the sum of some, as it is.
#[derive(Debug, Clone)]
pub(super) struct Source {
    /// By group and direction.
    groups: Vec<Vec<Bands>>,
    moments: Moments,
}

fn ln(light: Bands) -> Bands {
    light.map(|value| value.max(DARK).ln())
}

impl Source {
    /// Adds an order, with all that follows it where it is the last: from it on, orders shrink by the constant ratio of
    /// the means of `order` and the one `before` it.
    fn add(&mut self, order: &Self, before: Option<&Self>) {
        let rest: Bands = std::array::from_fn(|band| {
            before.map_or(1.0, |before| {
                let ratio = order.moments.mean[band] / before.moments.mean[band].max(DARK);
                1.0 / (1.0 - ratio.clamp(0.0, MAX_RATIO))
            })
        });
        let add = |sum: &mut Bands, value: &Bands| {
            (0..BAND_COUNT).for_each(|band| sum[band] = sum[band].max(DARK) + value[band].max(DARK) * rest[band]);
        };
        for (sum, value) in self.groups.iter_mut().flatten().zip(order.groups.iter().flatten()) {
            add(sum, value);
        }
        let (mean, added) = (self.moments.mean, order.moments.mean);
        for (sum, value) in self.moments.harmonics.iter_mut().zip(&order.moments.harmonics) {
            for band in 0..BAND_COUNT {
                let (mean, added) = (mean[band].max(DARK), added[band].max(DARK) * rest[band]);
                sum[band] = (mean * sum[band] + added * value[band]) / (mean + added);
            }
        }
        add(&mut self.moments.mean, &order.moments.mean);
        add(&mut self.moments.irradiance, &order.moments.irradiance);
    }
}

impl Moments {
    /// As a table holds them.
    pub(super) fn encoded(&self) -> Vec<Bands> {
        let mut values = vec![ln(self.mean.map(|mean| mean * MEAN_TO_I_00))];
        values.extend(&self.harmonics);
        values.push(ln(self.irradiance));
        values
    }
}

impl SourceTable {
    /// From all texels, row by row.
    fn new(size: [u32; 2], texels: &[Source]) -> Self {
        let [width, height] = size;
        let first = &texels[0];
        let of_group = |group: usize| {
            let directions = first.groups[group].len();
            let slice = |k: usize| texels.iter().map(move |texel| ln(texel.groups[group][k]));
            Table::new([width, height, directions as u32], (0..directions).flat_map(slice).collect())
        };
        let encoded: Vec<_> = texels.iter().map(|texel| texel.moments.encoded()).collect();
        let moments = (0..MOMENT_COUNT as usize).flat_map(|k| encoded.iter().map(move |values| values[k]));
        Self {
            groups: (0..first.groups.len()).map(of_group).collect(),
            moments: Table::new([width, height, MOMENT_COUNT], moments.collect()),
        }
    }

    /// From the shaders' picture of tiles (`source_grid.wgsl`), one slice for each group: tiles of `size` texels side by side
    /// by azimuth and row by row by zenith angle; in one row more irradiance, mean, and the others.
    ///
    /// # Panics
    /// When the picture is smaller than its grid says: a mistake of the caller's, not of a user's.
    pub fn from_tiles(grid: SourceGrid, size: [u32; 2], tiles: &Table) -> Self {
        let [width, height] = size;
        let tile = |column: u32, row: u32, group: u32| {
            let places = (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]));
            places.map(move |[x, y]| tiles.texel(column * width + x, row * height + y, group))
        };
        let of_group = |group: u32| {
            let texels = (0..grid.count()).flat_map(|k| tile(k % grid.azimuths, k / grid.azimuths, group));
            Table::new([width, height, grid.count()], texels.collect())
        };
        let moment = |column: u32| tile(column, grid.cosines(), 0);
        let mean = moment(1).map(|ln_mean| ln_mean.map(|value| value + MEAN_TO_I_00.ln()));
        let moments = mean.chain((0..HARMONIC_COUNT as u32).flat_map(|k| moment(2 + k))).chain(moment(0));
        Self {
            groups: (0..tiles.size()[2]).map(of_group).collect(),
            moments: Table::new([width, height, MOMENT_COUNT], moments.collect()),
        }
    }

    /// Its moments, as packs hold them: docs/notation.md.
    pub fn moments(&self) -> &Table {
        &self.moments
    }

    /// ln of the sky's irradiance on a horizontal plane: (sun, altitude).
    pub fn irradiance(&self) -> Table {
        self.moments.slice(MOMENT_COUNT - 1)
    }

    /// Where unit coordinates of a sun and an altitude lie in it.
    pub(super) fn place(&self, unit: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|i| inside_tile(unit[i], self.moments.size()[i]))
    }

    /// Irradiance of the sky at a place.
    pub(super) fn irradiance_at(&self, place: [f64; 2]) -> Bands {
        self.moments.bilinear(place, MOMENT_COUNT - 1).map(f64::exp)
    }

    /// Of a group at a place, between the directions of the grid.
    pub(super) fn at(&self, group: usize, place: [f64; 2], corners: &[(u32, f64); 4]) -> Bands {
        let mut logarithm = [0.0; BAND_COUNT];
        for &(direction, weight) in corners {
            let value = self.groups[group].bilinear(place, direction);
            (0..BAND_COUNT).for_each(|band| logarithm[band] += weight * value[band]);
        }
        logarithm.map(f64::exp)
    }
}

impl Light<'_> {
    /// The table of the sum of all orders. `progress` is told the number of each order before it is computed.
    pub(super) fn source_table(&self, progress: impl Fn(u32)) -> SourceTable {
        let size = self.settings.source_size;
        let mapping = MultipleScatteringMapping::new(self.air.planet());
        let texels = |field: &(dyn Fn(f64, f64) -> Field + Sync)| -> Vec<Source> {
            let texel = |index: u32| {
                let [altitude_m, mu_s] = mapping.parameters(unit_from_texel([index % size[0], index / size[0]], size));
                let field = field(altitude_m, mu_s);
                let groups = field.source_function(self.air, &self.phases, &self.groups);
                Source { groups, moments: field.moments() }
            };
            (0..size[0] * size[1]).into_par_iter().map(texel).collect()
        };
        progress(1);
        let mut order =
            texels(&|altitude_m, mu_s| self.field(altitude_m, mu_s, |ray, phases| self.first_order(ray, phases)));
        let mut sum = order.clone();
        for n in 2..=self.settings.orders {
            progress(n);
            let table = SourceTable::new(size, &order);
            let next = texels(&|altitude_m, mu_s| self.field(altitude_m, mu_s, |ray, _| self.next_order(&table, ray)));
            let is_last = n == self.settings.orders;
            for ((sum, next), before) in sum.iter_mut().zip(&next).zip(&order) {
                sum.add(next, is_last.then_some(before));
            }
            order = next;
        }
        SourceTable::new(size, &sum)
    }

    /// What `radiance` gives along the rays of the grid's directions, given the phase functions towards the light.
    fn field(&self, altitude_m: f64, mu_s: f64, radiance: impl Fn(AirRay, &[f64]) -> Bands) -> Field {
        let grid: GridAt = self.grid.at(self.horizon_mu(altitude_m), mu_s);
        Field::new(&grid, self.grid.grid.count(), |index| {
            let direction = grid.direction(index);
            let (mu, cos_phi) = (direction.mu, direction.phi_rad.cos());
            let ray = AirRay::along(self.air, altitude_m, mu_s, mu, cos_phi, direction.hits_ground);
            radiance(ray, &phases_towards(&self.phases, &grid, index))
        })
    }

    /// The moments of the field that a table of all orders lights, anywhere.
    pub(super) fn moments(&self, table: &SourceTable, altitude_m: f64, mu_s: f64) -> Moments {
        let all = |ray: AirRay, phases: &[f64]| {
            let (first, more) = (self.first_order(ray, phases), self.next_order(table, ray));
            std::array::from_fn(|band| first[band] + more[band])
        };
        self.field(altitude_m, mu_s, all).moments()
    }
}
