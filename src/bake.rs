//! Packs of a scene: its air's tables from either backend, and what belongs beside them.

use welkin_lut::bake::{Air, AirError, BakeSettings, Baked};
use welkin_lut::pack::{Description, ExtraFile, Sun};
use welkin_lut::sky_tables::SkyTables;
use welkin_shaders::{Language, ShaderError};

use crate::passes::RenderError;
use crate::plan::{Facts, Outputs, PlanError, Settings};
use crate::probe::Orders;
use crate::renderer::Renderer;
use crate::scene::{Light, Scene};
use crate::shader_export::shader_files;

/// Why a scene has no pack.
#[derive(Debug, thiserror::Error)]
pub enum BakeError {
    /// Its air cannot be tabulated.
    #[error(transparent)]
    Air(#[from] AirError),
    /// The plan does not know it.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A shader cannot be written.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// It has more wavelengths than three.
    #[error(
        "the scene has {0} wavelengths; a pack holds three bands, so set [spectrum] wavelengths = 3 or leave it out"
    )]
    Wavelengths(usize),
}

/// The air of a scene.
///
/// # Errors
/// [`BakeError::Air`]; [`BakeError::Wavelengths`].
pub fn air_of(scene: &Scene) -> Result<Air, BakeError> {
    if scene.spectrum.group_count() > 1 {
        return Err(BakeError::Wavelengths(scene.spectrum.wavelengths));
    }
    Ok(Air::new(&scene.planet, &scene.medium)?)
}

/// The tables from a device, with what evaluates them between their texels on the CPU.
///
/// # Errors
/// As [`Renderer::bake`].
pub fn bake_on_device<'a>(
    renderer: &mut Renderer,
    scene: &Scene,
    air: &'a Air,
    settings: BakeSettings,
) -> Result<Baked<'a>, RenderError> {
    let (source, set) = renderer.bake(scene, &settings)?;
    Ok(Baked::around(air, settings, source, SkyTables::new(air, settings.scattering, set)))
}

/// What a pack of a scene says of itself. `backend` is what has computed the tables.
pub fn describe(scene: &Scene, air: &Air, backend: &str) -> Description {
    let sun = scene.lights.iter().find_map(|light| match light {
        Light::Directional(light) => {
            Some(Sun { irradiance: light.irradiance, angular_radius_rad: light.angular_radius_rad })
        }
        _ => None,
    });
    Description {
        scene: scene.name.clone(),
        generator: concat!("welkin ", env!("CARGO_PKG_VERSION")).to_owned(),
        backend: backend.to_owned(),
        scatterers: air.scatterers().iter().map(|constituent| constituent.name.clone()).collect(),
        wavelengths_nm: scene.spectrum.groups()[0].wavelengths_nm,
        sun,
        left_out: left_out(scene),
    }
}

/// What of a scene packs do not hold.
fn left_out(scene: &Scene) -> Vec<String> {
    let layers = scene.clouds.iter().filter(|layer| !layer.is_empty()).map(|layer| format!("clouds '{}'", layer.name));
    let terrain = scene.terrain.iter().map(|_| "terrain; the ground is smooth".to_owned());
    let glow = scene.medium.constituents.iter().filter(|constituent| constituent.emits());
    let glow = glow.map(|constituent| format!("the light that '{}' gives off", constituent.name));
    let lights = scene.lights.iter().skip(1).map(|light| match light {
        Light::Directional(light) => format!("light '{}': use the tables a second time for it", light.name),
        Light::Point(light) => format!("light '{}'", light.name),
        Light::Environment(_) => "the environment light".to_owned(),
    });
    let volumes = scene.volumes.iter().filter(|volume| !volume.is_empty()).map(|volume| format!("'{}'", volume.name));
    layers.chain(volumes).chain(terrain).chain(glow).chain(lights).collect()
}

/// The shader files of all languages, in a folder for each.
///
/// # Errors
/// [`BakeError::Plan`]; [`BakeError::Shader`].
pub fn shaders(scene: &Scene, settings: &BakeSettings) -> Result<Vec<ExtraFile>, BakeError> {
    let facts = Facts::new(scene, Settings::for_bake(settings), Orders::All, Outputs::default())?;
    let mut files = Vec::new();
    for language in Language::ALL {
        let of_language = shader_files(language, &facts)?.into_iter();
        files.extend(of_language.map(|file| {
            let path = format!("shaders/{language}/{}", file.name);
            ExtraFile { path, bytes: file.bytes }
        }));
    }
    Ok(files)
}
