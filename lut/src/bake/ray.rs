//! The quadrature along a ray through the air: as in the shaders' `march.wgsl`, in f64.
//!
//! A ray is cut at its tangent point and where it crosses the planet's shadow, or comes closest to it. Each leg is Gauss-Legendre in v, where
//! distance grows with v² from the leg's low end; optical depth between nodes is Simpson's rule in v, that of tents in
//! closed form.

use crate::geometry::{
    altitude_along, closest_to_shadow_m, distance_to_shell_from_below, grazing_distance_m, shadow_interval_m,
};
use crate::quadrature::GaussNode;
use crate::{BAND_COUNT, Bands};

use super::Air;
use super::tent::{Stretch, optical_depth_of_tents};

/// Panels of Simpson's rule on each leg where only optical depth is asked for.
const FINE_PANELS: u32 = 64;

/// A ray from a point in the air until it leaves the air or meets the ground.
#[derive(Debug, Clone, Copy)]
pub(super) struct AirRay {
    pub(super) altitude_m: f64,
    pub(super) mu: f64,
    pub(super) mu_s: f64,
    pub(super) nu: f64,
    pub(super) hits_ground: bool,
    pub(super) length_m: f64,
    tangent_m: f64,
    shadow_m: [f64; 2],
}

/// A place on a ray where its integrand is taken.
pub(super) struct Node {
    pub(super) altitude_m: f64,
    /// The length of ray that this node stands for, m.
    pub(super) weight_m: f64,
    /// Whether the planet hides the light from the leg.
    pub(super) dark: bool,
    /// Optical depth from the ray's start.
    pub(super) optical_depth: Bands,
    /// Cosines of the zenith angles of ray and light, and of the azimuth between them, in the node's own frame.
    pub(super) mu: f64,
    pub(super) mu_s: f64,
    pub(super) cos_phi: f64,
}

/// A part of a ray on which altitude only rises or only falls.
struct Leg {
    start_m: f64,
    length_m: f64,
    descending: bool,
    v: f64,
    altitude_m: f64,
    /// Without tents, times v.
    weighted_extinction_per_m: Bands,
}

impl AirRay {
    /// A ray along μ; `hits_ground` says which of sky and ground it belongs to. Not cut at the shadow.
    pub(super) fn new(air: &Air, altitude_m: f64, [mu, mu_s, nu]: [f64; 3], hits_ground: bool) -> Self {
        let (radius_m, top_m) = (air.planet().radius_m, air.planet().atmosphere_height_m);
        let length_m = match hits_ground {
            true => grazing_distance_m(radius_m, altitude_m, mu, 0.0),
            false => distance_to_shell_from_below(radius_m, altitude_m, mu, top_m),
        };
        let tangent_m = -(radius_m + altitude_m) * mu;
        Self { altitude_m, mu, mu_s, nu, hits_ground, length_m, tangent_m, shadow_m: [1.0, 0.0] }
    }

    /// The same with the azimuth between ray and light.
    pub(super) fn along(air: &Air, altitude_m: f64, mu_s: f64, mu: f64, cos_phi: f64, hits_ground: bool) -> Self {
        let sines = ((1.0 - mu * mu) * (1.0 - mu_s * mu_s)).max(0.0).sqrt();
        let nu = (mu * mu_s + sines * cos_phi).clamp(-1.0, 1.0);
        Self::new(air, altitude_m, [mu, mu_s, nu], hits_ground)
    }

    /// The same ray, cut also where it enters and leaves the planet's shadow, or where it comes closest.
    pub(super) fn cut_at_shadow(self, air: &Air) -> Self {
        let (radius_m, directions) = (air.planet().radius_m, [self.mu, self.mu_s, self.nu]);
        let mut shadow_m = shadow_interval_m(radius_m, self.altitude_m, directions, self.length_m);
        if shadow_m[0] >= shadow_m[1] {
            shadow_m = [closest_to_shadow_m(radius_m, self.altitude_m, directions, self.length_m); 2];
        }
        Self { shadow_m, ..self }
    }

    /// Cosine of the light's zenith angle where the ray meets the ground.
    pub(super) fn ground_mu_s(&self, air: &Air) -> f64 {
        let radius_m = air.planet().radius_m;
        (((radius_m + self.altitude_m) * self.mu_s + self.length_m * self.nu) / radius_m).clamp(-1.0, 1.0)
    }

    fn ends_m(&self) -> [f64; 5] {
        let [enter, leave] = if self.shadow_m[0] <= self.shadow_m[1] { self.shadow_m } else { [0.0; 2] };
        let mut ends = [self.tangent_m.clamp(0.0, self.length_m), enter, leave];
        ends.sort_by(f64::total_cmp);
        [0.0, ends[0], ends[1], ends[2], self.length_m]
    }

    fn altitude_at(&self, air: &Air, distance_m: f64) -> f64 {
        altitude_along(air.planet().radius_m, self.altitude_m, self.mu, distance_m).max(0.0)
    }

    /// Visits the nodes of all legs in order; the result is the optical depth of the whole ray.
    pub(super) fn walk(&self, air: &Air, rule: &[GaussNode], mut visit: impl FnMut(&Node)) -> Bands {
        let mut optical_depth = [0.0; BAND_COUNT];
        for ends in self.ends_m().windows(2) {
            let Some(mut leg) = self.leg(air, ends[0], ends[1]) else { continue };
            let middle_m = 0.5 * (ends[0] + ends[1]);
            let dark = middle_m > self.shadow_m[0] && middle_m < self.shadow_m[1];
            for gauss in rule {
                // The nodes are symmetric about 1/2, so a leg walked from its high end only mirrors them.
                let v = if leg.descending { 1.0 - gauss.abscissa } else { gauss.abscissa };
                let distance_m = leg.distance_m(v);
                let altitude_m = self.altitude_at(air, distance_m);
                self.advance(air, &mut leg, v, &mut optical_depth);
                let weight_m = 2.0 * leg.length_m * v * gauss.weight;
                let [mu, mu_s, cos_phi] = self.local_directions(air, distance_m, altitude_m);
                visit(&Node { altitude_m, weight_m, dark, optical_depth, mu, mu_s, cos_phi });
            }
            let end = if leg.descending { 0.0 } else { 1.0 };
            self.advance(air, &mut leg, end, &mut optical_depth);
        }
        optical_depth
    }

    /// Optical depth of the whole ray.
    pub(super) fn optical_depth(&self, air: &Air) -> Bands {
        let mut optical_depth = [0.0; BAND_COUNT];
        for ends in self.ends_m().windows(2) {
            let Some(mut leg) = self.leg(air, ends[0], ends[1]) else { continue };
            for n in 1..=FINE_PANELS {
                let share = f64::from(n) / f64::from(FINE_PANELS);
                let v = if leg.descending { 1.0 - share } else { share };
                self.advance(air, &mut leg, v, &mut optical_depth);
            }
        }
        optical_depth
    }

    fn leg(&self, air: &Air, start_m: f64, end_m: f64) -> Option<Leg> {
        let length_m = end_m - start_m;
        if length_m <= 0.0 {
            return None;
        }
        let descending = start_m + 0.5 * length_m < self.tangent_m;
        let altitude_m = self.altitude_at(air, start_m);
        // Ascending legs start at v = 0, where the weight vanishes.
        let (v, weighted_extinction_per_m) = match descending {
            true => (1.0, air.extinction_without_tents_per_m(altitude_m)),
            false => (0.0, [0.0; BAND_COUNT]),
        };
        Some(Leg { start_m, length_m, descending, v, altitude_m, weighted_extinction_per_m })
    }

    fn advance(&self, air: &Air, leg: &mut Leg, v: f64, optical_depth: &mut Bands) {
        let v_middle = 0.5 * (leg.v + v);
        let middle_m = self.altitude_at(air, leg.distance_m(v_middle));
        let altitude_m = self.altitude_at(air, leg.distance_m(v));
        let middle = air.extinction_without_tents_per_m(middle_m);
        let end = air.extinction_without_tents_per_m(altitude_m);
        let stretch = Stretch {
            length_m: 2.0 * leg.length_m * (v - leg.v).abs() * v_middle,
            distances_m: [leg.v, v].map(|v| (leg.distance_m(v) - self.tangent_m).abs()),
            altitudes_m: [leg.altitude_m, middle_m, altitude_m],
        };
        let tents = optical_depth_of_tents(air, self.altitude_m, self.mu, &stretch);
        // dt = 2 length v dv, by Simpson's rule.
        let step = 2.0 * leg.length_m * (v - leg.v).abs() / 6.0;
        for band in 0..BAND_COUNT {
            let end = end[band] * v;
            let simpson = step * (leg.weighted_extinction_per_m[band] + 4.0 * middle[band] * v_middle + end);
            optical_depth[band] += simpson + tents[band];
            leg.weighted_extinction_per_m[band] = end;
        }
        leg.v = v;
        leg.altitude_m = altitude_m;
    }

    /// Cosines of the zenith angles of ray and light, and of the azimuth between them, in a point's own frame.
    fn local_directions(&self, air: &Air, distance_m: f64, altitude_m: f64) -> [f64; 3] {
        let radius_m = air.planet().radius_m;
        let (r_start, r) = (radius_m + self.altitude_m, radius_m + altitude_m);
        let mu = ((r_start * self.mu + distance_m) / r).clamp(-1.0, 1.0);
        let mu_s = ((r_start * self.mu_s + distance_m * self.nu) / r).clamp(-1.0, 1.0);
        let sines = ((1.0 - mu * mu) * (1.0 - mu_s * mu_s)).sqrt();
        // Where an azimuth is undefined every term that it enters has a factor of zero.
        [mu, mu_s, ((self.nu - mu * mu_s) / sines.max(1e-6)).clamp(-1.0, 1.0)]
    }
}

impl Leg {
    fn distance_m(&self, v: f64) -> f64 {
        let along_m = self.length_m * v * v;
        self.start_m + if self.descending { self.length_m - along_m } else { along_m }
    }
}
