//! Single scattering under lights with a disc: a disc as a handful of beams, more until it does not matter.

use glam::DVec3;
use welkin_lut::{BAND_COUNT, Bands};

use super::light::{Emitter, limb_factor};
use super::matter::around;
use super::quadrature::GaussLegendre;
use super::single::{FirstOrder, first_order, is_covered};
use super::world::World;

/// Rings and beams on each ring, from coarse to fine.
const RULES: [(usize, usize); 5] = [(2, 4), (3, 7), (5, 11), (8, 17), (13, 29)];

/// [`first_order`] with the light of discs as well. Where beams see different things (the edge of the planet's shadow,
/// the forward peak of droplets) more of them are taken until two rules agree to `relative_error`; their difference is
/// in the error of the result.
pub fn first_order_with_discs(world: &World, p: DVec3, d: DVec3, relative_error: f64) -> FirstOrder {
    let mut result = first_order(world, p, d, relative_error);
    for light in world.lights.iter().filter(|light| matches!(light, Emitter::Disc { sphere: None, .. })) {
        let under = under_disc(world, light, p, d, relative_error);
        for j in 0..BAND_COUNT {
            result.single.value[j] += under.single.value[j];
            result.single.error[j] += under.single.error[j];
            result.ground[j] += under.ground[j];
        }
    }
    result
}

/// Whether [`first_order_with_discs`] covers a light: not a sphere lit from one side, which is sampled.
pub fn is_integrated(light: &Emitter) -> bool {
    is_covered(light) || matches!(light, Emitter::Disc { sphere: None, .. })
}

/// Light of the first order under one disc alone.
fn under_disc(world: &World, light: &Emitter, p: DVec3, d: DVec3, relative_error: f64) -> FirstOrder {
    let mut coarse = under_beams(world, beams(light, RULES[0]), p, d, relative_error);
    for rule in &RULES[1..] {
        let mut fine = under_beams(world, beams(light, *rule), p, d, relative_error);
        let mut agree = true;
        for j in 0..BAND_COUNT {
            let single = (fine.single.value[j] - coarse.single.value[j]).abs();
            let ground = (fine.ground[j] - coarse.ground[j]).abs();
            agree &= single <= relative_error * fine.single.value[j] && ground <= relative_error * fine.ground[j];
            fine.single.error[j] += single;
        }
        coarse = fine;
        if agree {
            break;
        }
    }
    coarse
}

fn under_beams(world: &World, beams: Vec<Emitter>, p: DVec3, d: DVec3, relative_error: f64) -> FirstOrder {
    let mut sum = FirstOrder::default();
    // One beam at a time: each has its own edge of the planet's shadow.
    for beam in beams {
        let lit = World { lights: vec![beam], ..world.clone() };
        let under = first_order(&lit, p, d, relative_error);
        for j in 0..BAND_COUNT {
            sum.single.value[j] += under.single.value[j];
            sum.single.error[j] += under.single.error[j];
            sum.ground[j] += under.ground[j];
        }
    }
    sum
}

/// Beams that together have the irradiance of a disc. With the sine of the angle from the centre relative to that of the
/// limb as sin, radiance falls as cos^k towards the limb, and cos is what the rings are spaced by.
fn beams(light: &Emitter, (rings, around_each): (usize, usize)) -> Vec<Emitter> {
    let Emitter::Disc { toward, irradiance, radius_rad, limb_exponent, .. } = *light else { return Vec::new() };
    let rule = GaussLegendre::new(rings);
    let height = 2.0 * (0.5 * radius_rad).sin().powi(2);
    let share = |cos: f64, weight: f64| -> Bands {
        limb_exponent.map(|k| 2.0 * cos * weight * limb_factor(k, 1.0 - cos * cos))
    };
    let mut whole = [0.0; BAND_COUNT];
    for (cos, weight) in &rule.points {
        let share = share(*cos, *weight);
        (0..BAND_COUNT).for_each(|j| whole[j] += share[j]);
    }
    let mut beams = Vec::with_capacity(rings * around_each);
    for (ring, (cos, weight)) in rule.points.iter().enumerate() {
        let share = share(*cos, *weight);
        let irradiance = std::array::from_fn(|j| irradiance[j] * share[j] / (whole[j] * around_each as f64));
        for step in 0..around_each {
            // Rings are turned against each other, so that no direction is favoured.
            let turn = (step as f64 + 0.5 * (ring % 2) as f64) / around_each as f64;
            let toward = around(toward, 1.0 - (1.0 - cos * cos) * height, turn).normalize();
            beams.push(Emitter::Beam { toward, irradiance });
        }
    }
    beams
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_beams_of_a_disc_have_its_irradiance_and_lie_on_it() {
        let toward = DVec3::new(0.3, 0.4, 0.5).normalize();
        let disc = Emitter::Disc {
            toward,
            irradiance: [1.0, 2.0, 3.0],
            radius_rad: 0.02,
            limb_exponent: [0.0, 0.5, 1.0],
            sphere: None,
        };
        for rule in RULES {
            let beams = beams(&disc, rule);
            let mut sum = [0.0; BAND_COUNT];
            let mut mean = DVec3::ZERO;
            for beam in &beams {
                let Emitter::Beam { toward: ray, irradiance } = beam else { panic!("no beam") };
                assert!(ray.angle_between(toward) < 0.02);
                (0..BAND_COUNT).for_each(|j| sum[j] += irradiance[j]);
                mean += *ray * irradiance[0];
            }
            (0..BAND_COUNT).for_each(|j| assert!((sum[j] - (j + 1) as f64).abs() < 1e-12));
            assert!(mean.normalize().angle_between(toward) < 1e-9);
            // Control: without one beam both are off.
            assert!((sum[0] - 1.0 / beams.len() as f64 - 1.0).abs() > 1e-3);
        }
    }

    #[test]
    fn the_mean_square_angle_of_the_beams_is_that_of_the_discs_light() {
        // For radiance ∝ cos^k the mean of sin² is 2 / (4 + k).
        for k in [0.0, 0.5, 1.0, 2.0] {
            let disc = Emitter::Disc {
                toward: DVec3::Z,
                irradiance: [1.0; 3],
                radius_rad: 0.01,
                limb_exponent: [k; 3],
                sphere: None,
            };
            let mean: f64 = beams(&disc, RULES[3])
                .iter()
                .map(|beam| {
                    let Emitter::Beam { toward, irradiance } = beam else { panic!("no beam") };
                    irradiance[0] * toward.truncate().length_squared() / 0.01_f64.sin().powi(2)
                })
                .sum();
            let exact = 2.0 / (4.0 + k);
            assert!((mean / exact - 1.0).abs() < 2e-3, "k {k}: {mean} and {exact}");
        }
    }
}
