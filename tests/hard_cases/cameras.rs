//! Where the camera stands and looks.

use super::{Bound, Case};

const MIXED: &str = "pixels on the horizon mix both sides";

pub fn cases() -> Vec<Case> {
    let at = |name: &str, altitude_m: &str| Case::new(name, format!("camera.altitude_m = {altitude_m}"));
    let looking = |name: &str, camera: &str| Case::new(name, format!("[camera]\n{camera}"));
    vec![
        at("camera 100 m below the ground", "-100"),
        at("camera on the ground", "0"),
        at("camera 1 mm up", "0.001").quick(),
        at("camera 2 m up", "2").quick(),
        at("camera one f32 below the top", "99999.9921875"),
        at("camera one f64 below the top", "99999.99999999999"),
        at("camera at the top", "100000"),
        at("camera one f64 above the top", "100000.00000000001"),
        at("camera one f32 above the top", "100000.0078125"),
        looking("camera at 400 km", "altitude_m = 4e5\nelevation_deg = -40").quick(),
        looking("camera on the Moon", "altitude_m = 3.844e8\nelevation_deg = -90\nvertical_field_of_view_deg = 1.2"),
        looking("view straight up", "elevation_deg = 90\nvertical_field_of_view_deg = 1"),
        looking("view straight down", "altitude_m = 1000\nelevation_deg = -90\nvertical_field_of_view_deg = 1"),
        horizon("view one f32 above the horizon", 1.0),
        horizon("view on the horizon", 0.0),
        horizon("view one f32 below the horizon", -1.0),
        looking("view into the light", "elevation_deg = 30\nazimuth_deg = 200\nvertical_field_of_view_deg = 0.1")
            .bound(Bound::LawsOnly("all pixels lie within 0.1° of a parallel beam")),
        looking(
            "view away from the light",
            "altitude_m = 1000\nelevation_deg = -30\nazimuth_deg = 20\nvertical_field_of_view_deg = 0.1",
        ),
    ]
}

/// One pixel along the horizon from 2 m, and so many steps of an f32 zenith angle (1.2e-7 rad) above it.
fn horizon(name: &str, steps: f64) -> Case {
    let dip_rad = (2.0_f64 * (2.0 * 6.36e6 + 2.0)).sqrt().atan2(6.36e6);
    let elevation_deg = (steps * f64::from(f32::EPSILON) - dip_rad).to_degrees();
    let camera =
        format!("elevation_deg = {elevation_deg:e}\nvertical_field_of_view_deg = 0.001\nwidth = 3\nheight = 3");
    Case::new(name, format!("[camera]\n{camera}")).bound(Bound::LawsOnly(MIXED))
}
