//! Records dispatches, puts the barriers between them, and runs them.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;

use ash::vk;

use super::barrier::{Barriers, State, Use};
use super::buffer::{BufferInner, BufferKind, GpuBuffer};
use super::command_list::CommandList;
use super::context::{Context, lock};
use super::descriptors::Descriptors;
use super::error::GpuError;
use super::image::GpuImage;
use super::pipeline::Pipeline;
use super::resource::{self, Bound, Resource};
use super::sampler::Sampler;
use super::timer::{Clock, DispatchTime, Timer};

/// How much a dispatch computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Work {
    /// Numbers of workgroups.
    Workgroups([u32; 3]),
    /// Numbers of invocations, such as an image's extent: as many workgroups as cover them, so that a pass must leave
    /// out the invocations beyond.
    Invocations([u32; 3]),
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
}

/// What the device uses until the list is done.
#[derive(Default)]
struct Kept {
    descriptors: Vec<Descriptors>,
    data: Vec<BufferInner>,
    pipelines: Vec<Pipeline>,
    samplers: Vec<Sampler>,
}

impl Commands {
    pub(crate) fn new(context: &Arc<Context>, label: &str, clock: Option<Clock>) -> Result<Self, GpuError> {
        let list = CommandList::new(context)?;
        context.open_recording(label)?;
        context.begin_label(list.raw, label);
        Ok(Self {
            context: context.clone(),
            list,
            images: HashMap::new(),
            buffers: HashMap::new(),
            kept: Kept::default(),
            timer: clock.map_or(Timer::Off, |clock| Timer::new(context, clock)),
            clock,
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
        let bound = resource::bind(pipeline.name(), pipeline.bindings(), resources)?;
        self.check_written(pipeline.name(), &bound)?;
        let first_data = self.kept.data.len();
        self.kept.data.extend(self.upload_data(&bound)?);
        let data = &self.kept.data[first_data..];
        let descriptors = Descriptors::new(&self.context, &pipeline.0, &bound, data)?;
        self.context.begin_label(self.list.raw, label);
        self.barriers(&bound).record(&self.context.device, self.list.raw);
        self.begin_time(label)?;
        self.record(pipeline, descriptors.as_ref(), workgroups);
        if let Timer::Timestamps(timestamps) = &mut self.timer {
            timestamps.end(self.list.raw);
        }
        self.context.end_label(self.list.raw);
        self.kept.descriptors.extend(descriptors);
        self.kept.pipelines.push(pipeline.clone());
        self.end_time(label)
    }

    /// Runs everything that was recorded and waits for it.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] when the device fails.
    pub fn submit_and_wait(mut self) -> Result<Completed, GpuError> {
        self.context.end_label(self.list.raw);
        self.flush()?;
        Ok(Completed { times: self.timer.times()?, clock: self.clock })
    }

    fn workgroups(&self, pipeline: &Pipeline, work: Work) -> Result<[u32; 3], GpuError> {
        let workgroups = match work {
            Work::Workgroups(workgroups) => workgroups,
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
            Resource::Image(image) => {
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
                Resource::Image(image) => image.name(),
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
            if let Resource::Sampler(sampler) = resource {
                self.kept.samplers.push((*sampler).clone());
            }
            let Some(next): Option<Use> = *needs else { continue };
            let Some(barrier) = self.state(*resource).and_then(|state| state.next(next)) else { continue };
            match resource {
                Resource::Image(image) => barriers.image(image.0.raw, barrier),
                _ => barriers.buffer(barrier),
            }
        }
        barriers
    }

    fn record(&self, pipeline: &Pipeline, descriptors: Option<&Descriptors>, [x, y, z]: [u32; 3]) {
        let (device, commands) = (&self.context.device, self.list.raw);
        let bind_point = vk::PipelineBindPoint::COMPUTE;
        // SAFETY: the list is being recorded; pipeline, sets and resources are kept until it is done, and the sets
        // were made for the pipeline's layout.
        unsafe {
            device.cmd_bind_pipeline(commands, bind_point, pipeline.0.raw);
            if let Some(descriptors) = descriptors {
                let layout = pipeline.0.layout;
                device.cmd_bind_descriptor_sets(commands, bind_point, layout, 0, &descriptors.sets, &[]);
            }
            device.cmd_dispatch(commands, x, y, z);
        }
    }

    fn begin_time(&mut self, label: &str) -> Result<(), GpuError> {
        match &mut self.timer {
            Timer::Off => {}
            Timer::Timestamps(timestamps) => timestamps.begin(self.list.raw, label)?,
            Timer::Host { started, .. } => *started = Some(Instant::now()),
        }
        Ok(())
    }

    /// With the host's clock, runs what was recorded so far, which is one dispatch.
    fn end_time(&mut self, label: &str) -> Result<(), GpuError> {
        let Timer::Host { .. } = self.timer else { return Ok(()) };
        self.flush()?;
        if let Timer::Host { started: Some(started), times } = &mut self.timer {
            let milliseconds = started.elapsed().as_secs_f64() * 1e3;
            times.push(DispatchTime { label: label.to_owned(), milliseconds });
        }
        self.list.restart()
    }

    /// Runs the list and notes what it has done to its resources.
    fn flush(&mut self) -> Result<(), GpuError> {
        self.list.submit_and_wait()?;
        for (image, state) in self.images.values() {
            *lock(&image.0.state) = *state;
        }
        for (buffer, state) in self.buffers.values() {
            *lock(&buffer.0.state) = *state;
        }
        Ok(())
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        self.context.close_recording();
    }
}
