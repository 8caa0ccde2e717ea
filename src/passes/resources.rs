//! What passes leave behind on the device, by name, and the pipelines that make it.

use std::collections::BTreeMap;

use welkin_shaders::{Definitions, ParameterBuffers, Shader};

use super::blocks::{AngularFields, SlabFields};
use super::pipelines::Pipelines;
use super::{HostRecording, RenderError, ShaderSources};
use crate::gpu::{
    AddressMode, Clock, Commands, Filter, Filtering, Gpu, GpuBuffer, GpuError, GpuImage, ImageFormat, ImageShape,
    NextUse, Pace, Pipeline, Sampler, ScreenEncoding,
};
use crate::plan::TableFormat;

/// Images, buffers and pipelines that outlive a frame.
pub struct Resources {
    /// The device.
    pub gpu: Gpu,
    shaders: ShaderSources,
    sampler: Sampler,
    images: BTreeMap<&'static str, GpuImage>,
    buffers: BTreeMap<&'static str, GpuBuffer>,
    /// What the host has filled buffers with.
    filled: BTreeMap<&'static str, Vec<u8>>,
    /// What the next recording copies into buffers.
    uploads: Vec<(GpuBuffer, Vec<u8>)>,
    /// Those of other groups of wavelengths than the one at the front.
    parked: Vec<Parked>,
    group: usize,
    pipelines: Pipelines,
    /// Where shaders that are not compiled yet will find their parameters.
    pub parameter_buffers: ParameterBuffers,
    /// The widest format of tables that the device can interpolate.
    pub widest_tables: TableFormat,
    /// How long submissions may be, where others use the device as well.
    pub pace: Option<Pace>,
    /// What the picture is encoded for.
    pub screen: ScreenEncoding,
    /// What times are taken with; none for the best that the device has.
    pub clock: Option<Clock>,
    /// Light around lamps, of the kinds of matter that were seen last.
    pub angular_fields: AngularFields,
    /// Light scattered in fog, of the banks that were seen last.
    pub slab_fields: SlabFields,
    /// Images of the host's that a frame is drawn into, and what it does with them next.
    pub targets: Vec<(&'static str, GpuImage, NextUse)>,
    /// The frame of a host's that is being recorded.
    pub host: Option<HostRecording>,
}

/// Images and buffers of a group that is not at the front.
#[derive(Default)]
struct Parked {
    images: BTreeMap<&'static str, GpuImage>,
    buffers: BTreeMap<&'static str, GpuBuffer>,
    filled: BTreeMap<&'static str, Vec<u8>>,
}

/// The widest format of tables that can be interpolated, by how 32-bit and half floats are filtered.
fn widest_tables(filtering: [Filtering; 2]) -> Option<TableFormat> {
    match filtering {
        [Filtering::Linear, _] => Some(TableFormat::Float32),
        [_, Filtering::Linear] => Some(TableFormat::Float16),
        _ => None,
    }
}

impl Resources {
    /// Nothing yet, but a device that can hold the tables.
    ///
    /// # Errors
    /// As [`Resources::with_shaders`].
    pub fn new(gpu: Gpu) -> Result<Self, RenderError> {
        Self::with_shaders(gpu, ShaderSources::embedded())
    }

    /// The same with other shaders than the built-in ones.
    ///
    /// # Errors
    /// [`RenderError::NoLinearFilter`] when the device can interpolate tables of no format.
    pub fn with_shaders(gpu: Gpu, shaders: ShaderSources) -> Result<Self, RenderError> {
        let device = gpu.info().name.clone();
        let formats = [ImageFormat::Rgba32Float, ImageFormat::Rgba16Float].map(|format| gpu.filtering(format));
        let widest_tables = widest_tables(formats).ok_or(RenderError::NoLinearFilter { device })?;
        if widest_tables == TableFormat::Float16 {
            let name = &gpu.info().name;
            tracing::warn!("'{name}' cannot interpolate 32-bit floats: tables are half floats at every quality");
        }
        let sampler = gpu.sampler(Filter::Linear, [AddressMode::Clamp; 3])?;
        Ok(Self {
            parameter_buffers: gpu.parameter_buffers(),
            gpu,
            shaders,
            sampler,
            images: BTreeMap::new(),
            buffers: BTreeMap::new(),
            filled: BTreeMap::new(),
            uploads: Vec::new(),
            parked: Vec::new(),
            group: 0,
            pipelines: Pipelines::default(),
            widest_tables,
            pace: None,
            screen: ScreenEncoding::Srgb,
            clock: None,
            angular_fields: AngularFields::default(),
            slab_fields: SlabFields::default(),
            targets: Vec::new(),
            host: None,
        })
    }

    /// The image of a name, made anew unless it has this shape and format already.
    pub fn image(&mut self, name: &'static str, shape: ImageShape, format: ImageFormat) -> Result<GpuImage, GpuError> {
        if let Some(image) = self.images.get(name)
            && (image.shape(), image.format()) == (shape, format)
        {
            return Ok(image.clone());
        }
        let image = self.gpu.image(name, shape, format)?;
        self.images.insert(name, image.clone());
        Ok(image)
    }

    /// Takes in an image that was made elsewhere.
    pub fn keep(&mut self, name: &'static str, image: GpuImage) {
        self.images.insert(name, image);
    }

    /// Exchanges the images of two names; either may have none.
    pub fn exchange(&mut self, a: &'static str, b: &'static str) {
        let [of_a, of_b] = [a, b].map(|name| self.images.remove(name));
        self.images.extend([(a, of_b), (b, of_a)].into_iter().filter_map(|(name, image)| Some((name, image?))));
    }

    /// The image of a name, if a pass has left one.
    pub fn existing_image(&self, name: &str) -> Option<&GpuImage> {
        self.images.get(name)
    }

    /// Has the next recording fill the storage buffer of a name; what it holds already is not copied again.
    pub fn fill_buffer<T: bytemuck::NoUninit>(&mut self, name: &'static str, content: &[T]) -> Result<(), GpuError> {
        let bytes: &[u8] = bytemuck::cast_slice(content);
        if self.filled.get(name).is_some_and(|held| held == bytes) {
            return Ok(());
        }
        let buffer = self.buffer(name, bytes.len() as u64)?;
        self.filled.insert(name, bytes.to_vec());
        self.uploads.push((buffer, bytes.to_vec()));
        Ok(())
    }

    /// Copies into buffers what they are to be filled with. It is remembered until the recording has ended well.
    pub fn record_uploads(&self, commands: &mut Commands) -> Result<(), GpuError> {
        self.uploads.iter().try_for_each(|(buffer, content)| commands.upload(buffer, content))
    }

    /// The uploads are on the device, or will be before what comes next.
    pub fn finish_uploads(&mut self) {
        self.uploads.clear();
    }

    /// Fills buffers at once. Nothing may be being recorded.
    pub fn upload_now(&mut self) -> Result<(), GpuError> {
        self.uploads.drain(..).try_for_each(|(buffer, content)| self.gpu.write_buffer(&buffer, &content))
    }

    /// The storage buffer of a name, made anew unless it has this size already.
    pub fn buffer(&mut self, name: &'static str, bytes: u64) -> Result<GpuBuffer, GpuError> {
        if let Some(buffer) = self.buffers.get(name).filter(|buffer| buffer.bytes() == bytes) {
            return Ok(buffer.clone());
        }
        let buffer = self.gpu.storage_buffer(name, bytes)?;
        self.buffers.insert(name, buffer.clone());
        Ok(buffer)
    }

    /// The buffer of a name, if it was made.
    pub fn existing_buffer(&self, name: &str) -> Option<&GpuBuffer> {
        self.buffers.get(name)
    }

    /// The one sampler: linear, clamped.
    pub fn sampler(&self) -> &Sampler {
        &self.sampler
    }

    /// Frees what a skipped pass would have left; targets stay.
    pub fn release(&mut self, name: &str) {
        if self.targets.iter().all(|(target, ..)| *target != name) {
            self.images.remove(name);
        }
    }

    /// Forgets all images and buffers: their contents are not what was thought.
    pub fn forget(&mut self) {
        self.images.clear();
        self.buffers.clear();
        self.filled.clear();
        self.uploads.clear();
        self.parked.clear();
    }

    /// Brings the images and buffers of a group of wavelengths to the front; those of `shared` names come along.
    pub fn select_group(&mut self, group: usize, shared: &[&'static str]) {
        if group == self.group {
            return;
        }
        let groups = self.parked.len().max(group + 1).max(self.group + 1);
        self.parked.resize_with(groups, Parked::default);
        let mut next = std::mem::take(&mut self.parked[group]);
        for name in shared {
            next.images.extend(self.images.remove_entry(name));
        }
        let images = std::mem::replace(&mut self.images, next.images);
        let buffers = std::mem::replace(&mut self.buffers, next.buffers);
        let filled = std::mem::replace(&mut self.filled, next.filled);
        self.parked[self.group] = Parked { images, buffers, filled };
        self.group = group;
    }

    /// Takes other shaders. Every pipeline that is kept is compiled first: where one fails, all stay.
    pub fn set_shaders(&mut self, shaders: ShaderSources) -> Result<(), RenderError> {
        let compile = |pass: &str, definitions: &Definitions| {
            compile(&self.gpu, &shaders, pass, definitions, self.parameter_buffers)
        };
        let pipelines = self.pipelines.compiled_anew(&shaders, compile)?;
        (self.shaders, self.pipelines) = (shaders, pipelines);
        Ok(())
    }

    /// The pipeline of a pass, specialised; compiled unless it is kept from before.
    pub fn pipeline(&mut self, pass: &'static str, definitions: &Definitions) -> Result<Pipeline, RenderError> {
        let Self { gpu, shaders, parameter_buffers, pipelines, .. } = self;
        let compile = |relevant: &Definitions| compile(gpu, shaders, pass, relevant, *parameter_buffers);
        pipelines.get(shaders, pass, definitions, compile)
    }

    /// Compiles the pipelines of passes with their definitions, side by side, where they are not kept from before.
    pub fn compile_ahead(&mut self, expected: &[(&'static str, Definitions)]) {
        let Self { gpu, shaders, parameter_buffers, pipelines, .. } = self;
        let compile = |pass: &str, relevant: &Definitions| compile(gpu, shaders, pass, relevant, *parameter_buffers);
        pipelines.compile_ahead(shaders, expected, compile);
    }

    /// How many pipelines were compiled ahead and never asked for.
    pub fn idle_pipelines(&self) -> usize {
        self.pipelines.idle()
    }

    /// How many pipelines have been compiled so far.
    pub fn compiled_pipelines(&self) -> u64 {
        self.pipelines.compiled
    }

    /// Begins a recording: what earlier ones have compiled and not used for long is let go (`Pipelines`).
    pub fn begin_recording(&mut self) {
        self.pipelines.begin_recording();
    }
}

fn compile(
    gpu: &Gpu,
    shaders: &ShaderSources,
    pass: &str,
    definitions: &Definitions,
    buffers: ParameterBuffers,
) -> Result<Pipeline, RenderError> {
    Ok(gpu.pipeline(&Shader::with_parameters(shaders, pass, definitions, buffers)?)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_that_interpolates_half_floats_alone_gets_tables_of_them() {
        use Filtering::{Linear, NearestOnly};
        assert_eq!(widest_tables([Linear, Linear]), Some(TableFormat::Float32));
        assert_eq!(widest_tables([NearestOnly, Linear]), Some(TableFormat::Float16));
        assert_eq!(widest_tables([NearestOnly, NearestOnly]), None);
    }
}
