//! The source function of a place from the radiance field there: the shaders' `convolution.wgsl`, in f64.
//!
//! The sum over directions cannot resolve a peak narrower than their spacing, so the peak is subtracted: with p of
//! integral 1, ∫p I dω' = I + ∫p (I(ω') - I) dω', whose integrand vanishes where p is largest. Of matter that throws light
//! back the peak lies in the opposite direction: there it is the field around that direction that is subtracted. A peak
//! elsewhere is not, and a direction in it may count for more than the whole of p: the sum is then divided by what it counts.
//! Phase functions that have no more than a square of ν need no sum for each direction: five products do for all.

use std::f64::consts::PI;

use crate::phase::PhaseLobe;
use crate::{BAND_COUNT, Bands};

use super::Air;
use super::glow::{peak_side, phase_per_sr};
use super::harmonics::{HARMONIC_COUNT, harmonics};
use super::light::DARK;
use super::source_grid::GridAt;

/// Radiance at a place in all directions of the grid.
pub(super) struct Field {
    directions: Vec<UnitDirection>,
    radiance: Vec<Bands>,
}

/// x towards the light's azimuth, y across, z up.
struct UnitDirection {
    x: f64,
    y: f64,
    z: f64,
    cos_phi: f64,
    solid_angle_sr: f64,
}

/// Mean over both mirror images of ν² is a sum over xx, yy, zz and twice xz of one direction times those of the other;
/// the last is 1.
const PRODUCT_COUNT: usize = 5;

impl UnitDirection {
    /// Cosines of the angles to another direction, and to its mirror image.
    fn cosines_to(&self, there: &Self) -> [f64; 2] {
        let (level, across) = (self.x * there.x + self.z * there.z, self.y * there.y);
        [level + across, level - across].map(|nu| nu.clamp(-1.0, 1.0))
    }

    fn products(&self) -> [f64; PRODUCT_COUNT] {
        [self.x * self.x, self.y * self.y, self.z * self.z, self.x * self.z, 1.0]
    }
}

/// Sums of products over all directions: of the field, and of 1.
struct Squares {
    of_field: [Bands; PRODUCT_COUNT],
    of_directions: [f64; PRODUCT_COUNT],
}

/// What a field is as a whole.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Moments {
    /// Over all directions.
    pub(super) mean: Bands,
    /// I_lm / I_00 from (1, 0) on.
    pub(super) harmonics: Vec<Bands>,
    /// On a horizontal plane, from above.
    pub(super) irradiance: Bands,
}

impl Field {
    /// The field that `radiance` gives by the numbers of directions.
    pub(super) fn new(grid: &GridAt, directions: u32, radiance: impl Fn(u32) -> Bands) -> Self {
        let unit = |index| {
            let direction = grid.direction(index);
            let sine = (1.0 - direction.mu * direction.mu).max(0.0).sqrt();
            let (sin_phi, cos_phi) = direction.phi_rad.sin_cos();
            let solid_angle_sr = direction.solid_angle_sr;
            UnitDirection { x: sine * cos_phi, y: sine * sin_phi, z: direction.mu, cos_phi, solid_angle_sr }
        };
        Self { directions: (0..directions).map(unit).collect(), radiance: (0..directions).map(radiance).collect() }
    }

    fn sum(&self, weight: impl Fn(&UnitDirection) -> f64) -> Bands {
        let mut sum = [0.0; BAND_COUNT];
        for (direction, radiance) in self.directions.iter().zip(&self.radiance) {
            let weight = direction.solid_angle_sr * weight(direction);
            (0..BAND_COUNT).for_each(|band| sum[band] += weight * radiance[band]);
        }
        sum
    }

    /// Its moments.
    pub(super) fn moments(&self) -> Moments {
        let y = |direction: &UnitDirection, k: usize| harmonics(direction.z, direction.cos_phi)[k];
        let all = self.sum(|direction| y(direction, 0));
        let relative = |k: usize| -> Bands {
            let of_degree = self.sum(|direction| y(direction, k));
            std::array::from_fn(|band| of_degree[band] / all[band].max(DARK))
        };
        Moments {
            mean: self.sum(|_| 1.0).map(|sum| sum / (4.0 * PI)),
            harmonics: (1..=HARMONIC_COUNT).map(relative).collect(),
            irradiance: self.sum(|direction| direction.z.max(0.0)),
        }
    }

    /// For each group of scatterers with one density profile, and each direction: Σ_c b_c ∫p_c I dω' / Σ_c b_c.
    pub(super) fn source_function(&self, air: &Air, phases: &[Vec<PhaseLobe>], groups: &[usize]) -> Vec<Vec<Bands>> {
        let group_count = groups.iter().max().map_or(0, |last| last + 1);
        let mut convolved = vec![vec![[0.0; BAND_COUNT]; self.radiance.len()]; group_count];
        let mut scattering = vec![[0.0; BAND_COUNT]; group_count];
        let squares = self.squares();
        for ((constituent, lobes), &group) in air.scatterers().iter().zip(phases).zip(groups) {
            let b = constituent.scattering_per_m;
            (0..BAND_COUNT).for_each(|band| scattering[group][band] += b[band]);
            let is_quadratic = lobes.iter().all(|lobe| lobe.slope == 0.0);
            for (index, sum) in convolved[group].iter_mut().enumerate() {
                let change =
                    if is_quadratic { self.quadratic(&squares, lobes, index) } else { self.convolution(lobes, index) };
                (0..BAND_COUNT).for_each(|band| sum[band] += b[band] * change[band]);
            }
        }
        for (of_group, b) in convolved.iter_mut().zip(&scattering) {
            for (value, radiance) in of_group.iter_mut().zip(&self.radiance) {
                (0..BAND_COUNT).for_each(|band| value[band] = radiance[band] + value[band] / b[band].max(DARK));
            }
        }
        convolved
    }

    fn squares(&self) -> Squares {
        let mut squares = Squares { of_field: [[0.0; BAND_COUNT]; PRODUCT_COUNT], of_directions: [0.0; PRODUCT_COUNT] };
        for (direction, radiance) in self.directions.iter().zip(&self.radiance) {
            for (m, product) in direction.products().into_iter().enumerate() {
                let weight = direction.solid_angle_sr * product;
                squares.of_directions[m] += weight;
                (0..BAND_COUNT).for_each(|band| squares.of_field[m][band] += weight * radiance[band]);
            }
        }
        squares
    }

    /// [`Field::convolution`] where lobes are of the form scale (1 + quadratic ν²).
    fn quadratic(&self, squares: &Squares, lobes: &[PhaseLobe], index: usize) -> Bands {
        let (products, radiance) = (self.directions[index].products(), self.radiance[index]);
        std::array::from_fn(|band| {
            let change = |m: usize| squares.of_field[m][band] - radiance[band] * squares.of_directions[m];
            let square: f64 = [1.0, 1.0, 1.0, 2.0].iter().enumerate().map(|(m, n)| n * products[m] * change(m)).sum();
            let even = change(PRODUCT_COUNT - 1);
            lobes.iter().map(|lobe| lobe.scale_per_sr * (even + lobe.quadratic * square)).sum()
        })
    }

    /// The field opposite to a direction: a mean over all, by the inverse fourth power of the distance (Shepard's).
    fn radiance_opposite(&self, here: &UnitDirection) -> Bands {
        let (mut sum, mut weights) = ([0.0; BAND_COUNT], 0.0);
        for (there, seen) in self.directions.iter().zip(&self.radiance) {
            let per_distance4 = here.cosines_to(there).map(|nu| (1.0 + nu + 1e-6).powi(-2));
            let weight = there.solid_angle_sr * (per_distance4[0] + per_distance4[1]);
            weights += weight;
            (0..BAND_COUNT).for_each(|band| sum[band] += weight * seen[band]);
        }
        sum.map(|value| value / weights)
    }

    /// ∫p (I(ω') - I) dω' for the direction of a number.
    fn convolution(&self, lobes: &[PhaseLobe], index: usize) -> Bands {
        let (here, radiance) = (&self.directions[index], self.radiance[index]);
        let is_thrown_back = peak_side(lobes) < 0.0;
        let at_peak = if is_thrown_back { self.radiance_opposite(here) } else { radiance };
        let mut sum = [0.0; BAND_COUNT];
        // How much of p, of 1, the sum counts.
        let mut counted = 0.0;
        for (other, (there, seen)) in self.directions.iter().zip(&self.radiance).enumerate() {
            // In the peak itself nothing is left to count.
            if other == index && !is_thrown_back {
                continue;
            }
            let phase: f64 = here.cosines_to(there).map(|nu| phase_per_sr(lobes, nu)).iter().sum();
            let weight = 0.5 * there.solid_angle_sr * phase;
            counted += weight;
            (0..BAND_COUNT).for_each(|band| sum[band] += weight * (seen[band] - at_peak[band]));
        }
        std::array::from_fn(|band| at_peak[band] - radiance[band] + sum[band] / counted.max(1.0))
    }
}
