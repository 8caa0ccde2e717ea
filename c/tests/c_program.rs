//! The C program of `examples/`, compiled by cc against the header and run with the library; and the header against it.

use std::collections::BTreeSet;
use std::fs;
use std::mem::{offset_of, size_of};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use welkin_c::{WelkinBakeOptions, WelkinRay, WelkinSky, WelkinTexels, WelkinVerified};
use welkin_lut::pack::{Pack, Precision};

fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Where cargo has put the libraries: beside this program.
fn libraries() -> PathBuf {
    std::env::current_exe().unwrap().parent().unwrap().to_owned()
}

/// The newest library of an ending; builds with other settings leave theirs there as well.
fn library(ending: &str) -> PathBuf {
    let files = fs::read_dir(libraries()).unwrap().map(|entry| entry.unwrap().path());
    let ours = files.filter(|path| {
        let name = path.file_name().unwrap().to_string_lossy();
        name.starts_with("libwelkin_c") && name.ends_with(ending)
    });
    ours.max_by_key(|path| fs::metadata(path).unwrap().modified().unwrap()).expect("cargo builds it with this test")
}

fn succeeded(output: Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{}{}", text(&output.stdout), text(&output.stderr));
    text(&output.stdout)
}

#[test]
fn the_c_program_bakes_verifies_reads_and_samples_a_pack() {
    let folder = tempfile::tempdir().unwrap();
    let [program, archive, pack] = ["program", "welkin.a", "pack"].map(|name| folder.path().join(name));
    let compile = |arguments: &[&Path]| {
        let strict = ["-std=c11", "-Wall", "-Wextra", "-Werror", "-pedantic", "-I"];
        let mut cc = Command::new("cc");
        cc.args(strict)
            .arg(here().join("include"))
            .arg(here().join("examples/bake_and_read.c"))
            .arg("-o")
            .arg(&program);
        succeeded(cc.args(arguments).arg("-lm").output().expect("cc, which scripts/setup.sh installs"));
    };
    let run = || {
        let mut command = Command::new(&program);
        let output = command.arg(here().join("../scenes/noon.toml")).arg(&pack).current_dir(folder.path()).output();
        succeeded(output.unwrap())
    };
    // The static library first: it needs the system's libraries alone.
    fs::copy(library(".a"), &archive).unwrap();
    // Its metrics of pictures are in C++.
    compile(&[&archive, Path::new("-lpthread"), Path::new("-ldl"), Path::new("-lstdc++")]);
    let said = run();
    // The library's answers are those of the crate, and the file's those of the table.
    let tables = Pack::read(&pack).unwrap().tables(Precision::F16, None).unwrap();
    let [r, g, b] = tables.sky_radiance(2.0, [0.5, 1.0, 0.5]);
    let found: Vec<f64> = said.split_whitespace().take(3).map(|number| number.parse().unwrap()).collect();
    assert_eq!(found, [r, g, b], "{said}");
    assert!(said.contains("200 x 24 x "), "{said}");
    // The shared library, found where it lies.
    let shared = library(".so");
    let path = format!("-Wl,-rpath,{}", shared.parent().unwrap().display());
    compile(&[&shared, Path::new(&path)]);
    assert_eq!(run(), said, "both libraries say the same");
}

/// The names of functions that a text mentions.
fn functions(text: &str) -> BTreeSet<String> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = BTreeSet::new();
    for (at, _) in text.match_indices("welkin_") {
        let name: String = text[at..].chars().take_while(|&c| is_word(c)).collect();
        let starts = !text[..at].ends_with(is_word);
        if starts && text[at + name.len()..].starts_with('(') {
            found.insert(name);
        }
    }
    found
}

#[test]
fn the_header_declares_what_the_library_has_and_the_program_uses_all_of_it() {
    let read = |path: &str| fs::read_to_string(here().join(path)).unwrap();
    let header = functions(&read("include/welkin.h"));
    assert_eq!(header, functions(&read("examples/bake_and_read.c")));
    let symbols = succeeded(Command::new("nm").args(["-D", "--defined-only"]).arg(library(".so")).output().unwrap());
    let symbols: BTreeSet<String> =
        symbols.split_whitespace().filter(|word| word.starts_with("welkin_")).map(str::to_owned).collect();
    assert_eq!(header, symbols, "and the library has no other");
}

#[test]
fn structs_are_laid_out_as_the_header_says() {
    // The same numbers stand in the program, where the C compiler checks them.
    let sizes = [size_of::<WelkinVerified>(), size_of::<WelkinRay>(), size_of::<WelkinSky>()];
    assert_eq!(sizes, [24, 32, 144]);
    assert_eq!(size_of::<WelkinBakeOptions>(), 16 + 2 * size_of::<usize>());
    assert_eq!(offset_of!(WelkinBakeOptions, progress), 16);
    assert_eq!(size_of::<WelkinTexels>(), size_of::<usize>() + 16);
    assert_eq!(offset_of!(WelkinTexels, depth), size_of::<usize>() + 8);
    assert_eq!(offset_of!(WelkinSky, ground_radiance), 120);
}
