//! What a scene may have or lack, for those who ask what it would cost.

use welkin_lut::cloud::{CloudKind, CloudLayer};
use welkin_lut::height_field::HeightField;

use super::{Preset, Scene, Terrain};

/// Something that a scene may have besides air, ground and lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Effect {
    /// Layers of clouds.
    Clouds,
    /// Hills and mountains.
    Mountains,
    /// Light that the air gives off.
    Airglow,
}

impl Effect {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Clouds, Self::Mountains, Self::Airglow];

    /// In words, what [`Effect::added_to`] adds.
    pub fn name(self) -> &'static str {
        match self {
            Self::Clouds => "fair-weather cumulus",
            Self::Mountains => "mountains",
            Self::Airglow => "the Earth's airglow",
        }
    }

    /// Whether a scene has it.
    pub fn is_in(self, scene: &Scene) -> bool {
        match self {
            Self::Clouds => scene.clouds.iter().any(|layer| !layer.is_empty()),
            Self::Mountains => scene.terrain.is_some(),
            Self::Airglow => scene.medium.constituents.iter().any(|constituent| constituent.emits()),
        }
    }

    /// A scene that has it: the same one where it is there already, else with a usual one of its kind.
    pub fn added_to(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        if self.is_in(&scene) {
            return scene;
        }
        match self {
            Self::Clouds => scene.clouds = vec![cumulus(scene.planet.atmosphere_height_m)],
            Self::Mountains => {
                let height_m = (0.005 * scene.planet.radius_m).min(2000.0);
                let albedo = scene.planet.ground_albedo;
                let field = HeightField::new(height_m, 10.0 * height_m, 1, [0.0; 2]);
                scene.terrain = Some(Terrain { field, albedo, snow_line_m: f64::INFINITY, snow_albedo: albedo });
            }
            Self::Airglow => {
                scene.medium.constituents.extend(Preset::Earth.optional().into_iter().filter(|extra| extra.emits()))
            }
        }
        scene
    }

    /// A scene that lacks it.
    pub fn removed_from(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        match self {
            Self::Clouds => scene.clouds.clear(),
            Self::Mountains => scene.terrain = None,
            Self::Airglow => {
                for constituent in &mut scene.medium.constituents {
                    constituent.emission_per_m = [0.0; welkin_lut::BAND_COUNT];
                }
            }
        }
        scene
    }
}

/// Cumulus, lower where the air does not reach as high.
fn cumulus(top_m: f64) -> CloudLayer {
    let mut layer = CloudLayer::of_kind(CloudKind::Cumulus);
    let squeeze = (0.5 * top_m / layer.top_m).min(1.0);
    (layer.base_m, layer.top_m) = (squeeze * layer.base_m, squeeze * layer.top_m);
    layer
}
