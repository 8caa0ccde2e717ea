//! How far a table as it is stored is from evaluation in f64, between its texels.

use rayon::prelude::*;

use super::Precision;
use super::manifest::MeasuredError;
use crate::Bands;
use crate::bake::Baked;
use crate::geometry::horizon_mu;
use crate::mapping::{MultipleScatteringMapping, OpticalDepthMapping, SkyHalf, SkyViewMapping};
use crate::sky_tables::SkyTables;

/// Places at which cheap tables are compared, and dear ones.
const MANY: u32 = 2000;
const FEW: u32 = 128;

/// Light that counts as dark, for unit irradiance of the sun: half of what the full moon sends.
const DARK: f64 = 1e-6;

/// The radical inverse of an index: Halton's sequence in one base (Halton 1964, Comm. ACM 7, 701).
fn halton(mut index: u32, base: u32) -> f64 {
    let (mut value, mut share) = (0.0, 1.0);
    while index > 0 {
        share /= f64::from(base);
        value += share * f64::from(index % base);
        index /= base;
    }
    value
}

/// Places spread evenly over [0, 1]⁵.
fn place(index: u32) -> [f64; 5] {
    [2, 3, 5, 7, 11].map(|base| halton(index + 1, base))
}

fn statistics(of: String, mut errors: Vec<f64>) -> MeasuredError {
    errors.sort_by(f64::total_cmp);
    let at = |quantile: f64| errors.get((quantile * (errors.len() - 1) as f64).round() as usize).copied();
    let at = |quantile| if errors.is_empty() { 0.0 } else { at(quantile).unwrap_or(0.0) };
    MeasuredError { of, samples: errors.len() as u32, median: at(0.5), p99: at(0.99), maximum: at(1.0) }
}

/// Relative errors of values that are not dark, apart for a sun above and below the horizontal.
fn by_sun(quantity: &str, pairs: &[(f64, Bands, Bands)]) -> Vec<MeasuredError> {
    let errors = |up: bool| {
        let chosen = pairs.iter().filter(|(mu_s, ..)| (*mu_s >= 0.0) == up);
        let each = chosen.flat_map(|(_, truth, found)| truth.iter().zip(found));
        each.filter(|(truth, _)| **truth > DARK).map(|(truth, found)| (found / truth - 1.0).abs()).collect()
    };
    let name = |sun: &str| format!("relative error of {quantity}, sun {sun} the horizontal, above {DARK:e}");
    vec![statistics(name("above"), errors(true)), statistics(name("below"), errors(false))]
}

/// The errors of each table, in the order of the pack, in one precision.
type ErrorsByTable = Vec<Vec<MeasuredError>>;

/// What is measured of each precision.
pub(super) fn measure(baked: &Baked, stored: &[(Precision, SkyTables)]) -> Vec<ErrorsByTable> {
    let planet = baked.air().planet();
    let (radius_m, top_m) = (planet.radius_m, planet.atmosphere_height_m);
    let depth = OpticalDepthMapping { radius_m, top_m };
    let sun = MultipleScatteringMapping::new(planet);

    let directions: Vec<_> = (0..MANY).map(|i| depth.parameters([place(i)[0], place(i)[1]])).collect();
    let optical: Vec<Bands> = directions.par_iter().map(|&[h, mu]| baked.optical_depth(h, mu)).collect();
    let suns: Vec<_> = (0..FEW).map(|i| sun.parameters([place(i)[0], place(i)[1]])).collect();
    let fields: Vec<Vec<Bands>> = suns.par_iter().map(|&[h, mu_s]| baked.multiple_scattering(h, mu_s)).collect();
    let rays: Vec<_> = (0..MANY).map(|i| view(place(i), &sun, radius_m)).collect();
    let radiance: Vec<Bands> = rays.par_iter().map(|&(h, cosines)| baked.sky_radiance(h, cosines)).collect();

    let of_tables = |tables: &SkyTables| {
        let transmittance = directions.iter().zip(&optical).flat_map(|(&[h, mu], tau)| {
            let found = tables.transmittance_to_space(h, mu.max(horizon_mu(radius_m, h)));
            (0..3).map(move |band| (found[band] - (-tau[band]).exp()).abs())
        });
        let transmittance = statistics("absolute error of transmittance".to_owned(), transmittance.collect());
        let irradiance: Vec<_> = suns
            .iter()
            .zip(&fields)
            .map(|(&[h, mu_s], field)| {
                let truth = field[field.len() - 1].map(f64::exp);
                (mu_s, truth, tables.sky_irradiance(h, mu_s))
            })
            .collect();
        let mean: Vec<_> = suns
            .iter()
            .zip(&fields)
            .map(|(&[h, mu_s], field)| {
                let found = tables.set().multiple_scattering.at_unit(sun.unit(h, mu_s), 0);
                (mu_s, field[0].map(f64::exp), found.map(f64::exp))
            })
            .collect();
        let sky: Vec<_> = rays
            .iter()
            .zip(&radiance)
            .map(|(&(h, cosines), truth)| (cosines[1], *truth, tables.sky_radiance(h, cosines)))
            .collect();
        vec![
            vec![transmittance],
            by_sun("irradiance", &irradiance),
            by_sun("the mean over directions, I_00", &mean),
            by_sun("sky_radiance", &sky),
        ]
    };
    stored.iter().map(|(_, tables)| of_tables(tables)).collect()
}

/// A ray spread over the table of scattered light as its texels are: altitude, and cosines of view, sun and between.
fn view(place: [f64; 5], sun: &MultipleScatteringMapping, radius_m: f64) -> (f64, [f64; 3]) {
    let [altitude_m, mu_s] = sun.parameters([place[0], place[1]]);
    let half = if place[4] < 0.5 { SkyHalf::Sky } else { SkyHalf::Ground };
    let mapping = SkyViewMapping::within_air(horizon_mu(radius_m, altitude_m).acos());
    let [zenith_rad, azimuth_rad] = mapping.parameters([place[2], place[3]], half);
    let mu = zenith_rad.cos();
    let nu = mu * mu_s + zenith_rad.sin() * (1.0 - mu_s * mu_s).max(0.0).sqrt() * azimuth_rad.cos();
    (altitude_m, [mu, mu_s, nu.clamp(-1.0, 1.0)])
}
