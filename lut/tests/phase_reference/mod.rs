//! The tables in `reference/` as phase functions.
#![allow(dead_code, reason = "each test file uses its part")]

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
            tables.push(MieTable { name: row[0].to_owned(), points: Vec::new(), mean_cosine: number(5) });
        }
        tables.last_mut().unwrap().points.push((number(3), number(4)));
    }
    tables
}
