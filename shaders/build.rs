//! Lists the WGSL files of `wgsl/`, so that a new file is embedded without naming it a second time.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let directory = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it")).join("wgsl");
    println!("cargo::rerun-if-changed={}", directory.display());
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    fs::write(out.join("embedded.rs"), embedded(&directory)?)
}

/// The text of a constant slice of (file name, source), in the order of the names.
fn embedded(directory: &Path) -> io::Result<String> {
    let mut paths = fs::read_dir(directory)?.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "wgsl"));
    paths.sort();
    let mut text = String::from("const EMBEDDED: &[(&str, &str)] = &[\n");
    for path in paths {
        let name = path.file_name().expect("a listed file has a name");
        writeln!(text, "    ({name:?}, include_str!({path:?})),").expect("writing to a String cannot fail");
    }
    text.push_str("];\n");
    Ok(text)
}
