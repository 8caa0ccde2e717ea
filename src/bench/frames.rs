//! What whole frames cost.

use serde::Serialize;

use super::{Motion, Series, Stopwatch};
use crate::gpu::Gpu;
use crate::passes::{RenderError, ShaderSources};
use crate::plan::{Decision, Outputs, Settings};
use crate::renderer::Renderer;
use crate::scene::Scene;

/// Frames before those that count: pipelines are made, tables are filled.
const WARM_UP: u32 = 2;

/// A series of frames to measure.
pub struct FrameCase {
    /// What it is called, but for its size.
    pub name: String,
    /// What is rendered.
    pub scene: Scene,
    /// How.
    pub settings: Settings,
    /// What changes in between.
    pub motion: Motion,
    /// Frames of which one measurement is the mean.
    pub frames: u32,
}

/// What the frames of a case have cost.
#[derive(Debug, Serialize)]
pub struct FrameCost {
    /// Its name.
    pub name: String,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Processor time of all threads, ms a frame.
    pub processor_ms: Series,
    /// Time that passed, ms a frame.
    pub wall_ms: Series,
    /// Bytes of all that stays on the device for the frame.
    pub bytes: u64,
    /// The passes that ran in the last frame.
    pub ran: Vec<&'static str>,
}

/// Measures cases in turn, `rounds` times: what disturbs the machine disturbs all of them. Frames stay on the device, as
/// linear radiance.
///
/// # Errors
/// As [`Renderer::render`].
pub fn frame_costs(
    gpu: &Gpu,
    shaders: &ShaderSources,
    cases: Vec<FrameCase>,
    rounds: u32,
) -> Result<Vec<FrameCost>, RenderError> {
    let mut running = Vec::new();
    for case in cases {
        running.push(Running::new(gpu, shaders, case)?);
    }
    for _ in 0..rounds {
        running.iter_mut().try_for_each(Running::measure)?;
    }
    Ok(running.into_iter().map(|running| running.cost).collect())
}

struct Running {
    case: FrameCase,
    renderer: Renderer,
    frame: u32,
    cost: FrameCost,
}

impl Running {
    fn new(gpu: &Gpu, shaders: &ShaderSources, case: FrameCase) -> Result<Self, RenderError> {
        let renderer = Renderer::with_shaders(gpu.clone(), shaders.clone())?;
        let camera = &case.scene.camera;
        let cost = FrameCost {
            name: case.name.clone(),
            size: [camera.width, camera.height],
            processor_ms: Series::default(),
            wall_ms: Series::default(),
            bytes: 0,
            ran: Vec::new(),
        };
        let mut running = Self { case, renderer, frame: 0, cost };
        for _ in 0..WARM_UP {
            running.advance()?;
        }
        Ok(running)
    }

    fn advance(&mut self) -> Result<(), RenderError> {
        self.case.motion.advance(&mut self.case.scene, self.frame);
        self.frame += 1;
        if self.case.motion == Motion::Anew {
            self.renderer.forget();
        }
        let timings = self.renderer.compute(&self.case.scene, self.case.settings, Outputs::default())?;
        let ran = timings.plan.passes.iter().filter(|pass| pass.decision == Decision::Run);
        self.cost.ran = ran.map(|pass| pass.name).collect();
        self.cost.bytes = timings.plan.passes.iter().map(|pass| pass.bytes).sum();
        Ok(())
    }

    fn measure(&mut self) -> Result<(), RenderError> {
        let stopwatch = Stopwatch::start();
        for _ in 0..self.case.frames {
            self.advance()?;
        }
        let frames = f64::from(self.case.frames);
        self.cost.processor_ms.values.push(stopwatch.processor_ms() / frames);
        self.cost.wall_ms.values.push(stopwatch.wall_ms() / frames);
        Ok(())
    }
}

impl FrameCost {
    /// Pixels of a frame.
    pub fn pixels(&self) -> f64 {
        self.size.map(f64::from).iter().product()
    }
}
