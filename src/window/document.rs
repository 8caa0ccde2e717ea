//! The scene that is being looked at, as its file says it: what the panel edits, undo restores and saving writes.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use toml::{Table, Value};

use crate::scene::{Scene, SceneError};

/// A scene file in memory, always one that the reader accepts.
#[derive(Debug, Clone)]
pub struct Document {
    table: Table,
    scene: Arc<Scene>,
    path: PathBuf,
    /// What the file holds, as far as is known.
    saved: Table,
}

impl Document {
    /// Checks a scene file's text.
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub fn new(text: &str, path: &Path) -> Result<Self, SceneError> {
        let scene = Arc::new(Scene::parse(text, path)?);
        let table: Table = toml::from_str(text).unwrap_or_default();
        Ok(Self { saved: table.clone(), table, scene, path: path.to_owned() })
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Its file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// All that the file would say.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// The text of the file; its comments are not kept.
    pub fn text(&self) -> String {
        // A table that came from TOML can be written as TOML.
        toml::to_string(&self.table).unwrap_or_default()
    }

    /// Whether it differs from its file.
    pub fn is_modified(&self) -> bool {
        self.table != self.saved
    }

    /// Whether a text is what its file holds already.
    pub fn is_saved_as(&self, text: &str) -> bool {
        toml::from_str::<Table>(text).is_ok_and(|table| table == self.saved)
    }

    /// It has been written to a file.
    pub fn saved_as(&mut self, path: &Path) {
        (self.path, self.saved) = (path.to_owned(), self.table.clone());
    }

    /// Replaces what it says by an earlier table of its own.
    ///
    /// # Errors
    /// As [`Document::edit`].
    pub fn restore(&mut self, table: &Table) -> Result<(), String> {
        self.edit(|current| *current = table.clone())
    }

    /// Changes what it says, if the reader accepts the result.
    ///
    /// # Errors
    /// What is wrong with the field; then nothing is changed.
    pub fn edit(&mut self, change: impl FnOnce(&mut Table)) -> Result<(), String> {
        let mut table = self.table.clone();
        change(&mut table);
        if table == self.table {
            return Ok(());
        }
        let text = toml::to_string(&table).map_err(|error| error.to_string())?;
        let scene = Scene::parse(&text, &self.path).map_err(|error| match error {
            SceneError::Invalid(field) => match field.field {
                Some(name) => format!("{name}: {}", field.problem),
                None => field.problem,
            },
            error => error.to_string(),
        })?;
        (self.table, self.scene) = (table, Arc::new(scene));
        Ok(())
    }

    /// Sets one field by its path, as in `clouds[0].base_m`.
    #[cfg(test)]
    pub fn set(&mut self, path: &str, value: impl Into<Value>) -> Result<(), String> {
        let value = value.into();
        self.edit(|table| set(table, path, Some(value)))
    }

    /// The value of a field, where the file says it.
    pub fn get(&self, path: &str) -> Option<&Value> {
        let mut steps = steps(path).into_iter();
        let Some(Step::Key(first)) = steps.next() else { return None };
        steps.try_fold(self.table.get(&first)?, |value, step| match step {
            Step::Key(key) => value.get(key),
            Step::Index(index) => value.get(index),
        })
    }

    /// A number that the file says.
    pub fn number(&self, path: &str) -> Option<f64> {
        self.get(path).and_then(as_number)
    }
}

/// A number of either kind.
pub fn as_number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

enum Step {
    Key(String),
    Index(usize),
}

fn steps(path: &str) -> Vec<Step> {
    let parts = path.split(['.', '[']).map(|part| part.trim_end_matches(']')).zip(path_kinds(path));
    parts
        .map(|(part, is_index)| match part.parse() {
            Ok(index) if is_index => Step::Index(index),
            _ => Step::Key(part.to_owned()),
        })
        .collect()
}

/// Of each part of a path, whether it stands in brackets.
fn path_kinds(path: &str) -> impl Iterator<Item = bool> {
    let separators = path.chars().filter(|c| ['.', '['].contains(c)).map(|c| c == '[');
    std::iter::once(false).chain(separators)
}

/// Sets a field of a table, or takes it away; tables on the way are made, and empty ones that are left are removed.
pub fn set(table: &mut Table, path: &str, value: Option<Value>) {
    let steps = steps(path);
    let Some((Step::Key(first), rest)) = steps.split_first() else { return };
    match (rest.is_empty(), value) {
        (true, Some(value)) => drop(table.insert(first.clone(), value)),
        (true, None) => drop(table.remove(first)),
        (false, value) => {
            let inner = table.entry(first.clone()).or_insert_with(|| Value::Table(Table::new()));
            set_in(inner, rest, value);
        }
    }
}

fn set_in(value: &mut Value, steps: &[Step], new: Option<Value>) {
    let (step, rest) = (&steps[0], &steps[1..]);
    match (step, value) {
        (Step::Key(key), Value::Table(table)) if rest.is_empty() => match new {
            Some(new) => drop(table.insert(key.clone(), new)),
            None => drop(table.remove(key)),
        },
        (Step::Key(key), Value::Table(table)) => {
            set_in(table.entry(key.clone()).or_insert_with(|| Value::Table(Table::new())), rest, new);
        }
        (Step::Index(index), Value::Array(list)) if rest.is_empty() => match new {
            Some(new) if *index < list.len() => list[*index] = new,
            Some(new) => list.push(new),
            None if *index < list.len() => drop(list.remove(*index)),
            None => {}
        },
        (Step::Index(index), Value::Array(list)) if *index < list.len() => set_in(&mut list[*index], rest, new),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "preset = \"earth\"\n[sun]\nelevation_deg = 30\nazimuth_deg = 180\n[camera]\naltitude_m = 2\n\
                        elevation_deg = 10\nazimuth_deg = 180\n[[clouds]]\nkind = \"cumulus\"\n";

    fn document() -> Document {
        Document::new(TEXT, Path::new("scene.toml")).unwrap()
    }

    #[test]
    fn an_edit_changes_the_scene_and_what_is_saved_is_read_as_the_same_scene() {
        let mut document = document();
        document.set("clouds[0].base_m", 1200.0).unwrap();
        document.set("medium.aerosol.density_factor", 3).unwrap();
        document.set("camera.altitude_m", 500.0).unwrap();
        assert_eq!(document.scene().camera.altitude_m, 500.0);
        let read = Scene::parse(&document.text(), Path::new("scene.toml")).unwrap();
        assert_eq!(read, **document.scene());
        assert_eq!(document.number("clouds[0].base_m"), Some(1200.0));
        assert!(document.is_modified());
    }

    #[test]
    fn a_wrong_edit_is_refused_by_its_field_and_changes_nothing() {
        let mut document = document();
        let before = document.text();
        let refused = document.set("camera.elevation_deg", 95.0).unwrap_err();
        assert!(refused.contains("camera.elevation_deg") && refused.contains("from -90 to 90"), "{refused}");
        assert_eq!(document.text(), before);
        assert!(!document.is_modified());
    }

    #[test]
    fn what_is_taken_away_is_the_presets_again() {
        let mut document = document();
        let radius_m = document.scene().planet.radius_m;
        document.set("planet.radius_m", 1e6).unwrap();
        document.edit(|table| set(table, "planet.radius_m", None)).unwrap();
        assert_eq!(document.scene().planet.radius_m, radius_m);
        document.edit(|table| set(table, "clouds[0]", None)).unwrap();
        assert!(document.scene().clouds.is_empty());
    }
}
