//! `manifest.json`: what a pack holds, in which units and places, and how far its tables are from the truth.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::format::{FileFormat, atlas};
use super::wording::meaning;
use super::{Description, Precision};
use crate::bake::{BakeSettings, ScatteringSize};
use crate::mapping::MultipleScatteringMapping;
use crate::phase::PhaseLobe;
use crate::sky_tables::SkyTables;
use crate::{Bands, Planet};

/// Version of the format that is written and read. It changes when something that a reader relies on does.
pub const PACK_VERSION: u32 = 3;

/// What `format` says in every manifest.
pub const PACK_FORMAT: &str = "welkin-pack";

/// A pack of tables for an engine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "welkin pack")]
pub struct Manifest {
    /// Always `welkin-pack`.
    pub format: String,
    /// Version of this format.
    pub version: u32,
    /// SHA-256 of this file with 64 zeros in place of this hash. Files are hashed one by one below.
    pub content_sha256: String,
    /// The program that wrote it.
    pub generator: String,
    /// The scene it was baked from.
    pub scene: String,
    /// What of the scene is not in the tables.
    pub left_out: Vec<String>,
    /// What one could confuse.
    pub conventions: Conventions,
    /// Wavelengths of the three channels, nm.
    pub wavelengths_nm: Bands,
    /// The sun of the scene. Tables are for unit irradiance: multiply what they say by `irradiance`.
    pub sun: Option<Sun>,
    /// What the shaders' uniform block `sky` holds; `sky_parameters.bin` is the block itself.
    pub sky_parameters: SkyParameters,
    /// How light was integrated.
    pub method: Method,
    /// The tables.
    pub tables: Vec<TableEntry>,
    /// All other files.
    pub files: Vec<FileEntry>,
}

/// What one could confuse, said once.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Conventions {
    /// Unit of all lengths.
    pub length: String,
    /// Unit of all angles.
    pub angle: String,
    /// Which way is up.
    pub up: String,
    /// What light is measured in.
    pub light: String,
    /// What the three channels are.
    pub colour: String,
    /// In which order texels lie.
    pub texel_order: String,
    /// Where texels are read.
    pub texel_centres: String,
    /// How a sampler must be set.
    pub sampler: String,
}

/// The sun above the air.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sun {
    /// On a plane normal to the beam, W·m⁻²·nm⁻¹.
    pub irradiance: Bands,
    /// Of the disc, rad.
    pub angular_radius_rad: f64,
}

/// What the functions that read the tables must know.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SkyParameters {
    /// Lambertian reflectance of the ground.
    pub ground_albedo: Bands,
    /// Of the planet, m.
    pub radius_m: f64,
    /// k, asinh(k s) of the lowest sun, and the range from there to asinh(k), s = 1 - sqrt(1 - mu_s): how tables are spread over heights of the sun.
    pub sun_warp: [f64; 3],
    /// Altitude of the air's top, m.
    pub top_m: f64,
    /// Tiles of the table of scattered light along x.
    pub azimuth_count: u32,
    /// Columns of a tile.
    pub sun_count: u32,
    /// Rows.
    pub elevation_count: u32,
    /// Slices of a block along z.
    pub altitude_count: u32,
    /// In the order of the layers of scattered light.
    pub scatterers: Vec<Scatterer>,
}

/// A constituent of the air that scatters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scatterer {
    /// What the scene calls it.
    pub name: String,
    /// Its phase function: the sum of scale (1 + quadratic ν²) (gap + slope (1 - ν))^(-exponent).
    pub phase_function: Vec<Lobe>,
}

/// A lobe of a phase function, ν the cosine of the angle to the sun.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lobe {
    /// 1/sr.
    pub scale_per_sr: f64,
    /// Factor of ν².
    pub quadratic: f64,
    /// The base at ν = 1.
    pub gap: f64,
    /// How the base grows with 1 - ν.
    pub slope: f64,
    /// Power of one over the base.
    pub exponent: f64,
}

impl From<PhaseLobe> for Lobe {
    fn from(lobe: PhaseLobe) -> Self {
        let (gap, slope) = lobe.about_forward();
        let PhaseLobe { scale_per_sr, quadratic, exponent, .. } = lobe;
        Self { scale_per_sr, quadratic, gap, slope, exponent }
    }
}

impl From<Lobe> for PhaseLobe {
    fn from(Lobe { scale_per_sr, quadratic, gap, slope, exponent }: Lobe) -> Self {
        Self { scale_per_sr, quadratic, exponent, ..Self::ABSENT }.with_base_about_forward(gap, slope)
    }
}

/// How the tables were made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Method {
    /// What computed them.
    pub backend: String,
    /// Gauss-Legendre nodes on each leg of a ray.
    pub nodes_per_leg: u32,
    /// Directions in which the source function of multiply scattered light is tabulated.
    pub direction_count: u32,
    /// Orders of scattering one by one; the rest of the series is geometric.
    pub orders: u32,
}

/// A table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TableEntry {
    /// Its name: that of the shaders' variable without `_table`.
    pub name: String,
    /// What its texels hold.
    pub holds: String,
    /// How a texel's value becomes the quantity.
    pub storage_transform: String,
    /// The quantity's unit.
    pub unit: String,
    /// Columns, rows and slices; one slice is a flat texture.
    pub size: [u32; 3],
    /// Along x, y and z: parameters, and their place between the first and last texel's centre, 0 to 1.
    pub axes: Vec<Axis>,
    /// Columns and rows of tiles in the EXR files, which lay slices side by side, row by row.
    pub atlas: [u32; 2],
    /// The same texels in every precision and container.
    pub files: Vec<TableFile>,
}

/// An axis of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// What varies.
    pub parameter: String,
    /// From the parameter to [0, 1].
    pub mapping: String,
}

/// A file of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TableFile {
    /// Its container.
    pub container: FileFormat,
    /// Its numbers.
    pub precision: Precision,
    /// How far the table as it is stored is from f64 evaluation between its texels.
    pub errors: Vec<MeasuredError>,
    /// The file.
    #[serde(flatten)]
    pub file: FileEntry,
}

/// Errors over places between texels, spread evenly over the table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredError {
    /// What was compared, and over which places.
    pub of: String,
    /// How many values.
    pub samples: u32,
    /// Half of them are below.
    pub median: f64,
    /// 99 % of them are below.
    pub p99: f64,
    /// The largest.
    pub maximum: f64,
}

/// A file of the pack.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FileEntry {
    /// Its path in the pack, with slashes.
    pub path: String,
    /// Its length.
    pub bytes: u64,
    /// SHA-256 of its content, in hexadecimal.
    pub sha256: String,
}

impl SkyParameters {
    pub(super) fn new(tables: &SkyTables, names: &[String]) -> Self {
        let (planet, layout) = (tables.planet(), tables.layout());
        let scatterer = |(name, lobes): (&String, &Vec<PhaseLobe>)| Scatterer {
            name: name.clone(),
            phase_function: lobes.iter().copied().map(Lobe::from).collect(),
        };
        Self {
            ground_albedo: planet.ground_albedo,
            radius_m: planet.radius_m,
            sun_warp: MultipleScatteringMapping::new(planet).sun_warp(),
            top_m: planet.atmosphere_height_m,
            azimuth_count: layout.azimuths,
            sun_count: layout.suns,
            elevation_count: layout.elevations,
            altitude_count: layout.altitudes,
            scatterers: names.iter().zip(tables.phases()).map(scatterer).collect(),
        }
    }

    pub(super) fn planet(&self) -> Planet {
        Planet { radius_m: self.radius_m, atmosphere_height_m: self.top_m, ground_albedo: self.ground_albedo }
    }

    pub(super) fn layout(&self) -> ScatteringSize {
        ScatteringSize {
            azimuths: self.azimuth_count,
            suns: self.sun_count,
            elevations: self.elevation_count,
            altitudes: self.altitude_count,
        }
    }

    pub(super) fn phases(&self) -> Vec<Vec<PhaseLobe>> {
        let lobes = |scatterer: &Scatterer| scatterer.phase_function.iter().copied().map(PhaseLobe::from).collect();
        self.scatterers.iter().map(lobes).collect()
    }
}

impl Method {
    pub(super) fn new(backend: &str, settings: &BakeSettings, planet: &Planet) -> Self {
        Self {
            backend: backend.to_owned(),
            nodes_per_leg: settings.nodes_per_leg,
            direction_count: settings.source_grid.on(planet).count(),
            orders: settings.orders,
        }
    }
}

impl TableEntry {
    /// What a table of this name holds; its files come later.
    pub(super) fn new(name: &str, size: [u32; 3]) -> Self {
        let (holds, storage_transform, unit, axes) = meaning(name);
        let axis =
            |(parameter, mapping): (&str, &str)| Axis { parameter: parameter.to_owned(), mapping: mapping.to_owned() };
        Self {
            name: name.to_owned(),
            holds: holds.to_owned(),
            storage_transform: storage_transform.to_owned(),
            unit: unit.to_owned(),
            size,
            axes: axes.iter().copied().map(axis).collect(),
            atlas: atlas(size),
            files: Vec::new(),
        }
    }
}

impl Manifest {
    pub(super) fn new(description: &Description, tables: &SkyTables, settings: &BakeSettings) -> Self {
        Self {
            format: PACK_FORMAT.to_owned(),
            version: PACK_VERSION,
            content_sha256: UNHASHED.to_owned(),
            generator: description.generator.clone(),
            scene: description.scene.clone(),
            left_out: description.left_out.clone(),
            conventions: Conventions::new(),
            wavelengths_nm: description.wavelengths_nm,
            sun: description.sun,
            sky_parameters: SkyParameters::new(tables, &description.scatterers),
            method: Method::new(&description.backend, settings, tables.planet()),
            tables: Vec::new(),
            files: Vec::new(),
        }
    }

    /// Every file but the manifest itself.
    pub fn all_files(&self) -> impl Iterator<Item = &FileEntry> {
        let of_tables = self.tables.iter().flat_map(|table| table.files.iter().map(|file| &file.file));
        of_tables.chain(&self.files)
    }
}

/// Stands for the manifest's own hash while it is taken.
pub(super) const UNHASHED: &str = "0000000000000000000000000000000000000000000000000000000000000000";
