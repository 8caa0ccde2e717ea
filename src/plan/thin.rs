//! Air so thin, over ground so dark, that light scattered more than once does not show.
//!
//! With the irradiance E of a light, P_min and P_max the least and the largest value of the phase functions, 1/sr, albedo A of
//! the ground and vertical optical depth τ of all that scatters, relative to light scattered once, b P E, which is at least
//! b P_min E:
//! - the ground sends A μ_s E / π up; scattered by the air that is at most b A μ_s E / π, as ∫P dω = 1;
//! - light scattered once comes from each direction as at most P_max E times the optical depth of that direction. Over all
//!   directions this integrates to at most 2π τ (1 + ln C) P_max E, where a horizontal path is at most C times as deep as τ;
//!   scattered again that is at most P_max times as much.
//!
//! And relative to the light that the ground sends back of the sun's, that of the sky is at most 2π P_max τ / μ_s. None of this holds
//! for air in the planet's shadow, which has no light of the first order.

use std::f64::consts::{FRAC_PI_2, PI};

use welkin_lut::{BAND_COUNT, Constituent, geometry};

use super::Skipping;
use crate::scene::{DirectionalLight, Scene};

/// 1 + ln C of a layer of 10 m on the Earth: its horizontal paths are 2 √(2R / 10 m) times as deep as τ. That of the air itself
/// is 5.
const HORIZONTAL: f64 = 8.7;

/// The largest share of a pixel's light that was scattered more than once; infinite where some air in view lies in the
/// planet's shadow.
fn share(scene: &Scene, scatterers: &[&Constituent], light: &DirectionalLight) -> f64 {
    let planet = &scene.planet;
    let dip_rad =
        |altitude_m: f64| geometry::horizon_mu(planet.radius_m, altitude_m).clamp(-1.0, 1.0).acos() - FRAC_PI_2;
    // Over the horizon one sees air as far beyond it as the top of the air is from there.
    let lowest_rad = dip_rad(scene.camera.altitude_m.max(0.0)) + dip_rad(planet.atmosphere_height_m);
    let lower_edge_rad = light.direction.elevation_rad - light.angular_radius_rad;
    if lower_edge_rad <= lowest_rad {
        return f64::INFINITY;
    }
    let mu_s = lower_edge_rad.sin();
    let values =
        scatterers.iter().flat_map(|c| (0..=180_u8).map(|deg| c.phase.value(f64::from(deg).to_radians().cos())));
    let (least, largest) =
        values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    // With mu_s = 1 for the ground.
    let in_band = |band: usize| {
        let depth: f64 =
            scatterers.iter().map(|c| c.scattering_per_m[band] * c.profile.column_m(planet.atmosphere_height_m)).sum();
        let from_ground = planet.ground_albedo[band] / PI;
        let from_air = 2.0 * PI * HORIZONTAL * depth * largest * largest;
        let on_ground = 2.0 * PI * largest * depth / mu_s;
        ((from_ground + from_air) / least).max(on_ground)
    };
    (0..BAND_COUNT).map(in_band).fold(0.0, f64::max)
}

/// Why light scattered more than once is left out, if it is.
pub fn reason(
    scene: &Scene,
    scatterers: &[&Constituent],
    lights: &[&DirectionalLight],
    skipping: &Skipping,
) -> Option<String> {
    let most = lights.iter().map(|light| share(scene, scatterers, light)).reduce(f64::max)?;
    (!scatterers.is_empty() && most <= skipping.thin_share).then(|| {
        format!(
            "the air is thin and the ground dark: of no pixel's light more than {:.3} % is scattered more than once (limit {:.2} %)",
            100.0 * most,
            100.0 * skipping.thin_share
        )
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::plan::{Facts, Outputs, Quality, Settings};
    use crate::probe::Orders;
    use crate::scene::Light;

    /// Whether light scattered more than once is left out at noon, in air of so much of its density over ground of an albedo.
    fn is_left_out(density: f64, albedo: f64, elevation_deg: f64) -> bool {
        let mut scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/noon.toml")).unwrap();
        scene.planet.ground_albedo = [albedo; BAND_COUNT];
        scene.medium.constituents.retain(|constituent| constituent.name == "rayleigh");
        for constituent in &mut scene.medium.constituents {
            constituent.scattering_per_m = constituent.scattering_per_m.map(|b| b * density);
        }
        let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
        sun.direction.elevation_rad = elevation_deg.to_radians();
        let facts = Facts::new(&scene, Settings::of(Quality::Low), Orders::All, Outputs::default()).unwrap();
        !facts.has_multiple_scattering()
    }

    #[test]
    fn it_is_left_out_of_thin_air_over_dark_ground_by_day_alone() {
        assert!(is_left_out(1e-3, 0.0, 40.0));
        assert!(!is_left_out(1.0, 0.0, 40.0), "the air of the Earth");
        assert!(!is_left_out(1e-3, 0.1, 40.0), "ground that sends light back");
        assert!(!is_left_out(1e-3, 0.0, 5.0), "beyond the horizon air lies in shadow");
    }
}
