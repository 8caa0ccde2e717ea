//! Dependencies point one way: what is below never knows what is above. What each part may use is written down here,
//! so that a new dependency is a decision and not an accident.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The modules of `src/`, lowest first, and the other modules that each may use.
const MAY_USE: [(&str, &[&str]); 16] = [
    ("scene", &[]),
    ("foreground", &["scene"]),
    ("frame", &[]),
    ("probe", &[]),
    ("gpu", &[]),
    ("output", &["frame", "scene"]),
    ("plan", &["probe", "scene"]),
    ("goal", &["plan"]),
    ("reference", &["frame", "output", "probe", "scene"]),
    ("report", &["frame", "goal", "output", "plan", "probe", "reference", "scene"]),
    ("passes", &["foreground", "gpu", "output", "plan", "probe", "scene"]),
    ("shader_export", &["passes", "plan"]),
    ("renderer", &["foreground", "frame", "gpu", "passes", "plan", "probe", "scene"]),
    ("window", &["frame", "goal", "gpu", "output", "passes", "plan", "reference", "renderer", "scene"]),
    ("bench", &["gpu", "passes", "plan", "probe", "reference", "renderer", "scene"]),
    ("bake", &["passes", "plan", "probe", "renderer", "scene", "shader_export"]),
];

/// Words of code that only these modules may say: crates, and what the compiler cannot check.
const ONLY_IN: [(&str, &[&str]); 11] = [
    ("ash", &["gpu"]),
    ("ash_window", &["gpu"]),
    ("raw_window_handle", &["gpu"]),
    ("egui", &["window"]),
    ("egui_ash_renderer", &["window"]),
    ("egui_winit", &["window"]),
    ("winit", &["window"]),
    ("gpu_allocator", &["gpu"]),
    ("unsafe", &["gpu"]),
    ("welkin_shaders", &["bake", "gpu", "passes", "shader_export"]),
    ("clap", &["cli"]),
];

/// The solution, as far as the tables' crate holds it: the reference must find its own.
const SOLUTION: [&str; 6] = ["bake", "geometry", "mapping", "pack", "quadrature", "sky_tables"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Code without its line comments; the project has no others.
fn without_comments(source: &str) -> String {
    source.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// The words of code, in order.
fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c| !is_word(c)).filter(|word| !word.is_empty())
}

/// The names that code takes from a crate, as `CRATE::NAME` or within `CRATE::{NAME, NAME::{..}}`.
fn names_from(package: &str, code: &str) -> BTreeSet<String> {
    code.split(&format!("{package}::")).skip(1).flat_map(names_at).collect()
}

fn names_at(path: &str) -> Vec<String> {
    let leading_word = |text: &str| text.trim_start().chars().take_while(|&c| is_word(c)).collect::<String>();
    let Some(list) = path.strip_prefix('{') else { return vec![leading_word(path)] };
    let (mut depth, mut names) = (0, vec![leading_word(list)]);
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => names.push(leading_word(&list[at + 1..])),
            _ => {}
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

/// Every Rust file below a folder.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            files.push(path);
        }
    }
    files
}

/// The code of each module of `src/`, file by file: `src/gpu.rs` and all of `src/gpu/` are `gpu`.
fn code_by_module() -> BTreeMap<String, Vec<(PathBuf, String)>> {
    let mut modules: BTreeMap<String, Vec<_>> = BTreeMap::new();
    for path in rust_files(&root().join("src")) {
        let inside = path.strip_prefix(root().join("src")).unwrap();
        let module = inside.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs");
        let code = without_comments(&fs::read_to_string(&path).unwrap());
        modules.entry(module.to_owned()).or_default().push((path, code));
    }
    modules
}

/// What code of a module names although it may not.
fn forbidden(module: &str, code: &str) -> Vec<String> {
    let may_use = MAY_USE.iter().find(|(name, _)| *name == module).map_or(&[][..], |(_, others)| others);
    let allowed = |name: &str| name == module || may_use.contains(&name);
    let modules = names_from("crate", code).into_iter().filter(|name| !allowed(name));
    let kept = ONLY_IN.iter().filter(|(word, homes)| !homes.contains(&module) && words(code).any(|w| w == *word));
    modules.chain(kept.map(|(word, _)| (*word).to_owned())).collect()
}

#[test]
fn every_module_uses_only_what_lies_below_it() {
    let modules = code_by_module();
    for (module, files) in modules.iter().filter(|(name, _)| !["lib", "main", "cli"].contains(&name.as_str())) {
        assert!(
            MAY_USE.iter().any(|(name, _)| name == module),
            "say in MAY_USE what the new module '{module}' may use"
        );
        for (path, code) in files {
            assert_eq!(forbidden(module, code), Vec::<String>::new(), "{}", path.display());
        }
    }
    // A module that the scan did not see would pass unseen.
    assert!(MAY_USE.iter().all(|(name, _)| modules.contains_key(*name)), "found only {:?}", modules.keys());
}

#[test]
fn what_a_module_may_use_is_below_it() {
    // Each names only earlier ones, so there is no way round; and neither the truth nor its metrics reach the device.
    for (index, (module, may_use)) in MAY_USE.iter().enumerate() {
        let below: Vec<_> = MAY_USE[..index].iter().map(|(name, _)| name).collect();
        assert!(may_use.iter().all(|name| below.contains(&name)), "{module} uses what does not lie below it");
    }
    for module in ["reference", "report", "plan", "output", "scene"] {
        assert!(!reached_from(module).contains("gpu"), "{module} reaches gpu");
    }
    assert!(reached_from("renderer").contains("scene"));
}

/// What code takes of the solution.
fn of_the_solution(code: &str) -> Vec<String> {
    names_from("welkin_lut", code).into_iter().filter(|name| SOLUTION.contains(&name.as_str())).collect()
}

#[test]
fn the_reference_shares_the_problem_and_nothing_of_the_solution() {
    for (path, code) in &code_by_module()["reference"] {
        assert_eq!(of_the_solution(code), Vec::<String>::new(), "{}", path.display());
    }
    assert_eq!(of_the_solution("use welkin_lut::{Bands, mapping::SkyHalf};"), ["mapping"]);
    let names = fs::read_to_string(root().join("lut/src/lib.rs")).unwrap();
    assert!(SOLUTION.iter().all(|name| names.contains(&format!("pub mod {name};"))), "a module has another name now");
}

/// A module and all that it uses, directly or through others.
fn reached_from(module: &str) -> BTreeSet<&'static str> {
    let (name, may_use) = MAY_USE.iter().find(|(name, _)| *name == module).unwrap();
    may_use.iter().flat_map(|other| reached_from(other)).chain([*name]).collect()
}

#[test]
fn the_scan_notices_what_is_forbidden() {
    let gpu = "use crate::scene::{Light, Scene};\n";
    assert_eq!(forbidden("gpu", gpu), ["scene"]);
    let reference = "use std::fmt;\nuse crate::{\n    frame::Frame,\n    gpu::{Gpu, GpuImage},\n    scene,\n};\n";
    assert_eq!(forbidden("reference", reference), ["gpu"]);
    assert_eq!(forbidden("report", "fn f(r: &crate::renderer::Renderer) {}"), ["renderer"]);
    assert_eq!(forbidden("plan", "let x = ash::vk::Format::UNDEFINED;"), ["ash"]);
    assert_eq!(forbidden("scene", "unsafe { *pointer }"), ["unsafe"]);
    // What belongs, what is only written about, and words that merely begin alike.
    let fine = "use crate::plan::Facts; // as crate::renderer does\nlet (ashen, clapped) = (crate::gpu::X, 1);";
    assert_eq!(forbidden("passes", &without_comments(fine)), Vec::<String>::new());
}

/// Names of the packages that one of the workspace's packages is built with.
fn packages_of(package: &str, more: &[&str]) -> BTreeSet<String> {
    let arguments = ["tree", "--package", package, "--edges", "normal", "--prefix", "none", "--offline", "--locked"];
    let arguments = [&arguments, more].concat();
    let output = Command::new(env!("CARGO")).current_dir(root()).args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect()
}

#[test]
fn the_crates_for_engines_bring_neither_vulkan_nor_a_command_line() {
    let unwanted = ["ash", "gpu-allocator", "clap", "winit", "egui", "welkin"];
    let among = |packages: &BTreeSet<String>| unwanted.into_iter().filter(|name| packages.contains(*name)).count();
    let lut = packages_of("welkin-lut", &[]);
    assert!(lut.contains("welkin-lut") && among(&lut) == 0, "{lut:?}");
    assert!(!lut.contains("welkin-shaders") && !lut.contains("naga"), "{lut:?}");
    let shaders = packages_of("welkin-shaders", &[]);
    assert!(shaders.contains("naga") && among(&shaders) == 0, "{shaders:?}");
    assert!(!shaders.contains("welkin-lut"), "{shaders:?}");
    // The program itself has what those must not have.
    let program = packages_of("welkin", &[]);
    assert!(["ash", "clap", "welkin-lut"].iter().all(|name| program.contains(*name)), "{program:?}");
}

#[test]
fn a_build_without_the_window_brings_no_library_of_windows() {
    let of_windows = ["winit", "egui", "egui-winit", "egui-ash-renderer", "ash-window", "arboard"];
    let among = |packages: &BTreeSet<String>| of_windows.into_iter().filter(|name| packages.contains(*name)).count();
    let without = packages_of("welkin", &["--no-default-features"]);
    assert!(without.contains("ash") && among(&without) == 0, "{without:?}");
    assert_eq!(among(&packages_of("welkin", &[])), of_windows.len(), "the control: the window needs them");
}
