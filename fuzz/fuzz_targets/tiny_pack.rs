//! A pack with tables of a few texels, one file of which can be replaced.

use std::fs;
use std::path::Path;

use sha2::{Digest, Sha256};
use welkin_lut::bake::{Air, BakeSettings, Baked, ScatteringSize, SourceGrid};
use welkin_lut::pack::{Description, FileFormat, Manifest, PackOptions, Precision, write_pack};
use welkin_lut::{Constituent, DensityProfile, Medium, PhaseFunction, Planet};

const TINY: BakeSettings = BakeSettings {
    nodes_per_leg: 2,
    optical_depth_size: [2, 2],
    source_size: [2, 2],
    source_grid: SourceGrid { ground: 2, low: 2, high: 2, azimuths: 2 },
    orders: 3,
    scattering: ScatteringSize { azimuths: 2, suns: 2, elevations: 2, altitudes: 2 },
};

/// Stands for the manifest's own hash while it is taken.
const UNHASHED: &str = "0000000000000000000000000000000000000000000000000000000000000000";

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Writes the pack into a new folder.
pub fn write(folder: &Path) -> Manifest {
    let molecules = Constituent {
        name: "molecules".to_owned(),
        scattering_per_m: [5.802e-6, 13.558e-6, 33.1e-6],
        absorption_per_m: [0.0; 3],
        emission_per_m: [0.0; 3],
        profile: DensityProfile::Exponential { scale_height_m: 8000.0 },
        phase: PhaseFunction::Rayleigh,
    };
    let planet = Planet { radius_m: 6_360_000.0, atmosphere_height_m: 100_000.0, ground_albedo: [0.3; 3] };
    let air = Air::new(&planet, &Medium { constituents: vec![molecules] }).expect("this air can be baked");
    let baked = Baked::new(&air, TINY, &|_| {});
    let description = Description {
        scene: "tiny".to_owned(),
        generator: "fuzz".to_owned(),
        backend: "cpu".to_owned(),
        scatterers: vec!["molecules".to_owned()],
        wavelengths_nm: [680.0, 550.0, 440.0],
        sun: None,
        left_out: Vec::new(),
    };
    let options = PackOptions { formats: FileFormat::ALL.to_vec(), precisions: vec![Precision::F16] };
    write_pack(folder, &baked, &description, &options, &[]).expect("room for temporary files")
}

/// The files of the pack, the manifest last.
pub fn files(manifest: &Manifest) -> Vec<String> {
    manifest.all_files().map(|file| file.path.clone()).chain(["manifest.json".to_owned()]).collect()
}

/// Replaces one file, and what the manifest says of it, so that only its content can be what is wrong.
pub fn replace(folder: &Path, manifest: &Manifest, path: &str, content: &[u8]) {
    let text = if path == "manifest.json" {
        String::from_utf8_lossy(content).into_owned()
    } else {
        fs::write(folder.join(path), content).expect("room for temporary files");
        let mut manifest = manifest.clone();
        let of_tables = manifest.tables.iter_mut().flat_map(|table| table.files.iter_mut().map(|file| &mut file.file));
        let mut all = of_tables.chain(&mut manifest.files);
        let entry = all.find(|file| file.path == path).expect("a file of the pack");
        (entry.bytes, entry.sha256) = (content.len() as u64, sha256(content));
        serde_json::to_string(&manifest).expect("names and finite numbers are always JSON")
    };
    fs::write(folder.join("manifest.json"), signed(&text)).expect("room for temporary files");
}

/// The text of a manifest with the hash that it has.
fn signed(text: &str) -> String {
    let value: serde_json::Value = serde_json::from_str(text).unwrap_or_default();
    let Some(old) = value["content_sha256"].as_str().filter(|old| !old.is_empty()) else { return text.to_owned() };
    let unsigned = text.replacen(old, UNHASHED, 1);
    let hash = sha256(unsigned.as_bytes());
    unsigned.replacen(UNHASHED, &hash, 1)
}
