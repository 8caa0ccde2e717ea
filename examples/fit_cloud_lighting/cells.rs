//! What the size of the cells costs: slabs in few rows against a discrete-ordinate code, and voxel clouds, none of them
//! fitted, in ever wider cells against the path tracer.

use std::error::Error;

use welkin::passes::ordinates::Directions;
use welkin::passes::ordinates::coefficients::band_attenuations;
use welkin_lut::PhaseFunction;

use super::field::{Method, Solver};
use super::fields::{Cloud, Kind};
use super::methods;
use super::samples::Samples;
use super::score::{CLOUDY, Score};
use super::slabs;
use super::truth::truth;
use super::views::{View, suns};
use super::{grid_field, truth_folder};

const CLOUDS: [(Kind, u32); 4] = [(Kind::Cumulus, 3), (Kind::Stratocumulus, 3), (Kind::Congestus, 3), (Kind::Tower, 3)];
const VIEWS: [View; 4] = [View::Side, View::ToSun, View::Above, View::Below];
/// What the grid alone has to find, Henyey and Greenstein's function, and droplets.
const PHASES: [PhaseFunction; 3] = [
    PhaseFunction::Isotropic,
    PhaseFunction::HenyeyGreenstein { g: 0.85 },
    PhaseFunction::HenyeyGreensteinDraine { droplet_diameter_um: 20.0 },
];
const ROWS: [u32; 5] = [2, 4, 8, 16, 64];

/// Edges of cells, m.
pub fn run(solver: &mut Solver, walks: u64, cells_m: &[f64]) -> Result<(), Box<dyn Error>> {
    PHASES.iter().try_for_each(|phase| clouds(solver, phase, walks, cells_m))?;
    slabs::in_rows(solver, &PHASES[1], &ROWS)
}

fn clouds(solver: &mut Solver, phase: &PhaseFunction, walks: u64, cells_m: &[f64]) -> Result<(), Box<dyn Error>> {
    println!("{phase:?}, cells of {cells_m:?} m");
    let mut all = vec![[Score::default(); 2]; cells_m.len()];
    for (kind, seed) in CLOUDS {
        let cloud = Cloud::new(kind, seed);
        let grid = grid_field(&cloud)?;
        let mut sums = vec![[Score::default(); 2]; cells_m.len()];
        let views = VIEWS.map(|view| Samples::gather(&grid, view));
        let truths: Vec<_> =
            VIEWS.iter().map(|&view| truth(truth_folder(), &cloud, phase, view, walks)).collect::<Result<_, _>>()?;
        for (sun, toward) in suns().into_iter().enumerate() {
            for (of_cell, &cell_m) in sums.iter_mut().zip(cells_m) {
                let method = Method { directions: Directions::Sixteen, cell_m };
                let field = solver.solve(&grid, method, phase, toward)?;
                for (samples, truth) in views.iter().zip(&truths) {
                    let bands = methods::bands(samples, sun, phase, band_attenuations(phase, 1.0));
                    let picture = methods::sum(bands, &methods::field(samples, sun, &field));
                    let score = Score::new(&picture, truth, sun, &samples.opacity, CLOUDY);
                    // Views that the sun shines on, and those against it.
                    let side = usize::from(methods::nu(samples, sun) > 0.0);
                    of_cell[side] = of_cell[side].and(score);
                }
            }
        }
        print(&cloud.name(), &sums);
        for (all, sums) in all.iter_mut().flatten().zip(sums.iter().flatten()) {
            *all = all.and(*sums);
        }
    }
    print("all", &all);
    Ok(())
}

fn print(name: &str, scores: &[[Score; 2]]) {
    let text: Vec<_> = scores.iter().map(|[front, back]| format!("{front} {back}")).collect();
    println!("| {name} | {:.2} | {} |", scores[0][0].noise(), text.join(" | "));
}
