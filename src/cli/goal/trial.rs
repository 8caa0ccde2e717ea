//! Settings that are tried on the scene itself.

use std::collections::BTreeMap;

use welkin::goal::{Choice, GoalError, MeasuredFront, SearchError, search};
use welkin::plan::{LadderStep, Outputs, Rung, SceneTraits};
use welkin::renderer::Renderer;
use welkin::report::{SampleGrid, distance};
use welkin::scene::Scene;

use super::kept::Kept;
use crate::cli::Failure;
use crate::cli::backend::failure;

/// The cheapest settings whose error on a scene is found to be within a target, from small pictures of it. How far these are from
/// each other is kept: it depends on the scene alone.
///
/// The outer error is the renderer's.
pub fn found_on_scene(
    front: &MeasuredFront,
    renderer: &mut Renderer,
    scene: &Scene,
    target: f64,
) -> Result<Result<Choice, GoalError>, Failure> {
    let kind = SceneTraits::of(scene).kind;
    if !front.scenes.iter().any(|measured| measured.traits.kind == kind) {
        return Ok(Err(GoalError::NotMeasured { kind }));
    }
    let kept = Kept::new(format!("distances {:?}", Scene { name: String::new(), ..scene.clone() }));
    let known: BTreeMap<String, f64> = kept.read().unwrap_or_default();
    let mut trial = Trial { grid: SampleGrid::new(scene), renderer, pictures: BTreeMap::new(), known };
    let before = trial.known.len();
    let price = |step| front.milliseconds(kind, step);
    let found = search(target, dearest(), price, |step, finest| trial.distance(step, finest));
    if trial.known.len() > before {
        kept.write(&trial.known);
    }
    match found {
        Ok(choice) => Ok(Ok(choice)),
        Err(SearchError::Goal(error)) => Ok(Err(error)),
        Err(SearchError::Picture(error)) => Err(error),
    }
}

fn dearest() -> Rung {
    Rung::ALL[Rung::ALL.len() - 1]
}

/// Pictures of a scene at some steps.
struct Trial<'a> {
    grid: SampleGrid,
    renderer: &'a mut Renderer,
    pictures: BTreeMap<String, Vec<[f32; 3]>>,
    /// Distances by the names of the two steps.
    known: BTreeMap<String, f64>,
}

impl Trial<'_> {
    fn distance(&mut self, step: LadderStep, finest: LadderStep) -> Result<f64, Failure> {
        let key = format!("{step} from {finest}");
        if let Some(known) = self.known.get(&key) {
            return Ok(*known);
        }
        let (ours, other) = (self.picture(step)?, self.picture(finest)?);
        let channels = self.grid.picture.spectrum.channels;
        let found = distance(&ours, &other, channels, &self.grid.left_out());
        let black = || Failure::Input(anyhow::anyhow!("the picture is black, so no error is relative to anything"));
        let found = found.ok_or_else(black)?;
        self.known.insert(key, found);
        Ok(found)
    }

    fn picture(&mut self, step: LadderStep) -> Result<Vec<[f32; 3]>, Failure> {
        let name = step.to_string();
        if let Some(picture) = self.pictures.get(&name) {
            return Ok(picture.clone());
        }
        eprintln!("trying {name} on the scene");
        self.renderer.forget();
        let rendered =
            self.renderer.render(&self.grid.picture, step.settings(), Outputs::default()).map_err(failure)?;
        let sampled = self.grid.sample(&rendered.frame);
        self.pictures.insert(name, sampled.clone());
        Ok(sampled)
    }
}
