//! Records dispatches, puts the barriers between them, and runs them.

mod handing_over;
mod pieces;
mod poison;

use std::collections::HashMap;
use std::sync::Arc;

use ash::vk;

use super::barrier::{Barriers, State, Use};
use super::buffer::{BufferInner, BufferKind, GpuBuffer};
use super::command_list::CommandList;
use super::context::{Context, lock};
use super::descriptors::Descriptors;
use super::error::GpuError;
use super::image::GpuImage;
use super::pace::{Pace, Piece};
use super::pipeline::Pipeline;
use super::resource::{self, Bound, Resource};
use super::sampler::Sampler;
use super::timer::{Clock, DispatchTime, Timer};

/// How much a dispatch computes.
#[derive(Clone, Copy)]
pub enum Work<'a> {
    /// Numbers of workgroups.
    Workgroups([u32; 3]),
    /// Numbers of invocations, such as an image's extent: as many workgroups as cover them, so that a pass must leave
    /// out the invocations beyond.
    Invocations([u32; 3]),
    /// As many workgroups as the three numbers say that a storage buffer begins with: the device itself has counted. No
    /// number may be beyond the device's limit.
    Counted(&'a GpuBuffer),
}

/// Numbers of workgroups of a part of a dispatch.
#[derive(Clone, Copy)]
enum Portion {
    From { base: [u32; 3], count: [u32; 3] },
    Counted(vk::Buffer),
}

/// What came of a recording besides the content of its resources.
#[derive(Debug, Clone, PartialEq)]
pub struct Completed {
    /// The time of each dispatch in order; empty when the recording was not timed.
    pub times: Vec<DispatchTime>,
    /// What the times were taken with.
    pub clock: Option<Clock>,
}

/// A list of dispatches under construction. Dropped without submitting, it does nothing.
pub struct Commands {
    context: Arc<Context>,
    pub(crate) list: CommandList,
    images: HashMap<vk::Image, (GpuImage, State)>,
    buffers: HashMap<vk::Buffer, (GpuBuffer, State)>,
    kept: Kept,
    timer: Timer,
    clock: Option<Clock>,
    pace: Option<Pace>,
    /// What a paced recording has not submitted yet.
    piece: Piece,
    /// Times of pieces by the host's clock.
    piece_times: Vec<DispatchTime>,
    label: String,
}

/// What the device uses until the list is done.
#[derive(Default)]
pub(super) struct Kept {
    descriptors: Vec<Descriptors>,
    data: Vec<BufferInner>,
    staging: Vec<BufferInner>,
    pipelines: Vec<Pipeline>,
    samplers: Vec<Sampler>,
}

impl Commands {
    pub(crate) fn new(
        context: &Arc<Context>,
        label: &str,
        clock: Option<Clock>,
        pace: Option<Pace>,
    ) -> Result<Self, GpuError> {
        Self::into_list(context, CommandList::new(context)?, label, clock, pace)
    }

    pub(super) fn into_list(
        context: &Arc<Context>,
        list: CommandList,
        label: &str,
        clock: Option<Clock>,
        pace: Option<Pace>,
    ) -> Result<Self, GpuError> {
        context.open_recording(label)?;
        context.begin_label(list.raw, label);
        Ok(Self {
            context: context.clone(),
            list,
            images: HashMap::new(),
            buffers: HashMap::new(),
            kept: Kept::default(),
            timer: match (clock, &pace) {
                // Pieces are timed as wholes.
                (None, _) | (Some(Clock::Host | Clock::Processor), Some(_)) => Timer::Off,
                (Some(clock), _) => Timer::new(context, clock),
            },
            piece_times: Vec::new(),
            clock,
            pace,
            piece: Piece::default(),
            label: label.to_owned(),
        })
    }

    /// Records a dispatch under its pass's name. Resources are bound by the names of the WGSL's variables, and the
    /// dispatch waits for what earlier ones do to the same resources.
    ///
    /// # Errors
    /// Typed ones for every binding that is missing, unknown, double, of the wrong kind, aliased with a written one or
    /// never written; [`GpuError::DispatchSize`].
    pub fn dispatch(
        &mut self,
        pipeline: &Pipeline,
        resources: &[(&str, Resource)],
        work: Work,
    ) -> Result<(), GpuError> {
        self.dispatch_as(pipeline.name(), pipeline, resources, work)
    }

    /// As [`Commands::dispatch`], under a label of its own: for passes that run several times.
    ///
    /// # Errors
    /// As [`Commands::dispatch`].
    pub fn dispatch_as(
        &mut self,
        label: &str,
        pipeline: &Pipeline,
        resources: &[(&str, Resource)],
        work: Work,
    ) -> Result<(), GpuError> {
        let workgroups = self.workgroups(pipeline, work)?;
        let counted = match work {
            Work::Counted(counts) => Some(counts),
            Work::Workgroups(_) | Work::Invocations(_) => None,
        };
        let bound = resource::bind(pipeline.name(), pipeline.bindings(), resources)?;
        self.check_written(pipeline.name(), &bound)?;
        let first_data = self.kept.data.len();
        self.kept.data.extend(self.upload_data(&bound)?);
        let data = &self.kept.data[first_data..];
        let descriptors = Descriptors::new(&self.context, &pipeline.0, &bound, data)?;
        self.poison(&bound);
        let mut barriers = self.barriers(&bound);
        if let Some(barrier) = counted.and_then(|counts| self.state(Resource::Buffer(counts))?.next(Use::counts())) {
            barriers.buffer(barrier);
        }
        barriers.record(&self.context.device, self.list.raw);
        match (self.pace.clone(), counted) {
            (None, None) => {
                let all = Portion::From { base: [0; 3], count: workgroups };
                self.record_portion(label, pipeline, descriptors.as_ref(), all)?;
            }
            (None, Some(counts)) => {
                self.record_portion(label, pipeline, descriptors.as_ref(), Portion::Counted(counts.0.raw))?;
            }
            (Some(pace), None) => self.record_in_pieces(&pace, label, pipeline, descriptors.as_ref(), workgroups)?,
            (Some(pace), Some(counts)) => {
                // In a list of its own: lavapipe (Mesa 22.3) begins an indirect dispatch at the workgroup at which the last
                // portion of a dispatch in the same list began.
                self.finish_piece(&pace)?;
                self.restart()?;
                // Nobody here knows how many there are: it is one piece, whose time is learnt as that of one workgroup.
                let portion = pace.portion(label, &self.piece, [1, 1], 1);
                self.record_portion(label, pipeline, descriptors.as_ref(), Portion::Counted(counts.0.raw))?;
                self.piece.add(label, 1, portion.milliseconds);
                if portion.ends_piece {
                    self.finish_piece(&pace)?;
                    self.restart()?;
                }
            }
        }
        self.kept.descriptors.extend(descriptors);
        self.kept.pipelines.push(pipeline.clone());
        Ok(())
    }

    /// Fills a storage buffer from the host, between what is recorded before and after.
    ///
    /// # Errors
    /// [`GpuError::Size`] unless there are as many bytes as the buffer has; memory is short.
    pub fn upload(&mut self, buffer: &GpuBuffer, content: &[u8]) -> Result<(), GpuError> {
        buffer.0.check_size(content.len() as u64)?;
        let staging = BufferInner::staging(&self.context, buffer.name(), buffer.bytes(), true)?;
        staging.write_mapped(content)?;
        let next = Use::copy_to(vk::ImageLayout::UNDEFINED);
        let mut barriers = Barriers::default();
        if let Some(barrier) = self.state(Resource::Buffer(buffer)).and_then(|state| state.next(next)) {
            barriers.buffer(barrier);
        }
        barriers.record(&self.context.device, self.list.raw);
        let region = vk::BufferCopy::default().size(buffer.bytes());
        // SAFETY: the list is being recorded, and keeps both buffers, which are of one size, until it is done.
        unsafe { self.context.device.cmd_copy_buffer(self.list.raw, staging.raw, buffer.0.raw, &[region]) };
        self.kept.staging.push(staging);
        Ok(())
    }

    /// Fills a storage buffer with zeros.
    pub fn clear(&mut self, buffer: &GpuBuffer) {
        let mut barriers = Barriers::default();
        if let Some(barrier) =
            self.state(Resource::Buffer(buffer)).and_then(|state| state.next(Use::clear(vk::ImageLayout::UNDEFINED)))
        {
            barriers.buffer(barrier);
        }
        barriers.record(&self.context.device, self.list.raw);
        // SAFETY: the list is being recorded; storage buffers are made to be copied to, and the recording keeps this one.
        unsafe { self.context.device.cmd_fill_buffer(self.list.raw, buffer.0.raw, 0, vk::WHOLE_SIZE, 0) };
    }

    fn record_portion(
        &mut self,
        label: &str,
        pipeline: &Pipeline,
        descriptors: Option<&Descriptors>,
        portion: Portion,
    ) -> Result<(), GpuError> {
        self.context.begin_label(self.list.raw, label);
        self.begin_time(label)?;
        self.record(pipeline, descriptors, portion);
        if let Timer::Timestamps(timestamps) = &mut self.timer {
            timestamps.end(self.list.raw);
        }
        self.context.end_label(self.list.raw);
        self.end_time(label)
    }

    /// Runs everything that was recorded and waits for it.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] when the device fails.
    pub fn submit_and_wait(mut self) -> Result<Completed, GpuError> {
        match self.pace.clone() {
            None => self.flush()?,
            Some(pace) => self.finish_piece(&pace)?,
        }
        let mut times = self.timer.times()?;
        times.append(&mut self.piece_times);
        Ok(Completed { times, clock: self.clock })
    }

    fn workgroups(&self, pipeline: &Pipeline, work: Work) -> Result<[u32; 3], GpuError> {
        let workgroups = match work {
            Work::Workgroups(workgroups) => workgroups,
            Work::Counted(_) => return Ok([1; 3]),
            Work::Invocations(invocations) => {
                std::array::from_fn(|axis| invocations[axis].div_ceil(pipeline.0.workgroup_size[axis]))
            }
        };
        let limit = self.context.info.limits.workgroups;
        if workgroups.iter().zip(limit).any(|(&count, limit)| count == 0 || count > limit) {
            return Err(GpuError::DispatchSize { pass: pipeline.name().to_owned(), workgroups, limit });
        }
        Ok(workgroups)
    }

    /// The state of an image or buffer in this recording, which starts as what has been submitted before.
    fn state(&mut self, resource: Resource) -> Option<&mut State> {
        match resource {
            Resource::Image(image) | Resource::Sampled(image, _) => {
                let start = || (image.clone(), *lock(&image.0.state));
                Some(&mut self.images.entry(image.0.raw).or_insert_with(start).1)
            }
            Resource::Buffer(buffer) => {
                let start = || (buffer.clone(), *lock(&buffer.0.state));
                Some(&mut self.buffers.entry(buffer.0.raw).or_insert_with(start).1)
            }
            Resource::Data(_) | Resource::Sampler(_) => None,
        }
    }

    fn check_written(&mut self, pass: &str, bound: &[Bound]) -> Result<(), GpuError> {
        for bound in bound.iter().filter(|bound| bound.only_reads()) {
            let resource = match bound.resource {
                Resource::Image(image) | Resource::Sampled(image, _) => image.name(),
                Resource::Buffer(buffer) => buffer.name(),
                Resource::Data(_) | Resource::Sampler(_) => continue,
            };
            if self.state(bound.resource).is_some_and(|state| !state.is_written()) {
                let (pass, binding) = (pass.to_owned(), bound.binding.name.clone());
                return Err(GpuError::ReadBeforeWrite { pass, binding, resource: resource.to_owned() });
            }
        }
        Ok(())
    }

    fn upload_data(&self, bound: &[Bound]) -> Result<Vec<BufferInner>, GpuError> {
        let data = bound.iter().filter_map(|bound| match bound.resource {
            Resource::Data(data) => Some((&bound.binding.name, data)),
            _ => None,
        });
        data.map(|(name, data)| {
            let buffer = BufferInner::new(&self.context, name, BufferKind::Uniform, data.len() as u64)?;
            buffer.write_mapped(data)?;
            Ok(buffer)
        })
        .collect()
    }

    /// All that must be waited for before a dispatch. A resource that is bound twice, which is then only read, is
    /// waited for once.
    fn barriers(&mut self, bound: &[Bound]) -> Barriers {
        let mut barriers = Barriers::default();
        for Bound { resource, needs, .. } in bound {
            if let Resource::Sampler(sampler) | Resource::Sampled(_, sampler) = resource {
                self.kept.samplers.push((*sampler).clone());
            }
            let Some(next): Option<Use> = *needs else { continue };
            let Some(barrier) = self.state(*resource).and_then(|state| state.next(next)) else { continue };
            match resource {
                Resource::Image(image) | Resource::Sampled(image, _) => {
                    barriers.image(image.0.raw, image.0.aspects(), barrier);
                }
                _ => barriers.buffer(barrier),
            }
        }
        barriers
    }

    fn record(&self, pipeline: &Pipeline, descriptors: Option<&Descriptors>, portion: Portion) {
        let (device, commands) = (&self.context.device, self.list.raw);
        let bind_point = vk::PipelineBindPoint::COMPUTE;
        // SAFETY: the list is being recorded; pipeline, sets and resources are kept until it is done, and the sets
        // were made for the pipeline's layout; pipelines are made to begin at any workgroup.
        unsafe {
            device.cmd_bind_pipeline(commands, bind_point, pipeline.0.raw);
            if let Some(descriptors) = descriptors {
                let layout = pipeline.0.layout;
                device.cmd_bind_descriptor_sets(commands, bind_point, layout, 0, &descriptors.sets, &[]);
            }
            match portion {
                // Validation layers of 2023 look at this one only.
                Portion::From { base: [0, 0, 0], count: [x, y, z] } => device.cmd_dispatch(commands, x, y, z),
                Portion::From { base: [from_x, from_y, from_z], count: [x, y, z] } => {
                    device.cmd_dispatch_base(commands, from_x, from_y, from_z, x, y, z);
                }
                Portion::Counted(counts) => device.cmd_dispatch_indirect(commands, counts, 0),
            }
        }
    }

    fn begin_time(&mut self, label: &str) -> Result<(), GpuError> {
        match &mut self.timer {
            Timer::Off => {}
            Timer::Timestamps(timestamps) => timestamps.begin(self.list.raw, label)?,
            Timer::Alone(alone) => alone.begin(),
        }
        Ok(())
    }

    /// With a clock of the host's, runs what was recorded so far, which is one dispatch.
    fn end_time(&mut self, label: &str) -> Result<(), GpuError> {
        let Timer::Alone(_) = self.timer else { return Ok(()) };
        self.flush()?;
        if let Timer::Alone(alone) = &mut self.timer {
            alone.end(label);
        }
        self.restart()
    }

    /// An empty list under the same label, after [`Commands::flush`].
    fn restart(&mut self) -> Result<(), GpuError> {
        self.list.restart()?;
        self.context.begin_label(self.list.raw, &self.label);
        Ok(())
    }

    /// Runs the list and notes what it has done to its resources.
    fn flush(&mut self) -> Result<(), GpuError> {
        // A label that is open across lists would be ended where it never began.
        self.context.end_label(self.list.raw);
        self.list.submit_and_wait()?;
        self.note_states();
        Ok(())
    }

    /// What comes next starts from what this has done.
    fn note_states(&self) {
        for (image, state) in self.images.values() {
            *lock(&image.0.state) = *state;
        }
        for (buffer, state) in self.buffers.values() {
            *lock(&buffer.0.state) = *state;
        }
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        self.context.close_recording();
    }
}
