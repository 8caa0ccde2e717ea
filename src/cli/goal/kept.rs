//! Measurements that are kept from run to run.

use std::path::PathBuf;

use anyhow::Context as _;
use serde::Serialize;
use serde::de::DeserializeOwned;
use welkin::output::AtomicFile;
use welkin::reference::picture::Fingerprint;

use crate::cli::backend::cache_folder;

/// The file of a measurement, in the folder for what can be made again; none where there is no such folder.
pub struct Kept(Option<PathBuf>);

impl Kept {
    /// Of what a text says, by this version of the program.
    pub fn new(of: String) -> Self {
        let kind = of.split(' ').next().unwrap_or_default();
        let key = Fingerprint::of(&format!("{} {of}", env!("CARGO_PKG_VERSION")));
        Self(cache_folder().map(|folder| folder.join(format!("{kind}-{key}.json"))))
    }

    /// What is there. A file that cannot be read is as good as none: it is made again.
    pub fn read<T: DeserializeOwned>(&self) -> Option<T> {
        let text = std::fs::read_to_string(self.0.as_ref()?).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// Keeps a measurement. Where that fails it is made again the next time, and a warning says so.
    pub fn write(&self, measurement: &impl Serialize) {
        self.try_write(measurement).unwrap_or_else(|error| tracing::warn!("the measurement is not kept: {error:#}"));
    }

    fn try_write(&self, measurement: &impl Serialize) -> anyhow::Result<()> {
        let Some(path) = &self.0 else { return Ok(()) };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)
                .with_context(|| format!("cannot make the folder '{}'", folder.display()))?;
        }
        Ok(AtomicFile::create(path)?.write_all(serde_json::to_string(measurement)?.as_bytes())?)
    }
}
