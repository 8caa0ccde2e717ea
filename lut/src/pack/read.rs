//! Reads packs, and refuses what is not as it was written.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::manifest::{FileEntry, Manifest, PACK_FORMAT, PACK_VERSION, TableFile, UNHASHED};
use super::probes::{ProbeAnswer, Probes};
use super::{FileFormat, PackError, Precision, sha256};
use crate::sky_tables::{SkyTables, TableSet};
use crate::table::Table;

/// How far answers may be from the probes, relative: the same numbers in the same order, so only what JSON rounds.
const VERIFY_TOLERANCE: f64 = 1e-9;

/// Longest side of a table that is read, texels: wider pictures are no textures on any device.
const MOST_TEXELS: u32 = 16384;

/// A pack on disk whose manifest and files are as they were written.
#[derive(Debug, Clone, PartialEq)]
pub struct Pack {
    folder: PathBuf,
    manifest: Manifest,
}

/// What a verification has looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Verified {
    /// Files whose hashes are right.
    pub files: usize,
    /// Files of tables that hold the same texels in every container.
    pub table_files: usize,
    /// Values of probes, over all precisions and containers.
    pub probes: usize,
}

impl Pack {
    /// Reads a manifest and checks every file's length and hash.
    ///
    /// # Errors
    /// Any [`PackError`] of a pack that is not as it was written.
    pub fn read(folder: &Path) -> Result<Self, PackError> {
        let pack = Self { folder: folder.to_owned(), manifest: read_manifest(folder)? };
        for file in pack.manifest.all_files() {
            pack.content(file)?;
        }
        pack.check_unlisted()?;
        Ok(pack)
    }

    /// What the pack says of itself.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The golden inputs and outputs.
    ///
    /// # Errors
    /// As [`Pack::read`].
    pub fn probes(&self) -> Result<Probes, PackError> {
        let missing = || PackError::Missing { path: self.folder.join("probes.json") };
        let file = self.manifest.files.iter().find(|file| file.path == "probes.json").ok_or_else(missing)?;
        let path = self.folder.join(&file.path);
        serde_json::from_slice(&self.content(file)?)
            .map_err(|error| PackError::Decode { path, reason: error.to_string() })
    }

    /// The tables of one precision, from the first container or from a certain one.
    ///
    /// # Errors
    /// [`PackError::Missing`] where the pack does not have them so; [`PackError::Decode`].
    pub fn tables(&self, precision: Precision, container: Option<FileFormat>) -> Result<SkyTables, PackError> {
        let table = |name: &str| -> Result<Table, PackError> {
            let entry = self.manifest.tables.iter().find(|table| table.name == name);
            let fits = |file: &&TableFile| file.precision == precision && container.is_none_or(|c| c == file.container);
            let found = entry.and_then(|entry| Some((entry, entry.files.iter().find(fits)?)));
            let ending = container.map_or("*", FileFormat::name);
            let missing = || PackError::Missing { path: self.folder.join(format!("{name}.{precision}.{ending}")) };
            let (entry, file) = found.ok_or_else(missing)?;
            self.decode(file, entry.size)
        };
        let set = TableSet {
            transmittance: table("transmittance")?,
            irradiance: table("irradiance")?,
            multiple_scattering: table("multiple_scattering")?,
            scattering: table("scattering")?,
        };
        let parameters = &self.manifest.sky_parameters;
        self.check_layout(&set)?;
        Ok(SkyTables::from_parts(parameters.planet(), parameters.phases(), parameters.layout(), set))
    }

    /// Whether the table of scattered light has the sides that its parameters say.
    fn check_layout(&self, set: &TableSet) -> Result<(), PackError> {
        let (layout, layers) =
            (self.manifest.sky_parameters.layout(), 1 + self.manifest.sky_parameters.scatterers.len());
        let columns = u64::from(layout.azimuths) * u64::from(layout.suns);
        let sides = [columns, u64::from(layout.elevations), 2 * layers as u64 * u64::from(layout.altitudes)];
        let least = [layout.azimuths, layout.suns, layout.elevations, layout.altitudes].into_iter().min();
        if set.scattering.size().map(u64::from) == sides && least >= Some(2) {
            return Ok(());
        }
        let reason = format!("its parameters ask for {sides:?} texels of scattering, not {:?}", set.scattering.size());
        Err(PackError::Manifest { path: self.folder.join("manifest.json"), reason })
    }

    fn decode(&self, file: &TableFile, size: [u32; 3]) -> Result<Table, PackError> {
        if !size.iter().all(|side| (1..=MOST_TEXELS).contains(side)) {
            let reason = format!("a table of {size:?} texels, expected sides of 1 to {MOST_TEXELS}");
            return Err(PackError::Manifest { path: self.folder.join("manifest.json"), reason });
        }
        let decoded = file.container.decode(&self.content(&file.file)?, size, file.precision);
        decoded.map_err(|reason| PackError::Decode { path: self.folder.join(&file.file.path), reason })
    }

    /// A file's bytes, if they are those that were written.
    fn content(&self, file: &FileEntry) -> Result<Vec<u8>, PackError> {
        let path = self.folder.join(&file.path);
        let bytes = fs::read(&path).map_err(|source| match source.kind() {
            std::io::ErrorKind::NotFound => PackError::Missing { path: path.clone() },
            _ => PackError::File { path: path.clone(), source },
        })?;
        if bytes.len() as u64 != file.bytes {
            return Err(PackError::Size { path, expected: file.bytes, found: bytes.len() as u64 });
        }
        let found = sha256(&bytes);
        match found == file.sha256 {
            true => Ok(bytes),
            false => Err(PackError::Changed { path, expected: file.sha256.clone(), found }),
        }
    }

    /// Refuses files that nobody has listed: the pack would not be what its hash says.
    fn check_unlisted(&self) -> Result<(), PackError> {
        let listed: BTreeSet<PathBuf> = self.manifest.all_files().map(|file| self.folder.join(&file.path)).collect();
        let mut folders = vec![self.folder.clone()];
        while let Some(folder) = folders.pop() {
            let failed = |source| PackError::File { path: folder.clone(), source };
            for entry in fs::read_dir(&folder).map_err(failed)? {
                let path = entry.map_err(failed)?.path();
                if path.is_dir() {
                    folders.push(path);
                } else if !listed.contains(&path) && path != self.folder.join("manifest.json") {
                    return Err(PackError::Unlisted { path });
                }
            }
        }
        Ok(())
    }
}

fn read_manifest(folder: &Path) -> Result<Manifest, PackError> {
    let path = folder.join("manifest.json");
    let bytes = fs::read(&path).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => PackError::NoPack { folder: folder.to_owned() },
        _ => PackError::File { path: path.clone(), source },
    })?;
    let wrong = |reason: String| PackError::Manifest { path: path.clone(), reason };
    let text = String::from_utf8(bytes).map_err(|error| wrong(error.to_string()))?;
    // The version first: another one may differ in everything else.
    let value: serde_json::Value = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    if value["format"] != PACK_FORMAT {
        return Err(wrong(format!("its format is {}, not \"{PACK_FORMAT}\"", value["format"])));
    }
    match value["version"].as_u64() {
        Some(version) if version == u64::from(PACK_VERSION) => {}
        Some(found) => return Err(PackError::Version { path, found, known: PACK_VERSION }),
        None => return Err(wrong("it has no version".to_owned())),
    }
    let manifest: Manifest = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    if let Some(file) = manifest.all_files().find(|file| !stays_inside(&file.path)) {
        return Err(wrong(format!("the path '{}' leads out of the pack", file.path)));
    }
    let found = sha256(text.replacen(&manifest.content_sha256, UNHASHED, 1).as_bytes());
    match found == manifest.content_sha256 {
        true => Ok(manifest),
        false => Err(PackError::Changed { path, expected: manifest.content_sha256, found }),
    }
}

fn stays_inside(path: &str) -> bool {
    let mut parts = Path::new(path).components();
    !path.is_empty() && parts.all(|part| matches!(part, std::path::Component::Normal(_)))
}

/// Reads a pack anew and checks everything: hashes, all containers of a table against each other, and the probes from
/// the tables of every container.
///
/// # Errors
/// The first thing that is not as it was written.
pub fn verify(folder: &Path) -> Result<Verified, PackError> {
    let pack = Pack::read(folder)?;
    let mut verified = Verified { files: pack.manifest.all_files().count() + 1, table_files: 0, probes: 0 };
    for entry in &pack.manifest.tables {
        let mut first: Option<(&TableFile, Table)> = None;
        for file in &entry.files {
            let table = pack.decode(file, entry.size)?;
            verified.table_files += 1;
            match first.as_ref().filter(|(other, _)| other.precision == file.precision) {
                Some((other, texels)) if *texels != table => {
                    let path = |file: &TableFile| pack.folder.join(&file.file.path);
                    return Err(PackError::Differs { path: path(file), other: path(other) });
                }
                Some(_) => {}
                None => first = Some((file, table)),
            }
        }
    }
    let probes = pack.probes()?;
    let Some(transmittance) = pack.manifest.tables.first() else {
        return Err(PackError::Missing { path: folder.join("transmittance.*") });
    };
    for file in &transmittance.files {
        let path = || folder.join("probes.json");
        let answers = probes.answers.iter().find(|answers| answers.precision == file.precision);
        let none = || PackError::Decode { path: path(), reason: format!("it has no answers for {}", file.precision) };
        let answers = answers.ok_or_else(none)?;
        if answers.values.len() != probes.inputs.len() {
            let reason = format!("it has {} inputs and {} answers", probes.inputs.len(), answers.values.len());
            return Err(PackError::Decode { path: path(), reason });
        }
        let tables = pack.tables(file.precision, Some(file.container))?;
        let found: Vec<_> = probes.inputs.iter().map(|input| ProbeAnswer::of(&tables, input)).collect();
        if let Some((probe, quantity, expected, found)) = probes.first_difference(answers, &found, VERIFY_TOLERANCE) {
            let precision = file.precision.name();
            return Err(PackError::Probe { probe, quantity, precision, expected, found });
        }
        verified.probes += 6 * found.len();
    }
    Ok(verified)
}
