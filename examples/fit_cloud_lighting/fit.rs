//! The numbers that come closest to the path tracer.

use std::error::Error;
use std::rc::Rc;

use welkin::passes::ordinates::Directions;
use welkin::passes::ordinates::coefficients::moment;
use welkin::reference::GridField;
use welkin_lut::PhaseFunction;

use super::field::{Method, Solver};
use super::fields::{Cloud, Kind};
use super::methods;
use super::phase::scaled;
use super::samples::Samples;
use super::score::{CLOUDY, Score};
use super::truth::{Truth, truth};
use super::views::{View, suns};
use super::{grid_field, truth_folder};

/// Clouds that are fitted.
pub const FITTED: [(Kind, u32); 4] =
    [(Kind::Cumulus, 1), (Kind::Broken, 1), (Kind::Stratocumulus, 1), (Kind::Tower, 1)];

/// [strength, share, asymmetry] of four octaves for Henyey-Greenstein droplets of g = 0.85, as `fit` finds them.
pub const FITTED_OCTAVES: [f64; 3] = [0.35, 0.30, 0.40];

/// Views that are fitted.
const VIEWS: [View; 3] = [View::Side, View::ToSun, View::Above];

/// The field between those that the presets solve.
const FIELD: Method = Method { directions: Directions::Sixteen, cell_m: 80.0 };

/// Degrees of the two bands that are tried.
const SHARP_DEGREES: [f64; 9] = [4.0, 5.0, 6.5, 8.0, 10.0, 13.0, 17.0, 24.0, 40.0];
const WIDE_DEGREES: [f64; 10] = [1.4, 1.7, 2.0, 2.2, 2.4, 2.65, 2.9, 3.2, 3.6, 4.2];

/// A cloud with its views.
struct Site {
    cloud: Cloud,
    grid: GridField,
    views: Vec<Rc<Samples>>,
}

/// One picture with what a fit needs of it.
struct Case {
    truth: Truth,
    samples: Rc<Samples>,
    sun: usize,
    field: Vec<f64>,
}

impl Case {
    fn score(&self, picture: &[f64]) -> Score {
        Score::new(picture, &self.truth, self.sun, &self.samples.opacity, CLOUDY)
    }
}

fn phases() -> Vec<PhaseFunction> {
    vec![
        PhaseFunction::HenyeyGreenstein { g: 0.85 },
        PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: 14.0 },
        PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: 30.0 },
        PhaseFunction::DoubleHenyeyGreenstein { weight: 0.9, g1: 0.85, g2: -0.2 },
        PhaseFunction::CornetteShanks { g: 0.8 },
    ]
}

/// RMS and energy for each pair of degrees.
type Table = Vec<Vec<Score>>;

pub fn run(walks: u64) -> Result<(), Box<dyn Error>> {
    let (mut solver, sites) = (Solver::new()?, sites()?);
    let mut together: Option<Table> = None;
    for phase in phases() {
        let cases = cases(&mut solver, &sites, &phase, walks)?;
        println!("{phase:?}: {} pictures, noise {:.2}", cases.len(), noise(&cases));
        let table = bands(&cases, &phase);
        print_best("  bands", &table);
        octaves(&cases, &phase);
        together = Some(match together {
            None => table,
            Some(sum) => added(sum, table),
        });
    }
    together.iter().for_each(|table| print_best("all phase functions: bands", table));
    Ok(())
}

fn noise(cases: &[Case]) -> f64 {
    cases.iter().fold(Score::default(), |sum, case| sum.and(case.score(&case.field))).noise()
}

fn sites() -> Result<Vec<Site>, Box<dyn Error>> {
    let site = |(kind, seed)| {
        let cloud = Cloud::new(kind, seed);
        let grid = grid_field(&cloud)?;
        let views = VIEWS.map(|view| Rc::new(Samples::gather(&grid, view))).to_vec();
        Ok(Site { cloud, grid, views })
    };
    FITTED.into_iter().map(site).collect()
}

fn cases(solver: &mut Solver, sites: &[Site], phase: &PhaseFunction, walks: u64) -> Result<Vec<Case>, Box<dyn Error>> {
    let mut cases = Vec::new();
    for Site { cloud, grid, views } in sites {
        let fields: Vec<_> =
            suns().into_iter().map(|sun| solver.solve(grid, FIELD, phase, sun)).collect::<Result<_, _>>()?;
        for samples in views {
            for (sun, solved) in fields.iter().enumerate() {
                let truth = truth(truth_folder(), cloud, phase, samples.view, walks)?;
                let field = methods::field(samples, sun, solved);
                cases.push(Case { truth, samples: samples.clone(), sun, field });
            }
        }
    }
    Ok(cases)
}

fn bands(cases: &[Case], phase: &PhaseFunction) -> Table {
    let mut table = vec![vec![Score::default(); WIDE_DEGREES.len()]; SHARP_DEGREES.len()];
    for case in cases {
        let [sharp, wide] = methods::band_phases(phase, methods::nu(&case.samples, case.sun));
        let dimmed = |degree: f64| methods::dimmed(&case.samples, case.sun, [1.0 - moment(phase, degree); 2]);
        let wide_pictures = WIDE_DEGREES.map(dimmed);
        for (row, degree) in table.iter_mut().zip(SHARP_DEGREES) {
            let mut base = case.field.clone();
            methods::add(&mut base, &dimmed(degree), sharp);
            for (score, picture) in row.iter_mut().zip(&wide_pictures) {
                let mut picture_of_both = base.clone();
                methods::add(&mut picture_of_both, picture, wide);
                *score = score.and(case.score(&picture_of_both));
            }
        }
    }
    table
}

fn added(mut sum: Table, table: Table) -> Table {
    for (a, b) in sum.iter_mut().flatten().zip(table.into_iter().flatten()) {
        *a = a.and(b);
    }
    sum
}

/// The pair of degrees with the least error, and its neighbours.
fn print_best(title: &str, table: &Table) {
    let all = || (0..SHARP_DEGREES.len()).flat_map(|i| (0..WIDE_DEGREES.len()).map(move |j| (i, j)));
    let Some((i, j)) = all().min_by(|&(a, b), &(c, d)| table[a][b].rms().total_cmp(&table[c][d].rms())) else { return };
    println!("{title}: degrees {}, {}: {}", SHARP_DEGREES[i], WIDE_DEGREES[j], table[i][j]);
    let row: Vec<_> = WIDE_DEGREES.iter().zip(&table[i]).map(|(degree, score)| format!("{degree}: {score}")).collect();
    println!("    second degree {}", row.join(", "));
    let column: Vec<_> = SHARP_DEGREES.iter().zip(table).map(|(degree, row)| format!("{degree}: {}", row[j])).collect();
    println!("    first degree {}", column.join(", "));
}

/// The best [strength, share, asymmetry] of four octaves.
fn octaves(cases: &[Case], phase: &PhaseFunction) {
    let steps = |from: f64, count: i32| (0..count).map(move |i| from + 0.05 * f64::from(i));
    let mut best = (Score::default(), [f64::NAN; 3]);
    for share in steps(0.2, 5) {
        let dimmed: Vec<[Vec<f64>; 4]> = cases
            .iter()
            .map(|case| [0, 1, 2, 3].map(|i| methods::dimmed(&case.samples, case.sun, [share.powi(i); 2])))
            .collect();
        for asymmetry in steps(0.2, 9) {
            for strength in steps(0.2, 8) {
                let mut sum = Score::default();
                for (case, dimmed) in cases.iter().zip(&dimmed) {
                    let nu = methods::nu(&case.samples, case.sun);
                    let mut picture = vec![0.0; case.field.len()];
                    for (i, light) in dimmed.iter().enumerate() {
                        let i = i as i32;
                        methods::add(&mut picture, light, strength.powi(i) * scaled(phase, asymmetry.powi(i), nu));
                    }
                    sum = sum.and(case.score(&picture));
                }
                if best.1[0].is_nan() || sum.rms() < best.0.rms() {
                    best = (sum, [strength, share, asymmetry]);
                }
            }
        }
    }
    println!("  four octaves: strength, share, asymmetry {:.2?}: {}", best.1, best.0);
}
