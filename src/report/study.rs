//! The measurements of a report: every scene with every setting, again and again.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Instant;

use super::candidate::{Breadth, Candidate, candidates};
use super::front::mark_dominated;
use super::ledger::{Entry, Header, Ledger};
use super::results::{Family, LeftOut, Point, Provenance, SceneResults, Spread, Study};
use super::sample_grid::SampleGrid;
use super::slab::slab_results;
use super::truth::{Truth, truth};
use super::{Deviation, ReportError, Uncertain};
use crate::frame::Frame;
use crate::plan::{SceneKind, SceneTraits, Settings};
use crate::reference::marching::March;
use crate::reference::picture::{CameraView, Film, Fingerprint, Observer, Outcome, Sampling, Shard, expose};
use crate::reference::{Solver, SolverError};
use crate::scene::Scene;

/// The seed of solvers that are compared with truths.
const SEED: u64 = 1;
/// The name under which a solver's time is kept.
const ALL_CORES: &str = "all cores";

/// What renders in real time. The report knows no device: whoever asks for one brings it.
pub trait Measure {
    /// Why a picture could not be rendered.
    type Error: Error + Send + Sync + 'static;

    /// Renders a scene as if nothing had been computed before.
    ///
    /// # Errors
    /// Those of the renderer.
    fn measure(&mut self, scene: &Scene, settings: Settings) -> Result<Measured, Self::Error>;
}

/// A picture with its price.
#[derive(Debug, Clone)]
pub struct Measured {
    /// Linear radiance or colour.
    pub frame: Frame,
    /// Time of each pass, ms.
    pub milliseconds: BTreeMap<String, f64>,
}

/// Who watches a study.
pub trait Watcher: Observer {
    /// So many steps are ahead.
    fn expects(&self, steps: u64);

    /// A step begins.
    fn begins(&self, what: &str);

    /// A step is done.
    fn done(&self);

    /// A picture of a scene by a preset, or its truth, for the page.
    ///
    /// # Errors
    /// Those of the disk.
    fn shows(&self, picture: &Shown) -> Result<(), ReportError>;
}

/// A picture of a study.
#[derive(Debug)]
pub struct Shown<'a> {
    /// Of which scene.
    pub scene: &'a Scene,
    /// The preset's name, or "truth".
    pub by: &'a str,
    /// Radiance or colour.
    pub frame: &'a Frame,
    /// Ours over the truth less one, in each band of each cell of the grid; none for the truth.
    pub relative: Option<Vec<[f32; 3]>>,
}

/// A scene to measure.
#[derive(Debug, Clone)]
pub struct Case {
    /// The scene.
    pub scene: Scene,
    /// Whether it was drawn at random, for the model of errors.
    pub random: bool,
    /// Most walks of its truth for each pixel.
    pub walks: u64,
    /// Relative standard error at which the truth is known well enough; none for all walks.
    pub truth_error: Option<f64>,
    /// Which settings are measured.
    pub breadth: Breadth,
    /// Walks of the path tracer as it is compared; with them the other solvers are compared too. Empty for none.
    pub solver_walks: &'static [u64],
}

/// What to measure, and where it is kept.
#[derive(Debug)]
pub struct Request {
    /// The scenes.
    pub cases: Vec<Case>,
    /// Walks of the path tracer on slabs.
    pub slab_walks: &'static [u64],
    /// How often each picture is rendered, at least once.
    pub repeats: u32,
    /// Folder of the truths.
    pub cache: PathBuf,
    /// The list of what has been measured.
    pub ledger: PathBuf,
    /// What tells this program from others, another build of it included: their measurements are not mixed.
    pub program: String,
    /// Where the numbers come from.
    pub provenance: Provenance,
}

/// A scene with its truth and what is measured on it.
struct Prepared {
    case: Case,
    fingerprint: String,
    grid: SampleGrid,
    left_out: Vec<bool>,
    truth: Truth,
    candidates: Vec<Candidate>,
}

/// Measures. Repetitions are interleaved, so that what else the machine does falls on all settings alike.
///
/// # Errors
/// [`ReportError::Interrupted`], after which the same request goes on where it was; those of scenes and disk.
pub fn study<M: Measure>(request: &Request, renderer: &mut M, watcher: &impl Watcher) -> Result<Study, ReportError> {
    let Provenance { device, driver, .. } = &request.provenance;
    let header = Header { program: request.program.clone(), device: format!("{device}, {driver}") };
    let mut ledger = Ledger::open(&request.ledger, &header)?;
    watcher.expects(request.cases.len() as u64);
    let (prepared, left_out) = prepare(request, watcher)?;
    let rounds = prepared.iter().map(|scene| scene.candidates.len() as u64).sum::<u64>() * u64::from(request.repeats);
    watcher.expects(rounds + prepared.iter().filter(|scene| !scene.case.solver_walks.is_empty()).count() as u64);
    for round in 0..request.repeats {
        for scene in &prepared {
            for candidate in &scene.candidates {
                if watcher.interrupted().load(Ordering::Relaxed) {
                    return Err(ReportError::Interrupted);
                }
                measure(scene, candidate, round, renderer, &mut ledger, watcher)?;
                watcher.done();
            }
        }
    }
    for scene in prepared.iter().filter(|scene| !scene.case.solver_walks.is_empty()) {
        solvers(scene, &mut ledger, watcher)?;
        watcher.done();
    }
    let scenes = prepared.iter().map(|scene| gather(scene, request.repeats, &ledger)).collect();
    watcher.begins("slabs");
    Ok(Study { provenance: request.provenance.clone(), scenes, slabs: slab_results(request.slab_walks), left_out })
}

fn prepare(request: &Request, watcher: &impl Watcher) -> Result<(Vec<Prepared>, Vec<LeftOut>), ReportError> {
    let (mut prepared, mut left_out) = (Vec::new(), Vec::new());
    for case in &request.cases {
        let name = &case.scene.name;
        watcher.begins(&format!("truth of {name}"));
        let grid = SampleGrid::new(&case.scene);
        match candidates(&grid.picture, &case.breadth) {
            Err(error) => left_out.push(LeftOut { scene: name.clone(), reason: error.to_string() }),
            Ok(candidates) => {
                let truth = truth(&grid.cells, case.walks, case.truth_error, &request.cache, watcher)?;
                watcher.shows(&Shown { scene: &grid.cells, by: "truth", frame: &truth.frame, relative: None })?;
                let (fingerprint, cells) = (fingerprint(&(&grid.picture, truth.walks)), grid.left_out());
                prepared.push(Prepared { case: case.clone(), fingerprint, left_out: cells, grid, truth, candidates });
            }
        }
        watcher.done();
    }
    Ok((prepared, left_out))
}

fn fingerprint(of: &impl std::fmt::Debug) -> String {
    Fingerprint::of(&format!("{of:?}")).to_string()
}

fn measure<M: Measure>(
    scene: &Prepared,
    candidate: &Candidate,
    round: u32,
    renderer: &mut M,
    ledger: &mut Ledger,
    watcher: &impl Watcher,
) -> Result<(), ReportError> {
    let (name, settings) = (&scene.case.scene.name, fingerprint(&candidate.settings));
    if ledger.find(&scene.fingerprint, &candidate.name, &settings, round).is_some() {
        return Ok(());
    }
    watcher.begins(&format!("{name}: {}", candidate.name));
    let Measured { frame, milliseconds } =
        renderer.measure(&scene.grid.picture, candidate.settings).map_err(|source| ReportError::Render {
            scene: name.clone(),
            settings: candidate.name.clone(),
            source: source.into(),
        })?;
    let sampled = scene.grid.sample(&frame);
    let error = deviation(scene, &sampled)?;
    if let (0, Some(preset)) = (round, candidate.preset) {
        let relative = Some(relative(&sampled, &scene.truth.frame));
        watcher.shows(&Shown { scene: &scene.grid.picture, by: preset.name(), frame: &frame, relative })?;
    }
    let counted = sampled.iter().zip(&scene.left_out).filter(|(_, left_out)| !**left_out);
    let cells = match scene.case.random && candidate.on_ladder && round == 0 {
        true => counted.map(|(cell, _)| *cell).collect(),
        false => Vec::new(),
    };
    let (scene, name) = (scene.fingerprint.clone(), candidate.name.clone());
    ledger.add(Entry { scene, name, settings, round, milliseconds, error, cells })
}

fn deviation(scene: &Prepared, sampled: &[[f32; 3]]) -> Result<Deviation, ReportError> {
    let truth = &scene.truth.frame;
    let standard_error = truth.standard_error.as_deref().unwrap_or_default();
    let truth = Uncertain { radiance: &truth.radiance, standard_error, channels: truth.channels };
    let found = Deviation::of(sampled, &truth, &scene.left_out);
    found.ok_or_else(|| ReportError::Black(scene.case.scene.name.clone()))
}

fn relative(sampled: &[[f32; 3]], truth: &Frame) -> Vec<[f32; 3]> {
    let ratio = |ours: f32, truth: f32| if truth > 0.0 { ours / truth - 1.0 } else { 0.0 };
    let pairs = sampled.iter().zip(&truth.radiance);
    pairs.map(|(ours, truth)| std::array::from_fn(|band| ratio(ours[band], truth[band]))).collect()
}

/// The reference's solvers as points, from light scattered once to the path tracer.
fn compared_solvers(walks: &[u64]) -> Vec<(String, Solver, Sampling)> {
    let march = March { directions: 8, depth: 1, step_optical_depth: 0.25, fewest_steps: 24 };
    let mut all = vec![
        ("single scattering by quadrature".to_owned(), Solver::Single, Sampling::without_noise()),
        ("recursive marching, two orders".to_owned(), Solver::Marching(march), Sampling::new(Some(2), None)),
    ];
    all.extend(
        walks
            .iter()
            .map(|&walks| (format!("path tracer, {walks} walks"), Solver::Path, Sampling::new(Some(walks), None))),
    );
    all
}

fn solvers(scene: &Prepared, ledger: &mut Ledger, watcher: &impl Watcher) -> Result<(), ReportError> {
    let cells = &scene.grid.cells;
    for (name, solver, sampling) in compared_solvers(scene.case.solver_walks) {
        let settings = fingerprint(&solver);
        // Through clouds each of the marching solver's steps goes on for minutes.
        let too_long = matches!(solver, Solver::Marching(_)) && SceneTraits::of(cells).kind == SceneKind::Clouds;
        if too_long || ledger.find(&scene.fingerprint, &name, &settings, 0).is_some() {
            continue;
        }
        watcher.begins(&format!("{}: {name}", scene.case.scene.name));
        let view = match CameraView::new(cells, solver, SEED, sampling.walks_per_batch) {
            Ok(view) => view,
            // A solver without mountains or airglow is no point of a scene that has them.
            Err(SolverError::Relief | SolverError::Emission | SolverError::Surroundings { .. }) => continue,
            Err(other) => return Err(other.into()),
        };
        let mut film = Film::new(Shard::WHOLE, view.pixels());
        let started = Instant::now();
        if expose(&&view, &mut film, &sampling.stop(), watcher)? == Outcome::Interrupted {
            return Err(ReportError::Interrupted);
        }
        let pixels = |scene: &Scene| f64::from(scene.camera.width) * f64::from(scene.camera.height);
        let scale = pixels(&scene.grid.picture) / pixels(cells);
        let milliseconds = [(ALL_CORES.to_owned(), 1e3 * started.elapsed().as_secs_f64() * scale)].into();
        let error = deviation(scene, &view.develop(&film).radiance)?;
        ledger.add(Entry {
            scene: scene.fingerprint.clone(),
            name,
            settings,
            round: 0,
            milliseconds,
            error,
            cells: Vec::new(),
        })?;
    }
    Ok(())
}

/// All measurements of a scene, from the list.
fn gather(scene: &Prepared, repeats: u32, ledger: &Ledger) -> SceneResults {
    let find = |name: &str, settings: &str| -> Vec<&Entry> {
        (0..repeats).filter_map(|round| ledger.find(&scene.fingerprint, name, settings, round)).collect()
    };
    let mut points: Vec<Point> = Vec::new();
    for candidate in &scene.candidates {
        let family = if candidate.on_ladder { Family::Ladder } else { Family::Variation };
        let preset = candidate.preset.map(|preset| preset.name().to_owned());
        points.extend(point(
            &candidate.name,
            family,
            preset,
            &find(&candidate.name, &fingerprint(&candidate.settings)),
        ));
    }
    for (name, solver, _) in compared_solvers(scene.case.solver_walks) {
        let entries = find(&name, &fingerprint(&solver));
        points.extend(point(&name, Family::Reference, None, &entries));
    }
    mark_dominated(&mut points);
    let pictures = scene.candidates.iter().filter_map(|candidate| {
        let entry = ledger.find(&scene.fingerprint, &candidate.name, &fingerprint(&candidate.settings), 0)?;
        (!entry.cells.is_empty()).then(|| (candidate.name.clone(), entry.cells.clone()))
    });
    let camera = &scene.grid.picture.camera;
    SceneResults {
        scene: scene.case.scene.name.clone(),
        random: scene.case.random,
        traits: SceneTraits::of(&scene.grid.picture),
        width: camera.width,
        height: camera.height,
        truth_walks: scene.truth.walks,
        points,
        channels: scene.grid.picture.spectrum.channels,
        pictures: pictures.collect(),
    }
}

fn point(name: &str, family: Family, preset: Option<String>, entries: &[&Entry]) -> Option<Point> {
    let error = entries.first()?.error;
    let totals: Vec<f64> = entries.iter().map(|entry| entry.milliseconds.values().sum()).collect();
    let mut passes: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    if family != Family::Reference {
        for (pass, time) in entries.iter().flat_map(|entry| &entry.milliseconds) {
            passes.entry(pass.clone()).or_default().push(*time);
        }
    }
    let passes = passes.into_iter().map(|(pass, times)| (pass, Spread::of(&times))).collect();
    let milliseconds = Spread::of(&totals);
    Some(Point { name: name.to_owned(), family, preset, error, milliseconds, passes, dominated_by: None })
}
