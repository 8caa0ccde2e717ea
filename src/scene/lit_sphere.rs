//! A disc that is a sphere lit from one side: the moon. `lit_sphere.wgsl` is the same in f32.

use std::f64::consts::PI;

use glam::DVec3;
use welkin_lut::Bands;

/// How light is spread over the disc of a sphere that scatters as Lommel and Seeliger found, as μ₀ / (μ₀ + μ): at full
/// phase the disc is even, as the moon's is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LitSphere {
    /// Unit vector from the sphere to the light that falls on it, in the local frame.
    pub toward_source: DVec3,
    /// Share of the irradiance that comes evenly from the whole disc, per band: earthshine.
    pub even_share: Bands,
}

impl LitSphere {
    /// Phase angle of a sphere that stands in the direction `toward`, rad: 0 full, π new.
    pub fn phase_rad(&self, toward: DVec3) -> f64 {
        self.toward_source.angle_between(-toward)
    }

    /// The integral of μ₀ / (μ₀ + μ) over the disc of unit radius: π/2 (1 - sin(α/2) tan(α/2) ln cot(α/4)).
    pub fn disc_integral(phase_rad: f64) -> f64 {
        if phase_rad < 1e-6 {
            return 0.5 * PI;
        }
        let half = (0.5 * phase_rad).min(0.5 * PI - 1e-9);
        let loss = half.sin() * half.tan() * (1.0 / (0.5 * half).tan()).ln();
        // Near new moon the difference loses its digits; the crescent still has a width.
        (0.5 * PI * (1.0 - loss)).max(1e-9)
    }

    /// Radiance per irradiance of the whole disc times the square of its angular radius, 1/sr, at an offset from the
    /// centre in radii, of length up to 1, in the plane normal to the unit vector `toward` the sphere.
    pub fn profile(&self, toward: DVec3, offset: DVec3) -> Bands {
        let mu = (1.0 - offset.length_squared()).max(0.0).sqrt();
        let mu_source = (offset - mu * toward).dot(self.toward_source).max(0.0);
        let lit = if mu_source > 0.0 { mu_source / (mu_source + mu) } else { 0.0 };
        let lit = lit / Self::disc_integral(self.phase_rad(toward));
        self.even_share.map(|even| (1.0 - even) * lit + even / PI)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_phase_brings_the_irradiance_of_its_light() {
        let toward = DVec3::Y;
        for degrees in [0.0, 5.0, 60.0, 90.0, 135.0, 170.0_f64] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let sphere = LitSphere { toward_source: DVec3::new(sine, -cosine, 0.0), even_share: [0.0, 0.25, 1.0] };
            assert!((sphere.phase_rad(toward).to_degrees() - degrees).abs() < 1e-6);
            let count = 800;
            let step = 2.0 / f64::from(count);
            let mut sum = [0.0; 3];
            for i in 0..count * count {
                let at = |k: i32| (f64::from(k) + 0.5) * step - 1.0;
                let offset = DVec3::new(at(i % count), 0.0, at(i / count));
                if offset.length_squared() <= 1.0 {
                    let profile = sphere.profile(toward, offset);
                    (0..3).for_each(|band| sum[band] += profile[band] * step * step);
                }
            }
            for (band, total) in sum.iter().enumerate() {
                // The crescent at 170° is six of the sum's steps wide.
                assert!((total - 1.0).abs() < 1e-2, "band {band} at {degrees}°: {total}");
            }
        }
    }

    #[test]
    fn the_lit_side_faces_the_light() {
        let toward = DVec3::Y;
        let sphere = LitSphere { toward_source: DVec3::new(0.8, 0.6, 0.0), even_share: [0.0; 3] };
        let at = |x: f64| sphere.profile(toward, DVec3::new(x, 0.0, 0.0))[0];
        assert!(at(0.95) > 0.0 && at(-0.95) == 0.0 && at(0.0) == 0.0);
    }
}
