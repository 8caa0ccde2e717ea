//! Makes anew what the fuzzers begin with: each file of the tiny pack as an input of the target `pack`, and the words of
//! scene files as a dictionary. `cargo run --release --example seeds`, within `fuzz/`.

#[path = "../fuzz_targets/tiny_pack.rs"]
#[allow(dead_code)]
mod tiny_pack;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;

fn main() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    pack(&here.join("seeds/pack"));
    let mut words = BTreeSet::new();
    collect(&welkin::scene::schema(), &mut words);
    let lines: String = words.iter().map(|word| format!("\"{word}\"\n")).collect();
    fs::write(here.join("scene_file.dict"), lines).expect("the folder can be written");
}

fn pack(seeds: &Path) {
    fs::create_dir_all(seeds).expect("the folder can be written");
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let place = folder.path().join("pack");
    let manifest = tiny_pack::write(&place);
    for (index, path) in tiny_pack::files(&manifest).into_iter().enumerate() {
        let content = fs::read(place.join(&path)).expect("a file of the pack");
        fs::write(seeds.join(path), [&[index as u8][..], &content].concat()).expect("the folder can be written");
    }
}

/// Names of fields and of choices in a schema.
fn collect(schema: &Value, words: &mut BTreeSet<String>) {
    match schema {
        Value::Object(fields) => {
            words.extend(schema["properties"].as_object().into_iter().flatten().map(|(name, _)| name.clone()));
            words.extend(schema["const"].as_str().map(str::to_owned));
            let choices = schema["enum"].as_array().into_iter().flatten();
            words.extend(choices.filter_map(|choice| choice.as_str().map(str::to_owned)));
            fields.values().for_each(|part| collect(part, words));
        }
        Value::Array(parts) => parts.iter().for_each(|part| collect(part, words)),
        _ => {}
    }
}
