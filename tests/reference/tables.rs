//! Readers of the tables beside this file, and the atmosphere they belong to.
#![allow(dead_code)]

use std::collections::HashMap;
use std::path::Path;

use welkin::reference::{Emitter, Shape, World};
use welkin_lut::{Constituent, DensityProfile, PhaseFunction};

/// One line of a table: cells by the name of their column.
pub struct Row(HashMap<String, String>);

impl Row {
    /// Whether there is such a column.
    pub fn has(&self, column: &str) -> bool {
        self.0.contains_key(column)
    }

    /// A cell as text.
    pub fn text(&self, column: &str) -> &str {
        &self.0[column]
    }

    /// A cell as a number.
    pub fn number(&self, column: &str) -> f64 {
        let text = self.text(column);
        text.parse().unwrap_or_else(|_| panic!("column {column}: '{text}' is not a number"))
    }

    /// All cells, for messages.
    pub fn line(&self) -> String {
        let mut cells: Vec<String> = self.0.iter().map(|(name, value)| format!("{name}={value}")).collect();
        cells.sort();
        cells.join(" ")
    }

    /// The index of the spectral band that the row is for.
    pub fn band(&self) -> usize {
        ["R", "G", "B"].iter().position(|name| *name == self.text("band")).expect("band is R, G or B")
    }
}

/// All rows of `tests/reference/NAME`.
pub fn read(name: &str) -> Vec<Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference").join(name);
    let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    reader.deserialize().map(|row| Row(row.unwrap_or_else(|e| panic!("{name}: {e}")))).collect()
}

/// The tables' Earth: variant A has haze with an absorption of 4.40e-6 per metre, B with an extinction of 4.44e-6.
pub fn earth(variant: &str, ground_albedo: f64) -> World {
    let haze_absorption = if variant == "A" { 4.40e-6 } else { 0.444e-6 };
    let constituent = |name: &str, scattering, absorption, profile, phase| Constituent {
        name: name.into(),
        scattering_per_m: scattering,
        absorption_per_m: absorption,
        emission_per_m: [0.0; 3],
        profile,
        phase,
    };
    let constituents = [
        constituent(
            "air",
            [5.802e-6, 13.558e-6, 33.1e-6],
            [0.0; 3],
            DensityProfile::Exponential { scale_height_m: 8000.0 },
            PhaseFunction::Rayleigh,
        ),
        constituent(
            "haze",
            [3.996e-6; 3],
            [haze_absorption; 3],
            DensityProfile::Exponential { scale_height_m: 1200.0 },
            PhaseFunction::HenyeyGreenstein { g: 0.8 },
        ),
        constituent(
            "ozone",
            [0.0; 3],
            [0.650e-6, 1.881e-6, 0.085e-6],
            DensityProfile::Tent { centre_m: 25_000.0, half_width_m: 15_000.0 },
            PhaseFunction::Isotropic,
        ),
    ];
    let shape = Shape::Sphere { radius_m: 6.36e6, height_m: 1e5 };
    let mut world = World::stratified(shape, [ground_albedo; 3], &constituents);
    world.lights.push(Emitter::Beam { toward: glam::DVec3::Z, irradiance: [1.0; 3] });
    world
}

/// The tables' phase functions by name.
pub fn phase(name: &str) -> PhaseFunction {
    match name.split_once('_') {
        Some(("hg", g)) => PhaseFunction::HenyeyGreenstein { g: g.parse().expect("g is a number") },
        _ if name == "rayleigh" => PhaseFunction::Rayleigh,
        _ if name == "isotropic" => PhaseFunction::Isotropic,
        _ => panic!("unknown phase function {name}"),
    }
}

/// A homogeneous slab one metre thick over a surface that reflects `surface_albedo`, under a beam of irradiance 1
/// from the zenith cosine `mu0`, travelling towards the north.
pub fn slab_world(tau: f64, ssa: f64, phase: PhaseFunction, mu0: f64, surface_albedo: f64) -> World {
    let constituent = Constituent {
        name: "slab".into(),
        scattering_per_m: [tau * ssa; 3],
        absorption_per_m: [tau * (1.0 - ssa); 3],
        emission_per_m: [0.0; 3],
        profile: DensityProfile::Layer { bottom_m: 0.0, top_m: 1.0 },
        phase,
    };
    let mut world = World::stratified(Shape::Plane { height_m: 1.0 }, [surface_albedo; 3], &[constituent]);
    let toward = glam::DVec3::new(0.0, -(1.0 - mu0 * mu0).sqrt(), mu0);
    world.lights.push(Emitter::Beam { toward, irradiance: [1.0; 3] });
    world
}

/// Where a row of `slab_radiance.csv` looks from and in which direction, in the world of [`slab_world`].
pub fn slab_ray(row: &Row) -> (glam::DVec3, glam::DVec3) {
    let (mu, azimuth) = (row.number("mu_view"), row.number("rel_azimuth_deg").to_radians());
    let up = row.text("side") == "top_up";
    // The light of the beam and, at azimuth 0, of the row travel towards the north.
    let sine = (1.0 - mu * mu).max(0.0).sqrt();
    let travels = glam::DVec3::new(sine * azimuth.sin(), sine * azimuth.cos(), if up { mu } else { -mu });
    (glam::DVec3::new(0.0, 0.0, if up { 1.0 } else { 0.0 }), -travels)
}
