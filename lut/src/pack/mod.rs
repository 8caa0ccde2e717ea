//! A pack: a folder of tables in the formats of engines, with what one must know to read them, and probes by which an
//! importer tests itself.
//!
//! [`write_pack`] writes one whole or not at all; [`Pack::read`] reads one and refuses whatever is not as it was written;
//! [`verify`] also compares all formats with each other and with the probes.

mod error;
mod folder;
mod format;
mod manifest;
mod measure;
mod probes;
mod read;
mod sky_block;
mod texels;
mod wording;
mod write;

pub use error::PackError;
pub use format::{FileFormat, UnknownFormat};
pub use manifest::{
    Axis, Conventions, FileEntry, Lobe, Manifest, MeasuredError, Method, PACK_FORMAT, PACK_VERSION, Scatterer,
    SkyParameters, Sun, TableEntry, TableFile,
};
pub use probes::{ProbeAnswer, ProbeAnswers, ProbeInput, Probes, probe_inputs};
pub use read::{Pack, Verified, verify};
pub use texels::{Precision, UnknownPrecision};
pub use write::{Description, ExtraFile, PackOptions, write_pack};

use sha2::{Digest, Sha256};

/// SHA-256 in hexadecimal.
fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The JSON schema of `manifest.json`.
pub fn manifest_schema() -> serde_json::Value {
    schemars::schema_for!(Manifest).into()
}

/// The JSON schema of `probes.json`.
pub fn probes_schema() -> serde_json::Value {
    schemars::schema_for!(Probes).into()
}
