//! Runs a plan on a device: no physics, no Vulkan.

mod bake;
mod embedded;
mod pending;
mod prices;
mod sequence;
mod spectral;
mod step_times;
mod targets;

use std::collections::BTreeMap;
use std::path::Path;

use crate::foreground::Foreground;
use crate::frame::Frame;
use crate::gpu::{Clock, DeviceRequest, Gpu, Pace};
use crate::passes::{
    self, CLOUDS, FRAME, ParameterBuffers, Pass, Recording, RenderError, Resources, ShaderSources, TABLES, record_probe,
};
use crate::plan::{Decision, Facts, History, Outputs, Plan, PlanError, Sequence, Settings, Surface, TableFormat};
use crate::probe::{Orders, Ray, RayRadiance};
use crate::scene::{Light, Scene};

pub use crate::passes::{DepthBuffer, HostDepth, HostFrame, HostFroxels, HostLeft};
pub use embedded::HostedFrame;
pub use pending::PendingFrame;
use pending::ToChannels;
pub use prices::{Price, prices};
use sequence::Before;
pub use targets::Targets;

/// Renders scenes on one device; what one frame has computed, the next reuses.
pub struct Renderer {
    resources: Resources,
    history: History,
    foregrounds: u64,
    /// Of other groups of wavelengths than the one at the front.
    histories: Vec<History>,
    group: usize,
    /// Where the frame that is being rendered stands among others.
    sequence: Option<Sequence>,
    before: Option<Before>,
}

/// A frame with what it took.
pub struct Rendered {
    /// Linear radiance, transmittance and distance; without a capture only radiance is filled.
    pub frame: Frame,
    /// sRGB bytes, three a pixel, when a picture was asked for.
    pub picture: Option<Vec<u8>>,
    /// What each pass took.
    pub timings: Timings,
}

/// What a plan's execution took.
#[derive(Debug, Clone)]
pub struct Timings {
    /// The plan.
    pub plan: Plan,
    /// Milliseconds of each pass that ran, by name.
    pub milliseconds: BTreeMap<String, f64>,
    /// What they were taken with.
    pub clock: Option<Clock>,
}

impl Timings {
    /// Those of a plan that did not run.
    pub fn unmeasured(plan: Plan) -> Self {
        Self { plan, milliseconds: BTreeMap::new(), clock: None }
    }
}

impl Renderer {
    /// What a scene's first frame would run; needs no device.
    ///
    /// # Errors
    /// [`RenderError::Plan`] when the scene asks for more than the renderer can do.
    pub fn plan(scene: &Scene, settings: Settings, outputs: Outputs) -> Result<Plan, RenderError> {
        if scene.spectrum.group_count() > 1 {
            return Self::plan_groups(scene, settings, outputs);
        }
        let facts = Facts::new(scene, settings, Orders::All, outputs)?.in_picture();
        let declarations: Vec<_> = TABLES.iter().chain(&CLOUDS).chain(&FRAME).map(|pass| pass.declaration).collect();
        Ok(Plan::new(&facts, &History::default(), &declarations))
    }

    /// Opens a device.
    ///
    /// # Errors
    /// [`RenderError::Gpu`] when there is none that can be used; [`RenderError::NoLinearFilter`].
    pub fn new(request: &DeviceRequest) -> Result<Self, RenderError> {
        Self::on(Gpu::new(request)?)
    }

    /// Renders on a device that is open already, and that others may use as well.
    ///
    /// # Errors
    /// [`RenderError::NoLinearFilter`].
    pub fn on(gpu: Gpu) -> Result<Self, RenderError> {
        Self::with_shaders(gpu, ShaderSources::embedded())
    }

    /// Renders with other shaders than the built-in ones: those that somebody edits, or those in which a test has planted
    /// a fault.
    ///
    /// # Errors
    /// [`RenderError::NoLinearFilter`]; what is wrong with a shader is said when it is first needed.
    pub fn with_shaders(gpu: Gpu, shaders: ShaderSources) -> Result<Self, RenderError> {
        Ok(Self {
            resources: Resources::with_shaders(gpu, shaders)?,
            history: History::default(),
            histories: Vec::new(),
            group: 0,
            foregrounds: 0,
            sequence: None,
            before: None,
        })
    }

    /// Keeps tables no wider than this, as on a device that can interpolate nothing wider.
    pub fn limit_tables(&mut self, widest: TableFormat) {
        self.resources.widest_tables = widest;
    }

    /// Has shaders find their parameters elsewhere than this device likes best ([`Gpu::parameter_buffers`]).
    pub fn place_parameters(&mut self, buffers: ParameterBuffers) {
        self.resources.parameter_buffers = buffers;
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.resources.gpu
    }

    /// How many pipelines it has compiled so far.
    pub fn compiled_pipelines(&self) -> u64 {
        self.resources.compiled_pipelines()
    }

    /// How many of them were compiled ahead of a recording that then did without: none, unless a pass chose another variant than it
    /// was expected to.
    pub fn idle_pipelines(&self) -> usize {
        self.resources.idle_pipelines()
    }

    /// From now on frames come in submissions short enough for others who share the device, and can be stopped. A
    /// stopped frame ends in [`crate::gpu::GpuError::Stopped`]; the next one computes what it has left undone.
    pub fn set_pace(&mut self, pace: Option<Pace>) {
        self.resources.pace = pace;
    }

    /// Takes the times of passes with another clock than the device's best. With those of the host every dispatch waits for
    /// the one before.
    pub fn set_clock(&mut self, clock: Clock) {
        self.resources.clock = Some(clock);
    }

    /// Takes shaders from a folder, as somebody edits them, in place of those that the program was built with; the next
    /// frame computes everything anew.
    ///
    /// # Errors
    /// [`RenderError::Shader`] with the file and line of what does not compile; then the shaders stay as they are.
    pub fn take_shaders_from(&mut self, folder: &Path) -> Result<(), RenderError> {
        self.resources.set_shaders(ShaderSources::from_directory(folder)?)?;
        self.forget();
        Ok(())
    }

    /// Forgets what earlier frames have computed, so that the next runs every pass that it needs: for measurements.
    pub fn forget(&mut self) {
        self.history = History::default();
        self.histories.clear();
        self.before = None;
    }

    /// Renders what the scene's camera sees.
    ///
    /// # Errors
    /// [`RenderError::Plan`] when the scene asks for more than the renderer can do; device and shader errors.
    pub fn render(&mut self, scene: &Scene, settings: Settings, outputs: Outputs) -> Result<Rendered, RenderError> {
        self.render_pending(scene, settings, outputs)?.wait()
    }

    /// The same without waiting for the pixels, so that the next frame can be rendered while they come.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_pending(
        &mut self,
        scene: &Scene,
        settings: Settings,
        outputs: Outputs,
    ) -> Result<PendingFrame, RenderError> {
        if scene.spectrum.group_count() > 1 {
            return self.render_groups(scene, settings, outputs);
        }
        self.render_frame(&Facts::new(scene, settings, Orders::All, outputs)?.in_picture())
    }

    /// Renders the air before surfaces that the host has drawn, and sky and ground where there are none. A surface behind
    /// the scene's ground is seen through all the air before the ground.
    ///
    /// # Errors
    /// As [`Renderer::render`]; [`RenderError::Foreground`] when the foreground is not of the camera's size.
    pub fn render_over(
        &mut self,
        scene: &Scene,
        settings: Settings,
        outputs: Outputs,
        foreground: &Foreground,
    ) -> Result<Rendered, RenderError> {
        if scene.spectrum.group_count() > 1 {
            let what = "the host's surfaces have three bands and the scene more wavelengths".to_owned();
            return Err(PlanError::Unsupported { what }.into());
        }
        passes::upload_foreground(&mut self.resources, &scene.camera, foreground)?;
        self.foregrounds += 1;
        let surface = Some(Surface::Given(self.foregrounds));
        let facts = Facts::new(scene, settings, Orders::All, outputs)?.in_picture().with_surface(surface);
        self.render_frame(&facts)?.wait()
    }

    /// Renders what the scene's camera sees, and leaves it on the device: as [`Renderer::render`] without its copies. What
    /// nothing has changed is not computed again, the picture included. Radiance that nobody asks for is kept in half floats, times
    /// an exposure, as what the picture is made from.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn compute(&mut self, scene: &Scene, settings: Settings, outputs: Outputs) -> Result<Timings, RenderError> {
        if scene.spectrum.group_count() > 1 {
            return self.execute_groups(scene, settings, outputs);
        }
        let mut facts = Facts::new(scene, settings, Orders::All, outputs)?.in_picture();
        if self.resources.targets.iter().all(|(target, ..)| *target != "radiance_image") {
            facts = facts.for_screen();
        }
        let passes: Vec<_> = TABLES.iter().chain(&CLOUDS).chain(&FRAME).collect();
        self.execute("frame", &facts, &passes)
    }

    fn render_frame(&mut self, facts: &Facts) -> Result<PendingFrame, RenderError> {
        let passes: Vec<_> = TABLES.iter().chain(&CLOUDS).chain(&FRAME).collect();
        let timings = self.execute("frame", facts, &passes)?;
        let (images, channels) = (["radiance_image", "transmittance_image"], ToChannels::of_bands(facts.scene));
        self.start_reading(&facts.scene.camera, facts.outputs, images, channels, timings)
    }

    /// Radiance along rays, each from its own altitude under its own sun: the scene's first directional light, moved
    /// there. Other lights stay where the scene has them.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn probe(
        &mut self,
        scene: &Scene,
        settings: Settings,
        rays: &[Ray],
        orders: Orders,
    ) -> Result<Vec<RayRadiance>, RenderError> {
        if scene.clouds.iter().any(|layer| !layer.is_empty()) {
            return Err(
                PlanError::Unsupported { what: "single rays are asked for in a scene with clouds".to_owned() }.into()
            );
        }
        let mut answers =
            vec![RayRadiance { radiance: [0.0; 3], transmittance: [0.0; 3], standard_error: [0.0; 3] }; rays.len()];
        for group in groups_of_one_view(rays, is_directional_alone(scene)) {
            let seen_from = scene_for_ray(scene, &rays[group[0]]);
            let ends = group.iter().any(|&index| rays[index].distance_m < f64::INFINITY);
            let facts = Facts::new(&seen_from, settings, orders, Outputs::default())?
                .with_surface(ends.then_some(Surface::Rays));
            let group_rays: Vec<_> = group.iter().map(|&index| rays[index]).collect();
            passes::upload_rays(&mut self.resources, &group_rays, &facts.sky_view_mapping())?;
            let passes: Vec<_> = TABLES.iter().collect();
            self.execute_and("probe", &facts, &passes, |recording| record_probe(recording, group.len()))?;
            for (index, answer) in group.into_iter().zip(passes::download_answers(&self.resources)?) {
                answers[index] = answer;
            }
        }
        Ok(answers)
    }

    /// Plans and runs passes. Where every result still holds, nothing is submitted.
    fn execute(&mut self, label: &str, facts: &Facts, passes: &[&Pass]) -> Result<Timings, RenderError> {
        let facts = &self.adapted(facts);
        let plan = self.prepare(facts, passes);
        let runs = plan.passes.iter().any(|pass| pass.decision == Decision::Run);
        if !runs && self.resources.targets.is_empty() {
            self.history.record(&plan);
            return Ok(Timings::unmeasured(plan));
        }
        self.run(label, facts, passes, plan, |_| Ok(()))
    }

    /// The same, and then what is no part of a plan.
    fn execute_and(
        &mut self,
        label: &str,
        facts: &Facts,
        passes: &[&Pass],
        and_then: impl FnOnce(&mut Recording) -> Result<(), RenderError>,
    ) -> Result<Timings, RenderError> {
        let facts = &self.adapted(facts);
        let plan = self.prepare(facts, passes);
        self.run(label, facts, passes, plan, and_then)
    }

    /// The facts on this device, in this place of a sequence of frames.
    fn adapted<'a>(&mut self, facts: &Facts<'a>) -> Facts<'a> {
        if self.sequence.is_none() {
            self.before = None;
        }
        facts.clone().with_tables_up_to(self.resources.widest_tables).in_sequence(self.sequence)
    }

    /// Plans, and makes room for what will run.
    fn prepare(&mut self, facts: &Facts, passes: &[&Pass]) -> Plan {
        let declarations: Vec<_> = passes.iter().map(|pass| pass.declaration).collect();
        let plan = Plan::new(facts, &self.history, &declarations);
        self.release_what_nobody_writes(&plan, passes);
        self.history.begin(&plan);
        plan
    }

    fn run(
        &mut self,
        label: &str,
        facts: &Facts,
        passes: &[&Pass],
        plan: Plan,
        and_then: impl FnOnce(&mut Recording) -> Result<(), RenderError>,
    ) -> Result<Timings, RenderError> {
        let mut recording = Recording::new(label, facts, &mut self.resources)?;
        let run = |pass: &&&Pass| plan.decision(pass.declaration.name) == Some(Decision::Run);
        recording.compile_ahead(passes.iter().filter(run).copied());
        for pass in passes.iter().filter(run) {
            (pass.record)(&mut recording)?;
        }
        and_then(&mut recording)?;
        recording.leave_targets();
        let completed = recording.finish()?;
        self.history.record(&plan);
        let mut milliseconds = BTreeMap::new();
        for time in completed.times {
            *milliseconds.entry(time.label).or_insert(0.0) += time.milliseconds;
        }
        Ok(Timings { plan, milliseconds, clock: completed.clock })
    }

    /// Frees what skipped passes have left, but what another pass writes or keeps under the same name.
    fn release_what_nobody_writes(&mut self, plan: &Plan, passes: &[&Pass]) {
        let freed = |pass: &&&Pass| {
            let name = pass.declaration.name;
            plan.decision(name) == Some(Decision::Skip) && !plan.keeps(name)
        };
        let held: Vec<_> = passes.iter().filter(|pass| !freed(pass)).flat_map(|pass| pass.declaration.writes).collect();
        let left = passes.iter().filter(freed).flat_map(|pass| pass.declaration.writes);
        left.filter(|name| !held.contains(name)).for_each(|name| self.resources.release(name));
    }
}

/// Indices of rays that share altitude and sun, and so a sky-view table.
fn groups_of_one_view(rays: &[Ray], light_is_alone: bool) -> Vec<Vec<usize>> {
    let mut groups: BTreeMap<[u64; 3], Vec<usize>> = BTreeMap::new();
    for (index, ray) in rays.iter().enumerate() {
        let azimuth_rad = if light_is_alone { 0.0 } else { ray.sun_azimuth_rad };
        let view = [ray.altitude_m, ray.sun_zenith_rad, azimuth_rad].map(f64::to_bits);
        groups.entry(view).or_default().push(index);
    }
    groups.into_values().collect()
}

/// Whether at most one directional light shines, so that its azimuth matters relative to a ray's alone.
fn is_directional_alone(scene: &Scene) -> bool {
    scene.lights.iter().filter(|light| matches!(light, Light::Directional(_))).count() <= 1
}

/// The scene with its camera and its first directional light where a ray has them.
fn scene_for_ray(scene: &Scene, ray: &Ray) -> Scene {
    let mut scene = scene.clone();
    scene.camera.altitude_m = ray.altitude_m;
    let first = scene.lights.iter_mut().find_map(|light| match light {
        Light::Directional(light) => Some(light),
        _ => None,
    });
    if let Some(light) = first {
        light.direction.elevation_rad = std::f64::consts::FRAC_PI_2 - ray.sun_zenith_rad;
        light.direction.azimuth_rad = ray.sun_azimuth_rad;
    }
    scene
}
