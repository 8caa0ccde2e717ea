//! The shader files that engines take: functions that read a pack's tables, and the passes that bake them.

use serde::Serialize;
use welkin_shaders::{BindingKind, Definitions, Dimension, Language, Shader, ShaderError, Sources};

use crate::passes::definitions;
use crate::plan::Facts;

/// A file for an engine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShaderFile {
    /// Its name, with an ending by language.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// The pass that names the functions for engines.
const FUNCTIONS: &str = "pack_functions";

/// Files with an entry point: their stem and their pass.
const ENTRY_POINTS: [(&str, &str); 5] = [
    ("sky_probe", "pack_probe"),
    ("bake_optical_depth", "optical_depth"),
    ("bake_first_source", "first_source"),
    ("bake_higher_source", "higher_source"),
    ("bake_scattering", "scattering_table"),
];

/// What `interface.json` says.
#[derive(Debug, Serialize)]
struct Interface {
    language: &'static str,
    /// Which numbers the entry points that bake are compiled for.
    specialised_for: String,
    entry_points: Vec<EntryPoint>,
}

#[derive(Debug, Serialize)]
struct EntryPoint {
    file: String,
    name: String,
    workgroup_size: [u32; 3],
    bindings: Vec<Resource>,
}

#[derive(Debug, Serialize)]
struct Resource {
    name: String,
    group: u32,
    binding: u32,
    kind: String,
    /// Of structs in uniform buffers: members and their places.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    members: Vec<Member>,
}

#[derive(Debug, Serialize)]
struct Member {
    name: String,
    offset_bytes: u32,
}

/// All files in one language: `sky.*`, functions to include; `sky_probe.*`, which answers probes with them;
/// `bake_*.*`, compute passes that make the tables, specialised for the constituents of a scene's air; and
/// `interface.json`, their entry points and bindings. SPIR-V has no functions to include. `bake_higher_source` is dispatched once
/// for each order; in the last dispatch, which closes the series, `order` is a smaller image than `sum`.
///
/// # Errors
/// [`ShaderError`] for what the language cannot say.
pub fn shader_files(language: Language, facts: &Facts) -> Result<Vec<ShaderFile>, ShaderError> {
    let sources = Sources::embedded();
    let definitions = definitions(facts);
    let mut files = Vec::new();
    if let Some(text) = language.export_functions(&sources, FUNCTIONS, &definitions)? {
        // Without a stage it is no file that a compiler would take by itself.
        let ending = if language == Language::Glsl { "glsl" } else { language.extension() };
        files.push(ShaderFile { name: format!("sky.{ending}"), bytes: text.into_bytes() });
    }
    let mut entry_points = Vec::new();
    for (stem, pass) in ENTRY_POINTS {
        let exported = language.export(&sources, pass, &definitions)?;
        let name = format!("{stem}.{}", language.extension());
        entry_points.push(entry_point(&name, exported.entry_point, pass, &definitions)?);
        files.push(ShaderFile { name, bytes: exported.bytes });
    }
    let constituents: Vec<_> = facts.constituents.iter().map(|c| c.name.as_str()).collect();
    let interface = Interface {
        language: language.name(),
        specialised_for: format!(
            "air of {}; {} nodes on each leg of a ray, the source function in {} directions",
            constituents.join(", "),
            facts.settings.nodes_per_leg,
            facts.source_grid().count()
        ),
        entry_points,
    };
    let text = serde_json::to_string_pretty(&interface).expect("names and numbers are always JSON");
    files.push(ShaderFile { name: "interface.json".to_owned(), bytes: format!("{text}\n").into_bytes() });
    Ok(files)
}

fn entry_point(file: &str, name: String, pass: &str, definitions: &Definitions) -> Result<EntryPoint, ShaderError> {
    let shader = Shader::from_sources(&Sources::embedded(), pass, definitions)?;
    let bindings = shader.bindings.iter().map(|binding| Resource {
        name: binding.name.clone(),
        group: binding.group,
        binding: binding.index,
        kind: describe(&binding.kind),
        members: members(&shader, &binding.name),
    });
    Ok(EntryPoint { file: file.to_owned(), name, workgroup_size: shader.workgroup_size, bindings: bindings.collect() })
}

/// The members of a uniform block: its struct is called as the variable is, but for these.
fn members(shader: &Shader, variable: &str) -> Vec<Member> {
    let name = match variable {
        "sky" => "SkyParameters",
        "atmosphere" => "Atmosphere",
        "scattering_layout" => "ScatteringLayout",
        _ => return Vec::new(),
    };
    let fields = shader.struct_layout(name).map(|layout| layout.fields.as_slice()).unwrap_or_default();
    let named = fields.iter().filter(|field| !field.name.starts_with("padding"));
    named.map(|field| Member { name: field.name.clone(), offset_bytes: field.offset }).collect()
}

fn describe(kind: &BindingKind) -> String {
    let shape = |dimension: &Dimension| match dimension {
        Dimension::D1 => "1d",
        Dimension::D2 => "2d",
        Dimension::D2Array => "2d array",
        Dimension::D3 => "3d",
    };
    match kind {
        BindingKind::UniformBuffer { size } => format!("uniform buffer, {size} bytes"),
        BindingKind::StorageBuffer { writable: true, .. } => "storage buffer, written".to_owned(),
        BindingKind::StorageBuffer { .. } => "storage buffer, read".to_owned(),
        BindingKind::SampledTexture { dimension } => format!("{} texture", shape(dimension)),
        BindingKind::CombinedTexture { dimension } => format!("{} texture with its sampler", shape(dimension)),
        BindingKind::StorageTexture { format, dimension, .. } => {
            format!("{} storage texture, {format:?}", shape(dimension))
        }
        BindingKind::Sampler => "sampler".to_owned(),
    }
}
