//! The Earth of Hillaire 2020 ("A Scalable and Production Ready Sky and Atmosphere Rendering Technique", CGF 39) as his
//! code and the engines that follow it have it: Mie extinction 4.44e-6 /m, where the paper prints 4.40e-6 /m as its
//! absorption.

use welkin_lut::{Medium, PhaseFunction, Planet};

use super::{PresetSun, SOLAR_IRRADIANCE, exponential, ozone};

pub fn planet() -> Planet {
    Planet { radius_m: 6_360_000.0, atmosphere_height_m: 100_000.0, ground_albedo: [0.3; 3] }
}

pub fn medium() -> Medium {
    let forward = PhaseFunction::HenyeyGreenstein { g: 0.8 };
    let constituents = vec![
        exponential("rayleigh", [5.802e-6, 13.558e-6, 33.1e-6], [0.0; 3], 8000.0, PhaseFunction::Rayleigh),
        exponential("mie", [3.996e-6; 3], [0.444e-6; 3], 1200.0, forward),
        ozone(),
    ];
    Medium { constituents }
}

pub fn sun() -> PresetSun {
    PresetSun { irradiance: SOLAR_IRRADIANCE, angular_radius_rad: 0.004675, limb_darkening: true }
}
