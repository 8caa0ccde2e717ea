//! What the light in clouds depends on, as the shaders read it.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use welkin_shaders::{Definition, Definitions};

use super::coefficients::falloff;
use super::grid::{Grid, Level, Sides};

/// Directions in which light is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Directions {
    /// S8: the corners of a cube.
    Eight,
    /// S16: four cosines of the zenith angle, four azimuths.
    Sixteen,
}

impl Directions {
    /// How many.
    pub fn count(self) -> u32 {
        match self {
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }
}

/// All that the light in clouds depends on besides the clouds.
#[derive(Debug, Clone, PartialEq)]
pub struct Problem {
    /// Where it is solved.
    pub grid: Grid,
    /// Along which directions.
    pub directions: Directions,
    /// Unit vector towards the sun in the grid's frame.
    pub toward_sun: DVec3,
    /// b'/c' of the similar medium, in [0, 1]: W (1 - f) / (1 - W f).
    pub albedo: f64,
    /// g' of the similar medium; see [`super::coefficients`].
    pub reduced_cosine: f64,
    /// Mean albedo of the ground, in [0, 1].
    pub ground_albedo: f64,
}

/// WGSL `Ordinates` up to its levels.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct OrdinatesHeader {
    pub(crate) toward_sun: [f32; 3],
    pub(crate) albedo: f32,
    pub(crate) reduced_cosine: f32,
    pub(crate) ground_albedo: f32,
    pub(crate) falloff: f32,
    pub(crate) padding: f32,
}

/// WGSL `Level`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct LevelBlock {
    pub(crate) lowest_m: [f32; 3],
    pub(crate) first_slice: u32,
    pub(crate) cell_m: [f32; 3],
    pub(crate) first_cell: u32,
    pub(crate) size: [u32; 3],
    pub(crate) padding: u32,
}

impl Problem {
    /// What the shaders are specialised by.
    pub fn definitions(&self) -> Definitions {
        let number = |name: &str, value: u32| (name.to_owned(), Definition::U32(value));
        let flag = |name: &str, value: bool| (name.to_owned(), Definition::Bool(value));
        Definitions::from([
            number("ORDINATES_LEVEL_COUNT", self.grid.levels.len() as u32),
            number("ORDINATES_REFINEMENT", self.grid.refinement),
            flag("ORDINATES_PERIODIC", self.grid.sides == Sides::Periodic),
            flag("ORDINATES_SIXTEEN", self.directions == Directions::Sixteen),
        ])
    }

    /// WGSL `Ordinates`.
    pub fn block(&self) -> Vec<u8> {
        let header = OrdinatesHeader {
            toward_sun: self.toward_sun.as_vec3().to_array(),
            albedo: self.albedo as f32,
            reduced_cosine: self.reduced_cosine as f32,
            ground_albedo: self.ground_albedo as f32,
            falloff: falloff(self.reduced_cosine) as f32,
            padding: 0.0,
        };
        let (mut first_slice, mut first_cell) = (0, 0);
        let block = |level: &Level| {
            let block = LevelBlock {
                lowest_m: level.lowest_m.as_vec3().to_array(),
                first_slice,
                cell_m: level.cell_m.as_vec3().to_array(),
                first_cell,
                size: level.size.to_array(),
                padding: 0,
            };
            first_slice += level.size.z;
            first_cell += level.size.element_product();
            block
        };
        let levels: Vec<_> = self.grid.levels.iter().map(block).collect();
        [bytemuck::bytes_of(&header), bytemuck::cast_slice(&levels)].concat()
    }
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;

    use glam::UVec3;
    use welkin_shaders::compile;

    use super::*;

    #[test]
    fn blocks_lie_in_memory_as_the_shaders_declare_them() {
        let level = Level { lowest_m: DVec3::ZERO, cell_m: DVec3::ONE, size: UVec3::ONE };
        let problem = Problem {
            grid: Grid { levels: vec![level], sides: Sides::Clear, refinement: 1 },
            directions: Directions::Eight,
            toward_sun: DVec3::Z,
            albedo: 1.0,
            reduced_cosine: 0.0,
            ground_albedo: 0.0,
        };
        let shader = compile("ordinates_sweep", &problem.definitions()).unwrap();
        let offset = |name: &str, field: &str| {
            let layout = shader.struct_layout(name).unwrap_or_else(|| panic!("{name}"));
            layout.fields.iter().find(|f| f.name == field).unwrap_or_else(|| panic!("{field}")).offset as usize
        };
        assert_eq!(offset("Ordinates", "reduced_cosine"), offset_of!(OrdinatesHeader, reduced_cosine));
        assert_eq!(offset("Ordinates", "ground_albedo"), offset_of!(OrdinatesHeader, ground_albedo));
        assert_eq!(offset("Ordinates", "falloff"), offset_of!(OrdinatesHeader, falloff));
        assert_eq!(offset("Ordinates", "levels"), size_of::<OrdinatesHeader>());
        assert_eq!(offset("Level", "first_slice"), offset_of!(LevelBlock, first_slice));
        assert_eq!(offset("Level", "cell_m"), offset_of!(LevelBlock, cell_m));
        assert_eq!(offset("Level", "first_cell"), offset_of!(LevelBlock, first_cell));
        assert_eq!(offset("Level", "size"), offset_of!(LevelBlock, size));
        assert_eq!(shader.struct_layout("Level").unwrap().size as usize, size_of::<LevelBlock>());
        assert_eq!(problem.block().len(), size_of::<OrdinatesHeader>() + size_of::<LevelBlock>());
    }
}
