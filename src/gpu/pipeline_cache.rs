//! Pipelines as the driver compiled them, kept in a file from one run of a program to the next.
//!
//! The file is a help and never a need: one that is missing, cut off, changed or another driver's is passed over, and
//! one that cannot be written is said in a warning. Vulkan asks drivers to recognise foreign data, but not damaged
//! data, so the driver's bytes lie in an envelope with their length and checksum.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use ash::vk;
use tempfile::NamedTempFile;

use super::device::Candidate;
use super::error::{During, GpuError};

/// Starts the file and says how the rest is laid out: length of the driver's bytes (u64), their CRC-32 (u32), both
/// little-endian, then the bytes.
const MAGIC: &[u8; 8] = b"welkinP1";
const HEADER_BYTES: usize = MAGIC.len() + 8 + 4;

/// The driver's cache, and the file that it came from and goes to.
pub(crate) struct PipelineCache {
    pub(crate) raw: vk::PipelineCache,
    /// None when nothing is to be kept.
    path: Option<PathBuf>,
    /// Of the bytes that were read, so that an unchanged cache is not written again.
    loaded_crc: Option<u32>,
}

impl PipelineCache {
    /// Reads what an earlier run left in a folder for this device and driver.
    pub(crate) fn new(device: &ash::Device, candidate: &Candidate, folder: Option<&Path>) -> Result<Self, GpuError> {
        let path = folder.map(|folder| folder.join(file_name(&candidate.pipeline_cache_id)));
        let loaded = path.as_deref().and_then(read);
        let data = loaded.as_deref().unwrap_or_default();
        let info = vk::PipelineCacheCreateInfo::default().initial_data(data);
        // SAFETY: the device is alive; the data is whole, and the driver checks that it is its own.
        let raw = unsafe { device.create_pipeline_cache(&info, None) }.during("vkCreatePipelineCache")?;
        Ok(Self { raw, path, loaded_crc: loaded.as_deref().map(crc32fast::hash) })
    }

    /// Writes the file unless it holds the same already, and destroys the cache.
    pub(crate) fn close(&self, device: &ash::Device) {
        if let Some(path) = &self.path {
            // SAFETY: the cache is of this device, as below.
            match unsafe { device.get_pipeline_cache_data(self.raw) } {
                Ok(data) if self.loaded_crc == Some(crc32fast::hash(&data)) => {}
                Ok(data) => {
                    if let Err(error) = write(path, &data) {
                        tracing::warn!("pipelines are not kept for the next run: '{}': {error}", path.display());
                    }
                }
                Err(error) => tracing::warn!("pipelines are not kept for the next run: {error}"),
            }
        }
        // SAFETY: pipelines do not need the cache that they were made with.
        unsafe { device.destroy_pipeline_cache(self.raw, None) };
    }
}

/// A file for each device and driver, as the driver tells them apart.
fn file_name(pipeline_cache_id: &[u8; vk::UUID_SIZE]) -> String {
    let id: String = pipeline_cache_id.iter().map(|byte| format!("{byte:02x}")).collect();
    format!("pipelines-{id}.bin")
}

/// The driver's bytes, if the file is there and whole.
fn read(path: &Path) -> Option<Vec<u8>> {
    let file = fs::read(path).ok()?;
    let data = open_envelope(&file);
    if data.is_none() {
        tracing::warn!("'{}' is damaged: pipelines are compiled anew", path.display());
    }
    data.map(<[u8]>::to_vec)
}

/// Written beside and renamed, so that a second process sees the old file or the new one.
fn write(path: &Path, data: &[u8]) -> std::io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)?;
    let mut file = NamedTempFile::new_in(folder)?;
    file.write_all(&envelope(data))?;
    file.persist(path)?;
    Ok(())
}

fn envelope(data: &[u8]) -> Vec<u8> {
    let length = (data.len() as u64).to_le_bytes();
    let crc = crc32fast::hash(data).to_le_bytes();
    [MAGIC.as_slice(), &length, &crc, data].concat()
}

fn open_envelope(file: &[u8]) -> Option<&[u8]> {
    let (header, data) = file.split_at_checked(HEADER_BYTES)?;
    (header == &envelope(data)[..HEADER_BYTES]).then_some(data)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_comes_back_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("made/on/demand.bin");
        for data in [&b""[..], &b"what the driver gave"[..]] {
            write(&path, data).unwrap();
            assert_eq!(read(&path).unwrap(), data);
        }
    }

    #[test]
    fn a_file_that_was_damaged_anywhere_is_passed_over() {
        let whole = envelope(b"what the driver gave");
        assert!(open_envelope(&whole).is_some());
        for place in 0..whole.len() {
            let mut changed = whole.clone();
            changed[place] ^= 1;
            assert_eq!(open_envelope(&changed), None, "byte {place} changed");
            assert_eq!(open_envelope(&whole[..place]), None, "cut off after {place} bytes");
        }
        assert_eq!(open_envelope(&[&whole[..], &[0]].concat()), None, "one byte more");
    }
}
