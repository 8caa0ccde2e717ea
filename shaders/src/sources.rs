//! WGSL files by name: the embedded ones, or others.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::{Definitions, ShaderError, compose};

include!(concat!(env!("OUT_DIR"), "/embedded.rs"));

/// A set of WGSL files, among which imports are resolved.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    files: BTreeMap<String, Cow<'static, str>>,
    /// Goes before a file's name in messages, so that they name a path one can open.
    directory: String,
}

impl Sources {
    /// The files that were in `shaders/wgsl/` when this crate was built.
    pub fn embedded() -> Self {
        let files = EMBEDDED.iter().map(|&(name, text)| (name.to_owned(), Cow::Borrowed(text))).collect();
        Self { files, directory: "shaders/wgsl/".to_owned() }
    }

    /// Every `.wgsl` file of a directory, not of its subdirectories.
    ///
    /// # Errors
    /// [`ShaderError::Unreadable`], naming the path, when the directory or a file cannot be read.
    pub fn from_directory(directory: &Path) -> Result<Self, ShaderError> {
        let unreadable = |path: &Path, source| ShaderError::Unreadable { path: path.to_owned(), source };
        let mut files = BTreeMap::new();
        for entry in fs::read_dir(directory).map_err(|error| unreadable(directory, error))? {
            let path = entry.map_err(|error| unreadable(directory, error))?.path();
            let Some(name) = path.file_name().and_then(|name| name.to_str()) else { continue };
            if name.ends_with(".wgsl") {
                let text = fs::read_to_string(&path).map_err(|error| unreadable(&path, error))?;
                files.insert(name.to_owned(), Cow::Owned(text));
            }
        }
        Ok(Self { files, directory: format!("{}/", directory.display()) })
    }

    /// Adds a file, or replaces the one of the same name. A pass is found by `file_name` without `.wgsl`.
    #[must_use]
    pub fn with(mut self, file_name: &str, text: impl Into<Cow<'static, str>>) -> Self {
        self.files.insert(file_name.to_owned(), text.into());
        self
    }

    /// The names of all passes: the files that are not modules.
    pub fn passes(&self) -> impl Iterator<Item = &str> {
        self.files.iter().filter(|(_, text)| import_path(text).is_none()).map(|(file, _)| stem(file))
    }

    /// Those definitions that can make a difference to a pass: what is compiled with others would be the same again.
    ///
    /// # Errors
    /// [`ShaderError::UnknownPass`]; [`ShaderError::ImportCycle`].
    pub fn relevant(&self, pass: &str, definitions: &Definitions) -> Result<Definitions, ShaderError> {
        compose::relevant(self, pass, definitions)
    }

    /// A pass's path for messages, and its text.
    pub(crate) fn pass(&self, name: &str) -> Result<(String, &str), ShaderError> {
        match self.files.get(&format!("{name}.wgsl")) {
            Some(text) if import_path(text).is_none() => Ok((format!("{}{name}.wgsl", self.directory), text)),
            _ => Err(ShaderError::UnknownPass {
                name: name.to_owned(),
                available: self.passes().collect::<Vec<_>>().join(", "),
            }),
        }
    }

    /// All modules: their path for messages and their text, by import path.
    pub(crate) fn modules(&self) -> BTreeMap<&str, (String, &str)> {
        self.files
            .iter()
            .filter_map(|(file, text)| Some((import_path(text)?, (format!("{}{file}", self.directory), text.as_ref()))))
            .collect()
    }
}

fn stem(file_name: &str) -> &str {
    file_name.strip_suffix(".wgsl").unwrap_or(file_name)
}

/// What `#define_import_path` declares; such a file is a module.
fn import_path(text: &str) -> Option<&str> {
    text.lines().find_map(|line| line.trim_start().strip_prefix("#define_import_path").map(str::trim))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Definition;

    #[test]
    fn files_with_an_import_path_are_modules_and_all_others_are_passes() {
        let sources = Sources::default()
            .with("sky.wgsl", "// a pass\n")
            .with("optics.wgsl", "// a module\n#define_import_path welkin::optics\n");
        assert_eq!(sources.passes().collect::<Vec<_>>(), ["sky"]);
        assert_eq!(sources.modules().into_keys().collect::<Vec<_>>(), ["welkin::optics"]);
    }

    #[test]
    fn an_unknown_pass_is_an_error_that_lists_the_known_ones() {
        let sources = Sources::default().with("clouds.wgsl", "").with("sky.wgsl", "");
        let error = sources.pass("cloud").unwrap_err().to_string();
        assert!(error.contains("`cloud`") && error.contains("clouds, sky"), "{error}");
    }

    #[test]
    fn only_definitions_that_a_pass_or_its_imports_name_are_relevant() {
        let sources = Sources::default()
            .with("sky.wgsl", "#import welkin::optics\n#ifdef GROUND\n#endif\nconst M: u32 = optics::N;\n")
            .with("optics.wgsl", "#define_import_path welkin::optics\nconst N: u32 = #{NODE_COUNT}u;\n")
            .with("other.wgsl", "#define_import_path welkin::other\n#ifdef CLOUDS\n#endif\n");
        let names = ["GROUND", "NODE_COUNT", "CLOUDS", "NODE"];
        let all = names.map(|name| (name.to_owned(), Definition::U32(1))).into();
        let relevant = sources.relevant("sky", &all).unwrap();
        assert_eq!(relevant.into_keys().collect::<Vec<_>>(), ["GROUND", "NODE_COUNT"]);
    }

    #[test]
    fn a_missing_directory_is_named() {
        let error = Sources::from_directory(Path::new("no/such/directory")).unwrap_err().to_string();
        assert!(error.contains("no/such/directory"), "{error}");
    }
}
