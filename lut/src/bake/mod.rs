//! The tables of a planet's air, computed on the CPU in f64 by the same functions as the shaders' passes.
//!
//! [`Baked::new`] makes them; [`Baked::tables`] are what engines read, and the other functions of [`Baked`] evaluate the
//! same quantities anywhere between texels, which is how a pack measures what its tables lose.

mod air;
mod field;
mod harmonics;
mod light;
mod ray;
mod scattering;
mod settings;
mod tent;

pub use air::{Air, AirError, MAX_SCATTERERS};
pub use settings::{BakeSettings, Directions, ScatteringSize};

use rayon::prelude::*;

use crate::Bands;
use crate::mapping::{MultipleScatteringMapping, OpticalDepthMapping, unit_from_texel};
use crate::sky_tables::{SkyTables, TableSet};
use crate::table::Table;

use field::Field;
use light::Light;

/// How far a bake has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// What is being computed.
    pub stage: &'static str,
    /// Share of all work that is done, in [0, 1].
    pub done: f64,
}

/// Tables with all that evaluates them anew between their texels.
pub struct Baked<'a> {
    light: Light<'a>,
    /// The table of each order but the last.
    orders: Vec<Table>,
    tables: SkyTables,
}

impl<'a> Baked<'a> {
    /// Makes all tables on rayon's threads. `progress` is called from any of them, with rising shares.
    pub fn new(air: &'a Air, settings: BakeSettings, progress: &(dyn Fn(Progress) + Sync)) -> Self {
        progress(Progress { stage: "optical depth", done: 0.0 });
        let optical_depth = optical_depth_table(air, settings.optical_depth_size);
        let light = Light::new(air, settings, optical_depth.clone());
        let mut orders = Vec::new();
        let mut fields: Vec<Vec<Field>> = Vec::new();
        for order in 1..=settings.orders {
            // Each order costs about as much as a tenth of the scattered light.
            progress(Progress { stage: "multiple scattering", done: 0.05 * f64::from(order) });
            let computed = light.fields(&orders);
            if order < settings.orders {
                orders.push(light.table_of(&computed));
            }
            fields.push(computed);
        }
        let sums: Vec<Field> = (0..fields[0].len())
            .map(|texel| Field::sum(&fields.iter().map(|order| order[texel].clone()).collect::<Vec<_>>()))
            .collect();
        let multiple_scattering = light.table_of(&sums);
        let start = 0.05 * f64::from(settings.orders + 1);
        let share = |done: f64| progress(Progress { stage: "scattered light", done: start + (1.0 - start) * done });
        let scattering = light.scattering_table(&multiple_scattering, &share);
        progress(Progress { stage: "done", done: 1.0 });
        let set = TableSet {
            transmittance: optical_depth,
            irradiance: multiple_scattering.slice(settings.coefficient_count()),
            multiple_scattering,
            scattering,
        };
        Self { light, orders, tables: SkyTables::new(air, settings.scattering, set) }
    }

    /// The same around tables that another backend has made with the same settings: to evaluate between their texels.
    /// Only what other tables are computed from is computed here again.
    pub fn around(air: &'a Air, settings: BakeSettings, tables: SkyTables) -> Self {
        let light = Light::new(air, settings, tables.set().transmittance.clone());
        let mut orders = Vec::new();
        for _ in 1..settings.orders {
            let table = light.table_of(&light.fields(&orders));
            orders.push(table);
        }
        Self { light, orders, tables }
    }

    /// What engines read.
    pub fn tables(&self) -> &SkyTables {
        &self.tables
    }

    /// The air that they are made of.
    pub fn air(&self) -> &Air {
        self.light.air
    }

    /// How they were made.
    pub fn settings(&self) -> &BakeSettings {
        &self.light.settings
    }

    /// Optical depth from an altitude along μ, above the horizon, to the top.
    pub fn optical_depth(&self, altitude_m: f64, mu: f64) -> Bands {
        light::optical_depth(self.light.air, altitude_m, mu)
    }

    /// The texels of the table of multiple scattering at any place: ln I_00, I_lm / I_00, ln of the irradiance.
    pub fn multiple_scattering(&self, altitude_m: f64, mu_s: f64) -> Vec<Bands> {
        let fields: Vec<_> = (0..=self.orders.len())
            .map(|n| self.light.field_of_next_order(&self.orders[..n], altitude_m, mu_s))
            .collect();
        Field::sum(&fields).encoded()
    }
}

fn optical_depth_table(air: &Air, size: [u32; 2]) -> Table {
    let mapping = OpticalDepthMapping { radius_m: air.planet().radius_m, top_m: air.planet().atmosphere_height_m };
    let texel = |index: u32| {
        let [altitude_m, mu] = mapping.parameters(unit_from_texel([index % size[0], index / size[0]], size));
        light::optical_depth(air, altitude_m, mu)
    };
    Table::new([size[0], size[1], 1], (0..size[0] * size[1]).into_par_iter().map(texel).collect())
}

impl Light<'_> {
    /// The fields of the next order at all texels.
    fn fields(&self, orders: &[Table]) -> Vec<Field> {
        let size = self.settings.multiple_scattering_size;
        let mapping = MultipleScatteringMapping::new(self.air.planet());
        let texel = |index: u32| {
            let [altitude_m, mu_s] = mapping.parameters(unit_from_texel([index % size[0], index / size[0]], size));
            self.field_of_next_order(orders, altitude_m, mu_s)
        };
        (0..size[0] * size[1]).into_par_iter().map(texel).collect()
    }

    /// One slice for each value of a field.
    fn table_of(&self, fields: &[Field]) -> Table {
        let [width, height] = self.settings.multiple_scattering_size;
        let encoded: Vec<_> = fields.iter().map(Field::encoded).collect();
        let slices = self.settings.coefficient_count() + 1;
        let texels = (0..slices as usize).flat_map(|k| encoded.iter().map(move |values| values[k]));
        Table::new([width, height, slices], texels.collect())
    }
}
