//! A folder that appears under its name only when it is whole.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::PackError;

/// A folder that is filled beside its place and renamed to it at the end. Dropped before that, it leaves nothing behind.
pub(super) struct WholeFolder {
    place: PathBuf,
    filling: TempDir,
}

fn failed(path: &Path) -> impl Fn(std::io::Error) -> PackError {
    let path = path.to_owned();
    move |source| PackError::File { path: path.clone(), source }
}

impl WholeFolder {
    /// Opens a folder to fill. An older pack under that name stays until the new one is whole.
    pub(super) fn create(place: &Path) -> Result<Self, PackError> {
        if place.exists() && !may_replace(place) {
            return Err(PackError::Occupied { folder: place.to_owned() });
        }
        let parent = place.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::create_dir_all(parent).map_err(failed(parent))?;
        let filling = tempfile::Builder::new().prefix(".welkin-").suffix(".tmp").tempdir_in(parent);
        Ok(Self { place: place.to_owned(), filling: filling.map_err(failed(place))? })
    }

    /// Writes a file, by its path with slashes.
    pub(super) fn write(&self, path: &str, content: &[u8]) -> Result<(), PackError> {
        let path = self.filling.path().join(path);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(failed(folder))?;
        }
        fs::write(&path, content).map_err(failed(&path))
    }

    /// Renames the folder to its place.
    pub(super) fn commit(self) -> Result<(), PackError> {
        let Self { place, filling } = self;
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // Temporary folders are private; this one is for others to read.
            let readable = fs::Permissions::from_mode(0o755);
            fs::set_permissions(filling.path(), readable).map_err(failed(&place))?;
        }
        // What was there moves into a temporary folder, which takes it along when it goes.
        let parent = filling.path().parent().unwrap_or(Path::new("."));
        let old = tempfile::Builder::new().prefix(".welkin-old-").tempdir_in(parent).map_err(failed(&place))?;
        let moved = place.exists();
        if moved {
            fs::rename(&place, old.path().join("pack")).map_err(failed(&place))?;
        }
        let filled = filling.keep();
        if let Err(source) = fs::rename(&filled, &place) {
            let _ = fs::remove_dir_all(&filled);
            if moved {
                // Better the old pack than none.
                let _ = fs::rename(old.path().join("pack"), &place);
            }
            return Err(PackError::File { path: place, source });
        }
        Ok(())
    }
}

/// Whether a folder is empty or a pack.
fn may_replace(place: &Path) -> bool {
    let empty = fs::read_dir(place).is_ok_and(|mut entries| entries.next().is_none());
    let manifest = fs::read_to_string(place.join("manifest.json")).unwrap_or_default();
    empty || manifest.contains(super::PACK_FORMAT)
}
