//! The real-time sky's answers to the rows of the tables beside this file, and how far they are off.
#![allow(dead_code)]

use std::ops::RangeInclusive;
use std::path::Path;

use welkin::plan::Settings;
use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

use super::tables::Row;

/// Relative errors in per cent, each with the sun's zenith angle in degrees.
pub struct Errors(pub Vec<(f64, f64)>);

impl Errors {
    /// The q-quantile over a range of suns.
    pub fn quantile(&self, q: f64, sun: RangeInclusive<f64>) -> f64 {
        let chosen = self.0.iter().filter(|(sza, _)| sun.contains(sza));
        let mut errors: Vec<f64> = chosen.map(|(_, error)| *error).collect();
        errors.sort_by(f64::total_cmp);
        errors[((errors.len() - 1) as f64 * q).round() as usize]
    }
}

/// Which of the four reference scenes a row belongs to: the haze's variant and the ground's albedo.
fn scene_of(row: &Row) -> (&str, bool) {
    (
        if row.has("variant") { row.text("variant") } else { "B" },
        row.has("ground_albedo") && row.number("ground_albedo") > 0.0,
    )
}

/// One of the four reference scenes.
pub fn scene(variant: &str, bright_ground: bool) -> Scene {
    let albedo = if bright_ground { "0.3" } else { "0" };
    let file = format!("scenes/reference/earth-{}-{albedo}.toml", variant.to_lowercase());
    Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap_or_else(|error| panic!("{error}"))
}

fn ray(row: &Row) -> Ray {
    Ray {
        altitude_m: if row.has("observer_alt_m") { row.number("observer_alt_m") } else { 500.0 },
        view_zenith_rad: row.number("vza_deg").to_radians(),
        view_azimuth_rad: row.number("rel_azimuth_deg").to_radians(),
        sun_zenith_rad: row.number("sza_deg").to_radians(),
        sun_azimuth_rad: 0.0,
        distance_m: f64::INFINITY,
    }
}

/// Answers to rows in their order, after a change to each scene.
pub fn answers(
    renderer: &mut Renderer,
    rows: &[Row],
    settings: Settings,
    orders: Orders,
    change: impl Fn(&mut Scene),
) -> Vec<RayRadiance> {
    let mut answers: Vec<Option<RayRadiance>> = vec![None; rows.len()];
    for (variant, bright_ground) in [("A", false), ("A", true), ("B", false), ("B", true)] {
        let belongs = |&i: &usize| scene_of(&rows[i]) == (variant, bright_ground);
        let indices: Vec<usize> = (0..rows.len()).filter(belongs).collect();
        if indices.is_empty() {
            continue;
        }
        let rays: Vec<Ray> = indices.iter().map(|&i| ray(&rows[i])).collect();
        let mut scene = scene(variant, bright_ground);
        change(&mut scene);
        let found = renderer.probe(&scene, settings, &rays, orders).unwrap_or_else(|error| panic!("{error}"));
        indices.into_iter().zip(found).for_each(|(i, answer)| answers[i] = Some(answer));
    }
    answers.into_iter().map(|answer| answer.expect("every row belongs to one scene")).collect()
}

/// Errors against a column; rows in which nothing shines are left out.
pub fn errors(rows: &[Row], answers: &[RayRadiance], column: &str) -> Errors {
    let error = |(row, answer): (&Row, &RayRadiance)| {
        let truth = row.number(column);
        let error = 100.0 * (answer.radiance[row.band()] / truth - 1.0).abs();
        (truth > 0.0).then_some((row.number("sza_deg"), error))
    };
    Errors(rows.iter().zip(answers).filter_map(error).collect())
}
