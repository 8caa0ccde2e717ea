//! The compute engine on whatever device this machine has, under validation.

mod common;

use common::{resident_kib, with_gpu};
use welkin::gpu::{
    AddressMode, BufferKind, Clock, DeviceRequest, Filter, Filtering, Gpu, GpuError, GpuImage, ImageFormat, ImageShape,
    Pipeline, Resource, Validation, Work,
};
use welkin_shaders::{Definitions, ParameterBuffers, Shader, Sources};

/// Writes to every texel its own coordinates, times a parameter.
const COORDINATES: &str = "
struct Parameters { scale: f32, offset: f32 }
@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var picture: texture_storage_2d<rgba32float, write>;
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(picture)) { return; }
    let value = vec2<f32>(id.xy) * parameters.scale + parameters.offset;
    textureStore(picture, id.xy, vec4<f32>(value, 0.0, 1.0));
}";

/// Adds to every texel its left neighbour's value, so that a missing barrier shows.
const SHIFT: &str = "
@group(0) @binding(0) var before: texture_2d<f32>;
@group(0) @binding(1) var after: texture_storage_2d<rgba32float, write>;
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(after);
    if any(id.xy >= size) { return; }
    let left = vec2<u32>((id.x + size.x - 1u) % size.x, id.y);
    textureStore(after, id.xy, textureLoad(before, id.xy, 0) + textureLoad(before, left, 0));
}";

/// Samples the middle between texels of an array's layers into a buffer.
const SAMPLE: &str = "
@group(0) @binding(0) var table: texture_2d_array<f32>;
@group(0) @binding(1) var linear_clamp: sampler;
@group(0) @binding(2) var<storage, read> places: array<vec4<f32>>;
@group(1) @binding(0) var<storage, read_write> values: array<vec4<f32>>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&places) { return; }
    let place = places[id.x];
    values[id.x] = textureSampleLevel(table, linear_clamp, place.xy, u32(place.z), 0.0);
}";

/// Takes a time in proportion to a parameter.
const SPIN: &str = "
struct Parameters { steps: u32 }
@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read_write> values: array<f32>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    var x = f32(id.x) * 1e-3;
    for (var i = 0u; i < parameters.steps; i++) { x = sin(x) + 0.5; }
    values[id.x] = x;
}";

fn shader(name: &str, text: &'static str) -> Shader {
    let sources = Sources::default().with(&format!("{name}.wgsl"), text);
    Shader::from_sources(&sources, name, &Definitions::new()).unwrap_or_else(|error| panic!("{error}"))
}

fn pipeline(gpu: &Gpu, name: &str, text: &'static str) -> Pipeline {
    gpu.pipeline(&shader(name, text)).unwrap()
}

fn picture(gpu: &Gpu, name: &str, width: u32, height: u32) -> GpuImage {
    gpu.image(name, ImageShape::D2(width, height), ImageFormat::Rgba32Float).unwrap()
}

fn run(gpu: &Gpu, pipeline: &Pipeline, resources: &[(&str, Resource)], work: [u32; 3]) -> Result<(), GpuError> {
    let mut commands = gpu.record("test")?;
    commands.dispatch(pipeline, resources, Work::Invocations(work))?;
    commands.submit_and_wait().map(drop)
}

#[test]
fn a_pass_writes_every_texel_of_an_image_that_no_workgroup_divides() {
    with_gpu(|gpu| {
        let (width, height) = (37, 19);
        let image = picture(gpu, "picture", width, height);
        let pass = pipeline(gpu, "coordinates", COORDINATES);
        let resources = [("picture", Resource::Image(&image)), ("parameters", Resource::data(&[0.5_f32, 3.0]))];
        run(gpu, &pass, &resources, [width, height, 1]).unwrap();
        let texels: Vec<[f32; 4]> = gpu.read_image(&image).unwrap();
        let expected = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let expected: Vec<_> = expected.map(|(x, y)| [x as f32 * 0.5 + 3.0, y as f32 * 0.5 + 3.0, 0.0, 1.0]).collect();
        assert_eq!(texels, expected);
    });
}

#[test]
fn a_chain_of_passes_through_two_images_sees_each_result_of_the_one_before() {
    with_gpu(|gpu| {
        let (width, height, rounds) = (256_u32, 64_u32, 7);
        let images = [picture(gpu, "ping", width, height), picture(gpu, "pong", width, height)];
        let (first, shift) = (pipeline(gpu, "coordinates", COORDINATES), pipeline(gpu, "shift", SHIFT));
        let parameters = gpu.uniform_buffer("parameters", &[1.0_f32, 0.0]).unwrap();
        let work = Work::Invocations([width, height, 1]);
        let mut commands = gpu.record("chain").unwrap();
        let resources = [("parameters", Resource::Buffer(&parameters)), ("picture", Resource::Image(&images[0]))];
        commands.dispatch(&first, &resources, work).unwrap();
        for round in 0..rounds {
            let (from, to) = (&images[round % 2], &images[(round + 1) % 2]);
            let resources = [("before", Resource::Image(from)), ("after", Resource::Image(to))];
            commands.dispatch_as(&format!("shift {round}"), &shift, &resources, work).unwrap();
        }
        let completed = commands.submit_and_wait().unwrap();
        assert!(completed.times.is_empty(), "nothing was timed");

        let mut expected: Vec<f32> = (0..width).map(|x| x as f32).collect();
        for _ in 0..rounds {
            let last = expected.clone();
            let left = |x: usize| last[(x + last.len() - 1) % last.len()];
            expected = (0..last.len()).map(|x| last[x] + left(x)).collect();
        }
        let texels: Vec<[f32; 4]> = gpu.read_image(&images[rounds % 2]).unwrap();
        for row in texels.chunks(width as usize) {
            assert_eq!(row.iter().map(|texel| texel[0]).collect::<Vec<_>>(), expected, "sums of whole numbers");
        }
    });
}

#[test]
fn sampling_between_texels_interpolates_within_a_layer_and_clamps_at_its_edge() {
    with_gpu(|gpu| {
        assert_eq!(gpu.filtering(ImageFormat::Rgba16Float), Filtering::Linear, "Vulkan requires it of this format");
        let table = gpu.image("table", ImageShape::D2Array(2, 1, 2), ImageFormat::Rgba32Float).unwrap();
        let texel = |value: f32| [value, -value, 2.0 * value, 1.0];
        gpu.write_image(&table, &[texel(1.0), texel(3.0), texel(10.0), texel(30.0)]).unwrap();
        let sampler = gpu.sampler(Filter::Linear, [AddressMode::Clamp; 3]).unwrap();
        let places = [[0.5_f32, 0.5, 0.0, 0.0], [0.5, 0.5, 1.0, 0.0], [0.25, 0.5, 0.0, 0.0], [2.0, 0.5, 1.0, 0.0]];
        let places_buffer = gpu.storage_buffer_of("places", &places).unwrap();
        let values = gpu.storage_buffer("values", 64).unwrap();
        let resources = [
            ("table", Resource::Image(&table)),
            ("linear_clamp", Resource::Sampler(&sampler)),
            ("places", Resource::Buffer(&places_buffer)),
            ("values", Resource::Buffer(&values)),
        ];
        run(gpu, &pipeline(gpu, "sample", SAMPLE), &resources, [4, 1, 1]).unwrap();
        let values: Vec<[f32; 4]> = gpu.read_buffer(&values).unwrap();
        assert_eq!(values, [texel(2.0), texel(20.0), texel(1.0), texel(30.0)]);
    });
}

#[test]
fn what_is_written_from_the_host_is_read_back_in_every_shape_and_format() {
    with_gpu(|gpu| {
        let shapes = [ImageShape::D1(13), ImageShape::D2(7, 5), ImageShape::D2Array(5, 3, 4), ImageShape::D3(3, 5, 7)];
        let formats =
            [ImageFormat::Rgba32Float, ImageFormat::Rgba16Float, ImageFormat::R32Float, ImageFormat::Rgba8Unorm];
        for (shape, format) in shapes.into_iter().flat_map(|shape| formats.map(|format| (shape, format))) {
            let image = gpu.image("image", shape, format).unwrap();
            let bytes: Vec<u8> = (0..image.bytes()).map(|i| (i * 7 % 59) as u8).collect();
            gpu.write_image(&image, &bytes).unwrap();
            assert_eq!(gpu.read_image::<u8>(&image).unwrap(), bytes, "{shape:?} {format:?}");
        }
        let uniform = gpu.uniform_buffer("uniform", &[1_u32, 2, 3, 4]).unwrap();
        gpu.write_buffer(&uniform, &[5_u32, 6, 7, 8]).unwrap();
        assert_eq!(gpu.read_buffer::<u32>(&uniform).unwrap(), [5, 6, 7, 8]);
        assert_eq!(uniform.kind(), BufferKind::Uniform);
    });
}

#[test]
fn every_wrong_binding_is_an_error_that_names_pass_and_variable() {
    with_gpu(|gpu| {
        let pass = pipeline(gpu, "shift", SHIFT);
        let (from, to) = (picture(gpu, "source", 8, 8), picture(gpu, "target", 8, 8));
        gpu.write_image(&from, &[[0.0_f32; 4]; 64]).unwrap();
        let volume = gpu.image("volume", ImageShape::D3(8, 8, 8), ImageFormat::Rgba32Float).unwrap();
        let narrow = gpu.image("narrow", ImageShape::D2(8, 8), ImageFormat::Rgba16Float).unwrap();
        let (from, to) = (Resource::Image(&from), Resource::Image(&to));
        let error = |resources: &[(&str, Resource)]| run(gpu, &pass, resources, [8, 8, 1]).unwrap_err();
        let expect = |error: GpuError, words: &[&str]| {
            let text = error.to_string();
            assert!(words.iter().chain(&["`shift`"]).all(|word| text.contains(word)), "{text}");
            error
        };

        let missing = expect(error(&[("before", from)]), &["`after`"]);
        assert!(matches!(missing, GpuError::MissingBinding { .. }));
        let unknown = expect(error(&[("before", from), ("after", to), ("into", to)]), &["`into`", "before, after"]);
        assert!(matches!(unknown, GpuError::SuperfluousBinding { .. }));
        let twice = expect(error(&[("before", from), ("after", to), ("after", to)]), &["`after`"]);
        assert!(matches!(twice, GpuError::DuplicateBinding { .. }));
        let shape =
            expect(error(&[("before", Resource::Image(&volume)), ("after", to)]), &["`before`", "`volume`", "D3"]);
        assert!(matches!(shape, GpuError::WrongBinding { .. }));
        let format =
            expect(error(&[("before", from), ("after", Resource::Image(&narrow))]), &["`after`", "Rgba16Float"]);
        assert!(matches!(format, GpuError::WrongBinding { .. }));
        let kind = expect(error(&[("before", Resource::Data(&[0; 4])), ("after", to)]), &["`before`", "4 bytes"]);
        assert!(matches!(kind, GpuError::WrongBinding { .. }));
        let aliased = expect(error(&[("before", from), ("after", from)]), &["`before`", "`after`"]);
        assert!(matches!(aliased, GpuError::Aliased { .. }));
        let unwritten = expect(error(&[("before", to), ("after", from)]), &["`before`", "`target`"]);
        assert!(matches!(unwritten, GpuError::ReadBeforeWrite { .. }));
        run(gpu, &pass, &[("after", to), ("before", from)], [8, 8, 1]).expect("the right bindings, in any order");
    });
}

#[test]
fn a_parameter_block_of_the_wrong_size_is_refused() {
    with_gpu(|gpu| {
        let pass = pipeline(gpu, "coordinates", COORDINATES);
        let image = picture(gpu, "picture", 8, 8);
        let with = |parameters: Resource| {
            run(gpu, &pass, &[("picture", Resource::Image(&image)), ("parameters", parameters)], [8, 8, 1])
        };
        assert!(matches!(with(Resource::data(&[1.0_f32])), Err(GpuError::WrongBinding { .. })));
        assert!(matches!(with(Resource::data(&[1.0_f32; 3])), Err(GpuError::WrongBinding { .. })));
        with(Resource::data(&[1.0_f32; 2])).unwrap();
    });
}

#[test]
fn sizes_beyond_the_device_and_empty_ones_are_errors() {
    with_gpu(|gpu| {
        let side = gpu.info().limits.image_side[1];
        for shape in [ImageShape::D2(0, 4), ImageShape::D2(side + 1, 4), ImageShape::D2Array(4, 4, 0)] {
            let error = gpu.image("wide", shape, ImageFormat::Rgba8Unorm).map(drop).unwrap_err();
            assert!(matches!(error, GpuError::Resource { .. }) && error.to_string().contains("`wide`"), "{error}");
        }
        assert!(matches!(gpu.storage_buffer("none", 0).map(drop), Err(GpuError::Resource { .. })));
        let image = picture(gpu, "picture", 8, 8);
        assert!(matches!(gpu.write_image(&image, &[0_u8; 3]), Err(GpuError::Size { .. })));
        assert!(matches!(gpu.read_image::<[u8; 3]>(&image), Err(GpuError::Size { .. })));
        assert!(matches!(gpu.read_image::<u8>(&image), Err(GpuError::Resource { .. })), "nothing was written");

        let pass = pipeline(gpu, "coordinates", COORDINATES);
        let resources = [("picture", Resource::Image(&image)), ("parameters", Resource::data(&[1.0_f32; 2]))];
        let too_many = gpu.info().limits.workgroups[1].saturating_add(1);
        for workgroups in [[1, 0, 1], [1, too_many, 1]] {
            let error = gpu.record("empty").unwrap().dispatch(&pass, &resources, Work::Workgroups(workgroups));
            assert!(matches!(error, Err(GpuError::DispatchSize { .. })));
        }
    });
}

#[test]
fn while_a_list_is_recorded_nothing_else_may_reach_the_device() {
    with_gpu(|gpu| {
        let image = picture(gpu, "picture", 8, 8);
        gpu.write_image(&image, &[[0.0_f32; 4]; 64]).unwrap();
        let open = gpu.record("frame 7").unwrap();
        for error in [gpu.read_image::<f32>(&image).map(drop), gpu.record("frame 8").map(drop)] {
            let error = error.unwrap_err();
            assert!(matches!(error, GpuError::Recording { .. }) && error.to_string().contains("frame 7"), "{error}");
        }
        drop(open);
        gpu.read_image::<f32>(&image).expect("the list is gone");
    });
}

#[test]
fn a_fourth_uniform_buffer_is_refused_because_mesa_22_would_write_out_of_bounds() {
    with_gpu(|gpu| {
        let declare = |count: u32| {
            let numbers = 0..count;
            let variables: String =
                numbers.clone().map(|i| format!("@group(0) @binding({i}) var<uniform> u{i}: vec4<f32>;\n")).collect();
            let sum = numbers.map(|i| format!("u{i}")).collect::<Vec<_>>().join(" + ");
            let text = format!(
                "{variables}@group(0) @binding(9) var<storage, read_write> value: vec4<f32>;\n\
                 @compute @workgroup_size(1) fn main() {{ value = {sum}; }}"
            );
            let sources = Sources::default().with("uniforms.wgsl", text);
            Shader::from_sources(&sources, "uniforms", &Definitions::new()).unwrap()
        };
        gpu.pipeline(&declare(3)).expect("three are allowed");
        let error = gpu.pipeline(&declare(4)).map(drop).unwrap_err();
        assert!(matches!(error, GpuError::Pipeline { .. }) && error.to_string().contains("at most 3"), "{error}");
    });
}

#[test]
fn time_is_attributed_to_the_dispatch_that_took_it() {
    with_gpu(|gpu| {
        let pass = pipeline(gpu, "spin", SPIN);
        let values = gpu.storage_buffer("values", 64 * 64 * 4).unwrap();
        let steps = [4_u32, 4000, 4, 4, 4000];
        let times = |clock: Clock| {
            let mut commands = gpu.record_timed_by("timed", clock).unwrap();
            for (index, steps) in steps.iter().enumerate() {
                let resources = [("values", Resource::Buffer(&values)), ("parameters", Resource::data(steps))];
                commands.dispatch_as(&format!("{index}"), &pass, &resources, Work::Workgroups([64, 1, 1])).unwrap();
            }
            let completed = commands.submit_and_wait().unwrap();
            assert_eq!(completed.clock, Some(clock));
            assert!(completed.times.iter().enumerate().all(|(index, time)| time.label == index.to_string()));
            completed.times.iter().map(|time| time.milliseconds).collect::<Vec<_>>()
        };
        for clock in [Clock::Host, Clock::Processor, Clock::of(gpu.info())] {
            // The least of some tries leaves out what other processes cost.
            let tries: Vec<_> = (0..4).map(|_| times(clock)).collect();
            let least = |index: usize| tries.iter().map(|times| times[index]).fold(f64::INFINITY, f64::min);
            let (light, heavy) = (least(0).max(least(2)).max(least(3)), least(1).min(least(4)));
            // The work differs a thousandfold; what a dispatch costs by itself is the rest.
            assert!(heavy > 3.0 * light && heavy > 0.0, "{clock:?}: light {light} ms, heavy {heavy} ms");
        }
    });
}

#[test]
fn the_device_counts_the_workgroups_of_a_later_dispatch() {
    const COUNT: &str = "
        @group(0) @binding(0) var<storage, read_write> counts: array<atomic<u32>>;
        @compute @workgroup_size(32) fn main(@builtin(local_invocation_index) i: u32) {
            if i % 4u == 1u { atomicAdd(&counts[0], 1u); }
            atomicMax(&counts[1], 1u);
            atomicMax(&counts[2], 1u);
        }";
    const MARK: &str = "
        @group(0) @binding(0) var<storage, read_write> marks: array<u32>;
        @compute @workgroup_size(1) fn main(@builtin(workgroup_id) group: vec3<u32>) { marks[group.x] = 7u; }";
    with_gpu(|gpu| {
        let (count, mark) = (pipeline(gpu, "count", COUNT), pipeline(gpu, "mark", MARK));
        let counts = gpu.storage_buffer("counts", 16).unwrap();
        let marks = gpu.storage_buffer_of("marks", &[1_u32; 32]).unwrap();
        // Twice: the second time counts from zero again.
        for _ in 0..2 {
            let mut commands = gpu.record("counted").unwrap();
            commands.clear(&counts);
            commands.dispatch(&count, &[("counts", Resource::Buffer(&counts))], Work::Workgroups([1, 1, 1])).unwrap();
            commands.dispatch(&mark, &[("marks", Resource::Buffer(&marks))], Work::Counted(&counts)).unwrap();
            commands.submit_and_wait().unwrap();
        }
        let marked: Vec<u32> = gpu.read_buffer(&marks).unwrap();
        assert_eq!(marked.iter().filter(|&&mark| mark == 7).count(), 8);
        assert!(marked[..8].iter().all(|&mark| mark == 7) && marked[8..].iter().all(|&mark| mark == 1));
    });
}

#[test]
fn more_dispatches_than_one_query_pool_holds_are_all_timed() {
    with_gpu(|gpu| {
        let pass = pipeline(gpu, "spin", SPIN);
        let values = gpu.storage_buffer("values", 64 * 4).unwrap();
        let mut commands = gpu.record_timed("many").unwrap();
        let resources = [("values", Resource::Buffer(&values)), ("parameters", Resource::data(&1_u32))];
        for _ in 0..150 {
            commands.dispatch(&pass, &resources, Work::Workgroups([1, 1, 1])).unwrap();
        }
        let times = commands.submit_and_wait().unwrap().times;
        assert_eq!(times.len(), 150);
        assert!(times.iter().all(|time| time.label == "spin" && time.milliseconds < 1e3), "{times:?}");
    });
}

#[test]
fn dispatches_with_ever_new_parameters_leave_nothing_behind() {
    with_gpu(|gpu| {
        let sources = Sources::default().with("spin.wgsl", SPIN);
        let values = gpu.storage_buffer("values", 64 * 4).unwrap();
        let growth_kib = |parameters| {
            let shader = Shader::with_parameters(&sources, "spin", &Definitions::new(), parameters).unwrap();
            let pass = gpu.pipeline(&shader).unwrap();
            let dispatch = |steps: u32| {
                let resources = [("values", Resource::Buffer(&values)), ("parameters", Resource::data(&steps))];
                run(gpu, &pass, &resources, [64, 1, 1]).unwrap();
            };
            (1..10).for_each(dispatch);
            let (before, population) = (resident_kib(), gpu.population());
            (10..110).for_each(dispatch);
            assert_eq!(gpu.population(), population, "{parameters:?}");
            resident_kib().saturating_sub(before)
        };
        for parameters in [ParameterBuffers::Uniform, ParameterBuffers::Storage] {
            // Less than what a single compiled shader takes, for each dispatch.
            let kept = growth_kib(parameters);
            assert!(kept < 100 * 20, "{parameters:?}: {kept} KiB");
        }
        // Control: what is kept is counted.
        let before = gpu.population();
        let kept = picture(gpu, "kept", 64, 64);
        let after = gpu.population();
        assert_eq!((after.images, after.used_bytes > before.used_bytes), (before.images + 1, true));
        drop(kept);
        assert_eq!(gpu.population(), before);
    });
}

/// Runs this test again in a process of its own with one more environment variable, and returns what it prints.
fn again_with(test: &str, variable: &str, value: &str) -> String {
    let program = std::env::current_exe().unwrap();
    let mut child = std::process::Command::new(program);
    child.args(["--exact", test, "--nocapture"]).env("WELKIN_TEST_CHILD", "1").env(variable, value);
    String::from_utf8(child.output().unwrap().stdout).unwrap()
}

#[test]
fn without_a_driver_the_error_names_the_packages_to_install() {
    if std::env::var_os("WELKIN_TEST_CHILD").is_some() {
        let error = Gpu::new(&DeviceRequest::default()).map(drop).unwrap_err();
        return println!("usable: {}; {error}", !error.is_no_usable_device());
    }
    let test = "without_a_driver_the_error_names_the_packages_to_install";
    let text = again_with(test, "VK_DRIVER_FILES", "/no/such/driver.json");
    assert!(text.contains("usable: false; no Vulkan device"), "{text}");
    assert!(text.contains("libvulkan1 mesa-vulkan-drivers"), "{text}");
}

#[test]
fn without_the_validation_layer_asking_for_it_names_the_package_to_install() {
    if std::env::var_os("WELKIN_TEST_CHILD").is_some() {
        let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
        return println!("{}", Gpu::new(&request).map(drop).unwrap_err());
    }
    let test = "without_the_validation_layer_asking_for_it_names_the_package_to_install";
    let text = again_with(test, "VK_LAYER_PATH", "/no/such/directory");
    assert!(text.contains("apt-get install vulkan-validationlayers"), "{text}");
}

#[test]
fn a_device_is_found_by_a_part_of_its_name_and_an_unknown_one_lists_those_there_are() {
    let name = Gpu::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}")).info().name.clone();
    let part = name.split_whitespace().next().unwrap().to_uppercase();
    let request = |device: &str| DeviceRequest { device: Some(device.to_owned()), ..DeviceRequest::default() };
    assert!(Gpu::new(&request(&part)).unwrap().info().name.to_uppercase().contains(&part));
    let error = Gpu::new(&request("no such device")).map(drop).unwrap_err();
    assert!(matches!(&error, GpuError::UnknownDevice { available, .. } if available.contains(&name)), "{error}");
}
