//! Shaders of which nothing is left but what a scene calls for, as if nothing else had ever been written.

use std::path::Path;

use welkin_shaders::{Definition, Definitions, Sources};

/// Names that definitions leave undefined.
pub fn absent(definitions: &Definitions) -> Vec<String> {
    let undefined = definitions.iter().filter(|(_, value)| **value == Definition::Bool(false));
    undefined.map(|(name, _)| name.clone()).collect()
}

/// The sources without what stands between `#ifdef` of an absent name and its `#else` or `#endif`, and without the files
/// whose names begin with a word that only an absent effect has.
pub fn without(absent: &[String], prefixes: &[&str]) -> Sources {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders/wgsl");
    let mut sources = Sources::default();
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if name.ends_with(".wgsl") && !prefixes.iter().any(|prefix| name.starts_with(prefix)) {
            sources = sources.with(name, cut(&std::fs::read_to_string(&path).unwrap(), absent));
        }
    }
    sources
}

fn cut(text: &str, absent: &[String]) -> String {
    // For each open condition: whether it is about an absent name, and whether its lines are left out.
    let mut open: Vec<(bool, bool)> = Vec::new();
    let mut kept = String::new();
    for line in text.lines() {
        let words: Vec<_> = line.split_whitespace().collect();
        let is_absent = words.len() > 1 && absent.iter().any(|name| name == words[1]);
        match words.first().copied() {
            Some("#ifdef") => open.push((is_absent, is_absent)),
            Some("#ifndef") => open.push((is_absent, false)),
            Some("#if") => open.push((false, false)),
            _ => {}
        }
        let (about_absent, _) = open.last().copied().unwrap_or_default();
        let directive = matches!(words.first(), Some(&("#ifdef" | "#ifndef" | "#else" | "#endif")));
        if words.first() == Some(&"#else") && about_absent {
            let last = open.last_mut().unwrap();
            last.1 = !last.1;
        }
        if !(directive && about_absent) && open.iter().all(|(_, left_out)| !left_out) {
            kept.push_str(line);
            kept.push('\n');
        }
        if words.first() == Some(&"#endif") {
            open.pop();
        }
    }
    kept
}
