//! How large the planet is.

use super::Case;

pub fn cases() -> Vec<Case> {
    let planet = |name: &str, radius_m: &str| Case::new(name, format!("planet.radius_m = {radius_m}"));
    vec![
        planet("planet of 70 000 km", "7e7").quick(),
        planet("planet of 10 km under 100 km of air", "1e4"),
        planet("planet of 100 m under 100 km of air", "100"),
        Case::new(
            "planet of 100 m under 10 m of air",
            "planet = { radius_m = 100, atmosphere_height_m = 10 }\n[[medium]]\nname = \"matter\"\n\
             scattering_per_m = [0.05, 0.1, 0.2]\nphase = \"rayleigh\"\nprofile.exponential.scale_height_m = 1\n",
        ),
        Case::new("air 1 m high", "planet.atmosphere_height_m = 1\ncamera.altitude_m = 0.5"),
    ]
}
