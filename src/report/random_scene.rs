//! Scenes drawn at random, from which errors are learned and on which predictions are tried.

use rand_core::{Rng as _, SeedableRng as _};
use rand_pcg::Pcg64;

use crate::scene::{Scene, SceneError};

/// The text of the scene with a number: clear air of any of the presets, more or less hazy, under any sun from 8° below the
/// horizon up, from near the ground to space. The same number is always the same scene.
pub fn random_scene_text(number: u64) -> String {
    let mut generator = Pcg64::seed_from_u64(number);
    let mut uniform = || (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let between = |u: f64, low: f64, high: f64| low + u * (high - low);
    let preset = ["earth", "earth", "hillaire2020", "mars"][(4.0 * uniform()) as usize % 4];
    // Half of all suns stand within 12° of the horizon, where errors are largest.
    let sun_deg = if uniform() < 0.5 { between(uniform(), -8.0, 12.0) } else { between(uniform(), 12.0, 85.0) };
    let haze = between(uniform(), 0.2_f64.ln(), 8_f64.ln()).exp();
    // Of Mars's dust there is enough already.
    let haze = match preset {
        "earth" => format!("[medium.aerosol]\ndensity_factor = {haze:.4}\n"),
        "mars" => String::new(),
        _ => format!("[medium.mie]\ndensity_factor = {haze:.4}\n"),
    };
    let (altitude_m, elevation_deg) = match uniform() {
        u if u < 0.1 => (400_000.0, between(uniform(), -24.0, -16.0)),
        u if u < 0.4 => (between(uniform(), 200_f64.ln(), 12_000_f64.ln()).exp(), between(uniform(), -15.0, 20.0)),
        _ => (2.0, between(uniform(), 5.0, 40.0)),
    };
    let (azimuth_deg, field_deg, ground) = (between(uniform(), 0.0, 180.0), between(uniform(), 35.0, 70.0), uniform());
    format!(
        "name = \"random-{number}\"\npreset = \"{preset}\"\n[planet]\nground_albedo = {:.3}\n{haze}\
         [sun]\nelevation_deg = {sun_deg:.3}\nazimuth_deg = 0\n[camera]\n\
         altitude_m = {altitude_m:.1}\nelevation_deg = {elevation_deg:.3}\nazimuth_deg = {azimuth_deg:.3}\n\
         vertical_field_of_view_deg = {field_deg:.2}\nwidth = 1280\nheight = 720\n",
        0.5 * ground * ground,
    )
}

/// The scene with a number.
///
/// # Errors
/// Never, as its test says; those of scene files.
pub fn random_scene(number: u64) -> Result<Scene, SceneError> {
    Scene::parse(&random_scene_text(number), format!("random-{number}.toml").as_ref())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::SceneTraits;

    #[test]
    fn every_number_is_a_scene_of_its_own_and_always_the_same() {
        let elevations: Vec<f64> = (0..400)
            .map(|number| {
                let scene = random_scene(number).unwrap_or_else(|error| panic!("{error}"));
                assert_eq!(Some(&scene), random_scene(number).ok().as_ref());
                SceneTraits::of(&scene).light_elevation_deg
            })
            .collect();
        let low = elevations.iter().filter(|elevation| **elevation < 12.0).count();
        assert!((160..240).contains(&low) && elevations.iter().any(|elevation| *elevation > 75.0), "{low}");
    }
}
