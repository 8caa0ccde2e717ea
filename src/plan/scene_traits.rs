//! What of a scene decides how large the errors of settings are, in a few numbers: by them scenes are like each other.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use welkin_lut::{BAND_COUNT, Constituent};

use super::expected_ringing;
use crate::scene::{DirectionalLight, Light, Scene};

/// What is seen besides air and smooth ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SceneKind {
    /// Nothing.
    Clear,
    /// Hills and mountains.
    Terrain,
    /// Clouds.
    Clouds,
    /// Fog, local volumes or local lights, whatever else.
    Fog,
}

impl SceneKind {
    /// In words: a scene with ...
    pub fn name(self) -> &'static str {
        match self {
            Self::Clear => "clear air",
            Self::Terrain => "mountains",
            Self::Clouds => "clouds",
            Self::Fog => "fog, volumes or lamps",
        }
    }

    fn of(scene: &Scene) -> Self {
        let lamps = scene.lights.iter().any(|light| matches!(light, Light::Point(_)));
        if lamps || !scene.volumes.is_empty() {
            Self::Fog
        } else if scene.clouds.iter().any(|layer| !layer.is_empty()) {
            Self::Clouds
        } else if scene.terrain.is_some() {
            Self::Terrain
        } else {
            Self::Clear
        }
    }
}

/// The numbers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SceneTraits {
    /// What is seen.
    pub kind: SceneKind,
    /// Elevation of the light with the largest irradiance above the air, deg; -90 in darkness.
    pub light_elevation_deg: f64,
    /// How much three degrees of spherical harmonics would ring: [`expected_ringing`].
    pub ringing: f64,
    /// Vertical optical depth of all air in the densest band.
    pub optical_depth: f64,
    /// Height of the camera above the ground, m.
    pub camera_altitude_m: f64,
    /// Elevation of the middle of the picture's lower edge, deg.
    pub lowest_view_deg: f64,
}

impl SceneTraits {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        let top_m = scene.planet.atmosphere_height_m;
        let air: Vec<&Constituent> = scene.medium.constituents.iter().collect();
        let scatterers: Vec<&Constituent> = air.iter().copied().filter(|constituent| constituent.scatters()).collect();
        let in_band = |band: usize| -> f64 {
            air.iter()
                .map(|constituent| constituent.extinction_per_m()[band] * constituent.profile.column_m(top_m))
                .sum()
        };
        let half_field_deg = 0.5 * scene.camera.vertical_field_of_view_rad.to_degrees();
        Self {
            kind: SceneKind::of(scene),
            light_elevation_deg: brightest(scene).map_or(-90.0, |light| light.direction.elevation_rad.to_degrees()),
            ringing: expected_ringing(&scatterers, top_m, 3),
            optical_depth: (0..BAND_COUNT).map(in_band).fold(0.0, f64::max),
            camera_altitude_m: scene.camera.altitude_m,
            lowest_view_deg: scene.camera.direction.elevation_rad.to_degrees() - half_field_deg,
        }
    }

    /// How unlike two scenes of one kind are; none between kinds. One unit is about what doubles an error: half of the way
    /// to the horizon for a low light, a factor of four in haze or in the thickness of the air.
    pub fn distance(&self, other: &Self) -> Option<f64> {
        if self.kind != other.kind {
            return None;
        }
        // Twilight and a low sun differ by the degree, a high sun by the ten degrees.
        let light = |traits: &Self| 2.0 * (traits.light_elevation_deg / 6.0).asinh();
        let haze = |traits: &Self| (traits.ringing + 1e-4).ln() / 4_f64.ln();
        let depth = |traits: &Self| (traits.optical_depth + 1e-3).ln() / 4_f64.ln();
        let height = |traits: &Self| (traits.camera_altitude_m.max(0.0) + 300.0).ln() / 3.0;
        let view = |traits: &Self| 0.5 * (traits.lowest_view_deg / 10.0).asinh();
        let all: [&dyn Fn(&Self) -> f64; 5] = [&light, &haze, &depth, &height, &view];
        Some(all.iter().map(|part| (part(self) - part(other)).powi(2)).sum::<f64>().sqrt())
    }
}

fn brightest(scene: &Scene) -> Option<&DirectionalLight> {
    let irradiance = |light: &DirectionalLight| light.irradiance.iter().sum::<f64>();
    let directional = scene.lights.iter().filter_map(|light| match light {
        Light::Directional(light) if irradiance(light) > 0.0 => Some(light),
        _ => None,
    });
    // What has set lights nothing that another light above the horizon does not outshine.
    let seen = |light: &DirectionalLight| {
        irradiance(light) * (0.5 * light.direction.elevation_rad.to_degrees()).min(0.0).exp()
    };
    directional.max_by(|a, b| seen(a).total_cmp(&seen(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn traits(elevation_deg: f64, haze: f64, more: &str) -> SceneTraits {
        let text = format!(
            "preset = \"earth\"\n{more}\n[medium.aerosol]\ndensity_factor = {haze}\n[sun]\nelevation_deg = {elevation_deg}\n\
             azimuth_deg = 0\n[camera]\naltitude_m = 2\nelevation_deg = 10\nazimuth_deg = 0\n"
        );
        SceneTraits::of(&Scene::parse(&text, "traits.toml".as_ref()).unwrap())
    }

    #[test]
    fn a_low_sun_and_haze_set_scenes_apart_more_than_a_high_sun() {
        let (noon, morning) = (traits(60.0, 1.0, ""), traits(45.0, 1.0, ""));
        assert_eq!(noon.distance(&noon), Some(0.0));
        let near = noon.distance(&morning).unwrap();
        assert!(near < traits(3.0, 1.0, "").distance(&traits(-12.0, 1.0, "")).unwrap());
        assert!(near < noon.distance(&traits(60.0, 8.0, "")).unwrap());
        assert!(
            traits(60.0, 8.0, "").ringing > noon.ringing && traits(60.0, 8.0, "").optical_depth > noon.optical_depth
        );
    }

    #[test]
    fn clouds_are_like_clouds_alone_and_fog_like_fog() {
        let cloudy = traits(60.0, 1.0, "clouds = [{ kind = \"cumulus\" }]");
        assert_eq!(cloudy.kind, SceneKind::Clouds);
        assert_eq!(cloudy.distance(&traits(60.0, 1.0, "")), None);
        let foggy = traits(60.0, 1.0, "fog = [{ extinction_per_m = 0.01, profile.exponential.scale_height_m = 50 }]");
        assert_eq!(foggy.kind, SceneKind::Fog);
        assert_eq!(foggy.distance(&cloudy), None);
    }
}
