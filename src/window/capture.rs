//! Pictures as files, and the command that renders them.

use std::path::{Path, PathBuf};

use toml::Table;

use super::document::{Document, set};
use crate::output::{AtomicFile, OutputError, write_exr, write_png};
use crate::passes::RenderError;
use crate::plan::Outputs;
use crate::renderer::Rendered;
use crate::scene::{Scene, SceneError};

/// What a picture's files are made of.
pub const OUTPUTS: Outputs = Outputs { capture: true, picture: true };

/// Why a picture was not written.
#[derive(Debug, thiserror::Error)]
pub enum CaptureError {
    /// The scene does not stand on its own in the folder.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// It cannot be rendered.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] OutputError),
}

/// A picture to be: three files of one name, and the scene that `welkin render` makes the same pictures of.
pub struct Capture {
    stem: PathBuf,
    text: String,
    /// The scene as its file will be read.
    pub scene: Scene,
}

impl Capture {
    /// Of a document as a window of so many pixels shows it, under the first free name in a folder.
    ///
    /// # Errors
    /// [`CaptureError::Scene`] where the scene names tables that are not in that folder.
    pub fn new(document: &Document, size: [u32; 2], folder: &Path) -> Result<Self, CaptureError> {
        let stem = free_stem(folder, &document.scene().name);
        let text = toml::to_string(&sized(document.table(), size)).unwrap_or_default();
        let scene = Scene::parse(&text, &stem.with_extension("toml"))?;
        Ok(Self { stem, text, scene })
    }

    /// Writes the files; their names.
    ///
    /// # Errors
    /// [`CaptureError`].
    pub fn write(&self, rendered: Result<Rendered, RenderError>) -> Result<[PathBuf; 3], CaptureError> {
        let rendered = rendered?;
        let files = ["png", "exr", "toml"].map(|ending| self.stem.with_extension(ending));
        let (width, height) = (rendered.frame.width, rendered.frame.height);
        write_png(AtomicFile::create(&files[0])?, width, height, &rendered.picture.unwrap_or_default())?;
        write_exr(AtomicFile::create(&files[1])?, &rendered.frame, &self.scene)?;
        AtomicFile::create(&files[2])?.write_all(self.text.as_bytes())?;
        Ok(files)
    }
}

/// The scene with a camera of so many pixels.
fn sized(table: &Table, [width, height]: [u32; 2]) -> Table {
    let mut table = table.clone();
    set(&mut table, "camera.width", Some(i64::from(width).into()));
    set(&mut table, "camera.height", Some(i64::from(height).into()));
    table
}

/// `NAME-001` and so on: the first that no file has.
fn free_stem(folder: &Path, name: &str) -> PathBuf {
    let plain: String = name.chars().map(|c| if c.is_alphanumeric() || "-_".contains(c) { c } else { '-' }).collect();
    let plain = if plain.is_empty() { "picture".to_owned() } else { plain };
    let stem = |number: u32| folder.join(format!("{plain}-{number:03}"));
    let taken = |stem: &PathBuf| ["png", "exr", "toml"].iter().any(|ending| stem.with_extension(ending).exists());
    (1..=u32::MAX).map(stem).find(|stem| !taken(stem)).unwrap_or_else(|| stem(0))
}

/// The command that renders what a window of so many pixels shows, with the options for its settings. A scene that is not
/// saved goes along.
pub fn command(document: &Document, size: [u32; 2], options: &str) -> String {
    let name = quoted(&document.scene().name);
    let options = format!("-o {name}.png -o {name}.exr {options}");
    let table = sized(document.table(), size);
    if table == *document.table() && !document.is_modified() && document.path().exists() {
        return format!("welkin render {} {options}", quoted(&document.path().display().to_string()));
    }
    let text = toml::to_string(&table).unwrap_or_default();
    format!("welkin render /dev/stdin {options} <<'SCENE'\n{text}SCENE\n")
}

/// As one word for a shell.
fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./".contains(c);
    match !text.is_empty() && text.chars().all(plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "preset = \"earth\"\n[sun]\nelevation_deg = 30\nazimuth_deg = 180\n[camera]\naltitude_m = 2\n\
                        elevation_deg = 10\nazimuth_deg = 180\nwidth = 640\nheight = 360\n";

    #[test]
    fn a_saved_scene_goes_by_its_file_and_a_changed_one_goes_along() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("it's.toml");
        std::fs::write(&path, TEXT).unwrap();
        let mut document = Document::new(TEXT, &path).unwrap();
        let say = |document: &Document, size| command(document, size, "--quality high");
        let saved = say(&document, [640, 360]);
        assert!(saved.starts_with("welkin render '") && saved.contains("it'\\''s.toml' -o 'it'\\''s'.png"), "{saved}");
        assert!(saved.ends_with("--quality high"), "{saved}");
        assert!(say(&document, [800, 600]).contains("width = 800"));
        document.set("sun.elevation_deg", 4.0).unwrap();
        let changed = say(&document, [640, 360]);
        let text = changed.split_once('\n').unwrap().1.trim_end_matches("SCENE\n");
        assert_eq!(Scene::parse(text, &path).unwrap(), **document.scene());
    }

    #[test]
    fn names_are_never_used_twice() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(free_stem(folder.path(), "a/b"), folder.path().join("a-b-001"));
        std::fs::write(folder.path().join("a-b-001.exr"), "").unwrap();
        assert_eq!(free_stem(folder.path(), "a/b"), folder.path().join("a-b-002"));
    }
}
