//! What a long comparison has found so far, in a file: an interrupted one goes on from there.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::sync::Mutex;

/// Numbers by question. Without a file it keeps nothing and knows nothing.
#[derive(Default)]
pub struct Ledger {
    known: HashMap<String, Vec<f64>>,
    file: Option<Mutex<File>>,
}

impl Ledger {
    /// Reads the file, if there is one, and opens it for more. Its first line says what it belongs to; a file of
    /// something else is refused.
    pub fn open(path: Option<&str>, belongs_to: &str) -> Result<Self, String> {
        let Some(path) = path else { return Ok(Self::default()) };
        let text = match std::fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(format!("cannot read '{path}': {error}")),
        };
        let first = text.split_inclusive('\n').next().and_then(|line| line.strip_suffix('\n'));
        if first.is_some_and(|first| first != belongs_to) {
            return Err(format!("'{path}' holds answers of '{}', not of '{belongs_to}'", first.unwrap_or_default()));
        }
        let mut known = HashMap::new();
        // A process that was killed may leave half a line at the end, which is cut off below and answered again.
        for line in text.split_inclusive('\n').skip(1).filter_map(|line| line.strip_suffix('\n')) {
            let (key, values) = line.split_once(';').ok_or_else(|| format!("'{path}': '{line}' is no answer"))?;
            let values = values.split(',').map(str::parse).collect::<Result<_, _>>();
            known.insert(key.to_owned(), values.map_err(|error| format!("'{path}': '{line}': {error}"))?);
        }
        let cannot_write = |error| format!("cannot write '{path}': {error}");
        let mut file = OpenOptions::new().append(true).create(true).open(path).map_err(cannot_write)?;
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        file.set_len(whole as u64).map_err(cannot_write)?;
        if whole == 0 {
            file.write_all(format!("{belongs_to}\n").as_bytes()).map_err(cannot_write)?;
        }
        Ok(Self { known, file: Some(Mutex::new(file)) })
    }

    /// The answer to a question, from the file or by `compute`.
    pub fn answer(&self, key: &str, compute: impl FnOnce() -> Vec<f64>) -> Vec<f64> {
        if let Some(values) = self.known.get(key) {
            return values.clone();
        }
        let values = compute();
        if let Some(file) = &self.file {
            let numbers: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
            let line = format!("{key};{}\n", numbers.join(","));
            let mut file = file.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            file.write_all(line.as_bytes()).expect("the ledger can be written");
        }
        values
    }
}
