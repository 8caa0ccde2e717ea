//! Glowing volumes as lights of what is around them: all that leaves them, from their middle.

use std::f64::consts::PI;

use welkin_lut::volume::{Volume, VolumeField, VolumeForm, VolumeParameters};
use welkin_lut::{BAND_COUNT, Bands};

/// Cells along each side of a volume in which its density is looked at.
const CELLS: usize = 12;
/// Of them, one in so many along each side is a place that light leaves from.
const STRIDE: usize = 2;
/// Points on the way out.
const STEPS: usize = 12;

/// Light that leaves a volume.
pub(super) struct Glow {
    pub(super) centre_m: [f64; 3],
    /// W/sr/nm, the mean over all directions.
    pub(super) intensity: Bands,
    /// As large as a cube of the same content, m.
    pub(super) radius_m: f64,
}

/// Whether a local volume gives off light.
pub(super) fn is_glowing(volume: &Volume) -> bool {
    volume.altitudes_m().is_none() && volume.emission_per_m.iter().any(|&e| e > 0.0)
}

impl Glow {
    /// That of a local volume; nothing where it gives off no light.
    pub(super) fn of(volume: &Volume) -> Option<Self> {
        let (VolumeForm::Box { centre_m, size_m, .. } | VolumeForm::Ellipsoid { centre_m, size_m, .. }) = volume.form
        else {
            return None;
        };
        if !is_glowing(volume) {
            return None;
        }
        let densities = Densities::of(volume);
        let content_m3 = size_m.iter().product::<f64>() * densities.mean();
        let escaping = densities.escaping(volume.absorption_per_m);
        Some(Self {
            centre_m,
            intensity: std::array::from_fn(|band| volume.emission_per_m[band] * content_m3 * escaping[band]),
            radius_m: 0.5 * size_m.iter().product::<f64>().cbrt(),
        })
    }
}

/// The density of a volume in cells of the box around it, in the box's own axes.
struct Densities {
    half_size_m: [f64; 3],
    cells: Vec<f64>,
}

impl Densities {
    fn of(volume: &Volume) -> Self {
        let parameters = VolumeParameters::new(volume, 0.0);
        let field = VolumeField::new(volume, parameters);
        let [cos, sin] = parameters.turn.map(f64::from);
        let half_size_m = parameters.half_size_m.map(f64::from);
        let density = |index: usize| {
            let share = Self::middle(index);
            let q: [f64; 3] = std::array::from_fn(|axis| share[axis] * half_size_m[axis]);
            let p = [q[0] * cos + q[1] * sin, q[1] * cos - q[0] * sin, q[2]];
            let p: [f64; 3] = std::array::from_fn(|axis| p[axis] + f64::from(parameters.centre_m[axis]));
            let is_inside =
                matches!(volume.form, VolumeForm::Box { .. }) || share.iter().map(|s| s * s).sum::<f64>() <= 1.0;
            if is_inside { field.density(p, [0.0; 2], 0.0) } else { 0.0 }
        };
        Self { half_size_m, cells: (0..CELLS.pow(3)).map(density).collect() }
    }

    /// Middle of a cell, from -1 to 1 along each side.
    fn middle(index: usize) -> [f64; 3] {
        [index, index / CELLS, index / CELLS.pow(2)].map(|i| (2 * (i % CELLS) + 1) as f64 / CELLS as f64 - 1.0)
    }

    fn at(&self, share: [f64; 3]) -> f64 {
        let cell = share.map(|x| ((0.5 + 0.5 * x) * CELLS as f64).clamp(0.0, (CELLS - 1) as f64) as usize);
        self.cells[cell[0] + CELLS * (cell[1] + CELLS * cell[2])]
    }

    /// Over the whole box.
    fn mean(&self) -> f64 {
        self.cells.iter().sum::<f64>() / self.cells.len() as f64
    }

    /// The share of its light that leaves the volume, the rest of which it absorbs itself: the mean over places and directions.
    fn escaping(&self, absorption_per_m: Bands) -> Bands {
        let (mut left, mut sent) = ([0.0; BAND_COUNT], 0.0);
        for index in 0..self.cells.len() {
            let is_place =
                [index, index / CELLS, index / CELLS.pow(2)].iter().all(|i| i % CELLS % STRIDE == STRIDE / 2);
            if !is_place || self.cells[index] <= 0.0 {
                continue;
            }
            for (direction, weight) in directions() {
                let way_m = self.way_out_m(Self::middle(index), direction);
                sent += weight * self.cells[index];
                for band in 0..BAND_COUNT {
                    left[band] += weight * self.cells[index] * (-absorption_per_m[band] * way_m).exp();
                }
            }
        }
        left.map(|left| if sent > 0.0 { left / sent } else { 1.0 })
    }

    /// Density times length from a place out of the box, m.
    fn way_out_m(&self, from: [f64; 3], direction: [f64; 3]) -> f64 {
        // In shares of the sides per metre.
        let per_m: [f64; 3] = std::array::from_fn(|axis| direction[axis] / self.half_size_m[axis]);
        let out_m = (0..3).map(|axis| (per_m[axis].signum() - from[axis]) / per_m[axis]).fold(f64::INFINITY, f64::min);
        let along = |step: usize| (step as f64 + 0.5) / STEPS as f64 * out_m;
        let densities =
            (0..STEPS).map(|step| self.at(std::array::from_fn(|axis| from[axis] + per_m[axis] * along(step))));
        densities.sum::<f64>() * out_m / STEPS as f64
    }
}

/// Directions over the sphere with weights that add up to 1: points of a Fibonacci lattice, none of which lies along an axis.
fn directions() -> impl Iterator<Item = ([f64; 3], f64)> {
    const COUNT: usize = 16;
    let golden_angle_rad = PI * (3.0 - 5.0_f64.sqrt());
    (0..COUNT).map(move |i| {
        let z = 1.0 - (2 * i + 1) as f64 / COUNT as f64;
        let (sin, cos) = (golden_angle_rad * i as f64).sin_cos();
        let across = (1.0 - z * z).sqrt();
        ([across * cos, across * sin, z], 1.0 / COUNT as f64)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    fn glowing(text: &str) -> Volume {
        let text = format!(
            "preset = \"earth\"\nsun = {{ elevation_deg = 40, azimuth_deg = 0 }}\ncamera = {{ altitude_m = 2, elevation_deg = 0, azimuth_deg = 0 }}\n[[volumes]]\nname = \"gas\"\ncentre_m = [0, 60, 14]\nemission_per_m = 0.01\n{text}"
        );
        let scene = Scene::parse(&text, Path::new("glow.toml")).unwrap();
        scene.volumes[0].clone()
    }

    /// Of a ball that shines and absorbs evenly, of optical radius r: 3 / (8 r³) (2 r² - 1 + (1 + 2 r) e^(-2r))
    /// (Case, de Hoffmann & Placzek 1953, section 10).
    fn escape_from_ball(r: f64) -> f64 {
        3.0 / (8.0 * r.powi(3)) * (2.0 * r * r - 1.0 + (1.0 + 2.0 * r) * (-2.0 * r).exp())
    }

    #[test]
    fn a_ball_sends_out_what_escapes_from_it() {
        for absorption_per_m in [0.001, 0.05, 0.2, 0.6] {
            let ball = glowing(&format!(
                "shape = \"ellipsoid\"\nsize_m = [16, 16, 16]\nabsorption_per_m = {absorption_per_m}"
            ));
            let exact = 0.01 * 4.0 / 3.0 * PI * 512.0 * escape_from_ball(8.0 * absorption_per_m);
            let found = Glow::of(&ball).unwrap().intensity[1];
            assert!((found / exact - 1.0).abs() < 0.06, "{absorption_per_m} /m: {found} for {exact}");
        }
    }

    #[test]
    fn a_flat_box_hides_its_light_by_its_thickness_and_not_by_its_width() {
        // Of a slab of depth t, per area and emission: (1 - 2 E₃(t)) / 2t, E₃(0.5) = 0.22160.
        let slab = glowing("shape = \"box\"\nsize_m = [400, 400, 1]\nabsorption_per_m = 0.5");
        let exact = 0.01 * 16e4 * (1.0 - 2.0 * 0.221_60) / (2.0 * 0.5);
        let found = Glow::of(&slab).unwrap().intensity[1];
        assert!((found / exact - 1.0).abs() < 0.05, "{found} for {exact}");
    }
}
