//! `welkin schema`: the JSON schemas of scene files and of packs.

use clap::{Args, ValueEnum};

use super::{Failure, stdout};

/// What has a schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Document {
    /// A scene file
    Scene,
    /// A pack's manifest.json
    Pack,
    /// A pack's probes.json
    Probes,
}

/// Print the JSON schema of scene files, or of a pack's files, for editors and importers
#[derive(Debug, Args)]
pub struct Arguments {
    /// What to describe
    #[arg(value_enum, default_value = "scene")]
    document: Document,
}

/// Prints the schema.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let schema = match arguments.document {
        Document::Scene => welkin::scene::schema(),
        Document::Pack => welkin_lut::pack::manifest_schema(),
        Document::Probes => welkin_lut::pack::probes_schema(),
    };
    Ok(stdout::print(&format!("{schema:#}"))?)
}
