//! The shader code for engines, compiled by another compiler and run on a device, against the host's sampler.

mod common;
#[path = "../lut/tests/small_air/mod.rs"]
mod small_air;

use std::process::Command;

use small_air::{SMALL, description, earth};
use welkin::gpu::{AddressMode, Filter, Gpu, ImageFormat, ImageShape, Resource, Work};
use welkin_lut::Table;
use welkin_lut::bake::Baked;
use welkin_lut::pack::{FileFormat, Pack, PackOptions, Precision, ProbeAnswer, ProbeInput, write_pack};
use welkin_lut::sky_tables::SkyTables;
use welkin_shaders::{Binding, BindingKind, Definitions, Language, Shader, Sources};

/// WGSL `ProbeAnswer`: six vectors of four.
type Answer = [[f32; 4]; 6];

/// How a shader came to the device.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    /// naga's SPIR-V of the WGSL.
    Naga,
    /// glslc's, of the exported text.
    Glslc(Language),
}

const WAYS: [Way; 3] = [Way::Naga, Way::Glslc(Language::Glsl), Way::Glslc(Language::Hlsl)];

fn glslc(language: Language) -> Vec<u32> {
    let folder = tempfile::tempdir().unwrap();
    let exported = language.export(&Sources::embedded(), "pack_probe", &Definitions::new()).unwrap();
    let (text, binary) = (folder.path().join("probe"), folder.path().join("probe.spv"));
    std::fs::write(&text, exported.bytes).unwrap();
    let mut command = Command::new("glslc");
    command.args(match language {
        Language::Hlsl => ["-x", "hlsl", "-fentry-point=main", "--target-env=vulkan1.1"].as_slice(),
        _ => &["-x", "glsl", "--target-env=vulkan1.1"],
    });
    let output = command.args(["-O", "-fshader-stage=compute", "-o"]).arg(&binary).arg(&text).output();
    let output = output.expect("glslc, which scripts/setup.sh installs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let bytes = std::fs::read(binary).unwrap();
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect()
}

/// GLSL joins a texture with its sampler.
fn combined(bindings: &[Binding]) -> Vec<Binding> {
    let separate = bindings.iter().filter(|binding| binding.kind != BindingKind::Sampler);
    let join = |binding: &Binding| match binding.kind {
        BindingKind::SampledTexture { dimension } => {
            Binding { kind: BindingKind::CombinedTexture { dimension }, ..binding.clone() }
        }
        _ => binding.clone(),
    };
    separate.map(join).collect()
}

/// The answers of a device to all probes.
fn answers(gpu: &Gpu, way: Way, tables: &SkyTables, block: &[u8], inputs: &[ProbeInput]) -> Vec<Answer> {
    let native = welkin_shaders::compile("pack_probe", &Definitions::new()).unwrap();
    let pipeline = match way {
        Way::Naga => gpu.pipeline(&native),
        Way::Glslc(language) => {
            let glsl = language == Language::Glsl;
            let bindings = if glsl { combined(&native.bindings) } else { native.bindings.clone() };
            let foreign = Shader::foreign("sky_probe", glslc(language), native.workgroup_size, bindings);
            assert!(gpu.pipeline(&foreign).is_err(), "a host has to answer for it");
            // SAFETY: glslc has compiled what naga has translated from the very pass whose bindings these are.
            unsafe { gpu.foreign_pipeline(&foreign) }
        }
    };
    let pipeline = pipeline.unwrap();
    let image = |name: &str, table: &Table| {
        let [width, height, depth] = table.size();
        let shape = if depth > 1 { ImageShape::D3(width, height, depth) } else { ImageShape::D2(width, height) };
        let image = gpu.image(name, shape, ImageFormat::Rgba32Float).unwrap();
        let texels: Vec<[f32; 4]> =
            table.texels().iter().map(|&[r, g, b]| [r as f32, g as f32, b as f32, 1.0]).collect();
        gpu.write_image(&image, &texels).unwrap();
        image
    };
    let set = tables.set();
    let images = [
        ("transmittance_table", image("transmittance", &set.transmittance)),
        ("irradiance_table", image("irradiance", &set.irradiance)),
        ("scattering_table", image("scattering", &set.scattering)),
    ];
    let rows: Vec<[f32; 4]> =
        inputs.iter().map(|i| [i.altitude_m, i.mu, i.mu_s, i.nu].map(|value| value as f32)).collect();
    // glslang takes the number of words for that of bytes when HLSL asks for the length of a buffer.
    let padding = if way == Way::Glslc(Language::Hlsl) { 4 } else { 1 };
    let rows: Vec<_> = rows.iter().cycle().take(padding * rows.len()).copied().collect();
    let probes = gpu.storage_buffer_of("probes", &rows).unwrap();
    let results = gpu.storage_buffer("answers", (inputs.len() * size_of::<Answer>()) as u64).unwrap();
    let sampler = gpu.sampler(Filter::Linear, [AddressMode::Clamp; 3]).unwrap();
    let mut resources = vec![
        ("sky", Resource::Data(block)),
        ("probes", Resource::Buffer(&probes)),
        ("answers", Resource::Buffer(&results)),
    ];
    let glsl = way == Way::Glslc(Language::Glsl);
    for (name, image) in &images {
        resources.push((name, if glsl { Resource::Sampled(image, &sampler) } else { Resource::Image(image) }));
    }
    if !glsl {
        resources.push(("table_sampler", Resource::Sampler(&sampler)));
    }
    let mut commands = gpu.record("probes").unwrap();
    commands.dispatch(&pipeline, &resources, Work::Invocations([inputs.len() as u32, 1, 1])).unwrap();
    commands.submit_and_wait().unwrap();
    let numbers: Vec<[f32; 24]> = gpu.read_buffer(&results).unwrap();
    numbers.into_iter().map(|answer| std::array::from_fn(|i| std::array::from_fn(|k| answer[4 * i + k]))).collect()
}

fn as_answer([to_space, view, sky, sun, radiance, ground]: Answer) -> ProbeAnswer {
    let rgb = |[r, g, b, _]: [f32; 4]| [r, g, b].map(f64::from);
    ProbeAnswer {
        transmittance_to_space: rgb(to_space),
        view_transmittance: rgb(view),
        sky_irradiance: rgb(sky),
        sun_irradiance: rgb(sun),
        sky_radiance: rgb(radiance),
        ground_radiance: rgb(ground),
    }
}

#[test]
fn glsl_and_hlsl_answer_the_probes_of_a_pack_as_the_host_does() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("pack");
    let air = earth();
    let baked = Baked::new(&air, SMALL, &|_| {});
    let options = PackOptions { formats: vec![FileFormat::Ktx2], precisions: vec![Precision::F16] };
    write_pack(&place, &baked, &description(&baked), &options, &[]).unwrap();
    let pack = Pack::read(&place).unwrap();
    let (probes, tables) = (pack.probes().unwrap(), pack.tables(Precision::F16, None).unwrap());
    let block = std::fs::read(place.join("sky_parameters.bin")).unwrap();
    common::with_gpu(|gpu| {
        for way in WAYS {
            let found: Vec<_> = answers(gpu, way, &tables, &block, &probes.inputs).into_iter().map(as_answer).collect();
            let differs = |tolerance| probes.first_difference(&probes.answers[0], &found, tolerance);
            let step = |k: i32| 10_f64.powf(-f64::from(k) / 4.0);
            let nearest = (0..40).map(step).take_while(|&tolerance| differs(tolerance).is_none()).last();
            println!("{way:?}: within {:.1e} of the host's sampler", nearest.unwrap_or(1.0));
            assert_eq!(differs(probes.relative_tolerance), None, "{way:?}");
            // Negative control: a planet one part in a hundred larger.
            let mut larger = block.clone();
            larger[12..16].copy_from_slice(&(6_360_000.0_f32 * 1.01).to_le_bytes());
            let wrong =
                answers(gpu, way, &tables, &larger, &probes.inputs).into_iter().map(as_answer).collect::<Vec<_>>();
            assert!(
                probes.first_difference(&probes.answers[0], &wrong, probes.relative_tolerance).is_some(),
                "{way:?}"
            );
        }
    });
}
