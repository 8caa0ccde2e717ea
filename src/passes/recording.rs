//! A frame under construction: binds what shaders ask for by name.

use std::collections::BTreeMap;

use welkin_shaders::{Definition, Definitions};

use super::blocks::{
    CameraBlock, LocalLists, ZONAL_COUNT, atmosphere_block, blue_noise, cloud_frame_block, cloud_layers, cloud_matter,
    cloud_terms, cosine_nodes, emission_block, gauss_nodes, grid_nodes, height_field_block, lamps, legendre_moments,
    local_light_blocks, observer_block, volume_blocks, volume_phases, volume_samples,
};
use super::display::pre_exposure;
use super::host_froxels::FroxelGridBlock;
use super::{
    HostFrame, HostLeft, Pass, RenderError, Resources, definitions, display, host_froxels, interpolate, optical_depth,
    ordinates, sky_view,
};
use crate::gpu::{Commands, Completed, GpuBuffer, GpuImage, Resource, Work};
use crate::plan::{Facts, Surface};

/// Parameter blocks of a frame, by the names of the shaders' variables.
#[derive(Default)]
pub struct Parameters(BTreeMap<&'static str, Vec<u8>>);

impl Parameters {
    /// Narrows all that the shaders read of a scene.
    pub fn new(facts: &Facts) -> Self {
        let bytes = |slice: &[_]| bytemuck::cast_slice(slice).to_vec();
        Self(BTreeMap::from([
            ("atmosphere", atmosphere_block(facts)),
            ("emission", emission_block(facts)),
            ("gauss_nodes", bytes(&gauss_nodes(&facts.settings))),
            ("cosine_nodes", bytes(&cosine_nodes(&facts.settings))),
            ("grid_nodes", bytes(&grid_nodes(facts.source_grid()))),
            ("observer", observer_block(facts)),
            ("camera", bytemuck::bytes_of(&CameraBlock::new(&facts.scene.camera, pre_exposure(facts))).to_vec()),
        ]))
    }

    /// Adds a block of one pass.
    pub fn insert<T: bytemuck::NoUninit>(&mut self, name: &'static str, block: &T) {
        self.0.insert(name, bytemuck::bytes_of(block).to_vec());
    }
}

/// What passes record into.
pub struct Recording<'a> {
    /// What is known about the scene.
    pub facts: &'a Facts<'a>,
    /// What outlives the frame.
    pub resources: &'a mut Resources,
    parameters: Parameters,
    definitions: Definitions,
    commands: Commands,
}

impl<'a> Recording<'a> {
    /// Starts a frame whose dispatches are timed.
    pub fn new(label: &str, facts: &'a Facts<'a>, resources: &'a mut Resources) -> Result<Self, RenderError> {
        resources.begin_recording();
        resources.fill_buffer("legendre_moments", &legendre_moments(facts, facts.degree_count()))?;
        if !facts.emitters.is_empty() {
            resources.fill_buffer("zonal_moments", &legendre_moments(facts, ZONAL_COUNT))?;
        }
        if facts.has_overlay() {
            resources.fill_buffer("blue_noise", blue_noise())?;
        }
        if !facts.clouds.is_empty() {
            resources.fill_buffer("cloud_layers", &cloud_layers(facts))?;
            resources.fill_buffer("cloud_frame", &cloud_frame_block(facts))?;
            resources.fill_buffer("cloud_terms", &cloud_terms(facts))?;
            resources.fill_buffer("cloud_matter", &cloud_matter(facts))?;
        }
        if facts.has_local_media() || facts.froxels.is_some() {
            let lamps = lamps(facts);
            let lists = LocalLists::new(facts, &lamps);
            resources.angular_fields.prepare(facts);
            resources.fill_buffer("volumes", &volume_blocks(facts, &lists, &resources.angular_fields))?;
            resources.fill_buffer("volume_phases", &volume_phases(facts))?;
            resources.fill_buffer("volume_samples", &volume_samples(facts))?;
            resources.fill_buffer("local_lists", &lists.to_words())?;
            resources
                .fill_buffer("local_lights", &local_light_blocks(facts, &lamps, &lists, &resources.angular_fields))?;
            resources.fill_buffer("angular_fields", &resources.angular_fields.to_texels())?;
            let slab_fields = resources.slab_fields.to_texels(facts);
            resources.fill_buffer("slab_fields", &slab_fields)?;
        }
        if let Some(grid) = resources.host_frame().and_then(|frame| FroxelGridBlock::new(facts, frame)) {
            resources.fill_buffer("froxel_grid", &[grid])?;
        }
        if let Some(terrain) = facts.scene.terrain.as_ref() {
            resources.fill_buffer("height_field", &height_field_block(terrain))?;
        }
        if let Some(problem) = ordinates::problem(facts) {
            resources.fill_buffer("ordinates", &problem.block())?;
        }
        let mut commands = commands(label, resources)?;
        resources.record_uploads(&mut commands)?;
        Ok(Self { facts, resources, parameters: Parameters::new(facts), definitions: definitions(facts), commands })
    }

    /// Adds a parameter block of one pass.
    pub fn insert_parameters<T: bytemuck::NoUninit>(&mut self, name: &'static str, block: &T) {
        self.parameters.insert(name, block);
    }

    /// Compiles what passes are expected to dispatch.
    pub fn compile_ahead<'b>(&mut self, passes: impl Iterator<Item = &'b Pass>) {
        let names = passes.map(|pass| pass.declaration.name);
        let expected: Vec<_> = names.filter_map(|name| Some((name, self.with_flags(&flags(name, self)?)))).collect();
        self.resources.compile_ahead(&expected);
    }

    fn with_flags(&self, flags: &[&str]) -> Definitions {
        let mut definitions = self.definitions.clone();
        definitions.extend(flags.iter().map(|flag| ((*flag).to_owned(), Definition::Bool(true))));
        definitions
    }

    /// Records a dispatch of a pass's shader.
    ///
    /// `images` binds variables that have no lasting name; all others are found by theirs.
    pub fn dispatch(
        &mut self,
        pass: &'static str,
        flags: &[&str],
        images: &[(&str, &GpuImage)],
        work: Work,
    ) -> Result<(), RenderError> {
        let definitions = self.with_flags(flags);
        dispatch(self.resources, &mut self.commands, pass, definitions, &self.parameters, images, work)
    }

    /// What stands before the camera: hills, or what a host has drawn.
    pub fn surface(&self) -> Option<GpuImage> {
        let name = match self.facts.surface? {
            Surface::Terrain => "terrain_image",
            Surface::Given(_) => "foreground_image",
            Surface::Rays => return None,
        };
        self.resources.existing_image(name).cloned()
    }

    /// Fills a storage buffer with zeros.
    pub fn clear(&mut self, buffer: &GpuBuffer) {
        self.commands.clear(buffer);
    }

    /// What dispatches are recorded with, for passes that bring their own parameters.
    pub(super) fn parts(&mut self) -> (&mut Resources, &mut Commands) {
        (self.resources, &mut self.commands)
    }

    /// Puts images of the host's into the layout that it wants them in.
    pub fn leave_targets(&mut self) {
        for (_, image, next) in &self.resources.targets {
            self.commands.leave_for(image, *next);
        }
    }

    /// Runs what was recorded, or leaves it to the host that it was recorded for.
    pub fn finish(self) -> Result<Completed, RenderError> {
        let Self { resources, mut commands, .. } = self;
        let completed = match &mut resources.host {
            None => commands.submit_and_wait()?,
            Some(host) => {
                let mut left = |image| commands.hand_back_to_host(image);
                let depth = host.frame.depth.as_ref().map(|depth| left(&depth.image));
                let froxels = host.frame.froxels.as_ref();
                let froxels = froxels.map(|froxels| [left(&froxels.radiance), left(&froxels.transmittance)]);
                let left = HostLeft { colour: left(&host.frame.colour), depth, froxels };
                host.recorded = Some((commands.hand_over_to_host(), left));
                Completed { times: Vec::new(), clock: None }
            }
        };
        resources.finish_uploads();
        Ok(completed)
    }
}

/// What a pass's shader is compiled with besides the frame's definitions. None of passes that dispatch several shaders, or that choose
/// only when they are recorded: those are compiled then.
fn flags(pass: &str, recording: &Recording) -> Option<Vec<&'static str>> {
    match pass {
        "optical_depth" => Some(optical_depth::FLAGS.to_vec()),
        "sky_view" => Some(sky_view::flags(recording)),
        "interpolate" => Some(interpolate::flags(recording)),
        "display" => Some(display::flags(recording)),
        "host_froxels" => Some(host_froxels::flags(recording)),
        "emission_order"
        | "view_emission"
        | "aerial_optical_depth"
        | "cloud_gaps"
        | "ordinates_extinction"
        | "ordinates_sweep"
        | "colour"
        | "host_surface"
        | "host_colour" => None,
        _ => Some(Vec::new()),
    }
}

/// What a frame is recorded with.
fn commands(label: &str, resources: &mut Resources) -> Result<Commands, RenderError> {
    let of_host = resources.host.as_mut().and_then(|host| host.commands.take());
    if let Some(of_host) = of_host {
        let mut commands = resources.gpu.record_for_host(label, of_host)?;
        let images = resources.host_frame().into_iter().flat_map(HostFrame::images);
        images.for_each(|image| commands.take_over_from_host(image));
        return Ok(commands);
    }
    Ok(match (&resources.pace, resources.clock) {
        (Some(pace), _) => resources.gpu.record_paced(label, pace)?,
        (None, Some(clock)) => resources.gpu.record_timed_by(label, clock)?,
        (None, None) => resources.gpu.record_timed(label)?,
    })
}

/// Records a dispatch of a pass's shader; see [`Recording::dispatch`].
pub(super) fn dispatch(
    resources: &mut Resources,
    commands: &mut Commands,
    pass: &'static str,
    definitions: Definitions,
    parameters: &Parameters,
    images: &[(&str, &GpuImage)],
    work: Work,
) -> Result<(), RenderError> {
    let pipeline = resources.pipeline(pass, &definitions)?;
    let mut bound = Vec::with_capacity(pipeline.bindings().len());
    for binding in pipeline.bindings() {
        let name = binding.name.as_str();
        if let Some(resource) = find(name, images, parameters, resources) {
            bound.push((name, resource));
        }
    }
    Ok(commands.dispatch(&pipeline, &bound, work)?)
}

/// Whatever goes by a name; what goes by none is reported by the dispatch.
fn find<'a>(
    name: &str,
    images: &[(&str, &'a GpuImage)],
    parameters: &'a Parameters,
    resources: &'a Resources,
) -> Option<Resource<'a>> {
    if let Some((_, image)) = images.iter().find(|(local, _)| *local == name) {
        return Some(Resource::Image(image));
    }
    if name == "table_sampler" {
        return Some(Resource::Sampler(resources.sampler()));
    }
    let data = parameters.0.get(name).map(|block| Resource::Data(block));
    let image = || resources.existing_image(name).map(Resource::Image);
    let buffer = || resources.existing_buffer(name).map(Resource::Buffer);
    data.or_else(image).or_else(buffer)
}
