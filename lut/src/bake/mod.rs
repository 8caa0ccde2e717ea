//! The tables of a planet's air, computed on the CPU in f64 by the same functions as the shaders' passes.
//!
//! [`Baked::new`] makes them; [`Baked::tables`] are what engines read, and the other functions of [`Baked`] evaluate the
//! same quantities anywhere between texels, which is how a pack measures what its tables lose.

mod air;
mod convolution;
mod glow;
mod harmonics;
mod light;
mod ray;
mod scattering;
mod settings;
mod source;
mod source_grid;
mod tent;

pub use air::{Air, AirError, MAX_SCATTERERS};
pub use settings::{BakeSettings, ScatteringSize};
pub use source::SourceTable;
pub use source_grid::SourceGrid;

use rayon::prelude::*;

use crate::Bands;
use crate::mapping::{OpticalDepthMapping, unit_from_texel};
use crate::sky_tables::{SkyTables, TableSet};
use crate::table::Table;

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
    source: SourceTable,
    tables: SkyTables,
}

impl<'a> Baked<'a> {
    /// Makes all tables on rayon's threads. `progress` is called from any of them, with rising shares.
    pub fn new(air: &'a Air, settings: BakeSettings, progress: &(dyn Fn(Progress) + Sync)) -> Self {
        progress(Progress { stage: "optical depth", done: 0.0 });
        let optical_depth = optical_depth_table(air, settings.optical_depth_size);
        let light = Light::new(air, settings, optical_depth.clone());
        let source = light.source_table(|order| {
            // Each order costs about as much as a tenth of the scattered light.
            progress(Progress { stage: "multiple scattering", done: 0.05 * f64::from(order) });
        });
        let start = 0.05 * f64::from(settings.orders + 1);
        let share = |done: f64| progress(Progress { stage: "scattered light", done: start + (1.0 - start) * done });
        let scattering = light.scattering_table(&source, &share);
        progress(Progress { stage: "done", done: 1.0 });
        let set = TableSet {
            transmittance: optical_depth,
            irradiance: source.irradiance(),
            multiple_scattering: source.moments().clone(),
            scattering,
        };
        Self { light, source, tables: SkyTables::new(air, settings.scattering, set) }
    }

    /// The same around tables that another backend has made with the same settings: to evaluate between their texels.
    pub fn around(air: &'a Air, settings: BakeSettings, source: SourceTable, tables: SkyTables) -> Self {
        let light = Light::new(air, settings, tables.set().transmittance.clone());
        Self { light, source, tables }
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

    /// The texels of the table of multiple scattering at any place: ln I_00, I_lm / I_00, ln of the irradiance; from the
    /// light that the tables hold, walked to there once more.
    pub fn multiple_scattering(&self, altitude_m: f64, mu_s: f64) -> Vec<Bands> {
        self.light.moments(&self.source, altitude_m, mu_s).encoded()
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
