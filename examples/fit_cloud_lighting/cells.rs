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
const CELLS_M: [f64; 4] = [40.0, 64.0, 128.0, 256.0];
const ROWS: [u32; 5] = [2, 4, 8, 16, 64];

pub fn run(solver: &mut Solver, walks: u64) -> Result<(), Box<dyn Error>> {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.85 };
    slabs::in_rows(solver, &phase, &ROWS)?;
    let mut all = [[Score::default(); 2]; CELLS_M.len()];
    for (kind, seed) in CLOUDS {
        let cloud = Cloud::new(kind, seed);
        let grid = grid_field(&cloud)?;
        let mut sums = [[Score::default(); 2]; CELLS_M.len()];
        let views = VIEWS.map(|view| Samples::gather(&grid, view));
        let truths: Vec<_> =
            VIEWS.iter().map(|&view| truth(truth_folder(), &cloud, &phase, view, walks)).collect::<Result<_, _>>()?;
        for (sun, toward) in suns().into_iter().enumerate() {
            for (of_cell, &cell_m) in sums.iter_mut().zip(&CELLS_M) {
                let method = Method { directions: Directions::Sixteen, cell_m };
                let field = solver.solve(&grid, method, &phase, toward)?;
                for (samples, truth) in views.iter().zip(&truths) {
                    let bands = methods::bands(samples, sun, &phase, band_attenuations(&phase, 1.0));
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

fn print(name: &str, scores: &[[Score; 2]; CELLS_M.len()]) {
    let text: Vec<_> = scores.iter().map(|[front, back]| format!("{front} {back}")).collect();
    println!("| {name} | {:.2} | {} |", scores[0][0].noise(), text.join(" | "));
}
