//! The tables in `reference/` as phase functions.
#![allow(dead_code, reason = "each test file uses its part")]

use std::f64::consts::PI;
use std::sync::Arc;

use welkin_lut::{PhaseFunction, TabulatedPhase};

/// One function of phase.csv.
pub struct ReferenceFunction {
    pub phase: PhaseFunction,
    /// (cos θ, P in 1/sr).
    pub points: Vec<(f64, f64)>,
    pub mean_cosine: f64,
}

/// One size distribution of mie.csv.
pub struct MieTable {
    pub name: String,
    pub effective_radius_um: f64,
    /// (θ in degrees, P in 1/sr).
    pub points: Vec<(f64, f64)>,
    pub mean_cosine: f64,
}

impl MieTable {
    /// The table as a scene would give it.
    pub fn phase(&self) -> TabulatedPhase {
        let rows: String = self.points.iter().map(|(theta, p)| format!("{theta},{p}\n")).collect();
        TabulatedPhase::from_csv(&format!("theta_deg,phase_per_sr\n{rows}")).unwrap()
    }

    /// The same as a phase function.
    pub fn phase_function(&self) -> PhaseFunction {
        PhaseFunction::Tabulated(Arc::new(self.phase()))
    }
}

fn records(text: &str) -> Vec<csv::StringRecord> {
    csv::Reader::from_reader(text.as_bytes()).records().map(Result::unwrap).collect()
}

/// Every function of phase.csv.
pub fn reference_functions() -> Vec<ReferenceFunction> {
    let mut functions: Vec<ReferenceFunction> = Vec::new();
    for row in records(include_str!("../reference/phase.csv")) {
        let number = |column: usize| row[column].parse::<f64>().unwrap_or(f64::NAN);
        let (p1, p2, weight) = (number(1), number(2), number(3));
        let phase = match &row[0] {
            "isotropic" => PhaseFunction::Isotropic,
            "rayleigh" => PhaseFunction::Rayleigh,
            "hg" => PhaseFunction::HenyeyGreenstein { g: p1 },
            "double_hg" => PhaseFunction::DoubleHenyeyGreenstein { weight, g1: p1, g2: p2 },
            "schlick" => PhaseFunction::Schlick { k: p1 },
            "cornette_shanks" => PhaseFunction::CornetteShanks { g: p1 },
            "draine" => PhaseFunction::Draine { g: p1, alpha: p2 },
            "hg_draine" => PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: p1 },
            family => panic!("unknown family {family}"),
        };
        if functions.last().is_none_or(|last| last.phase != phase) {
            functions.push(ReferenceFunction { phase, points: Vec::new(), mean_cosine: number(7) });
        }
        functions.last_mut().unwrap().points.push((number(5), number(6)));
    }
    functions
}

/// Every size distribution of mie.csv.
pub fn mie_tables() -> Vec<MieTable> {
    let mut tables: Vec<MieTable> = Vec::new();
    for row in records(include_str!("../reference/mie.csv")) {
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        if tables.last().is_none_or(|last| last.name != row[0]) {
            tables.push(MieTable {
                name: row[0].to_owned(),
                effective_radius_um: number(1),
                points: Vec::new(),
                mean_cosine: number(5),
            });
        }
        tables.last_mut().unwrap().points.push((number(3), number(4)));
    }
    tables
}

/// A band of scattering angles, degrees.
#[derive(Clone, Copy)]
pub struct Band {
    pub from_deg: f64,
    pub to_deg: f64,
}

impl Band {
    pub const SPHERE: Self = Self { from_deg: 0.0, to_deg: 180.0 };

    /// ∫ f(cos θ) dω over the band, by the midpoint rule in steps of 1/100 of a degree or less.
    pub fn integral(self, f: impl Fn(f64) -> f64) -> f64 {
        let steps = ((self.to_deg - self.from_deg) * 100.0).ceil();
        let step = (self.to_deg - self.from_deg).to_radians() / steps;
        let angle = |i: usize| self.from_deg.to_radians() + (i as f64 + 0.5) * step;
        2.0 * PI * step * (0..steps as usize).map(|i| f(angle(i).cos()) * angle(i).sin()).sum::<f64>()
    }
}

/// √(mean of (ln P/P₀)²) over the directions of a band, each direction weighing the same.
pub fn root_mean_square_log_ratio(phase: &PhaseFunction, reference: &PhaseFunction, band: Band) -> f64 {
    let square = |c: f64| (phase.value(c) / reference.value(c)).ln().powi(2);
    (band.integral(square) / band.integral(|_| 1.0)).sqrt()
}
