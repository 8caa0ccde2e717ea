//! Reflectance of homogeneous slabs by each method, beside that of a discrete-ordinate code.

use std::error::Error;
use std::f64::consts::TAU;

use glam::DVec3;
use welkin::passes::ordinates::coefficients::{band_attenuations, forward_share};
use welkin_lut::PhaseFunction;

use super::field::{LightField, Solver};
use super::fit::FITTED_OCTAVES;
use super::methods::band_phases;
use super::phase::scaled;

/// Steps through the slab, and cells of the field.
const STEPS: usize = 800;
const ROWS: u32 = 64;
/// Cosines and azimuths of the views.
const COSINES: usize = 24;
const AZIMUTHS: usize = 24;

#[derive(serde::Deserialize)]
struct Row {
    tau: f64,
    ssa: f64,
    phase: String,
    mu0: f64,
    surface_albedo: f64,
    #[serde(rename = "R_diffuse")]
    reflectance: f64,
}

/// A slab under a sun.
struct Slab<'a> {
    depth: f64,
    mu0: f64,
    phase: &'a PhaseFunction,
}

/// Prints all open rows of thick, conservative slabs over black ground.
pub fn run() -> Result<(), Box<dyn Error>> {
    let mut solver = Solver::new()?;
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.85 };
    println!("   tau   mu0  truth single oct-sun oct-both oct-fit  S16");
    for row in open_rows()? {
        let slab = Slab { depth: row.tau, mu0: row.mu0, phase: &phase };
        let toward_sun = DVec3::new((1.0 - row.mu0 * row.mu0).sqrt(), 0.0, row.mu0);
        let field = solver.slab(row.tau, toward_sun, &phase, ROWS)?;
        let found = [
            slab.reflectance(|nu| octaves(&phase, nu, 1, [1.0; 3], true), None),
            slab.reflectance(|nu| octaves(&phase, nu, 8, [0.5; 3], false), None),
            slab.reflectance(|nu| octaves(&phase, nu, 8, [0.5; 3], true), None),
            slab.reflectance(|nu| octaves(&phase, nu, 4, FITTED_OCTAVES, true), None),
            slab.reflectance(|nu| bands(&phase, nu), Some(&field)),
        ];
        let text: Vec<_> = found.iter().map(|r| format!("{r:.4}")).collect();
        println!("{:6} {:5} {:.4} {}", row.tau, row.mu0, row.reflectance, text.join(" "));
    }
    Ok(())
}

/// Prints what is wrong with the reflectances of thick, conservative slabs, in percent, where the field has few rows of
/// cells.
pub fn in_rows(solver: &mut Solver, phase: &PhaseFunction, rows: &[u32]) -> Result<(), Box<dyn Error>> {
    println!("   tau   mu0  truth  error in percent with so many rows: {rows:?}");
    for row in open_rows()? {
        if row.tau < 4.0 || row.mu0 < 0.15 {
            continue;
        }
        let slab = Slab { depth: row.tau, mu0: row.mu0, phase };
        let toward_sun = DVec3::new((1.0 - row.mu0 * row.mu0).sqrt(), 0.0, row.mu0);
        let mut error = |&rows: &u32| -> Result<String, Box<dyn Error>> {
            let field = solver.slab(row.tau, toward_sun, phase, rows)?;
            let found = slab.reflectance(|nu| bands(phase, nu), Some(&field));
            Ok(format!("{:6.1}", 100.0 * (found / row.reflectance - 1.0)))
        };
        let errors: Vec<_> = rows.iter().map(&mut error).collect::<Result<_, _>>()?;
        println!("{:6} {:5} {:.4} {}", row.tau, row.mu0, row.reflectance, errors.join(" "));
    }
    Ok(())
}

/// The open rows of conservative slabs over black ground.
fn open_rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let rows: Vec<Row> = csv::Reader::from_path("tests/reference/slab.csv")?.deserialize().collect::<Result<_, _>>()?;
    let is_ours = |row: &Row| row.ssa == 1.0 && row.surface_albedo == 0.0 && row.phase == "hg_0.85";
    Ok(rows.into_iter().filter(is_ours).collect())
}

/// A phase function with the shares of the depths to the sun and along the view.
type Term = (f64, [f64; 2]);

fn octaves(phase: &PhaseFunction, nu: f64, count: i32, [a, b, c]: [f64; 3], view: bool) -> Vec<Term> {
    let octave = |i: i32| (a.powi(i) * scaled(phase, c.powi(i), nu), [b.powi(i), if view { b.powi(i) } else { 1.0 }]);
    (0..count).map(octave).collect()
}

fn bands(phase: &PhaseFunction, nu: f64) -> Vec<Term> {
    let shares = band_attenuations(phase, 1.0);
    band_phases(phase, nu).into_iter().zip(shares).map(|(p, share)| (p, [share; 2])).collect()
}

impl Slab<'_> {
    /// Upward flux at the top over the sun's.
    fn reflectance(&self, terms: impl Fn(f64) -> Vec<Term>, field: Option<&LightField>) -> f64 {
        let mut flux = 0.0;
        for i in 0..COSINES {
            let mu = (i as f64 + 0.5) / COSINES as f64;
            for j in 0..AZIMUTHS {
                let (sine, azimuth) = ((1.0 - mu * mu).sqrt(), TAU * (j as f64 + 0.5) / AZIMUTHS as f64);
                // Views look down, against the light that leaves.
                let view = -DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), mu);
                flux += mu * self.radiance(view, &terms, field) * TAU / (COSINES * AZIMUTHS) as f64;
            }
        }
        flux / self.mu0
    }

    /// Radiance from above, 1/sr.
    fn radiance(&self, view: DVec3, terms: &impl Fn(f64) -> Vec<Term>, field: Option<&LightField>) -> f64 {
        let toward_sun = DVec3::new((1.0 - self.mu0 * self.mu0).sqrt(), 0.0, self.mu0);
        let (terms, mu) = (terms(view.dot(toward_sun)), -view.z);
        let mut sum = 0.0;
        for (phase, [sun, seen]) in terms {
            let rate = sun / self.mu0 + seen / mu;
            sum += phase / mu * -f64::exp_m1(-rate * self.depth) / rate;
        }
        if let Some(field) = field {
            let q = 1.0 - forward_share(self.phase);
            let step = self.depth / STEPS as f64;
            for i in 0..STEPS {
                let below = (i as f64 + 0.5) * step;
                let place_m = field.column_m(1.0 - below / self.depth);
                let seen = (-q * below / mu).exp() * q * step / mu;
                sum += seen * field.scattered(place_m, view, (-q * below / self.mu0).exp())[0];
            }
        }
        sum
    }
}
