//! Parameter blocks: what the shaders read of a scene, laid out as they declare it. The one place where f64 becomes f32.

mod angular_fields;
mod atmosphere;
mod blue_noise;
mod camera;
mod cloud_frame;
mod clouds;
mod emission;
mod glow;
mod local_lights;
mod local_lists;
mod observer;
mod quadrature;
mod slab_fields;
mod terrain;
mod volumes;

pub use angular_fields::AngularFields;
pub use atmosphere::{atmosphere_block, legendre_moments, lobe_count};
pub use blue_noise::blue_noise;
pub use camera::CameraBlock;
pub use cloud_frame::cloud_frame_block;
pub use clouds::{cloud_layers, cloud_matter, cloud_term_count, cloud_terms};
pub use emission::{ZONAL_COUNT, emission_block, emission_breakpoints_m};
pub use local_lights::{lamps, local_light_blocks, local_light_count};
pub use local_lists::LocalLists;
pub use observer::observer_block;
pub use quadrature::{GaussNodeBlock, cosine_nodes, gauss_nodes, grid_nodes};
pub use slab_fields::SlabFields;
pub use terrain::height_field_block;
pub use volumes::{volume_blocks, volume_phases, volume_samples};

use welkin_lut::Bands;

/// Narrows one value for each band.
fn vec3(bands: Bands) -> [f32; 3] {
    bands.map(|value| value as f32)
}

#[cfg(test)]
mod tests {
    use super::atmosphere::{AtmosphereHeader, ConstituentBlock, PhaseLobeBlock};
    use super::cloud_frame::CloudFrameHeader;
    use super::clouds::{CloudMatterBlock, CloudTermBlock};
    use super::emission::EmitterBlock;
    use super::local_lights::LocalLightBlock;
    use super::observer::{DirectionalLightBlock, ObserverHeader, SkyViewRangeBlock};
    use super::terrain::{HeightFieldHeader, OctaveBlock};
    use super::volumes::{VolumeBlock, VolumePhaseBlock};
    use super::*;
    use crate::passes::definitions;
    use crate::plan::{Facts, Outputs, Quality, Settings};
    use crate::probe::Orders;
    use crate::scene::Scene;
    use std::mem::offset_of;
    use std::path::Path;
    use welkin_lut::cloud::CloudParameters;
    use welkin_shaders::{Shader, compile};

    fn shader(pass: &str) -> Shader {
        shader_of("noon", pass)
    }

    fn shader_of(scene: &str, pass: &str) -> Shader {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{scene}.toml"));
        let scene = Scene::read(&path).unwrap();
        let facts = Facts::new(&scene, Settings::of(Quality::Low), Orders::All, Outputs::default()).unwrap();
        compile(pass, &definitions(&facts)).unwrap()
    }

    /// Offsets of a shader's fields by name; padding has no meaning.
    fn offsets(shader: &Shader, name: &str) -> Vec<(String, usize)> {
        let layout = shader.struct_layout(name).unwrap_or_else(|| panic!("{name} is not in the shader"));
        let fields = layout.fields.iter().filter(|field| !field.name.starts_with("padding"));
        fields.map(|field| (field.name.clone(), field.offset as usize)).collect()
    }

    fn size(shader: &Shader, name: &str) -> usize {
        shader.struct_layout(name).unwrap().size as usize
    }

    macro_rules! host_offsets {
        ($block:ty, [$($field:ident),*]) => {
            vec![$((stringify!($field).to_owned(), offset_of!($block, $field))),*]
        };
    }

    macro_rules! assert_layout {
        ($shader:expr, $name:literal, $block:ty, [$($field:ident),*]) => {
            assert_eq!(offsets(&$shader, $name), host_offsets!($block, [$($field),*]), "{}", $name);
        };
    }

    #[test]
    fn blocks_lie_in_memory_as_the_shaders_declare_them() {
        let compose = shader("compose");
        assert_layout!(
            compose,
            "Camera",
            CameraBlock,
            [forward, half_width, right, half_height, up, pre_exposure, size]
        );
        assert_eq!(size(&compose, "Camera"), size_of::<CameraBlock>());
        assert_layout!(
            compose,
            "DirectionalLight",
            DirectionalLightBlock,
            [direction, azimuth_rad, irradiance, angular_radius_rad, limb_exponent, averaged_radius_rad]
        );
        assert_eq!(size(&compose, "DirectionalLight"), size_of::<DirectionalLightBlock>());
        assert_layout!(compose, "SkyViewRange", SkyViewRangeBlock, [horizon_rad, sky_end_rad, sky_end_y, last_y]);
        assert_layout!(compose, "PhaseLobe", PhaseLobeBlock, [scale_per_sr, quadratic, gap, slope, exponent, peak_nu]);
        assert_eq!(size(&compose, "PhaseLobe"), size_of::<PhaseLobeBlock>());
        assert_layout!(
            compose,
            "Constituent",
            ConstituentBlock,
            [scattering_per_m, profile_a, extinction_per_m, profile_b, lobes, profile_group]
        );
        assert_eq!(size(&compose, "Constituent"), size_of::<ConstituentBlock>());
        let emission = shader("view_emission");
        assert_layout!(emission, "Emitter", EmitterBlock, [emission_per_m, profile_a, profile_b]);
        assert_eq!(size(&emission, "Emitter"), size_of::<EmitterBlock>());
        let terrain = shader("terrain");
        assert_layout!(terrain, "Octave", OctaveBlock, [to_cells, fraction, cell, wavelength_m, share, key]);
        assert_eq!(size(&terrain, "Octave"), size_of::<OctaveBlock>());
        let gauss = shader("first_order");
        assert_layout!(gauss, "GaussNode", GaussNodeBlock, [abscissa, weight, descending_abscissa, descending_weight]);
        assert_eq!(size(&gauss, "GaussNode"), size_of::<GaussNodeBlock>());
    }

    #[test]
    fn blocks_of_clouds_lie_in_memory_as_the_shaders_declare_them() {
        let clouds = shader_of("clouds/fair-cumulus", "clouds");
        assert_layout!(clouds, "CloudTerm", CloudTermBlock, [attenuation, lobes]);
        assert_eq!(size(&clouds, "CloudTerm"), size_of::<CloudTermBlock>());
        assert_layout!(clouds, "CloudMatter", CloudMatterBlock, [albedo, backward, similarity]);
        assert_eq!(size(&clouds, "CloudMatter"), size_of::<CloudMatterBlock>());
        assert_layout!(
            clouds,
            "CloudLayer",
            CloudParameters,
            [
                gradient,
                shape_per_m,
                base_m,
                shape_offset,
                thickness_m,
                erosion_offset,
                erosion_per_m,
                weather_offset,
                along,
                weather_per_m,
                sheet,
                coverage_from,
                coverage_slope,
                anvil_from,
                reach,
                erosion,
                curl_m,
                edge,
                water_at_base,
                extinction_per_m
            ]
        );
        assert_eq!(size(&clouds, "CloudLayer"), size_of::<[f32; 32]>());
        // The header, and behind it the drift of each layer.
        let mut frame = offsets(&clouds, "CloudFrame");
        assert_eq!(frame.pop(), Some(("drift_m".to_owned(), size_of::<CloudFrameHeader>())));
        let header = host_offsets!(
            CloudFrameHeader,
            [first_pixel, jitter, still, forward, half_width, right, half_height, up, altitude_m]
        );
        assert_eq!(frame, header);
    }

    #[test]
    fn blocks_of_fog_volumes_and_lamps_lie_in_memory_as_the_shaders_declare_them() {
        let media = shader_of("fog/street-lamp", "local_media");
        assert_layout!(
            media,
            "Volume",
            VolumeBlock,
            [
                centre_m,
                kind,
                half_size_m,
                per_edge,
                noise_offset,
                noise_per_m,
                scattering_per_m,
                noise_strength,
                extinction_per_m,
                detail_m,
                emission_per_m,
                per_scale_height,
                turn,
                bottom_m,
                top_m,
                grid_size,
                grid_first,
                similar_extinction,
                similarity,
                backward,
                is_even,
                first_block,
                lamp_field,
                again,
                beam_field,
                occluders_first,
                occluder_count
            ]
        );
        assert_eq!(size(&media, "Volume"), size_of::<VolumeBlock>());
        assert_layout!(media, "VolumePhase", VolumePhaseBlock, [lobes]);
        assert_eq!(size(&media, "VolumePhase"), size_of::<VolumePhaseBlock>());
        assert_layout!(
            media,
            "LocalLight",
            LocalLightBlock,
            [
                position_m,
                reach_m,
                intensity,
                size_squared,
                axis,
                inner_cosine,
                outer_cosine,
                solid_share,
                core_reach_m,
                field,
                lists_first,
                list_count,
                backward
            ]
        );
        assert_eq!(size(&media, "LocalLight"), size_of::<LocalLightBlock>());
    }

    #[test]
    fn arrays_follow_their_headers_without_a_gap() {
        let compose = shader("compose");
        let end = |name: &str| offsets(&compose, name).last().cloned().unwrap();
        assert_eq!(end("Observer"), ("lights".to_owned(), size_of::<ObserverHeader>()));
        assert_eq!(end("Atmosphere"), ("constituents".to_owned(), size_of::<AtmosphereHeader>()));
        let drifts = offsets(&shader_of("clouds/fair-cumulus", "clouds"), "CloudFrame").last().cloned().unwrap();
        assert_eq!(drifts, ("drift_m".to_owned(), size_of::<CloudFrameHeader>()));
        let octaves = offsets(&shader("terrain"), "HeightField").last().cloned().unwrap();
        assert_eq!(octaves, ("octaves".to_owned(), size_of::<HeightFieldHeader>()));
    }
}
