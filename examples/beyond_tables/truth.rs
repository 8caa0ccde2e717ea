//! The path tracer's answers, kept in files whose names say what was asked, so that only what is new is traced.

use std::fs;
use std::path::Path;

use welkin::probe::{Orders, Ray, RayRadiance};
use welkin::reference::{Effort, probe};
use welkin::scene::Scene;

/// Walks of the first round, from whose standard error the number still needed is estimated.
const PILOT_WALKS: u64 = 1 << 11;
/// Fewest walks of a result: with fewer, the means of batches are too skewed for a standard error to mean much.
const FEWEST_WALKS: u64 = 1 << 12;
/// Most walks of a ray, however dark it is.
const MOST_WALKS: u64 = 1 << 17;
const PILOT_SEED: u64 = 1;
const SEED: u64 = 2;

/// Answers to rays with a standard error of about `target` of the radiance, from the directory if they are there.
pub fn answers(directory: &Path, scene: &Scene, rays: &[Ray], target: f64) -> Vec<RayRadiance> {
    let asked = format!("{:?} {:?} {:?} {rays:?} {target} {MOST_WALKS}", scene.planet, scene.medium, scene.lights);
    let file = directory.join(format!("{:08x}-{}.csv", crc32fast::hash(asked.as_bytes()), rays.len()));
    if let Ok(text) = fs::read_to_string(&file) {
        return text.lines().map(parse).collect();
    }
    eprintln!("tracing {} rays for {}", rays.len(), file.display());
    let answers = trace(scene, rays, target);
    let text: String = answers.iter().map(line).collect();
    // Written beside and renamed: an interrupted run leaves no half file.
    let part = file.with_extension("tmp");
    let written = fs::create_dir_all(directory).and_then(|()| fs::write(&part, text));
    written.and_then(|()| fs::rename(&part, &file)).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    answers
}

/// A pilot says how many walks each ray needs; rays that need about as many go together, and the pilot is thrown away.
fn trace(scene: &Scene, rays: &[Ray], target: f64) -> Vec<RayRadiance> {
    let pilot = probe(scene, rays, Orders::All, Effort::Walks(PILOT_WALKS), PILOT_SEED);
    let needed = |answer: &RayRadiance| {
        let excess = (0..3).map(|band| relative_error(answer, band) / target).fold(0.0, f64::max);
        ((PILOT_WALKS as f64 * excess * excess) as u64).next_power_of_two().clamp(FEWEST_WALKS, MOST_WALKS)
    };
    let walks: Vec<u64> = pilot.iter().map(needed).collect();
    let mut answers = pilot;
    let mut steps = walks.clone();
    steps.sort_unstable();
    steps.dedup();
    for step in steps {
        let chosen: Vec<usize> = (0..rays.len()).filter(|&i| walks[i] == step).collect();
        let group: Vec<Ray> = chosen.iter().map(|&i| rays[i]).collect();
        eprintln!("  {} rays with {step} walks each", group.len());
        let traced = probe(scene, &group, Orders::All, Effort::Walks(step), SEED);
        chosen.into_iter().zip(traced).for_each(|(i, answer)| answers[i] = answer);
    }
    answers
}

/// One standard error over the radiance; none where nothing shines.
pub fn relative_error(answer: &RayRadiance, band: usize) -> f64 {
    if answer.radiance[band] > 0.0 { answer.standard_error[band] / answer.radiance[band] } else { 0.0 }
}

fn line(answer: &RayRadiance) -> String {
    let all = [answer.radiance, answer.transmittance, answer.standard_error].concat();
    let cells: Vec<String> = all.iter().map(|value| format!("{value:e}")).collect();
    format!("{}\n", cells.join(","))
}

fn parse(line: &str) -> RayRadiance {
    let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("the file is our own")).collect();
    let bands = |start: usize| [cells[start], cells[start + 1], cells[start + 2]];
    RayRadiance { radiance: bands(0), transmittance: bands(3), standard_error: bands(6) }
}
