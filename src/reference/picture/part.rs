//! Parts of a picture from different machines, and how they become one.

use std::path::{Path, PathBuf};

use super::film::Shard;
use super::identity::Identity;
use crate::frame::Frame;
use crate::output::{AtomicFile, ExrHeader, OutputError, read_exr_with_header, write_exr_with_header};

/// Name of the attribute that says what a file belongs to.
const ATTRIBUTE: &str = "welkin_part";

/// One part of a picture (or all of it), and what it belongs to.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// What it belongs to.
    pub identity: Identity,
    /// The whole picture's size; only the part's pixels mean something.
    pub frame: Frame,
    /// What the file says besides.
    pub header: ExrHeader,
}

/// What the file's attribute says.
#[derive(serde::Serialize, serde::Deserialize)]
struct Origin {
    #[serde(flatten)]
    identity: Identity,
    crc32: u32,
}

/// Why parts cannot be read or merged.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// The file cannot be read or written.
    #[error(transparent)]
    File(#[from] OutputError),
    /// The file is a picture, but not by `welkin reference`.
    #[error("'{}' was not written by `welkin reference`: {problem}", path.display())]
    NoPart {
        /// The file.
        path: PathBuf,
        /// What is missing.
        problem: String,
    },
    /// The file has changed since it was written.
    #[error("'{}' is damaged: its checksum does not fit; trace this part again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
    },
    /// Two files do not belong together.
    #[error("'{}' does not belong to '{}': it is of {difference}", path.display(), first.display())]
    Foreign {
        /// The file that differs.
        path: PathBuf,
        /// The file that it differs from.
        first: PathBuf,
        /// In what.
        difference: String,
    },
    /// Two files are the same part.
    #[error("'{}' and '{}' are both part {part} of {parts}", path.display(), first.display())]
    Duplicate {
        /// The file.
        path: PathBuf,
        /// The file that was there before.
        first: PathBuf,
        /// Which part.
        part: u32,
        /// Of how many.
        parts: u32,
    },
    /// Parts are missing.
    #[error("of {parts} parts {} missing: {}", if missing.len() == 1 { "one is" } else { "some are" }, list(missing))]
    Missing {
        /// Which.
        missing: Vec<u32>,
        /// Of how many.
        parts: u32,
    },
}

fn list(numbers: &[u32]) -> String {
    numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")
}

/// Writes a part as an EXR file.
///
/// # Errors
/// [`PartError::File`].
pub fn write_part(file: AtomicFile, part: &Part) -> Result<(), PartError> {
    let origin = Origin { identity: part.identity.clone(), crc32: checksum(part) };
    let json = serde_json::to_string(&origin)
        .map_err(|source| OutputError::Encode { path: file.path().into(), source: source.into() })?;
    Ok(write_exr_with_header(file, &part.frame, &part.header.clone().with_text(ATTRIBUTE, &json))?)
}

/// Reads a part.
///
/// # Errors
/// [`PartError`]: unreadable, not a part, or damaged.
pub fn read_part(path: &Path) -> Result<Part, PartError> {
    let no_part = |problem: String| PartError::NoPart { path: path.into(), problem };
    let (frame, header) = read_exr_with_header(path)?;
    let json = header.text(ATTRIBUTE).ok_or_else(|| no_part(format!("it has no attribute '{ATTRIBUTE}'")))?;
    let origin: Origin =
        serde_json::from_str(&json).map_err(|error| no_part(format!("its attribute '{ATTRIBUTE}' says {error}")))?;
    let part = Part { identity: origin.identity, frame, header };
    let Identity { width, height, shard, shards, .. } = part.identity;
    let fits = (width, height) == (part.frame.width, part.frame.height) && (1..=shards).contains(&shard);
    if !fits || checksum(&part) != origin.crc32 {
        return Err(PartError::Damaged { path: path.into() });
    }
    Ok(part)
}

/// CRC-32 of identity and pixels.
fn checksum(part: &Part) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(format!("{:?}", part.identity).as_bytes());
    let Frame { radiance, transmittance, distance_m, standard_error, .. } = &part.frame;
    hasher.update(bytemuck::cast_slice(radiance));
    hasher.update(bytemuck::cast_slice(transmittance));
    hasher.update(bytemuck::cast_slice(distance_m));
    hasher.update(bytemuck::cast_slice(standard_error.as_deref().unwrap_or_default()));
    hasher.finalize()
}

/// Joins all parts of a picture, in any order, to what one run of the whole would have given.
///
/// # Errors
/// [`PartError::Foreign`], [`PartError::Duplicate`] or [`PartError::Missing`] where the parts are not exactly those
/// of one picture.
pub fn merge(parts: Vec<(PathBuf, Part)>) -> Result<Part, PartError> {
    let Some((first_path, first)) = parts.first() else {
        return Err(PartError::Missing { missing: vec![1], parts: 1 });
    };
    let count = first.identity.shards;
    let mut by_number: Vec<Option<&(PathBuf, Part)>> = vec![None; count as usize];
    for entry in &parts {
        let (path, part) = entry;
        if let Some(difference) = first.identity.difference_of_parts(&part.identity) {
            return Err(PartError::Foreign { path: path.clone(), first: first_path.clone(), difference });
        }
        let number = part.identity.shard;
        if let Some((before, _)) = by_number[number as usize - 1].replace(entry) {
            return Err(PartError::Duplicate { path: path.clone(), first: before.clone(), part: number, parts: count });
        }
    }
    let missing: Vec<u32> = (1..=count).filter(|&number| by_number[number as usize - 1].is_none()).collect();
    if !missing.is_empty() {
        return Err(PartError::Missing { missing, parts: count });
    }
    let mut whole = first.clone();
    whole.identity = Identity { shard: 1, shards: 1, ..whole.identity };
    for (_, part) in by_number.into_iter().flatten() {
        copy_pixels(part, &mut whole.frame);
    }
    Ok(whole)
}

fn copy_pixels(part: &Part, whole: &mut Frame) {
    let shard = Shard { index: part.identity.shard - 1, count: part.identity.shards };
    let pixels = part.frame.radiance.len();
    for pixel in (0..shard.pixels_of(pixels)).map(|number| shard.pixel(number)) {
        whole.radiance[pixel] = part.frame.radiance[pixel];
        whole.transmittance[pixel] = part.frame.transmittance[pixel];
        whole.distance_m[pixel] = part.frame.distance_m[pixel];
        if let (Some(whole), Some(part)) = (&mut whole.standard_error, &part.frame.standard_error) {
            whole[pixel] = part[pixel];
        }
    }
}
