//! What qualities mean for packs.

use welkin_lut::bake::BakeSettings;

use super::{MultipleScattering, Quality, Settings, Skipping};

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
    /// What the passes need to know to bake tables of these sizes. Packs hold the source function's light, whatever the air.
    pub fn for_bake(settings: &BakeSettings) -> Self {
        Self {
            nodes_per_leg: settings.nodes_per_leg,
            optical_depth_size: settings.optical_depth_size,
            multiple_scattering: MultipleScattering::SourceFunction,
            source_size: settings.source_size,
            source_grid: settings.source_grid,
            source_orders: settings.orders,
            // Thin air as well has tables.
            skipping: Skipping::NONE,
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
            assert_eq!((pack.source_size, pack.source_grid), (renderer.source_size, renderer.source_grid), "{quality}");
            assert_eq!(pack.source_orders, renderer.source_orders, "{quality}");
        }
    }
}
