//! Pixels between those that are marched through fog and volumes, and pixels with what stands before the camera.

mod common;

use std::path::Path;

use welkin::foreground::{Depth, Foreground};
use welkin::gpu::{DeviceRequest, Validation};
use welkin::plan::{Decision, Outputs, Quality, Settings, VolumeSettings};
use welkin::renderer::{Rendered, Renderer};
use welkin::scene::{Light, Scene};

const CAPTURE: Outputs = Outputs { capture: true, picture: false };
const SIZE: [usize; 2] = [128, 80];
/// Thousandths that interpolation may err by: none, so that all pixels are marched; the preset's; far too many.
const PERMILLE: [u32; 3] = [0, 20, 1000];

/// A camera in or over a bank of fog, and what else there is.
fn bank(camera: &str, rest: &str) -> Scene {
    let text = format!(
        "preset = \"earth\"\nsun = {{ elevation_deg = 12, azimuth_deg = 70 }}\n\
         camera = {{ {camera}, azimuth_deg = 0, vertical_field_of_view_deg = 20, width = {}, height = {} }}\n\
         [[fog]]\nextinction_per_m = 0.004\nprofile.exponential.scale_height_m = 40\n{rest}",
        SIZE[0], SIZE[1]
    );
    Scene::parse(&text, Path::new("fog.toml")).unwrap()
}

/// A scene, with what stands before its camera, as each of the tolerances has it.
fn rendered(scene: &Scene, before: Option<&Foreground>) -> [Rendered; 3] {
    let _alone = common::alone();
    let request = DeviceRequest { validation: Validation::On, ..DeviceRequest::default() };
    let mut renderer = Renderer::new(&request).unwrap();
    let log = renderer.gpu().validation_log();
    let low = Settings::of(Quality::Low);
    let rendered = PERMILLE.map(|lattice_permille| {
        let settings = Settings { volumes: VolumeSettings { lattice_permille, ..low.volumes }, ..low };
        match before {
            Some(foreground) => renderer.render_over(scene, settings, CAPTURE, foreground),
            None => renderer.render(scene, settings, CAPTURE),
        }
        .unwrap()
    });
    drop(renderer);
    assert!(log.messages().is_empty(), "{:?}", log.messages());
    rendered
}

/// Relative differences from the picture of which every pixel is marched.
struct Errors(Vec<f64>);

impl Errors {
    fn of(found: &Rendered, marched: &Rendered) -> Self {
        let pairs = found.frame.radiance.iter().flatten().zip(marched.frame.radiance.iter().flatten());
        Self(pairs.map(|(&found, &exact)| f64::from((found - exact).abs() / exact)).collect())
    }

    /// The share that is at most so large.
    fn share_within(&self, most: f64) -> f64 {
        self.0.iter().filter(|&&error| error <= most).count() as f64 / self.0.len() as f64
    }

    fn largest(&self) -> f64 {
        self.0.iter().copied().fold(0.0, f64::max)
    }

    /// Marching itself jumps by a hundredth in single pixels, where one step more fits before what the ray ends on.
    fn hold(&self) -> bool {
        self.share_within(0.02) > 0.999 && self.largest() < 0.03
    }
}

/// That interpolation keeps what it promises, and does interpolate; another picture must be told from it.
fn assert_interpolated([marched, between]: [&Rendered; 2], same_at_most: f64, other: &Rendered) {
    let (errors, by_other) = (Errors::of(between, marched), Errors::of(other, marched));
    let same = errors.share_within(0.0);
    println!("{same} are the same, {} within 2 %, at most {}", errors.share_within(0.02), errors.largest());
    assert!(errors.hold(), "{}", errors.largest());
    assert!(same < same_at_most, "{same}");
    assert!(!by_other.hold(), "{}", by_other.largest());
}

#[test]
fn media_between_marched_pixels_are_what_marching_each_of_them_finds() {
    // A lamp, and black balls of a few pixels.
    let ball = |i: usize| {
        let [east, up] = [13 * i as i32 - 50, 40 + 3 * i as i32];
        format!(
            "[[volumes]]\nname = \"{i}\"\nshape = \"ellipsoid\"\ncentre_m = [{east}, 400, {up}]\nsize_m = [5, 5, 5]\nabsorption_per_m = 1\n"
        )
    };
    let balls: String = (0..8).map(ball).collect();
    let lamp = "[[light.point]]\nname = \"lamp\"\nposition_m = [30, 300, 12]\nintensity = 4e4\n";
    let [marched, between, careless] =
        rendered(&bank("altitude_m = 60, elevation_deg = -2", &format!("{balls}{lamp}")), None);
    assert_interpolated([&marched, &between], 0.5, &careless);
    let decisions = [marched, between].map(|rendered| rendered.timings.plan.decision("media_interpolation"));
    assert_eq!(decisions, [Some(Decision::Skip), Some(Decision::Run)]);
}

#[test]
fn shadows_of_volumes_that_are_out_of_the_picture_lie_between_marched_pixels_as_well() {
    // Black balls high above, whose shadows on the ground are a few pixels wide and one high.
    let ball = |i: i32| {
        format!(
            "[[volumes]]\nname = \"{i}\"\nshape = \"ellipsoid\"\ncentre_m = [{}, {}, 140]\nsize_m = [6, 6, 6]\nabsorption_per_m = 4\n",
            17 * i - 60,
            107 + 6 * i
        )
    };
    let balls: String = (0..8).map(ball).collect();
    let mut scene = bank("altitude_m = 60, elevation_deg = -10", &balls);
    let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
    (sun.direction.elevation_rad, sun.direction.azimuth_rad) = (0.8, std::f64::consts::PI);
    let [marched, between, careless] = rendered(&scene, None);
    assert_interpolated([&marched, &between], 0.5, &careless);
}

#[test]
fn what_lamps_light_on_the_ground_lies_between_marched_pixels_as_well() {
    // Narrow cones from above the picture.
    let lamp = |i: i32| {
        format!(
            "[[light.spot]]\nname = \"{i}\"\nposition_m = [{}, {}, 60]\nintensity = 1000\nelevation_deg = -90\n\
             inner_deg = 1\nouter_deg = 2\n",
            11 * i - 40,
            240 + 13 * i
        )
    };
    let lamps: String = (0..7).map(lamp).collect();
    let with = |lamps: &str| rendered(&bank("altitude_m = 60, elevation_deg = -10", lamps), None);
    let ([marched, between, _], [dark, ..]) = (with(&lamps), with(""));
    assert_interpolated([&marched, &between], 0.5, &dark);
}

/// Posts of three pixels before each other, and between them the sky.
fn posts(scene: &Scene) -> Foreground {
    let distance_m = |pixel: usize| {
        let [column, row] = [pixel % SIZE[0], pixel / SIZE[0]];
        let post = column / 3;
        let is_post = post % 3 > 0 && row > 20 + 7 * (post % 5);
        if is_post { 20.0 * 1.13_f32.powi((post * 7 % 31) as i32) } else { f32::INFINITY }
    };
    let depth: Vec<f32> = (0..SIZE[0] * SIZE[1]).map(distance_m).collect();
    Foreground::new(&scene.camera, Depth::Distance, &depth, None).unwrap()
}

#[test]
fn media_before_edges_of_what_stands_there_are_what_marching_each_pixel_finds() {
    let scene = bank("altitude_m = 2, elevation_deg = 3", "");
    let [marched, between, careless] = rendered(&scene, Some(&posts(&scene)));
    // Nearly every cell has edges of posts.
    assert_interpolated([&marched, &between], 0.5, &careless);
    assert_eq!(between.timings.plan.decision("surface_cells"), Some(Decision::Run));
}

#[test]
fn surfaces_at_any_distance_have_media_before_them() {
    // A hand's breadth away, on a froxel's distance, beyond the last, and where space begins.
    let distances_m = [0.05, 12.0, 24.0, 900.0, 3e4, 3e8];
    let scene = bank("altitude_m = 30, elevation_deg = 3", "");
    let at = |pixel: usize| {
        if pixel.is_multiple_of(2) { distances_m[pixel % SIZE[0] * distances_m.len() / SIZE[0]] } else { f32::INFINITY }
    };
    let depth: Vec<f32> = (0..SIZE[0] * SIZE[1]).map(at).collect();
    let [marched, between, careless] =
        rendered(&scene, Some(&Foreground::new(&scene.camera, Depth::Distance, &depth, None).unwrap()));
    assert!(between.frame.radiance.iter().flatten().all(|radiance| radiance.is_finite()));
    assert_interpolated([&marched, &between], 0.9, &careless);
}

#[test]
fn froxels_are_kept_before_a_hosts_surfaces_alone() {
    let froxels = |rendered: &Rendered| rendered.timings.plan.decision("surface_cells");
    let scene = bank("altitude_m = 2, elevation_deg = 3", "");
    assert_eq!(froxels(&rendered(&scene, None)[1]), Some(Decision::Skip));
    let hills =
        bank("altitude_m = 400, elevation_deg = -5", "[terrain]\nheight_m = 300\nwavelength_m = 3000\nseed = 1\n");
    assert_eq!(froxels(&rendered(&hills, None)[1]), Some(Decision::Skip));
    let patchy = bank("altitude_m = 2, elevation_deg = 3", "noise = { size_m = 100, strength = 0.5 }\n");
    assert_eq!(froxels(&rendered(&patchy, Some(&posts(&patchy)))[1]), Some(Decision::Skip));
}
