//! Packs on disk: whole or not there, as they were written or refused.

mod small_air;

use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use small_air::{SMALL, description, earth};
use welkin_lut::bake::{Air, Baked};
use welkin_lut::pack::{
    ExtraFile, FileFormat, Manifest, Pack, PackError, PackOptions, Precision, manifest_schema, probes_schema, verify,
    write_pack,
};

fn all_formats() -> PackOptions {
    PackOptions { formats: FileFormat::ALL.to_vec(), precisions: Precision::ALL.to_vec() }
}

fn write(folder: &Path, air: &Air, options: &PackOptions) -> Manifest {
    let baked = Baked::new(air, SMALL, &|_| {});
    let shader = ExtraFile { path: "shaders/glsl/sky.glsl".to_owned(), bytes: b"// a shader\n".to_vec() };
    write_pack(folder, &baked, &description(&baked), options, &[shader]).unwrap()
}

/// A pack in all formats, in a folder that goes with it.
fn pack() -> (tempfile::TempDir, PathBuf, Manifest) {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("pack");
    let manifest = write(&place, &earth(), &all_formats());
    (folder, place, manifest)
}

/// Verifies after a change of one file, which is undone afterwards.
fn with_changed(path: &Path, change: impl FnOnce(&mut Vec<u8>), place: &Path) -> PackError {
    let content = fs::read(path).unwrap();
    let mut changed = content.clone();
    change(&mut changed);
    fs::write(path, &changed).unwrap();
    let refused = verify(place).expect_err("a change must be noticed");
    fs::write(path, &content).unwrap();
    refused
}

#[test]
fn a_pack_in_every_format_comes_back_as_it_was_written_and_answers_its_probes() {
    let (folder, place, manifest) = pack();
    let verified = verify(&place).unwrap();
    // 4 tables in 4 containers and 2 precisions; probes, parameters, a shader and the manifest itself.
    assert_eq!((verified.table_files, verified.files), (32, 36));
    assert!(verified.probes > 6 * 8 * 50, "{}", verified.probes);
    let read = Pack::read(&place).unwrap();
    assert!(*read.manifest() == manifest);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing lies beside the pack");
    // Half floats are what f32 rounds to, and no more.
    let (half, single) = (read.tables(Precision::F16, None).unwrap(), read.tables(Precision::F32, None).unwrap());
    assert!(half != single && half.set().scattering == Precision::F16.of_table(&single.set().scattering));
    // The uniform block as shaders lay it out: albedo, radius, the sun's warp, top, counts.
    let block = fs::read(place.join("sky_parameters.bin")).unwrap();
    let number = |at: usize| f32::from_le_bytes(block[4 * at..4 * at + 4].try_into().unwrap());
    assert_eq!((block.len(), number(3), number(7)), (48 + 8 * 2 * 32, 6_360_000.0, 100_000.0));
    assert_eq!(u32::from_le_bytes(block[32..36].try_into().unwrap()), 2, "scatterers");
}

#[test]
fn one_changed_byte_anywhere_is_refused_by_name() {
    let (_folder, place, manifest) = pack();
    for file in manifest.all_files() {
        let path = place.join(&file.path);
        for at in [0, file.bytes / 2, file.bytes - 1] {
            let refused = with_changed(&path, |bytes| bytes[at as usize] ^= 1, &place);
            assert!(matches!(&refused, PackError::Changed { path: named, .. } if *named == path), "{refused}");
        }
    }
    let path = place.join("manifest.json");
    let length = fs::read(&path).unwrap().len();
    for at in (0..length).step_by(97) {
        with_changed(&path, |bytes| bytes[at] ^= 1, &place);
    }
    // White space that no parser sees is content all the same.
    let refused = with_changed(&path, |bytes| bytes.push(b'\n'), &place);
    assert!(matches!(refused, PackError::Changed { .. }), "{refused}");
    verify(&place).unwrap();
}

#[test]
fn what_is_missing_cut_short_of_another_version_or_a_stranger_is_said() {
    let (_folder, place, _) = pack();
    let table = place.join("scattering.f16.ktx2");
    let refused = with_changed(&table, |bytes| bytes.truncate(1000), &place);
    assert!(matches!(&refused, PackError::Size { found: 1000, .. }), "{refused}");
    let version = |bytes: &mut Vec<u8>| {
        let text = String::from_utf8(bytes.clone()).unwrap();
        *bytes = text.replacen("\"version\": 3", "\"version\": 4", 1).into_bytes();
    };
    let refused = with_changed(&place.join("manifest.json"), version, &place);
    assert!(matches!(refused, PackError::Version { found: 4, known: 3, .. }), "{refused}");
    let outside = |bytes: &mut Vec<u8>| {
        let text = String::from_utf8(bytes.clone()).unwrap();
        *bytes = text.replacen("irradiance.f16.ktx2", "../irradiance.ktx2!", 1).into_bytes();
    };
    let refused = with_changed(&place.join("manifest.json"), outside, &place);
    assert!(refused.to_string().contains("leads out of the pack"), "{refused}");
    let refused = with_changed(&place.join("manifest.json"), |bytes| bytes.truncate(500), &place);
    assert!(matches!(refused, PackError::Manifest { .. }), "{refused}");
    fs::write(place.join("extra.txt"), "?").unwrap();
    assert!(matches!(verify(&place), Err(PackError::Unlisted { .. })));
    fs::remove_file(place.join("extra.txt")).unwrap();
    fs::remove_file(&table).unwrap();
    let refused = verify(&place).unwrap_err();
    assert!(matches!(&refused, PackError::Missing { path } if *path == table), "{refused}");
    fs::remove_file(place.join("manifest.json")).unwrap();
    assert!(matches!(verify(&place), Err(PackError::NoPack { .. })));
}

/// Signs a manifest anew, as who changes it on purpose can.
fn sign(manifest: &Manifest, place: &Path) {
    let unsigned = "0".repeat(64);
    let text = serde_json::to_string(&Manifest { content_sha256: unsigned.clone(), ..manifest.clone() }).unwrap();
    let hash: String = Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
    fs::write(place.join("manifest.json"), text.replacen(&unsigned, &hash, 1)).unwrap();
}

#[test]
fn sizes_that_no_file_can_have_are_refused_before_there_is_memory_for_them() {
    let (_folder, place, manifest) = pack();
    for size in [[0, 4, 1], [4, 1, 0], [65536, 65536, 1], [16384, 16384, 16384], [u32::MAX; 3]] {
        let mut lying = manifest.clone();
        lying.tables[0].size = size;
        sign(&lying, &place);
        let pack = Pack::read(&place).unwrap();
        for format in FileFormat::ALL {
            let refused = pack.tables(Precision::F16, Some(format)).unwrap_err();
            assert!(matches!(refused, PackError::Manifest { .. } | PackError::Decode { .. }), "{size:?}: {refused}");
        }
    }
    let mut lying = manifest.clone();
    lying.sky_parameters.azimuth_count = 1 << 16;
    lying.sky_parameters.sun_count = 1 << 16;
    sign(&lying, &place);
    let refused = Pack::read(&place).unwrap().tables(Precision::F16, None).unwrap_err();
    assert!(matches!(refused, PackError::Manifest { .. }), "{refused}");
    // Control: signed again without a lie it is read.
    sign(&manifest, &place);
    Pack::read(&place).unwrap().tables(Precision::F16, None).unwrap();
}

#[test]
fn a_new_pack_takes_the_place_of_an_old_one_and_of_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("deeper/pack");
    let first = write(&place, &earth(), &PackOptions::default());
    let options = PackOptions { formats: vec![FileFormat::Raw], precisions: vec![Precision::F32] };
    let second = write(&place, &earth(), &options);
    assert!(first != second && *Pack::read(&place).unwrap().manifest() == second);
    assert!(!place.join("scattering.f16.ktx2").exists(), "nothing of the old pack is left");
    // The same air gives the same bytes.
    assert!(write(&place, &earth(), &options) == second);
    let home = folder.path().join("home");
    fs::create_dir(&home).unwrap();
    fs::write(home.join("thesis.txt"), "years of work").unwrap();
    let baked_air = earth();
    let baked = Baked::new(&baked_air, SMALL, &|_| {});
    let refused = write_pack(&home, &baked, &description(&baked), &options, &[]).unwrap_err();
    assert!(matches!(refused, PackError::Occupied { .. }), "{refused}");
    assert_eq!(fs::read_to_string(home.join("thesis.txt")).unwrap(), "years of work");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "nothing half-written is left behind");
}

#[test]
fn the_manifest_says_how_far_each_table_is_from_evaluation_between_its_texels() {
    let (_folder, _, manifest) = pack();
    for table in &manifest.tables {
        for precision in Precision::ALL {
            let of_precision: Vec<_> = table.files.iter().filter(|file| file.precision == precision).collect();
            assert!(of_precision.iter().all(|file| file.errors == of_precision[0].errors), "the texels are the same");
            for error in &of_precision[0].errors {
                assert!(error.samples > 20 && error.maximum > 0.0, "{} {error:?}", table.name);
                assert!(error.median <= error.p99 && error.p99 <= error.maximum);
            }
        }
    }
    // Larger tables are nearer.
    let air = earth();
    let finer = welkin_lut::bake::BakeSettings { optical_depth_size: [160, 64], ..SMALL };
    let folder = tempfile::tempdir().unwrap();
    let baked = Baked::new(&air, finer, &|_| {});
    let options = PackOptions { formats: vec![FileFormat::Raw], precisions: vec![Precision::F32] };
    let fine = write_pack(&folder.path().join("pack"), &baked, &description(&baked), &options, &[]).unwrap();
    let median = |manifest: &Manifest| manifest.tables[0].files.last().unwrap().errors[0].median;
    // Four times the texels along each axis of a linear filter: a sixteenth of the error.
    let gain = median(&manifest) / median(&fine);
    assert!(gain > 8.0 && gain < 40.0, "{gain}");
}

#[test]
fn schemas_name_what_the_files_have() {
    let properties = |schema: &serde_json::Value| {
        let mut names: Vec<_> = schema["properties"].as_object().unwrap().keys().cloned().collect();
        names.sort();
        names
    };
    let (_folder, place, _) = pack();
    for (file, schema) in [("manifest.json", manifest_schema()), ("probes.json", probes_schema())] {
        let value: serde_json::Value = serde_json::from_slice(&fs::read(place.join(file)).unwrap()).unwrap();
        let mut keys: Vec<_> = value.as_object().unwrap().keys().cloned().collect();
        keys.sort();
        assert_eq!(keys, properties(&schema), "{file}");
    }
}
