//! Tables for other engines, made by the passes that make the renderer's own.

use std::f64::consts::FRAC_PI_4;

use welkin_lut::bake::{BakeSettings, SourceTable};
use welkin_lut::sky_tables::TableSet;
use welkin_lut::{BAND_COUNT, Table};

use super::Renderer;
use crate::gpu::ImageShape;
use crate::passes::{Pass, RenderError, TABLES, record_scattering_table};
use crate::plan::{Facts, Outputs, Settings};
use crate::probe::Orders;
use crate::scene::{Direction, DirectionalLight, Light, Scene};

/// The passes that a pack's tables come from, besides that of the scattered light.
const BAKED: [&str; 3] = ["optical_depth", "first_source", "higher_source"];

impl Renderer {
    /// The tables of a scene's air. Clouds, terrain and emission are not in them, nor is the scene's sun, for whose unit
    /// irradiance they are. With them the source function, for who evaluates light between their texels.
    ///
    /// # Errors
    /// As [`Renderer::render`]; a table that is beyond the device.
    pub fn bake(&mut self, scene: &Scene, settings: &BakeSettings) -> Result<(SourceTable, TableSet), RenderError> {
        let scene = air_alone(scene);
        let asked = Settings::for_bake(settings);
        // Thick air as well has the sizes that its pack was asked for.
        let facts = Facts { settings: asked, ..Facts::new(&scene, asked, Orders::All, Outputs::default())? };
        let passes: Vec<&Pass> = TABLES.iter().filter(|pass| BAKED.contains(&pass.declaration.name)).collect();
        self.execute_and("bake", &facts, &passes, |recording| {
            record_scattering_table(recording, &settings.scattering)
        })?;
        let grid = facts.source_grid();
        let source = SourceTable::from_tiles(grid, settings.source_size, &self.table("multiple_scattering_table")?);
        let set = TableSet {
            transmittance: self.table("optical_depth_table")?,
            irradiance: source.irradiance(),
            multiple_scattering: source.moments().clone(),
            scattering: self.table("scattering_table")?,
        };
        self.resources.release("scattering_table");
        Ok((source, set))
    }

    /// An image that the passes have made, as a table.
    fn table(&self, name: &str) -> Result<Table, RenderError> {
        let image = self.resources.existing_image(name).ok_or(RenderError::NothingToBake)?;
        let [width, height, depth] = image.shape().extent();
        let slices = if let ImageShape::D2Array(.., layers) = image.shape() { layers } else { depth };
        let texels: Vec<[f32; 4]> = self.gpu().read_image(image)?;
        Ok(Table::new(
            [width, height, slices],
            texels.into_iter().map(|[r, g, b, _]| [r, g, b].map(f64::from)).collect(),
        ))
    }
}

/// The scene with nothing but its air, under a sun of unit irradiance, so that every table is needed.
fn air_alone(scene: &Scene) -> Scene {
    let mut alone = scene.clone();
    alone.clouds.clear();
    alone.volumes.clear();
    alone.terrain = None;
    alone.medium.constituents.iter_mut().for_each(|constituent| constituent.emission_per_m = [0.0; BAND_COUNT]);
    alone.camera.altitude_m = 0.0;
    alone.lights = vec![Light::Directional(DirectionalLight {
        name: "sun".to_owned(),
        direction: Direction { elevation_rad: FRAC_PI_4, azimuth_rad: 0.0 },
        irradiance: [1.0; BAND_COUNT],
        angular_radius_rad: 0.0,
        limb_darkening: false,
        sphere: None,
        wavelengths_nm: welkin_lut::BAND_WAVELENGTHS_NM,
    })];
    alone
}
