//! Radiance fields as spherical harmonics, order by order: what the shaders' `directions.wgsl`, `first_order.wgsl` and
//! `higher_order.wgsl` do, in f64.

use std::f64::consts::PI;

use crate::quadrature::gauss_legendre;
use crate::table::Table;
use crate::{BAND_COUNT, Bands};

use super::harmonics::harmonics;
use super::light::{DARK, Light};
use super::ray::AirRay;

/// The largest ratio between orders that the series' rest believes.
const MAX_RATIO: f64 = 0.9;

/// A field at one altitude under one light.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Field {
    /// I_lm, absolute; I_00 first.
    coefficients: Vec<Bands>,
    /// On a horizontal plane, from above.
    irradiance: Bands,
}

struct Direction {
    mu: f64,
    cos_phi: f64,
    /// Both of its mirror images counted, sr.
    solid_angle_sr: f64,
    hits_ground: bool,
}

impl Light<'_> {
    /// Zenith angles are cut at the horizon, where radiance has a kink, and at the horizontal.
    fn directions(&self, horizon_mu: f64) -> Vec<Direction> {
        let counts = self.settings.directions;
        let below = gauss_legendre(counts.below as usize).into_iter().map(|node| {
            let x = node.abscissa;
            let width = 1.0 + horizon_mu;
            (horizon_mu - width * x * x, 2.0 * x * width * node.weight, true)
        });
        let band = gauss_legendre(counts.band as usize)
            .into_iter()
            .map(|node| (horizon_mu * (1.0 - node.abscissa), -horizon_mu * node.weight, false));
        let above = gauss_legendre(counts.above as usize)
            .into_iter()
            .map(|node| (node.abscissa * node.abscissa, 2.0 * node.abscissa * node.weight, false));
        let azimuths = counts.azimuths;
        let rings = below.chain(band).chain(above);
        rings
            .flat_map(|(mu, d_mu, hits_ground)| {
                (0..azimuths).map(move |k| Direction {
                    mu,
                    cos_phi: ((f64::from(k) + 0.5) * PI / f64::from(azimuths)).cos(),
                    solid_angle_sr: d_mu * 2.0 * PI / f64::from(azimuths),
                    hits_ground,
                })
            })
            .collect()
    }

    fn project(&self, altitude_m: f64, mu_s: f64, radiance: impl Fn(AirRay) -> Bands) -> Field {
        let mut coefficients = vec![[0.0; BAND_COUNT]; self.settings.coefficient_count() as usize];
        let mut irradiance = [0.0; BAND_COUNT];
        for direction in self.directions(self.horizon_mu(altitude_m)) {
            let Direction { mu, cos_phi, solid_angle_sr, hits_ground } = direction;
            let seen = radiance(AirRay::along(self.air, altitude_m, mu_s, mu, cos_phi, hits_ground));
            for (sum, y) in coefficients.iter_mut().zip(harmonics(mu, cos_phi, self.settings.degree_count)) {
                (0..BAND_COUNT).for_each(|band| sum[band] += solid_angle_sr * y * seen[band]);
            }
            (0..BAND_COUNT).for_each(|band| irradiance[band] += solid_angle_sr * mu.max(0.0) * seen[band]);
        }
        Field { coefficients, irradiance }
    }

    /// The field of the order after those that `orders` tabulates.
    pub(super) fn field_of_next_order(&self, orders: &[Table], altitude_m: f64, mu_s: f64) -> Field {
        match orders.last() {
            None => self.project(altitude_m, mu_s, |ray| self.first_order(ray)),
            Some(table) => self.project(altitude_m, mu_s, |ray| self.next_order(table, ray)),
        }
    }
}

impl Field {
    /// As a table holds it: ln I_00, then I_lm / I_00, then ln of the irradiance.
    pub(super) fn encoded(&self) -> Vec<Bands> {
        let mean = self.coefficients[0].map(|mean| mean.max(DARK));
        let mut values = vec![mean.map(f64::ln)];
        let ratio = |c: &Bands| std::array::from_fn(|band| c[band] / mean[band]);
        values.extend(self.coefficients[1..].iter().map(ratio));
        values.push(self.irradiance.map(|e| e.max(DARK).ln()));
        values
    }

    /// The sum of all orders: from the last on, successive orders shrink by a constant ratio, so the rest is geometric.
    pub(super) fn sum(orders: &[Self]) -> Self {
        let (last, before) = (&orders[orders.len() - 1], &orders[orders.len() - 2]);
        let rest = |this: Bands, before: Bands| -> Bands {
            std::array::from_fn(|i| 1.0 / (1.0 - (this[i].max(DARK) / before[i].max(DARK)).clamp(0.0, MAX_RATIO)))
        };
        let of_mean = rest(last.coefficients[0], before.coefficients[0]);
        let of_irradiance = rest(last.irradiance, before.irradiance);
        let mut sum = orders[0].clone();
        for (index, order) in orders.iter().enumerate().skip(1) {
            let is_last = index + 1 == orders.len();
            let share = |rest: &Bands, band: usize| if is_last { rest[band] } else { 1.0 };
            for (sum, c) in sum.coefficients.iter_mut().zip(&order.coefficients) {
                (0..BAND_COUNT).for_each(|band| sum[band] += c[band] * share(&of_mean, band));
            }
            for band in 0..BAND_COUNT {
                sum.irradiance[band] += order.irradiance[band] * share(&of_irradiance, band);
            }
        }
        sum
    }
}
