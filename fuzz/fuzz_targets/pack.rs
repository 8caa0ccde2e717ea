//! Whatever one file of a pack holds, and be its hash the right one, the pack is refused with a reason or answers.
//!
//! The first byte of an input says which file of the tiny pack it stands for, the rest is the content.
#![no_main]

mod tiny_pack;

use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;
use welkin_lut::pack::{Manifest, verify};

struct Tiny {
    _folder: TempDir,
    place: PathBuf,
    manifest: Manifest,
    /// Each with its content.
    files: Vec<(String, Vec<u8>)>,
}

static TINY: LazyLock<Tiny> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let place = folder.path().join("pack");
    let manifest = tiny_pack::write(&place);
    let content = |path: String| {
        let content = fs::read(place.join(&path)).expect("a file of the pack");
        (path, content)
    };
    let files = tiny_pack::files(&manifest).into_iter().map(content).collect();
    Tiny { _folder: folder, place, manifest, files }
});

fuzz_target!(|bytes: &[u8]| {
    let Some((&index, content)) = bytes.split_first() else { return };
    let (path, old) = &TINY.files[usize::from(index) % TINY.files.len()];
    tiny_pack::replace(&TINY.place, &TINY.manifest, path, content);
    if let Err(error) = verify(&TINY.place) {
        assert!(!error.to_string().is_empty());
    }
    fs::write(TINY.place.join(path), old).expect("room for temporary files");
});
