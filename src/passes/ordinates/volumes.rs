//! Records the passes that solve the light in clouds.

use welkin_shaders::{Definition, Definitions};

use super::Problem;
use crate::gpu::{Commands, GpuImage, ImageFormat, ImageShape, Work};
use crate::passes::recording::{Parameters, dispatch};
use crate::passes::{RenderError, Resources};

/// Bytes of the light in one direction of a cell: sun and sky.
const RADIANCE_BYTES: u64 = 8;
/// Slots of a cell besides its directions: how its light rises along each axis.
const SLOPES: u32 = 3;

/// Images with a texel a cell, and those with a texel a fine texel.
const CELL_IMAGES: [(&str, ImageFormat); 3] = [
    ("ordinates_source", ImageFormat::Rgba32Float),
    ("ordinates_low_faces", ImageFormat::Rgba16Float),
    ("ordinates_high_faces", ImageFormat::Rgba16Float),
];
const FINE_IMAGES: [(&str, ImageFormat); 6] = [
    ("ordinates_extinction", ImageFormat::R32Float),
    ("ordinates_passing", ImageFormat::R32Float),
    ("ordinates_depth", ImageFormat::R32Float),
    ("ordinates_sunlight", ImageFormat::Rgba16Float),
    ("ordinates_skylight", ImageFormat::Rgba16Float),
    ("ordinates_beam", ImageFormat::Rgba16Float),
];

/// What a solution starts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// The next coarser level's solution, darkness on the coarsest.
    Cold,
    /// What the last solution has left.
    Warm,
}

/// The passes that solve one problem, ready to be recorded.
pub struct Volumes<'a> {
    problem: &'a Problem,
    definitions: Definitions,
}

impl<'a> Volumes<'a> {
    /// Fills the parameters and makes what the passes write to. Nothing may be being recorded.
    pub fn prepare(problem: &'a Problem, resources: &mut Resources) -> Result<Self, RenderError> {
        resources.fill_buffer("ordinates", &problem.block())?;
        resources.upload_now()?;
        Self::allocate(problem, problem.definitions(), resources)
    }

    /// Makes what the passes write to; parameters are filled, and among the definitions are the problem's.
    pub(super) fn allocate(
        problem: &'a Problem,
        definitions: Definitions,
        resources: &mut Resources,
    ) -> Result<Self, RenderError> {
        let grid = &problem.grid;
        let [fine, cells] = [grid.fine_texture(), grid.cell_texture()].map(|[x, y, z]| ImageShape::D3(x, y, z));
        for (images, shape) in [(&FINE_IMAGES[..], fine), (&CELL_IMAGES[..], cells)] {
            for &(name, format) in images {
                resources.image(name, shape, format)?;
            }
        }
        resources.buffer("ordinates_radiance", radiance_bytes(problem))?;
        Ok(Self { problem, definitions })
    }

    /// Bytes of all that the passes write to.
    pub fn bytes(problem: &Problem) -> u64 {
        let texels = |extent: [u32; 3]| extent.map(u64::from).iter().product::<u64>();
        let texel = |images: &[(&str, ImageFormat)]| images.iter().map(|(_, format)| format.texel_bytes()).sum::<u64>();
        texels(problem.grid.fine_texture()) * texel(&FINE_IMAGES)
            + texels(problem.grid.cell_texture()) * texel(&CELL_IMAGES)
            + radiance_bytes(problem)
    }

    /// Extinction of the scene's clouds.
    pub(super) fn record_extinction(
        &self,
        resources: &mut Resources,
        commands: &mut Commands,
    ) -> Result<(), RenderError> {
        self.each_level(
            "ordinates_extinction",
            &["ordinates_passing"],
            self.problem.grid.refinement,
            resources,
            commands,
        )
    }

    /// Optical depth towards the sun of the extinction that lies in `ordinates_passing`.
    pub fn record_depth(&self, resources: &mut Resources, commands: &mut Commands) -> Result<(), RenderError> {
        self.each_level("ordinates_depth", &[], self.problem.grid.refinement, resources, commands)
    }

    /// What cells do to light.
    pub fn record_source(&self, resources: &mut Resources, commands: &mut Commands) -> Result<(), RenderError> {
        self.each_level("ordinates_source", &["ordinates_low_faces", "ordinates_high_faces"], 1, resources, commands)
    }

    /// Relaxes the light in every level so many times, the coarsest level first.
    pub fn record_light(
        &self,
        start: Start,
        sweeps: u32,
        resources: &mut Resources,
        commands: &mut Commands,
    ) -> Result<(), RenderError> {
        for index in (0..self.problem.grid.levels.len()).rev() {
            if start == Start::Cold {
                self.relax(index, &["START"], resources, commands)?;
            }
            for _ in 0..sweeps {
                self.relax(index, &[], resources, commands)?;
            }
        }
        Ok(())
    }

    /// Mean and flux of the light.
    pub fn record_moments(&self, resources: &mut Resources, commands: &mut Commands) -> Result<(), RenderError> {
        let names = ["ordinates_sunlight", "ordinates_skylight", "ordinates_beam"];
        let targets = images_of(resources, &names);
        let images: Vec<_> = targets.iter().map(|(name, image)| (name.as_str(), image)).collect();
        for (index, level) in self.problem.grid.levels.iter().enumerate() {
            let mut parameters = Parameters::default();
            parameters.insert("part", &[index as u32]);
            let work = Work::Invocations(level.size.to_array());
            dispatch(resources, commands, "ordinates_moments", self.definitions.clone(), &parameters, &images, work)?;
        }
        Ok(())
    }

    /// Both colours of a level.
    fn relax(
        &self,
        index: usize,
        flags: &[&str],
        resources: &mut Resources,
        commands: &mut Commands,
    ) -> Result<(), RenderError> {
        let mut definitions = self.definitions.clone();
        definitions.extend(flags.iter().map(|flag| ((*flag).to_owned(), Definition::Bool(true))));
        let [x, y, z] = self.problem.grid.levels[index].size.to_array();
        for colour in 0..2_u32 {
            let mut parameters = Parameters::default();
            parameters.insert("sweep", &[index as u32, colour]);
            let work = Work::Invocations([x.div_ceil(2), y, z]);
            dispatch(resources, commands, "ordinates_sweep", definitions.clone(), &parameters, &[], work)?;
        }
        Ok(())
    }

    /// One dispatch a level of a pass that fills the image of its own name and some others, of so many texels along a
    /// cell's edge.
    fn each_level(
        &self,
        pass: &'static str,
        others: &[&'static str],
        texels: u32,
        resources: &mut Resources,
        commands: &mut Commands,
    ) -> Result<(), RenderError> {
        let targets = images_of(resources, &[&[pass], others].concat());
        let images: Vec<_> = targets.iter().map(|(name, image)| (name.as_str(), image)).collect();
        for (index, level) in self.problem.grid.levels.iter().enumerate() {
            let mut parameters = Parameters::default();
            parameters.insert("part", &[index as u32]);
            let work = Work::Invocations((level.size * texels).to_array());
            dispatch(resources, commands, pass, self.definitions.clone(), &parameters, &images, work)?;
        }
        Ok(())
    }
}

fn radiance_bytes(problem: &Problem) -> u64 {
    problem.grid.cell_count() * u64::from(problem.directions.count() + SLOPES) * RADIANCE_BYTES
}

/// Images of those names, by the names of the variables that shaders write them through.
fn images_of(resources: &Resources, names: &[&str]) -> Vec<(String, GpuImage)> {
    let named = |name: &&str| Some((format!("{name}_image"), resources.existing_image(name)?.clone()));
    names.iter().filter_map(named).collect()
}
