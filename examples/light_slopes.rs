//! How much light in a picture's pixels is off per degree that its tables lag behind the sun: what `src/plan/lag.rs` is made of.
//!
//! `cargo run --release --example light_slopes`: for each elevation of the sun, the largest relative error of a pixel over
//! scenes, altitudes and views, when all that may lag lags by a fiftieth of a degree.

use std::collections::BTreeMap;
use std::path::Path;

use welkin::gpu::DeviceRequest;
use welkin::plan::{Outputs, Quality, Settings, Skipping};
use welkin::renderer::Renderer;
use welkin::scene::{Light, Scene};

/// A hundredth of the darkest night sky, W·m⁻²·sr⁻¹·nm⁻¹; below it nothing counts.
const DARKNESS: f64 = 1e-11;

const LAG_DEG: f64 = 0.02;

const ELEVATIONS_DEG: [i32; 14] = [0, 1, 2, 3, 5, 7, 10, 15, 20, 30, 45, 60, 75, 89];
const SCENES: [&str; 3] = ["noon", "mars", "hills"];
const ALTITUDES_M: [f64; 3] = [500.0, 12_000.0, 400_000.0];
/// Elevation of the view, and its azimuth from the sun, deg.
const VIEWS_DEG: [[f64; 2]; 5] = [[10.0, 0.0], [10.0, 100.0], [10.0, 180.0], [60.0, 90.0], [-20.0, 30.0]];

fn main() {
    let [mut exact, mut late] =
        [(); 2].map(|()| Renderer::new(&DeviceRequest::default()).unwrap_or_else(|error| panic!("{error}")));
    let lagging = Skipping { lag_share: f64::INFINITY, ..Skipping::USUAL };
    let mut worst: BTreeMap<i32, (f64, String)> = BTreeMap::new();
    for name in SCENES {
        for elevation_deg in ELEVATIONS_DEG {
            for altitude_m in ALTITUDES_M {
                for view_deg in VIEWS_DEG {
                    let place = Place { name, altitude_m, view_deg, elevation_deg: elevation_deg.into() };
                    let error = place.error_of_lag(&mut exact, &mut late, lagging);
                    let most = worst.entry(elevation_deg).or_default();
                    if error > most.0 {
                        *most = (error, format!("{name}, {altitude_m} m, view {view_deg:?}"));
                    }
                }
            }
        }
    }
    println!("elevation, deg | error per degree | where");
    for (elevation_deg, (error, place)) in worst {
        println!("{elevation_deg:3} | {:9.4} | {place}", error / LAG_DEG);
    }
}

struct Place {
    name: &'static str,
    altitude_m: f64,
    /// Elevation of the view, and its azimuth from the sun.
    view_deg: [f64; 2],
    elevation_deg: f64,
}

impl Place {
    /// The largest relative error of a pixel.
    fn error_of_lag(&self, exact: &mut Renderer, late: &mut Renderer, lagging: Skipping) -> f64 {
        let Self { name, altitude_m, view_deg: [view_deg, turn_deg], elevation_deg } = *self;
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"));
        let mut scene = Scene::read(&path).unwrap_or_else(|error| panic!("{error}"));
        (scene.camera.width, scene.camera.height, scene.camera.altitude_m) = (32, 18, altitude_m);
        scene.camera.vertical_field_of_view_rad = 70_f64.to_radians();
        scene.camera.direction.elevation_rad = view_deg.to_radians();
        let mut radiance = |renderer: &mut Renderer, elevation_deg: f64, skipping| {
            let Light::Directional(sun) = &mut scene.lights[0] else { panic!("the sun is directional") };
            sun.direction.elevation_rad = elevation_deg.to_radians();
            scene.camera.direction.azimuth_rad = sun.direction.azimuth_rad + turn_deg.to_radians();
            let settings = Settings { skipping, ..Settings::of(Quality::Low) };
            renderer
                .render(&scene, settings, Outputs::default())
                .unwrap_or_else(|error| panic!("{error}"))
                .frame
                .radiance
        };
        let now = radiance(exact, elevation_deg + LAG_DEG, Skipping::USUAL);
        radiance(late, elevation_deg, Skipping::USUAL);
        let lagged = radiance(late, elevation_deg + LAG_DEG, lagging);
        let errors = now.as_flattened().iter().zip(lagged.as_flattened());
        errors.map(|(now, lagged)| f64::from((now - lagged).abs()) / (f64::from(*now) + DARKNESS)).fold(0.0, f64::max)
    }
}
