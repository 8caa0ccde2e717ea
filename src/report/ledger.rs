//! What has been measured so far, line by line on disk, so that an interrupted report goes on where it was.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Deviation, ReportError};

/// What all lines have in common: other measurements must not be mixed with them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// What tells the program from others, another build of it included.
    pub program: String,
    /// Device with driver.
    pub device: String,
}

/// One picture of one scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Fingerprint of the scene and of its truth.
    pub scene: String,
    /// Name of the settings or of the solver.
    pub name: String,
    /// Fingerprint of the settings.
    pub settings: String,
    /// Which repetition, from 0.
    pub round: u32,
    /// Time of each pass, ms; of a solver one number.
    pub milliseconds: BTreeMap<String, f64>,
    /// How far the picture was from the truth.
    pub error: Deviation,
    /// The picture itself, where pictures of the scene are held against each other: the cells that count.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cells: Vec<[f32; 3]>,
}

impl Entry {
    fn key(&self) -> Key {
        (self.scene.clone(), self.name.clone(), self.settings.clone(), self.round)
    }
}

type Key = (String, String, String, u32);

/// The list, in memory and on disk.
#[derive(Debug)]
pub struct Ledger {
    path: PathBuf,
    file: File,
    entries: BTreeMap<Key, Entry>,
}

impl Ledger {
    /// Opens or begins the list. A last line that a crash left half-written is cut off.
    ///
    /// # Errors
    /// [`ReportError::Ledger`] where it cannot be read or written, is damaged, or is of another program or device.
    pub fn open(path: &Path, header: &Header) -> Result<Self, ReportError> {
        let failed = |problem: String| ReportError::Ledger { path: path.to_owned(), problem };
        let text = match std::fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(failed(error.to_string())),
        };
        let whole = &text[..text.rfind('\n').map_or(0, |end| end + 1)];
        let mut lines = whole.lines();
        let mut entries = BTreeMap::new();
        if let Some(first) = lines.next() {
            let found: Header = serde_json::from_str(first).map_err(|error| failed(format!("line 1: {error}")))?;
            if found != *header {
                return Err(failed(format!("it is of {found:?}, not of {header:?}")));
            }
            for (index, line) in lines.enumerate() {
                let entry: Entry =
                    serde_json::from_str(line).map_err(|error| failed(format!("line {}: {error}", index + 2)))?;
                entries.insert(entry.key(), entry);
            }
        }
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.map_err(|error| failed(error.to_string()))?;
        file.set_len(whole.len() as u64).map_err(|error| failed(error.to_string()))?;
        let mut ledger = Self { path: path.to_owned(), file, entries };
        if whole.is_empty() {
            ledger.write(header)?;
        }
        Ok(ledger)
    }

    /// What was measured before, if it was.
    pub fn find(&self, scene: &str, name: &str, settings: &str, round: u32) -> Option<&Entry> {
        self.entries.get(&(scene.to_owned(), name.to_owned(), settings.to_owned(), round))
    }

    /// Adds a measurement.
    ///
    /// # Errors
    /// [`ReportError::Ledger`] where the disk refuses.
    pub fn add(&mut self, entry: Entry) -> Result<(), ReportError> {
        self.write(&entry)?;
        self.entries.insert(entry.key(), entry);
        Ok(())
    }

    fn write(&mut self, line: &impl Serialize) -> Result<(), ReportError> {
        let text = format!("{}\n", serde_json::to_string(line)?);
        let written = self.file.write_all(text.as_bytes()).and_then(|()| self.file.flush());
        written.map_err(|error| ReportError::Ledger { path: self.path.clone(), problem: error.to_string() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header() -> Header {
        Header { program: "welkin 1".into(), device: "llvmpipe".into() }
    }

    fn entry(round: u32) -> Entry {
        let error = Deviation {
            rms: 0.1 / 3.0,
            low: 0.01,
            high: 0.05,
            noise: 1e-3,
            median: 0.02,
            p95: 0.06,
            p99: 0.07,
            energy_ratio: 1.001,
            pixels: 336,
        };
        let milliseconds = [("compose".to_owned(), 1.0 / 3.0)].into();
        Entry {
            scene: "ab".into(),
            name: "low".into(),
            settings: "cd".into(),
            round,
            milliseconds,
            error,
            cells: Vec::new(),
        }
    }

    #[test]
    fn what_was_measured_is_found_again_after_a_crash_in_the_middle_of_a_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("measured.jsonl");
        let mut ledger = Ledger::open(&path, &header()).unwrap();
        ledger.add(entry(0)).unwrap();
        ledger.add(entry(1)).unwrap();
        drop(ledger);
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, &text[..text.len() - 5]).unwrap();
        let mut ledger = Ledger::open(&path, &header()).unwrap();
        assert_eq!(ledger.find("ab", "low", "cd", 0), Some(&entry(0)));
        assert_eq!(ledger.find("ab", "low", "cd", 1), None);
        ledger.add(entry(1)).unwrap();
        drop(ledger);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    }

    #[test]
    fn measurements_of_another_device_are_not_mixed_with_these() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("measured.jsonl");
        Ledger::open(&path, &header()).unwrap();
        let message = Ledger::open(&path, &Header { device: "H200".into(), ..header() }).unwrap_err().to_string();
        assert!(message.contains("llvmpipe") && message.contains("H200") && message.contains("delete it"), "{message}");
        std::fs::write(&path, "nonsense\n").unwrap();
        assert!(Ledger::open(&path, &header()).unwrap_err().to_string().contains("line 1"));
    }
}
