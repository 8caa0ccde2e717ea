//! How costs grow with size.

use serde::Serialize;

use super::{Fit, FrameCost, pass_costs, reference_cost};
use crate::gpu::Gpu;
use crate::passes::{RenderError, ShaderSources};
use crate::plan::Settings;
use crate::scene::Scene;

/// One kind of work in several sizes.
#[derive(Debug, Clone, Serialize)]
pub struct Growth {
    /// What is done.
    pub name: String,
    /// What its size counts.
    pub unit: &'static str,
    /// Sizes in ascending order with what they cost, ms.
    pub points: Vec<(f64, f64)>,
}

impl Growth {
    /// The exponent of cost ∝ size^exponent, and the largest factor from that law.
    pub fn fit(&self) -> Option<Fit> {
        Fit::of(&self.points)
    }

    /// The exponents from each size to the next.
    pub fn steps(&self) -> Vec<f64> {
        self.points.windows(2).filter_map(Fit::of).map(|fit| fit.exponent).collect()
    }

    /// The size at which what grows costs as much as what does not: below it costs hardly depend on size. By least squares
    /// of relative errors of cost = fixed + rate * size. None where no fixed cost shows, and where none of the sizes reaches it.
    pub fn bend(&self) -> Option<f64> {
        // Weights 1 / cost²: x and y are what the two terms are multiplied by.
        let [mut xx, mut xy, mut yy, mut x1, mut y1] = [0.0; 5];
        for &(size, cost) in &self.points {
            let (x, y) = (1.0 / cost, size / cost);
            (xx, xy, yy, x1, y1) = (xx + x * x, xy + x * y, yy + y * y, x1 + x, y1 + y);
        }
        let determinant = xx * yy - xy * xy;
        let (fixed, rate) = ((yy * x1 - xy * y1) / determinant, (xx * y1 - xy * x1) / determinant);
        let largest = self.points.last()?.0;
        (self.points.len() > 2 && fixed > 0.0 && fixed < rate * largest).then_some(fixed / rate)
    }
}

/// Of frames that differ in nothing but their pixels.
pub fn growth_of_frames(frames: &[FrameCost]) -> Vec<Growth> {
    let mut names: Vec<_> = frames.iter().map(|cost| &cost.name).collect();
    names.sort();
    names.dedup();
    let growth = |name: &String| {
        let same = frames.iter().filter(|cost| &cost.name == name);
        let mut points: Vec<_> = same.map(|cost| (cost.pixels(), cost.processor_ms.median())).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Growth { name: name.clone(), unit: "pixels", points }
    };
    names.into_iter().map(growth).filter(|growth| growth.points.len() > 1).collect()
}

/// Sides of tables, over those of the settings.
const TABLE_SCALES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// Of the tables of a scene's sky: those passes whose tables follow the settings' sizes, one size changed at a time.
///
/// # Errors
/// As [`pass_costs`].
pub fn growth_of_tables(
    gpu: &Gpu,
    shaders: &ShaderSources,
    scene: &Scene,
    settings: Settings,
    rounds: u32,
) -> Result<Vec<Growth>, RenderError> {
    let mut small = scene.clone();
    (small.camera.width, small.camera.height) = (64, 36);
    type SizeOf = fn(&mut Settings) -> &mut [u32; 2];
    let tables: [(&str, SizeOf); 4] = [
        ("optical_depth", |settings| &mut settings.optical_depth_size),
        ("sky_view", |settings| &mut settings.sky_view_size),
        ("higher_order", |settings| &mut settings.multiple_scattering_size),
        ("isotropic_series", |settings| &mut settings.multiple_scattering_size),
    ];
    let mut all = Vec::new();
    for (pass, size_of) in tables {
        let mut points = Vec::new();
        for scale in TABLE_SCALES {
            let mut settings = settings;
            let size = size_of(&mut settings);
            *size = size.map(|side| (f64::from(side) * scale) as u32);
            let texels = f64::from(size[0]) * f64::from(size[1]);
            let costs = pass_costs(gpu, shaders, &small, settings, rounds)?;
            let Some(cost) = costs.iter().find(|cost| cost.name == pass) else { break };
            points.push((texels, cost.milliseconds.median()));
        }
        if points.len() > 1 {
            all.push(Growth { name: pass.to_owned(), unit: "texels", points });
        }
    }
    Ok(all)
}

/// Of the path tracer: processor time against walks on one core, and time that passes against cores.
pub fn growth_of_reference(scene: &Scene) -> Vec<Growth> {
    let walks = [16, 64, 256, 1024].map(|walks| {
        let cost = reference_cost(scene, walks, 1);
        (cost.size, cost.processor_ms)
    });
    let available = std::thread::available_parallelism().map_or(1, usize::from);
    let counts: Vec<usize> = std::iter::successors(Some(1), |n| Some(2 * n)).take_while(|n| *n <= available).collect();
    let cores = counts.iter().map(|&cores| (cores as f64, reference_cost(scene, 1024, cores).wall_ms));
    vec![
        Growth { name: "reference".to_owned(), unit: "walks", points: walks.to_vec() },
        Growth { name: "reference, time that passes".to_owned(), unit: "cores", points: cores.collect() },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn growth(cost: fn(f64) -> f64) -> Growth {
        let sizes = [1.0, 4.0, 16.0, 64.0];
        Growth { name: String::new(), unit: "", points: sizes.map(|size| (size, cost(size))).to_vec() }
    }

    #[test]
    fn a_fixed_cost_bends_the_law_where_what_grows_is_as_large() {
        let bent = growth(|size| 12.0 + 3.0 * size);
        assert!((bent.bend().unwrap() - 4.0).abs() < 1e-9);
        let steps = bent.steps();
        assert!(steps[0] < 0.5 && steps[2] > 0.8, "{steps:?}");
        assert_eq!(growth(|size| 3.0 * size * size).bend(), None, "what grows faster than its size has no fixed part");
        assert_eq!(growth(|_| 5.0).bend(), None);
    }
}
