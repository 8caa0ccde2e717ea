//! Wavelengths become colours: white is white, both backends agree, and what a space cannot mix is kept in an EXR file.

mod common;

use std::path::Path;
use std::sync::atomic::AtomicBool;

use glam::{DMat3, DVec3};
use welkin::frame::Frame;
use welkin::gpu::DeviceRequest;
use welkin::output::{AtomicFile, OutputError, read_exr, write_exr};
use welkin::plan::{Decision, Outputs, Quality, Settings};
use welkin::reference::Solver;
use welkin::reference::picture::{CameraView, Film, Observer, Outcome, Sampling, Shard, expose};
use welkin::renderer::{Rendered, Renderer};
use welkin::report::{MetricsError, compare};
use welkin::scene::{Light, Scene, SpectrumRequest};
use welkin_lut::BAND_WAVELENGTHS_NM;
use welkin_lut::spectrum::{Channels, ColourSpace};

const SRGB: Channels = Channels::Colour(ColourSpace::LinearSrgb);

const OUTPUTS: Outputs = Outputs { capture: true, picture: true };

fn scene_of(text: &str, wavelengths: usize, channels: Channels) -> Scene {
    let request = SpectrumRequest { wavelengths: Some(wavelengths), channels: Some(channels) };
    Scene::parse_with(text, Path::new("sky.toml"), request).unwrap()
}

/// A small picture of the sky beside the sun, with the horizon in it.
fn sky(preset: &str, sun_elevation_deg: f64) -> String {
    format!(
        "preset = \"{preset}\"\n[sun]\nelevation_deg = {sun_elevation_deg}\nazimuth_deg = 180\n\
         [camera]\naltitude_m = 2\nelevation_deg = 15\nazimuth_deg = 120\nwidth = 6\nheight = 4\n"
    )
}

fn renderer() -> Renderer {
    Renderer::new(&DeviceRequest::default()).unwrap()
}

fn render(renderer: &mut Renderer, scene: &Scene) -> Rendered {
    renderer.render(scene, Settings::of(Quality::Low), OUTPUTS).unwrap()
}

fn vector(pixel: [f32; 3]) -> DVec3 {
    DVec3::from_array(pixel.map(f64::from))
}

#[test]
fn three_wavelengths_are_the_bands() {
    let (bands, colour) = (scene_of(&sky("earth", 20.0), 3, Channels::Bands), scene_of(&sky("earth", 20.0), 3, SRGB));
    assert_eq!(bands.spectrum.groups()[0].wavelengths_nm, BAND_WAVELENGTHS_NM);
    assert_eq!(*colour.at(&colour.spectrum.groups()[0]), colour);
    let _alone = common::alone();
    let mut renderer = renderer();
    let (bands, matrix) = (render(&mut renderer, &bands), colour.colour()[0].radiance);
    let colour = render(&mut renderer, &colour);
    for (band, colour) in bands.frame.radiance.iter().zip(&colour.frame.radiance) {
        // The one rounding to 32 bits.
        let expected = matrix * vector(*band);
        assert!((vector(*colour) - expected).length() <= 1e-6 * expected.length());
    }
    assert_eq!(bands.picture, colour.picture);
}

#[test]
fn sunlight_is_white_in_every_space_from_any_number_of_wavelengths() {
    for preset in ["earth", "hillaire2020", "mars"] {
        for wavelengths in [3, 4, 7, 40] {
            for space in ColourSpace::ALL {
                let scene = scene_of(&sky(preset, 20.0), wavelengths, Channels::Colour(space));
                let groups = scene.spectrum.groups();
                let sun: DVec3 = groups
                    .iter()
                    .zip(scene.colour())
                    .map(|(group, colour)| match &scene.at(group).lights[0] {
                        Light::Directional(sun) => colour.radiance * DVec3::from_array(sun.irradiance),
                        _ => DVec3::ZERO,
                    })
                    .sum();
                assert!((sun / sun.y - 1.0).length() < 1e-9, "{preset}, {wavelengths}, {}: {sun}", space.name());
                let clear: DVec3 = scene.colour().iter().map(|colour| colour.transmittance * DVec3::ONE).sum();
                assert!((clear - 1.0).length() < 1e-9, "transmittance of a vacuum: {clear}");
            }
        }
    }
}

#[test]
fn without_balance_the_sun_is_warmer_than_daylight_of_6500_kelvin() {
    let text = sky("earth", 20.0) + "[spectrum]\nwhite = \"d65\"\n";
    let scene = scene_of(&text, 6, SRGB);
    let groups = scene.spectrum.groups();
    let sun = |(group, colour): (_, welkin::scene::GroupColour)| match &scene.at(group).lights[0] {
        Light::Directional(sun) => colour.radiance * DVec3::from_array(sun.irradiance),
        _ => DVec3::ZERO,
    };
    let [red, green, blue] = groups.iter().zip(scene.colour()).map(sun).sum::<DVec3>().to_array();
    assert!(red > green && green > blue, "{red} {green} {blue}");
}

#[test]
fn spaces_are_one_matrix_apart_and_stay_so_when_only_the_sun_moves() {
    let _alone = common::alone();
    let mut renderer = renderer();
    let srgb_to_acescg = ColourSpace::LinearSrgb.to_space(ColourSpace::AcesCg);
    for elevation_deg in [3.0, 20.0] {
        let text = sky("earth", elevation_deg);
        let srgb = render(&mut renderer, &scene_of(&text, 6, SRGB));
        let acescg = render(&mut renderer, &scene_of(&text, 6, Channels::Colour(ColourSpace::AcesCg)));
        let decision = |name| acescg.timings.plan.decision(name);
        // The tables of both groups are kept; what is seen is added up anew.
        assert_eq!((decision("higher_source"), decision("colour")), (Some(Decision::Reuse), Some(Decision::Run)));
        assert_eq!(acescg.frame.channels, Some(Channels::Colour(ColourSpace::AcesCg)));
        let apart = |matrix: DMat3, frame: &Frame| {
            let difference =
                |(a, b): (&[f32; 3], &[f32; 3])| (vector(*a) - matrix * vector(*b)).length() / vector(*a).length();
            acescg.frame.radiance.iter().zip(&frame.radiance).map(difference).fold(0.0, f64::max)
        };
        // Two roundings to 32 bits for each of two groups.
        assert!(apart(srgb_to_acescg, &srgb.frame) < 2e-6, "{}", apart(srgb_to_acescg, &srgb.frame));
        assert!(apart(DMat3::IDENTITY, &srgb.frame) > 1e-2);
    }
}

/// Lets an exposure run to its end.
struct Unwatched(AtomicBool);

impl Observer for Unwatched {
    fn advanced(&self, _: u64) {}

    fn paused(&self, _: &Film, _: bool) -> Result<(), OutputError> {
        Ok(())
    }

    fn interrupted(&self) -> &AtomicBool {
        &self.0
    }
}

/// Largest distance from a device's picture in standard errors and 3 % of the pixel, by the path tracer.
fn farthest(device: &Frame, scene: &Scene) -> f64 {
    let sampling = Sampling::new(Some(256), None);
    let view = CameraView::new(scene, Solver::Path, 1, sampling.walks_per_batch).unwrap();
    let mut film = Film::new(Shard::WHOLE, view.pixels());
    assert_eq!(expose(&&view, &mut film, &sampling.stop(), &Unwatched(AtomicBool::new(false))).unwrap(), Outcome::Done);
    let truth = view.develop(&film);
    let errors = truth.standard_error.as_ref().unwrap();
    let distance = |i: usize| {
        let (seen, truth, error) = (vector(device.radiance[i]), vector(truth.radiance[i]), vector(errors[i]));
        ((seen - truth).abs() / (4.0 * error + 0.03 * truth.max_element())).max_element()
    };
    (0..errors.len()).map(distance).fold(0.0, f64::max)
}

#[test]
fn both_backends_see_the_same_colours() {
    let scene = scene_of(&sky("earth", 20.0), 6, SRGB);
    let _alone = common::alone();
    let settings = Settings::of(Quality::Medium);
    let outputs = Outputs { capture: true, picture: false };
    let mut device = renderer().render(&scene, settings, outputs).unwrap().frame;
    assert!(farthest(&device, &scene) < 1.0, "{}", farthest(&device, &scene));
    // A quarter more blue is seen.
    device.radiance.iter_mut().for_each(|pixel| pixel[2] *= 1.25);
    assert!(farthest(&device, &scene) > 1.0);
}

#[test]
fn colours_that_a_space_cannot_mix_are_kept_in_an_exr_file_and_not_in_a_png() {
    let text =
        sky("earth", 20.0).replace("azimuth_deg = 180", "azimuth_deg = 180\nirradiance = [1.474, 1.8504, 1.91198]");
    // Glass that only violet light passes: the sky below it is bluer than sRGB's blue.
    let text = text
        + "[medium.glass]\nabsorption_per_m = [[470, 0], [500, 2e-3]]\nprofile.layer = { bottom_m = 2000, top_m = 4000 }\n[display]\nexposure_ev = 6\n";
    let scene = scene_of(&text, 9, SRGB);
    let _alone = common::alone();
    let rendered = render(&mut renderer(), &scene);
    assert!(rendered.frame.radiance.iter().any(|[r, g, _]| r.min(*g) < 0.0));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("violet.exr");
    write_exr(AtomicFile::create(&path).unwrap(), &rendered.frame, &scene).unwrap();
    assert_eq!(read_exr(&path).unwrap(), rendered.frame);
    let picture = rendered.picture.unwrap();
    assert!(picture.chunks(3).any(|pixel| pixel[2] > 40 && pixel[2] > pixel[0] && pixel[2] > pixel[1]));
}

#[test]
fn a_spectrum_that_cannot_be_is_refused_with_what_is_allowed() {
    let refusal = |section: &str| {
        let text = sky("earth", 20.0) + section;
        Scene::parse(&text, Path::new("sky.toml")).unwrap_err().to_string()
    };
    let cases = [
        ("[spectrum]\nwavelengths = 41\n", "a whole number of wavelengths from 3 to 40"),
        ("[spectrum]\nwavelengths = 6\ncolour_space = \"bands\"\n", "a colour space for 6 wavelengths"),
        ("[planet]\nground_albedo = [[600, 0.1], [500, 0.2]]\n", "expected rising wavelengths"),
        ("[planet]\nground_albedo = [[600, 0.1], 0.2]\n", "numbers beside pairs"),
        ("[planet]\nground_albedo = [[600, 1.5]]\n", "a number from 0 to 1"),
    ];
    for (section, allowed) in cases {
        let message = refusal(section);
        assert!(message.contains(allowed) && message.contains("sky.toml:1"), "{message}");
    }
}

#[test]
fn a_listed_spectrum_is_taken_at_its_wavelengths() {
    let text = sky("earth", 20.0) + "[planet]\nground_albedo = [[400, 0.1], [700, 0.4]]\n";
    let scene = scene_of(&text, 7, SRGB);
    for group in scene.spectrum.groups() {
        let albedo = scene.at(&group).planet.ground_albedo;
        for (nm, albedo) in group.wavelengths_nm.into_iter().zip(albedo) {
            assert!((albedo - (0.1 + 1e-3 * (nm.clamp(400.0, 700.0) - 400.0))).abs() < 1e-12, "{albedo} at {nm} nm");
        }
    }
    assert!((scene.planet.ground_albedo[1] - 0.25).abs() < 1e-12);
}

#[test]
fn pictures_of_different_spaces_are_not_compared() {
    let [a, b] = [Channels::Bands, SRGB].map(|channels| Frame::of_channels(2, 2, channels));
    assert!(matches!(compare(&a, &b), Err(MetricsError::Channels { .. })));
    assert!(compare(&a, &Frame { channels: None, ..b }).is_ok());
}
