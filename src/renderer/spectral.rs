//! More wavelengths than three: groups of three, one after the other, each with tables of its own.
//!
//! Tables stay on the device for each group, so that only what a change touches is computed again; the images of a frame
//! are shared, and what the wavelengths show is added up in them.

use super::pending::{PendingFrame, ToChannels};
use super::{Renderer, Timings};
use crate::passes::{CLOUDS, FRAME, RenderError, SHARED_IMAGES, TABLES};
use crate::plan::{Facts, History, Outputs, Plan, Settings, SpectralPart};
use crate::probe::Orders;
use crate::scene::Scene;

impl Renderer {
    /// What the first frame of every group would run, as one plan.
    pub(super) fn plan_groups(scene: &Scene, settings: Settings, outputs: Outputs) -> Result<Plan, RenderError> {
        let declarations: Vec<_> = TABLES.iter().chain(&CLOUDS).chain(&FRAME).map(|pass| pass.declaration).collect();
        let plan = |part: SpectralPart| -> Result<Plan, RenderError> {
            let at = scene.at(&part.wavelengths);
            let facts = Facts { part: Some(part), ..Facts::new(&at, settings, Orders::All, outputs)?.in_picture() };
            Ok(Plan::new(&facts, &History::default(), &declarations))
        };
        Ok(Plan::of_groups(&parts(scene).into_iter().map(plan).collect::<Result<Vec<_>, _>>()?, &SHARED_PASSES))
    }

    /// Renders the groups and adds them up.
    pub(super) fn render_groups(
        &mut self,
        scene: &Scene,
        settings: Settings,
        outputs: Outputs,
    ) -> Result<PendingFrame, RenderError> {
        let timings = self.execute_groups(scene, settings, outputs)?;
        let images = ["colour_image", "colour_transmittance_image"];
        self.start_reading(&scene.camera, outputs, images, ToChannels::done(scene), timings)
    }

    /// Computes the groups one after the other into the shared images.
    pub(super) fn execute_groups(
        &mut self,
        scene: &Scene,
        settings: Settings,
        outputs: Outputs,
    ) -> Result<Timings, RenderError> {
        let passes: Vec<_> = TABLES.iter().chain(&CLOUDS).chain(&FRAME).collect();
        let run = |part: &SpectralPart| {
            let at = scene.at(&part.wavelengths);
            let facts = Facts { part: Some(*part), ..Facts::new(&at, settings, Orders::All, outputs)?.in_picture() };
            self.select_group(part.index);
            let timings = self.execute("frame", &facts, &passes);
            // The next group overwrites the images of the frame.
            FRAME.iter().for_each(|pass| self.history.forget(pass.declaration.name));
            timings
        };
        let all: Result<Vec<_>, RenderError> = parts(scene).iter().map(run).collect();
        self.select_group(0);
        Ok(joined(all?))
    }

    /// Brings a group's tables and history to the front.
    fn select_group(&mut self, group: usize) {
        let groups = self.histories.len().max(group + 1).max(self.group + 1);
        self.histories.resize_with(groups, History::default);
        self.histories[self.group] = std::mem::take(&mut self.history);
        self.history = std::mem::take(&mut self.histories[group]);
        self.group = group;
        self.resources.select_group(group, &SHARED_IMAGES);
    }
}

/// Passes whose results the groups share.
const SHARED_PASSES: [&str; 6] = ["terrain", "sky_lattice", "interpolate", "compose", "colour", "display"];

fn parts(scene: &Scene) -> Vec<SpectralPart> {
    let (groups, colours) = (scene.spectrum.groups(), scene.colour());
    let count = groups.len();
    let part = |(index, (wavelengths, colour))| SpectralPart { index, count, wavelengths, colour };
    groups.into_iter().zip(colours).enumerate().map(part).collect()
}

/// The plans of all groups as one, with the sum of their times.
fn joined(all: Vec<Timings>) -> Timings {
    let plans: Vec<_> = all.iter().map(|timings| timings.plan.clone()).collect();
    let mut joined =
        Timings { plan: Plan::of_groups(&plans, &SHARED_PASSES), milliseconds: Default::default(), clock: None };
    for timings in all {
        joined.clock = timings.clock.or(joined.clock);
        for (name, milliseconds) in timings.milliseconds {
            *joined.milliseconds.entry(name).or_insert(0.0) += milliseconds;
        }
    }
    joined
}
