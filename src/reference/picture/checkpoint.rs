//! A run that was interrupted, on disk: exactly the film, so that it goes on to the same result.
//!
//! Layout: the line `welkin checkpoint 1`, a line of JSON (identity, goal, number of pixels), the pixels as they lie
//! in memory (little endian), and a CRC-32 of everything before it.

use std::path::{Path, PathBuf};

use super::film::{Film, PixelMean, Shard};
use super::identity::Identity;
use crate::output::{AtomicFile, OutputError};

const MAGIC: &str = "welkin checkpoint 1\n";

/// Why a checkpoint cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The file cannot be read.
    #[error("cannot read the checkpoint '{}'", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is damaged or something else.
    #[error("the checkpoint '{}' is damaged: {problem}; delete it to begin again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// The file belongs to another run.
    #[error("the checkpoint '{}' is of {difference}; delete it to begin again, or write to another file", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What it is of, and what was expected.
        difference: String,
    },
}

#[derive(serde::Serialize, serde::Deserialize)]
struct Header {
    identity: Identity,
    goal: u64,
    pixels: usize,
}

/// Where the checkpoint of a run with this output lies: beside it.
pub fn path_for(output: &Path) -> PathBuf {
    let mut name = output.file_name().unwrap_or_default().to_owned();
    name.push(".checkpoint");
    output.with_file_name(name)
}

/// Saves a film, whole or not at all.
///
/// # Errors
/// [`OutputError`], with what was there before untouched.
pub fn save(path: &Path, identity: &Identity, film: &Film) -> Result<(), OutputError> {
    let header = Header { identity: identity.clone(), goal: film.goal, pixels: film.pixels.len() };
    let mut bytes = MAGIC.as_bytes().to_vec();
    serde_json::to_writer(&mut bytes, &header)
        .map_err(|source| OutputError::Encode { path: path.into(), source: source.into() })?;
    bytes.push(b'\n');
    bytes.extend_from_slice(bytemuck::cast_slice(&film.pixels));
    bytes.extend_from_slice(&crc32fast::hash(&bytes).to_le_bytes());
    AtomicFile::create(path)?.write_all(&bytes)
}

/// Loads the film of a run.
///
/// # Errors
/// [`CheckpointError`]: unreadable, damaged, or of another run.
pub fn load(path: &Path, expected: &Identity) -> Result<Film, CheckpointError> {
    let bytes = std::fs::read(path).map_err(|source| CheckpointError::Read { path: path.into(), source })?;
    let damaged = |problem: &str| CheckpointError::Damaged { path: path.into(), problem: problem.to_owned() };
    let (content, checksum) = bytes.split_last_chunk::<4>().ok_or_else(|| damaged("it is too short"))?;
    let content = content.strip_prefix(MAGIC.as_bytes()).ok_or_else(|| damaged("it is no checkpoint"))?;
    if crc32fast::hash(&bytes[..bytes.len() - 4]) != u32::from_le_bytes(*checksum) {
        return Err(damaged("its checksum does not fit"));
    }
    let end = content.iter().position(|&byte| byte == b'\n').ok_or_else(|| damaged("it has no header"))?;
    let header: Header = serde_json::from_slice(&content[..end]).map_err(|error| damaged(&error.to_string()))?;
    let shard = Shard { index: expected.shard - 1, count: expected.shards };
    let identity = &header.identity;
    if let Some(difference) = expected.difference(identity) {
        return Err(CheckpointError::Foreign { path: path.into(), difference });
    }
    if identity.shard != expected.shard {
        let difference = format!("part {}, not part {}", identity.shard, expected.shard);
        return Err(CheckpointError::Foreign { path: path.into(), difference });
    }
    let pixels: Vec<PixelMean> =
        content[end + 1..].chunks_exact(size_of::<PixelMean>()).map(bytemuck::pod_read_unaligned).collect();
    if pixels.len() != header.pixels || content.len() - end - 1 != size_of_val(&pixels[..]) {
        return Err(damaged("its size does not fit"));
    }
    Ok(Film { shard, pixels, goal: header.goal })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::picture::identity::Fingerprint;

    fn identity() -> Identity {
        Identity {
            scene: "noon".into(),
            fingerprint: Fingerprint::of("noon"),
            version: "1".into(),
            solver: "path".into(),
            seed: 7,
            walks_per_batch: 16,
            most_walks: 256,
            max_error: Some(0.01),
            width: 5,
            height: 3,
            shard: 2,
            shards: 2,
        }
    }

    fn film() -> Film {
        let mut film = Film::new(Shard { index: 1, count: 2 }, 15);
        film.pixels[3].add([0.1, 1.0 / 3.0, f64::MIN_POSITIVE]);
        film.goal = 8;
        film
    }

    fn saved() -> (tempfile::TempDir, PathBuf) {
        let directory = tempfile::tempdir().unwrap();
        let path = path_for(&directory.path().join("out.exr"));
        save(&path, &identity(), &film()).unwrap();
        (directory, path)
    }

    #[test]
    fn a_film_comes_back_to_the_last_bit_and_nothing_else_is_left_behind() {
        let (directory, path) = saved();
        assert_eq!(load(&path, &identity()).unwrap(), film());
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn damage_of_any_byte_and_any_length_is_noticed() {
        let (_directory, path) = saved();
        let good = std::fs::read(&path).unwrap();
        for position in 0..good.len() {
            let mut bad = good.clone();
            bad[position] ^= 0x10;
            std::fs::write(&path, &bad).unwrap();
            assert!(matches!(load(&path, &identity()), Err(CheckpointError::Damaged { .. })), "byte {position}");
            std::fs::write(&path, &good[..position]).unwrap();
            assert!(matches!(load(&path, &identity()), Err(CheckpointError::Damaged { .. })), "length {position}");
        }
    }

    #[test]
    fn a_checkpoint_of_another_run_is_refused_with_the_difference() {
        let (_directory, path) = saved();
        let message = |other: Identity| load(&path, &other).unwrap_err().to_string();
        assert!(message(Identity { seed: 8, ..identity() }).contains("seed 7, not seed 8"));
        assert!(message(Identity { shard: 1, ..identity() }).contains("part 2, not part 1"));
        assert!(message(Identity { width: 6, ..identity() }).contains("5x3 pixels, not 6x3"));
        let dusk = Identity { scene: "dusk".into(), fingerprint: Fingerprint::of("dusk"), ..identity() };
        assert!(message(dusk).contains("scene 'noon'"));
    }
}
