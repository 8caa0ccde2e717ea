//! What qualities mean for packs.

use welkin_lut::bake::BakeSettings;

use super::{Directions, MultipleScattering, Quality, Settings};

/// The sizes of a pack of some quality.
pub fn bake_settings(quality: Quality) -> BakeSettings {
    match quality {
        Quality::Low => BakeSettings::LOW,
        Quality::Medium => BakeSettings::MEDIUM,
        Quality::High => BakeSettings::HIGH,
        Quality::Ultra => BakeSettings::ULTRA,
    }
}

impl Settings {
    /// What the passes need to know to bake tables of these sizes. Packs hold spherical harmonics.
    pub fn for_bake(settings: &BakeSettings) -> Self {
        let directions = settings.directions;
        Self {
            nodes_per_leg: settings.nodes_per_leg,
            optical_depth_size: settings.optical_depth_size,
            multiple_scattering_size: settings.multiple_scattering_size,
            degree_count: settings.degree_count,
            directions: Directions {
                below: directions.below,
                band: directions.band,
                above: directions.above,
                azimuths: directions.azimuths,
            },
            orders: settings.orders,
            multiple_scattering: MultipleScattering::Harmonics,
            ..Self::of(Quality::Medium)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pack_has_the_tables_of_the_renderer_at_the_same_quality() {
        for quality in Quality::ALL {
            let (pack, renderer) = (Settings::for_bake(&bake_settings(quality)), Settings::of(quality));
            assert_eq!(pack.nodes_per_leg, renderer.nodes_per_leg, "{quality}");
            assert_eq!(pack.optical_depth_size, renderer.optical_depth_size, "{quality}");
            assert_eq!(pack.multiple_scattering_size, renderer.multiple_scattering_size, "{quality}");
            assert_eq!(pack.directions, renderer.directions, "{quality}");
            assert_eq!((pack.degree_count, pack.orders), (renderer.degree_count, renderer.orders), "{quality}");
        }
    }
}
