//! Every method on every cloud, for Henyey-Greenstein droplets.

use std::error::Error;

use welkin::passes::ordinates::Directions;
use welkin::passes::ordinates::coefficients::band_attenuations;
use welkin_lut::PhaseFunction;

use super::field::{LightField, Method, Solver};
use super::fields::{Cloud, Kind};
use super::fit::{FITTED, FITTED_OCTAVES};
use super::methods;
use super::samples::Samples;
use super::score::{CLOUDY, Score, THIN};
use super::truth::truth;
use super::views::{View, suns};
use super::{grid_field, truth_folder};

/// Clouds that were not fitted: other seeds, other shapes.
const OTHERS: [(Kind, u32); 5] =
    [(Kind::Cumulus, 2), (Kind::Stratocumulus, 2), (Kind::Congestus, 2), (Kind::Sphere, 0), (Kind::Cirrus, 2)];

const GRIDS: [(&str, Method); 3] = [
    ("S8, 128 m", Method { directions: Directions::Eight, cell_m: 128.0 }),
    ("S16, 128 m", Method { directions: Directions::Sixteen, cell_m: 128.0 }),
    ("S16, 64 m", Method { directions: Directions::Sixteen, cell_m: 64.0 }),
];

/// Scores of one cloud by method: [cloudy, thin].
type Scores = Vec<(String, [Score; 2])>;

pub fn run(walks: u64) -> Result<(), Box<dyn Error>> {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.85 };
    let mut solver = Solver::new()?;
    for (title, clouds) in [("fitted", &FITTED[..]), ("not fitted", &OTHERS[..])] {
        let mut all: Scores = Vec::new();
        for &(kind, seed) in clouds {
            let cloud = Cloud::new(kind, seed);
            let scores = scores(&mut solver, &cloud, &phase, walks)?;
            println!("{}, noise {:.2}", cloud.name(), scores[0].1[0].noise());
            print(&scores);
            add(&mut all, scores);
        }
        println!("all that were {title}");
        print(&all);
    }
    Ok(())
}

fn print(scores: &Scores) {
    for (name, [cloudy, thin]) in scores {
        println!("  {name:22} {cloudy}   thin {thin}");
    }
}

fn add(all: &mut Scores, scores: Scores) {
    if all.is_empty() {
        *all = scores;
        return;
    }
    for (sum, (_, [cloudy, thin])) in all.iter_mut().zip(scores) {
        sum.1 = [sum.1[0].and(cloudy), sum.1[1].and(thin)];
    }
}

fn scores(solver: &mut Solver, cloud: &Cloud, phase: &PhaseFunction, walks: u64) -> Result<Scores, Box<dyn Error>> {
    let field = grid_field(cloud)?;
    let mut fields: Vec<Vec<LightField>> = Vec::new();
    for sun in suns() {
        fields
            .push(GRIDS.iter().map(|(_, method)| solver.solve(&field, *method, phase, sun)).collect::<Result<_, _>>()?);
    }
    let mut all = Scores::new();
    for view in View::ALL {
        let truth = truth(truth_folder(), cloud, phase, view, walks)?;
        let samples = Samples::gather(&field, view);
        for (sun, fields) in fields.iter().enumerate() {
            let scored = |(name, picture): (String, Vec<f64>)| {
                let score = |range| Score::new(&picture, &truth, sun, &samples.opacity, range);
                (name, [score(CLOUDY), score(THIN)])
            };
            add(&mut all, pictures(&samples, sun, phase, fields).into_iter().map(scored).collect());
        }
    }
    Ok(all)
}

fn pictures(samples: &Samples, sun: usize, phase: &PhaseFunction, fields: &[LightField]) -> Vec<(String, Vec<f64>)> {
    let octaves = |count, numbers, view| methods::octaves(samples, sun, phase, count, numbers, view);
    let single = octaves(1, [1.0; 3], true);
    let slab = methods::sum(single.clone(), &methods::slab(samples, sun, phase));
    let mut pictures = vec![
        ("single".to_owned(), single),
        ("8 octaves, sun only".to_owned(), octaves(8, [0.5; 3], false)),
        ("8 octaves, both".to_owned(), octaves(8, [0.5; 3], true)),
        ("4 octaves, fitted".to_owned(), octaves(4, FITTED_OCTAVES, true)),
        ("single, slab / 2".to_owned(), slab),
    ];
    let bands = methods::bands(samples, sun, phase, band_attenuations(phase, 1.0));
    for ((name, _), field) in GRIDS.iter().zip(fields) {
        pictures.push((format!("bands, {name}"), methods::sum(bands.clone(), &methods::field(samples, sun, field))));
    }
    pictures
}
