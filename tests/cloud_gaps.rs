//! What a march through clouds leaps over is empty.

use std::borrow::Cow;
use std::path::Path;

use welkin::gpu::{DeviceRequest, Gpu};
use welkin::passes::ShaderSources;
use welkin::plan::{CloudScattering, CloudSettings, Outputs, Quality, Settings};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

/// What a pixel is given whose ray has leapt over a cloud; no light in these scenes comes near.
const WATCHED: f32 = 1e7;

/// The march, looking sixteen times into each of its leaps. A gap may begin before a step does and the leap with it.
fn watched(gaps: f64) -> ShaderSources {
    let march = include_str!("../shaders/wgsl/clouds.wgsl");
    let leap = "        (*march).t_m = min(max(t_m + step_m, at_m + empty_m), boundary_m);\n";
    let stored = "    textureStore(cloud_radiance_image, id.xy, vec4<f32>(sum.radiance, transmittance));\n";
    assert!(march.contains(leap) && march.contains(stored), "the march has changed");
    let look = "        for (var i = 1u; i <= 16u && empty_m > 0.0; i++) {
            let seen_m = mix(at_m, min(at_m + empty_m, boundary_m), f32(i) / 16.0);
            var seen = bodies_at(to_map(atmosphere.radius_m, position_m(ray, seen_m)), altitude_m(ray, seen_m));
            leapt_over = leapt_over || is_any_above_zero(&seen);
        }
";
    let march = march
        .replace(leap, &format!("{look}{leap}"))
        .replace(
            stored,
            &format!("    sum.radiance = select(sum.radiance, vec3<f32>({WATCHED:e}), leapt_over);\n{stored}"),
        )
        .replace("struct Sum {", "var<private> leapt_over: bool;\n\nstruct Sum {");
    let skip = include_str!("../shaders/wgsl/cloud_skip.wgsl");
    let used = "const MARGIN: f32 = 0.85;";
    assert!(skip.contains(used), "the use of gaps has changed");
    let skip = skip.replace(used, &format!("const MARGIN: f32 = 0.85 * {gaps:.1};"));
    ShaderSources::embedded().with("clouds.wgsl", Cow::Owned(march)).with("cloud_skip.wgsl", Cow::Owned(skip))
}

/// Heaps with wind and anvils above them, a stretched sheet and a broken one.
const CLOUDS: &str = "
preset = \"earth\"
time_s = 4321
sun = { elevation_deg = 35, azimuth_deg = 200 }
[[clouds]]
kind = \"cumulus\"
coverage = 0.3
wind_m_per_s = [7, -3]
[[clouds]]
kind = \"cumulonimbus\"
coverage = 0.2
base_m = 2500
top_m = 9000
seed = 5
[[clouds]]
kind = \"cirrus\"
coverage = 0.2
base_m = 9500
top_m = 10000
wind_m_per_s = [20, 15]
";

/// From below all clouds, between them, above them, and from space towards the limb.
const CAMERAS: [(f64, f64); 5] = [(2.0, 20.0), (1800.0, 0.0), (9200.0, -10.0), (12_000.0, -40.0), (150_000.0, -13.0)];

/// Pixels whose rays leap over some cloud, over all views.
fn leaps(renderer: &mut Renderer) -> usize {
    let clouds = CloudSettings {
        scattering: CloudScattering::Single,
        near_samples: 0,
        grid_size: 16,
        grid_slices: 4,
        grid_levels: 2,
        ..CloudSettings::of(Quality::Low)
    };
    let settings = Settings { clouds, lattice_tolerance: 0.0, ..Settings::of(Quality::Low) };
    let watched = |&(altitude_m, elevation_deg): &(f64, f64)| {
        let camera = format!("[camera]\naltitude_m = {altitude_m}\nelevation_deg = {elevation_deg}\nazimuth_deg = 0\n");
        let size = "vertical_field_of_view_deg = 60\nwidth = 80\nheight = 48\n";
        let scene = Scene::parse(&format!("{CLOUDS}{camera}{size}"), Path::new("gaps.toml")).unwrap();
        let frame = renderer.render(&scene, settings, Outputs::default()).unwrap().frame;
        frame.radiance.iter().filter(|pixel| pixel[0] > 1e-2 * WATCHED).count()
    };
    CAMERAS.iter().map(watched).sum()
}

#[test]
fn no_leap_passes_over_a_cloud_and_leaps_of_three_gaps_do() {
    let found = |gaps| {
        let gpu = Gpu::new(&DeviceRequest::default()).unwrap();
        leaps(&mut Renderer::with_shaders(gpu, watched(gaps)).unwrap())
    };
    assert_eq!(found(1.0), 0);
    // Negative control: what the march takes for a gap and is none.
    let wrong = found(3.0);
    assert!(wrong > 100, "only {wrong} pixels show leaps that are too long");
}
