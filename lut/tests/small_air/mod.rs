//! An Earth with tables small enough for tests.

use welkin_lut::bake::{Air, BakeSettings, Baked, ScatteringSize, SourceGrid};
use welkin_lut::pack::{Description, Sun};
use welkin_lut::{Constituent, DensityProfile, Medium, PhaseFunction, Planet};

/// Tables of a few kilobytes.
pub const SMALL: BakeSettings = BakeSettings {
    nodes_per_leg: 6,
    optical_depth_size: [40, 16],
    source_size: [16, 8],
    source_grid: SourceGrid { ground: 2, low: 3, high: 3, azimuths: 4 },
    orders: 3,
    scattering: ScatteringSize { azimuths: 4, suns: 12, elevations: 14, altitudes: 6 },
};

/// Hillaire's numbers for the Earth.
#[allow(dead_code)]
pub fn earth() -> Air {
    let exponential = |name: &str, scattering_per_m, absorption_per_m, scale_height_m, phase| Constituent {
        name: name.to_owned(),
        scattering_per_m,
        absorption_per_m,
        emission_per_m: [0.0; 3],
        profile: DensityProfile::Exponential { scale_height_m },
        phase,
    };
    let rayleigh = [5.802e-6, 13.558e-6, 33.1e-6];
    let ozone = Constituent {
        profile: DensityProfile::Tent { centre_m: 25e3, half_width_m: 15e3 },
        ..exponential("ozone", [0.0; 3], [0.65e-6, 1.881e-6, 0.085e-6], 1.0, PhaseFunction::Isotropic)
    };
    let haze = PhaseFunction::HenyeyGreenstein { g: 0.8 };
    let constituents = vec![
        exponential("molecules", rayleigh, [0.0; 3], 8000.0, PhaseFunction::Rayleigh),
        exponential("haze", [3.996e-6; 3], [0.444e-6; 3], 1200.0, haze),
        ozone,
    ];
    let planet = Planet { radius_m: 6_360_000.0, atmosphere_height_m: 100_000.0, ground_albedo: [0.3, 0.2, 0.1] };
    Air::new(&planet, &Medium { constituents }).unwrap()
}

/// What a pack of it says.
#[allow(dead_code)]
pub fn description(baked: &Baked) -> Description {
    Description {
        scene: "test".to_owned(),
        generator: "test".to_owned(),
        backend: "cpu".to_owned(),
        scatterers: baked.air().scatterers().iter().map(|c| c.name.clone()).collect(),
        wavelengths_nm: [680.0, 550.0, 440.0],
        sun: Some(Sun { irradiance: [1.5, 1.9, 1.9], angular_radius_rad: 0.004675 }),
        left_out: Vec::new(),
    }
}
