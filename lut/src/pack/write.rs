//! Writes packs.

use std::path::Path;

use super::folder::WholeFolder;
use super::manifest::{FileEntry, Manifest, Sun, TableEntry, TableFile, UNHASHED};
use super::measure::measure;
use super::probes::Probes;
use super::sky_block::uniform_block;
use super::{FileFormat, PackError, Precision, sha256};
use crate::Bands;
use crate::bake::Baked;
use crate::sky_tables::{SkyTables, TableSet};
use crate::table::Table;

/// What a pack says of itself besides its tables.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// The scene's name.
    pub scene: String,
    /// The program and its version.
    pub generator: String,
    /// What computed the tables: "cpu", or a device.
    pub backend: String,
    /// Names of the scatterers, in the order of [`crate::bake::Air::scatterers`].
    pub scatterers: Vec<String>,
    /// Wavelengths of the bands, nm.
    pub wavelengths_nm: Bands,
    /// The scene's sun.
    pub sun: Option<Sun>,
    /// What of the scene is not in the tables.
    pub left_out: Vec<String>,
}

/// In which files tables are written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PackOptions {
    /// Containers, each with all tables.
    pub formats: Vec<FileFormat>,
    /// Precisions, each in all containers.
    pub precisions: Vec<Precision>,
}

impl Default for PackOptions {
    fn default() -> Self {
        Self { formats: vec![FileFormat::Ktx2], precisions: vec![Precision::F16] }
    }
}

/// A file that is put beside the tables, such as shaders.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExtraFile {
    /// Its path in the pack, with slashes.
    pub path: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// The tables of a set by name.
pub(super) fn named(set: &TableSet) -> [(&'static str, &Table); 4] {
    [
        ("transmittance", &set.transmittance),
        ("irradiance", &set.irradiance),
        ("multiple_scattering", &set.multiple_scattering),
        ("scattering", &set.scattering),
    ]
}

/// The tables as they are stored.
fn stored(tables: &SkyTables, precision: Precision) -> SkyTables {
    let set = tables.set();
    tables.with_set(TableSet {
        transmittance: precision.of_table(&set.transmittance),
        irradiance: precision.of_table(&set.irradiance),
        multiple_scattering: precision.of_table(&set.multiple_scattering),
        scattering: precision.of_table(&set.scattering),
    })
}

/// Measures the tables and writes the pack; it appears whole or not at all. A pack that is there already is replaced.
///
/// # Errors
/// [`PackError::Occupied`] where the folder holds something else; [`PackError::Encode`]; [`PackError::File`].
pub fn write_pack(
    folder: &Path,
    baked: &Baked,
    description: &Description,
    options: &PackOptions,
    extra: &[ExtraFile],
) -> Result<Manifest, PackError> {
    let whole = WholeFolder::create(folder)?;
    let tables = baked.tables();
    let mut precisions = options.precisions.clone();
    precisions.sort_unstable();
    precisions.dedup();
    let stored: Vec<_> = precisions.iter().map(|&precision| (precision, stored(tables, precision))).collect();
    let errors = measure(baked, &stored);
    let mut manifest = Manifest::new(description, tables, baked.settings());
    for (index, (name, table)) in named(tables.set()).into_iter().enumerate() {
        let mut entry = TableEntry::new(name, table.size());
        for ((precision, tables), errors) in stored.iter().zip(&errors) {
            let mut formats = options.formats.clone();
            formats.sort_unstable();
            formats.dedup();
            for container in formats {
                let path = format!("{name}.{precision}.{container}");
                let bytes = container.encode(named(tables.set())[index].1, *precision);
                let bytes = bytes.map_err(|reason| PackError::Encode { name: path.clone(), reason })?;
                let file = add(&whole, &path, &bytes)?;
                entry.files.push(TableFile { container, precision: *precision, errors: errors[index].clone(), file });
            }
        }
        manifest.tables.push(entry);
    }
    let probes = Probes::new(tables.planet().atmosphere_height_m, &stored);
    manifest.files.push(add(&whole, "probes.json", &json(&probes))?);
    manifest.files.push(add(&whole, "sky_parameters.bin", &uniform_block(&manifest.sky_parameters))?);
    for file in extra {
        manifest.files.push(add(&whole, &file.path, &file.bytes)?);
    }
    let text = String::from_utf8_lossy(&json(&manifest)).into_owned();
    manifest.content_sha256 = sha256(text.as_bytes());
    whole.write("manifest.json", text.replacen(UNHASHED, &manifest.content_sha256, 1).as_bytes())?;
    whole.commit()?;
    Ok(manifest)
}

fn add(folder: &WholeFolder, path: &str, bytes: &[u8]) -> Result<FileEntry, PackError> {
    folder.write(path, bytes)?;
    Ok(FileEntry { path: path.to_owned(), bytes: bytes.len() as u64, sha256: sha256(bytes) })
}

fn json(value: &impl serde::Serialize) -> Vec<u8> {
    let mut text = serde_json::to_string_pretty(value).expect("names and finite numbers are always JSON");
    text.push('\n');
    text.into_bytes()
}
