//! From a place to density.

use super::{Volume, VolumeGrid, VolumeKind, VolumeParameters};
use crate::cloud::CloudNoise;

/// The density of one volume at one time, relative to its coefficients. The shaders' module `volume_field` is the same chain.
#[derive(Debug, Clone, Copy)]
pub struct VolumeField<'a> {
    /// The clouds' tiles, where there are billows.
    noise: Option<&'a CloudNoise>,
    parameters: VolumeParameters,
    grid: Option<&'a VolumeGrid>,
}

/// Tiles of the fine noise along one of the coarse.
const FINE_TILES: f64 = 4.0;
/// Share of the fine noise.
const FINE_SHARE: f64 = 0.25;
/// Noise below the first of these leaves least of the density, above their distance from it everything.
const NOISE_FROM: f64 = 0.3;
const NOISE_SLOPE: f64 = 2.5;

impl<'a> VolumeField<'a> {
    /// The field of a volume with these parameters. Noise is made when the first volume asks for it.
    pub fn new(volume: &'a Volume, parameters: VolumeParameters) -> Self {
        let noise = (parameters.noise_strength > 0.0).then(CloudNoise::shared);
        Self { noise, parameters, grid: volume.grid.as_deref() }
    }
    /// A place (east, north, up, m) in a local form's own axes, from its middle, m.
    pub fn inside(&self, p: [f64; 3]) -> [f64; 3] {
        let v = &self.parameters;
        let [x, y, z] = std::array::from_fn(|axis| p[axis] - f64::from(v.centre_m[axis]));
        let [cos, sin] = v.turn.map(f64::from);
        [x * cos - y * sin, x * sin + y * cos, z]
    }

    /// Density at a place (east, north, up, m) that lies on the clouds' map at `map_m` and at an altitude (m); at least 0.
    pub fn density(&self, p: [f64; 3], map_m: [f64; 2], altitude_m: f64) -> f64 {
        let v = &self.parameters;
        if v.is_fog() {
            let shape = self.fog(altitude_m);
            return if shape > 0.0 { shape * self.billows([map_m[0], map_m[1], altitude_m]) } else { 0.0 };
        }
        let q = self.inside(p);
        let share: [f64; 3] = std::array::from_fn(|axis| q[axis] / f64::from(v.half_size_m[axis]));
        let depth = match v.kind {
            VolumeKind::Ellipsoid => 1.0 - share.iter().map(|s| s * s).sum::<f64>().sqrt(),
            _ => 1.0 - share.iter().fold(0.0_f64, |most, s| most.max(s.abs())),
        };
        if depth < 0.0 {
            return 0.0;
        }
        let samples = self.grid.map_or(1.0, |grid| grid.density(share.map(|s| 0.5 + 0.5 * s)));
        self.edge(depth) * samples * self.billows(q)
    }

    /// What the distance to the surface leaves, as a share of the half size or of the thickness.
    fn edge(&self, depth: f64) -> f64 {
        match self.parameters.per_edge {
            0.0 => 1.0,
            per_edge => (depth * f64::from(per_edge)).clamp(0.0, 1.0),
        }
    }

    fn fog(&self, altitude_m: f64) -> f64 {
        let v = &self.parameters;
        let (bottom_m, top_m) = (f64::from(v.bottom_m), f64::from(v.top_m));
        if !(bottom_m..=top_m).contains(&altitude_m) {
            return 0.0;
        }
        match v.kind {
            VolumeKind::FogLayer => self.edge((top_m - altitude_m) / (top_m - bottom_m)),
            _ => (-(altitude_m - bottom_m) * f64::from(v.per_scale_height)).exp(),
        }
    }

    fn billows(&self, at_m: [f64; 3]) -> f64 {
        let v = &self.parameters;
        let Some(noise) = self.noise else { return 1.0 };
        let tiles: [f64; 3] =
            std::array::from_fn(|axis| at_m[axis] * f64::from(v.noise_per_m) + f64::from(v.noise_offset[axis]));
        let coarse = noise.shape_at(tiles);
        let fine = noise.erosion_at(tiles.map(|x| x * FINE_TILES));
        let joined = coarse + (fine - coarse) * FINE_SHARE;
        let full = ((joined - NOISE_FROM) * NOISE_SLOPE).clamp(0.0, 1.0);
        1.0 - f64::from(v.noise_strength) * (1.0 - full)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FogProfile, VolumeForm, VolumeNoise};
    use super::*;
    use crate::PhaseFunction;

    fn volume(form: VolumeForm) -> Volume {
        Volume {
            name: "test".into(),
            form,
            edge: 0.0,
            scattering_per_m: [1.0; 3],
            absorption_per_m: [0.0; 3],
            emission_per_m: [0.0; 3],
            phase: PhaseFunction::Isotropic,
            noise: None,
            grid: None,
        }
    }

    fn density(volume: &Volume, p: [f64; 3]) -> f64 {
        VolumeField::new(volume, VolumeParameters::new(volume, 0.0)).density(p, [p[0], p[1]], p[2])
    }

    #[test]
    fn a_box_turned_by_a_right_angle_has_its_sides_exchanged() {
        let of = |turn_deg: f64| {
            volume(VolumeForm::Box {
                centre_m: [10.0, 20.0, 5.0],
                size_m: [8.0, 2.0, 4.0],
                turn_rad: turn_deg.to_radians(),
            })
        };
        assert_eq!(density(&of(0.0), [13.9, 20.0, 5.0]), 1.0);
        assert_eq!(density(&of(90.0), [13.9, 20.0, 5.0]), 0.0);
        assert_eq!(density(&of(90.0), [10.0, 23.9, 6.9]), 1.0);
        // An eighth of a turn clockwise brings the long side from the east to the south-east.
        assert_eq!(density(&of(45.0), [12.5, 17.5, 5.0]), 1.0);
        assert_eq!(density(&of(45.0), [12.5, 22.5, 5.0]), 0.0);
    }

    #[test]
    fn fog_thins_with_its_scale_height_and_a_layer_over_its_edge() {
        let fog = |profile| volume(VolumeForm::Fog { bottom_m: 100.0, profile });
        let exponential = fog(FogProfile::Exponential { scale_height_m: 50.0 });
        assert!((density(&exponential, [0.0, 0.0, 150.0]) - (-1.0_f64).exp()).abs() < 1e-7);
        assert_eq!(density(&exponential, [0.0, 0.0, 99.0]), 0.0);
        let layer = Volume { edge: 0.5, ..fog(FogProfile::Layer { top_m: 200.0 }) };
        assert_eq!(density(&layer, [0.0, 0.0, 120.0]), 1.0);
        assert!((density(&layer, [0.0, 0.0, 175.0]) - 0.5).abs() < 1e-6);
        assert_eq!(density(&layer, [0.0, 0.0, 201.0]), 0.0);
    }

    #[test]
    fn noise_takes_no_more_than_its_strength_and_wind_carries_it() {
        let noise =
            VolumeNoise { size_m: 30.0, strength: 0.75, seed: 1, wind_m_per_s: [3.0, -2.0], evolution_m_per_s: 0.0 };
        let form = VolumeForm::Fog { bottom_m: 0.0, profile: FogProfile::Layer { top_m: 100.0 } };
        let fog = Volume { noise: Some(noise), ..volume(form) };
        let at = |time_s: f64, p: [f64; 3]| {
            VolumeField::new(&fog, VolumeParameters::new(&fog, time_s)).density(p, [p[0], p[1]], p[2])
        };
        let mut sum = 0.0;
        for i in 0..2000 {
            let part = |factor: f64| (f64::from(i) * factor).fract();
            let p = [500.0 * part(0.7549), 500.0 * part(0.5698), 100.0 * part(0.4386)];
            let here = at(0.0, p);
            assert!((0.25..=1.0).contains(&here), "{here}");
            assert!((at(10.0, [p[0] + 30.0, p[1] - 20.0, p[2]]) - here).abs() < 2e-3);
            sum += here;
        }
        let mean = sum / 2000.0;
        println!("mean density {mean}");
        assert!((0.45..0.85).contains(&mean), "{mean}: the noise is flat");
    }
}
