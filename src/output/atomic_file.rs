//! A file that appears under its name only when it is whole.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::OutputError;

/// A file that is written beside its place and renamed to it at the end. Dropped before that, it leaves nothing behind.
#[derive(Debug)]
pub struct AtomicFile {
    path: PathBuf,
    temporary: NamedTempFile,
}

impl AtomicFile {
    /// Opens a file to write. Long work should do so first: a place that cannot be written is refused here.
    ///
    /// # Errors
    /// [`OutputError::NoFolder`] or [`OutputError::Write`] where the folder is missing or cannot be written;
    /// [`OutputError::NotAFile`] where a folder or a device has that name.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let failed = |source: std::io::Error| OutputError::Write { path: path.to_owned(), source };
        // Through a link, so that what it points to is replaced and not the link.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if fs::metadata(&target).is_ok_and(|metadata| !metadata.is_file()) {
            return Err(OutputError::NotAFile { path: path.to_owned() });
        }
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.is_dir() {
            return Err(OutputError::NoFolder { path: path.to_owned(), folder: folder.to_owned() });
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(".welkin-").suffix(".tmp");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // What the process's mask leaves of it, as for any new file; temporary files are private by default.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        // The kind alone: the rest of the message is about the temporary file, which the user does not know of.
        let temporary = builder.tempfile_in(folder).map_err(|error| failed(error.kind().into()))?;
        Ok(Self { path: target, temporary })
    }

    /// The open file, for writers that seek.
    pub fn file(&mut self) -> &mut File {
        self.temporary.as_file_mut()
    }

    /// Where it will stand.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Renames the file to its place, in one step.
    ///
    /// # Errors
    /// [`OutputError::Write`] when the file system refuses; then nothing is left behind.
    pub fn commit(mut self) -> Result<(), OutputError> {
        let Self { path, temporary } = &mut self;
        temporary.flush().map_err(|source| OutputError::Write { path: path.clone(), source })?;
        let Self { path, temporary } = self;
        temporary.persist(&path).map(drop).map_err(|error| OutputError::Write { path, source: error.error })
    }

    /// Writes the whole content and renames the file to its place.
    ///
    /// # Errors
    /// [`OutputError::Write`] as above.
    pub fn write_all(mut self, content: &[u8]) -> Result<(), OutputError> {
        let written = self.file().write_all(content);
        written.map_err(|source| OutputError::Write { path: self.path.clone(), source })?;
        self.commit()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_file_appears_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.txt");
        let mut dropped = AtomicFile::create(&path).unwrap();
        dropped.file().write_all(b"half").unwrap();
        drop(dropped);
        assert!(names(folder.path()).is_empty());
        AtomicFile::create(&path).unwrap().write_all(b"whole").unwrap();
        assert_eq!(names(folder.path()), ["result.txt"]);
        assert_eq!(fs::read(&path).unwrap(), b"whole");
    }

    #[test]
    fn a_folder_that_is_not_there_is_named() {
        let error = AtomicFile::create(Path::new("/no/such/folder/out.exr")).unwrap_err();
        assert!(error.to_string().starts_with("cannot write '/no/such/folder/out.exr': there is no folder"), "{error}");
    }

    #[test]
    fn a_folder_is_not_replaced_by_a_file() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(AtomicFile::create(folder.path()), Err(OutputError::NotAFile { .. })));
    }
}
