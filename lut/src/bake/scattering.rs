//! The 4D table of scattered light: the shaders' `scattering_table.wgsl`, in f64.

use std::sync::atomic::{AtomicU32, Ordering};

use rayon::prelude::*;

use crate::geometry::air_length_m;
use crate::mapping::{MultipleScatteringMapping, SkyHalf, SkyViewMapping, unit_from_texel};
use crate::quadrature::{GaussNode, gauss_legendre};
use crate::table::Table;
use crate::{BAND_COUNT, Bands};

use super::Baked;
use super::light::Light;
use super::ray::AirRay;
use super::source::SourceTable;

/// Light per metre below which all is night: over the longest ray a hundredth of the natural night sky. A floor much lower
/// would stand so far from lit texels, in logarithms, that a filter's rounding between them were seen.
const NIGHT: f64 = 1e-16;

/// Where rays of the table start: some way off the ground and below the top, so that all have a length that they can be
/// divided by.
fn table_altitude_m(altitude_m: f64, top_m: f64) -> f64 {
    altitude_m.clamp(1e-7 * top_m, (1.0 - 1e-5) * top_m)
}

impl Light<'_> {
    /// Multiply scattered radiance, then each scatterer's light, over the length of air: ln of 1/(m sr), and of 1/m.
    fn layers(&self, table: &SourceTable, ray: AirRay, nodes: &[GaussNode]) -> Vec<Bands> {
        let planet = self.air.planet();
        let (radius_m, top_m) = (planet.radius_m, planet.atmosphere_height_m);
        let length_m = air_length_m(radius_m, top_m, ray.altitude_m, ray.mu, ray.hits_ground).max(1e-3);
        let integrals = self.integrals(table, ray, nodes);
        let all = std::iter::once(integrals.multiple).chain(integrals.single);
        all.map(|light| light.map(|value| (value / length_m).max(NIGHT).ln())).collect()
    }

    pub(super) fn scattering_table(&self, source: &SourceTable, progress: &(dyn Fn(f64) + Sync)) -> Table {
        let size = self.settings.scattering;
        let layers = 1 + self.air.scatterers().len();
        let row_length = (size.azimuths * size.suns) as usize;
        let rows: Vec<(u32, u32, u32)> = (0..2)
            .flat_map(|half| (0..size.altitudes).map(move |slice| (half, slice)))
            .flat_map(|(half, slice)| (0..size.elevations).map(move |y| (half, slice, y)))
            .collect();
        let finished = AtomicU32::new(0);
        let computed: Vec<Vec<Vec<Bands>>> = rows
            .par_iter()
            .map(|&(half, slice, y)| {
                let row = (0..row_length as u32).map(|x| self.texel(source, half, slice, [x, y])).collect();
                let done = finished.fetch_add(1, Ordering::Relaxed) + 1;
                if done.is_multiple_of(64) {
                    progress(f64::from(done) / rows.len() as f64);
                }
                row
            })
            .collect();
        let block_rows = (size.altitudes * size.elevations) as usize;
        let mut texels = Vec::with_capacity(2 * layers * block_rows * row_length);
        for half in computed.chunks(block_rows) {
            for layer in 0..layers {
                texels.extend(half.iter().flatten().map(|values| values[layer]));
            }
        }
        let slices = 2 * layers as u32 * size.altitudes;
        Table::new([size.azimuths * size.suns, size.elevations, slices], texels)
    }

    fn texel(&self, source: &SourceTable, half: u32, slice: u32, [x, y]: [u32; 2]) -> Vec<Bands> {
        let size = self.settings.scattering;
        let light_unit = unit_from_texel([x % size.suns, slice], [size.suns, size.altitudes]);
        let [altitude_m, mu_s] = MultipleScatteringMapping::new(self.air.planet()).parameters(light_unit);
        let altitude_m = table_altitude_m(altitude_m, self.top_m());
        let view_unit = unit_from_texel([x / size.suns, y], [size.azimuths, size.elevations]);
        let half = if half == 0 { SkyHalf::Sky } else { SkyHalf::Ground };
        let mapping = SkyViewMapping::within_air(self.horizon_mu(altitude_m).acos());
        let [zenith_rad, azimuth_rad] = mapping.parameters(view_unit, half);
        let (mu, cos_phi) = (zenith_rad.cos(), azimuth_rad.cos());
        let ray = AirRay::along(self.air, altitude_m, mu_s, mu, cos_phi, half == SkyHalf::Ground);
        self.layers(source, ray, &self.rule)
    }
}

impl Baked<'_> {
    /// Radiance of the air along a ray from within it, 1/sr, for unit irradiance: with twice the nodes that the tables
    /// are made with, and no interpolation but that of optical depth and of the multiply scattered field on the way.
    pub fn sky_radiance(&self, altitude_m: f64, [mu, mu_s, nu]: [f64; 3]) -> Bands {
        let light = &self.light;
        let altitude_m = table_altitude_m(altitude_m, light.top_m());
        let ray = AirRay::new(light.air, altitude_m, [mu, mu_s, nu], mu < light.horizon_mu(altitude_m));
        let nodes = gauss_legendre(2 * light.settings.nodes_per_leg as usize);
        let integrals = light.integrals(&self.source, ray, &nodes);
        let mut radiance = integrals.multiple;
        for (single, scatterer) in integrals.single.iter().zip(light.air.scatterers()) {
            let phase = scatterer.phase.value(nu);
            (0..BAND_COUNT).for_each(|band| radiance[band] += phase * single[band]);
        }
        radiance
    }
}
