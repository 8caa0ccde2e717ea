//! What shines, and where it stands.

use super::{Bound, Case};

pub fn cases() -> Vec<Case> {
    let sun = |name: &str, elevation_deg: &str| Case::new(name, format!("sun.elevation_deg = {elevation_deg}"));
    vec![
        sun("sun at the zenith, azimuth undefined", "90").quick(),
        sun("sun 0.5° up", "0.5"),
        sun("sun at 90°", "0"),
        sun("sun 0.5° down", "-0.5").bound(Bound::Twilight),
        sun("sun 6° down", "-6").bound(Bound::Twilight),
        sun("sun 18° down", "-18").bound(Bound::Twilight),
        sun("sun at the nadir", "-90").bound(Bound::Twilight),
        Case::new("no light", "sun.irradiance = 0"),
        Case::new("eight lights", eight()),
        // The sun's disc above the air: 1.9 W/(m² nm) over 6.8e-5 sr.
        Case::new(
            "a disc of 1.6e9 cd/m²",
            "sun.irradiance = [1.5, 1.88, 1.83]\nsun.angular_radius_deg = 0.2667\nsun.limb_darkening = true",
        ),
        Case::new("irradiance at the end of its range", "sun.irradiance = 1e12"),
        Case::new("irradiance 1e-12", "sun.irradiance = 1e-12"),
        Case::new("a disc of 45°", "sun.angular_radius_deg = 45").bound(Bound::LawsOnly("the disc fills the picture")),
    ]
}

/// The sun and seven more, all around and two of them below the horizon.
fn eight() -> String {
    let light = |i: i32| {
        format!(
            "[[light.directional]]\nname = \"{i}\"\nelevation_deg = {}\nazimuth_deg = {}\nirradiance = [{}, 0.5, {}]\n",
            80 - 12 * i,
            45 * i,
            0.1 * f64::from(i),
            1.0 / f64::from(i)
        )
    };
    (1..=7).map(light).collect()
}
