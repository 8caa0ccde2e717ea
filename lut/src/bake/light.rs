//! Light along rays, order by order, from tables of what comes before; for unit irradiance of the light.

use std::f64::consts::PI;

use crate::geometry::horizon_mu;
use crate::mapping::{MultipleScatteringMapping, OpticalDepthMapping};
use crate::phase::PhaseLobe;
use crate::quadrature::{GaussNode, gauss_legendre};
use crate::table::Table;
use crate::{BAND_COUNT, Bands};

use super::ray::{AirRay, Node};
use super::source::SourceTable;
use super::source_grid::GridNodes;
use super::{Air, BakeSettings, MAX_SCATTERERS};

/// Below this, light is dark; it keeps logarithms finite.
pub(super) const DARK: f64 = 1e-30;

/// What rays are integrated with.
pub(super) struct Light<'a> {
    pub(super) air: &'a Air,
    pub(super) settings: BakeSettings,
    pub(super) rule: Vec<GaussNode>,
    pub(super) grid: GridNodes,
    /// Of each scatterer: its phase function, and the number of its density profile among those of all.
    pub(super) phases: Vec<Vec<PhaseLobe>>,
    pub(super) groups: Vec<usize>,
    optical_depth: Table,
}

/// Light along one view ray, without what depends on the angle to the light alone.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Integrals {
    /// Multiply scattered radiance, 1/sr.
    pub(super) multiple: Bands,
    /// ∫b T T_light dt of each scatterer: its phase function is missing.
    pub(super) single: Vec<Bands>,
}

impl<'a> Light<'a> {
    pub(super) fn new(air: &'a Air, settings: BakeSettings, optical_depth: Table) -> Self {
        Self {
            air,
            settings,
            rule: gauss_legendre(settings.nodes_per_leg as usize),
            grid: GridNodes::new(settings.source_grid.on(air.planet())),
            phases: air.phase_lobes(),
            groups: air.profile_groups(),
            optical_depth,
        }
    }

    pub(super) fn top_m(&self) -> f64 {
        self.air.planet().atmosphere_height_m
    }

    pub(super) fn optical_depth_to_top(&self, altitude_m: f64, mu: f64) -> Bands {
        let mapping = OpticalDepthMapping { radius_m: self.air.planet().radius_m, top_m: self.top_m() };
        self.optical_depth.at_unit(mapping.unit(altitude_m, mu), 0)
    }

    /// Radiance that the ground where a ray ends adds, given the irradiance there.
    fn add_ground(&self, radiance: &mut Bands, optical_depth: Bands, irradiance: Bands) {
        let albedo = self.air.planet().ground_albedo;
        for band in 0..BAND_COUNT {
            radiance[band] += (-optical_depth[band]).exp() * albedo[band] / PI * irradiance[band];
        }
    }

    /// Light scattered once, or reflected once by the ground, given each scatterer's phase function.
    pub(super) fn first_order(&self, ray: AirRay, phases: &[f64]) -> Bands {
        let ray = ray.cut_at_shadow(self.air);
        let mut radiance = [0.0; BAND_COUNT];
        let whole = ray.walk(self.air, &self.rule, |node| {
            if node.dark {
                return;
            }
            let light = self.optical_depth_to_top(node.altitude_m, node.mu_s);
            for (b, phase) in self.air.scattering_per_m(node.altitude_m).zip(phases) {
                for band in 0..BAND_COUNT {
                    let transmittance = (-node.optical_depth[band] - light[band]).exp();
                    radiance[band] += node.weight_m * b[band] * phase * transmittance;
                }
            }
        });
        if ray.hits_ground {
            let mu_s = ray.ground_mu_s(self.air);
            if mu_s > 0.0 {
                let irradiance = self.optical_depth_to_top(0.0, mu_s).map(|tau| mu_s * (-tau).exp());
                self.add_ground(&mut radiance, whole, irradiance);
            }
        }
        radiance
    }

    /// Light of one order more than a table holds.
    pub(super) fn next_order(&self, table: &SourceTable, ray: AirRay) -> Bands {
        let mut radiance = [0.0; BAND_COUNT];
        let whole = ray.walk(self.air, &self.rule, |node| {
            let source = self.source(table, node);
            for band in 0..BAND_COUNT {
                radiance[band] += node.weight_m * (-node.optical_depth[band]).exp() * source[band];
            }
        });
        if ray.hits_ground {
            let unit = MultipleScatteringMapping::new(self.air.planet()).unit(0.0, ray.ground_mu_s(self.air));
            self.add_ground(&mut radiance, whole, table.irradiance_at(table.place(unit)));
        }
        radiance
    }

    /// What a view ray's tables hold of it.
    pub(super) fn integrals(&self, table: &SourceTable, ray: AirRay, rule: &[GaussNode]) -> Integrals {
        let ray = ray.cut_at_shadow(self.air);
        let mut multiple = [0.0; BAND_COUNT];
        let mut single = vec![[0.0; BAND_COUNT]; self.air.scatterers().len()];
        ray.walk(self.air, rule, |node| {
            let transmittance = node.optical_depth.map(|tau| (-tau).exp());
            let source = self.source(table, node);
            for band in 0..BAND_COUNT {
                multiple[band] += node.weight_m * transmittance[band] * source[band];
            }
            if node.dark {
                return;
            }
            let light = self.optical_depth_to_top(node.altitude_m, node.mu_s);
            for (sum, b) in single.iter_mut().zip(self.air.scattering_per_m(node.altitude_m)) {
                for band in 0..BAND_COUNT {
                    sum[band] += node.weight_m * b[band] * transmittance[band] * (-light[band]).exp();
                }
            }
        });
        Integrals { multiple, single }
    }

    /// Radiance sent into the view direction per metre: Σ b_c ∫p_c I dω'.
    fn source(&self, table: &SourceTable, node: &Node) -> Bands {
        let unit = MultipleScatteringMapping::new(self.air.planet()).unit(node.altitude_m, node.mu_s);
        let corners = self.grid.at(self.horizon_mu(node.altitude_m), node.mu_s).corners(node.mu, node.cos_phi);
        let (mut source, place) = ([0.0; BAND_COUNT], table.place(unit));
        let mut found: [Option<Bands>; MAX_SCATTERERS] = [None; MAX_SCATTERERS];
        for (b, &group) in self.air.scattering_per_m(node.altitude_m).zip(&self.groups) {
            let light = *found[group].get_or_insert_with(|| table.at(group, place, &corners));
            (0..BAND_COUNT).for_each(|band| source[band] += b[band] * light[band]);
        }
        source
    }

    /// Cosine of the horizon's zenith angle at an altitude.
    pub(super) fn horizon_mu(&self, altitude_m: f64) -> f64 {
        horizon_mu(self.air.planet().radius_m, altitude_m)
    }
}

/// The optical depth from an altitude along μ, above the horizon, to the top.
pub(super) fn optical_depth(air: &Air, altitude_m: f64, mu: f64) -> Bands {
    AirRay::new(air, altitude_m, [mu, 1.0, mu], false).optical_depth(air)
}
