//! The light field that the passes find in a voxel cloud.

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use glam::{DVec3, UVec3};
use welkin::gpu::{DeviceRequest, Gpu};
use welkin::passes::ordinates::coefficients::{falloff, forward_share, reduced_cosine};
use welkin::passes::ordinates::{Directions, Grid, Level, Problem, Sides, Start, Volumes};
use welkin::passes::{Resources, ShaderSources};
use welkin::reference::{DensityField, GridField};
use welkin_lut::PhaseFunction;

use super::fields::extent_m;

/// Iterations from darkness; twice as many change no field here by a per cent.
const SWEEPS: u32 = 120;

/// The same for slabs: some rows times as many.
const SWEEPS_PER_ROW: u32 = 40;

/// Fine texels along a cell's edge, as for scenes.
const REFINEMENT: u32 = 2;

/// A device on which fields are solved.
pub struct Solver(Resources);

/// How a field is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    pub directions: Directions,
    pub cell_m: f64,
}

/// Means and fluxes of cells, trilinear in between.
pub struct LightField {
    size: UVec3,
    cell_m: DVec3,
    /// [sun, sky, beam] of each fine texel, times its weight, as `ordinates_moments.wgsl` says.
    moments: Vec<[[f64; 4]; 3]>,
    /// Extinction of each fine texel.
    extinction: Vec<f64>,
    /// Depth of each fine texel to the sun.
    depth: Vec<f64>,
    /// f and g'.
    pub forward_share: f64,
    reduced_cosine: f64,
}

impl Solver {
    pub fn new() -> Result<Self, Box<dyn Error>> {
        Self::with_shaders(None)
    }

    /// With the shaders of a folder in place of the built-in ones.
    pub fn with_shaders(folder: Option<&String>) -> Result<Self, Box<dyn Error>> {
        let shaders = match folder {
            Some(folder) => ShaderSources::from_directory(Path::new(folder))?,
            None => ShaderSources::embedded(),
        };
        Ok(Self(Resources::with_shaders(Gpu::new(&DeviceRequest::default())?, shaders)?))
    }

    /// Fills the grid with the cloud's extinction and solves.
    pub fn solve(
        &mut self,
        cloud: &GridField,
        method: Method,
        phase: &PhaseFunction,
        toward_sun: DVec3,
    ) -> Result<LightField, Box<dyn Error>> {
        let size = (extent_m() / method.cell_m).round().as_uvec3();
        let cell_m = extent_m() / size.as_dvec3();
        let levels = vec![Level { lowest_m: DVec3::ZERO, cell_m, size }];
        let problem = Problem {
            grid: Grid { levels, sides: Sides::Clear, refinement: REFINEMENT },
            directions: method.directions,
            toward_sun,
            albedo: 1.0,
            reduced_cosine: reduced_cosine(phase),
            ground_albedo: 0.0,
        };
        let extinction = texels(cloud, size * REFINEMENT, cell_m / f64::from(REFINEMENT), 1.0 - forward_share(phase));
        self.relax(&problem, &extinction, phase, SWEEPS)
    }

    /// A homogeneous slab of thickness 1 m and an optical depth that goes on to all sides, in rows of cells
    /// four times as wide as high: much wider ones would have slopes across that no slab has, and narrower ones, whose
    /// light comes back to them from the sides, would need more sweeps.
    pub fn slab(
        &mut self,
        depth: f64,
        toward_sun: DVec3,
        phase: &PhaseFunction,
        rows: u32,
    ) -> Result<LightField, Box<dyn Error>> {
        let (size, cell_m) = (UVec3::new(1, 1, rows), DVec3::new(4.0, 4.0, 1.0) / f64::from(rows));
        let levels = vec![Level { lowest_m: DVec3::ZERO, cell_m, size }];
        let problem = Problem {
            grid: Grid { levels, sides: Sides::Periodic, refinement: REFINEMENT },
            directions: Directions::Sixteen,
            toward_sun,
            albedo: 1.0,
            reduced_cosine: reduced_cosine(phase),
            ground_albedo: 0.0,
        };
        let extinction = vec![[(depth * (1.0 - forward_share(phase))) as f32; 2]; 8 * rows as usize];
        self.relax(&problem, &extinction, phase, SWEEPS_PER_ROW * rows)
    }

    fn relax(
        &mut self,
        problem: &Problem,
        extinction: &[[f32; 2]],
        phase: &PhaseFunction,
        sweeps: u32,
    ) -> Result<LightField, Box<dyn Error>> {
        let resources = &mut self.0;
        let volumes = Volumes::prepare(problem, resources)?;
        for (i, name) in ["ordinates_extinction", "ordinates_passing"].into_iter().enumerate() {
            let image = resources.existing_image(name).ok_or("prepared")?.clone();
            let texels: Vec<f32> = extinction.iter().map(|texel| texel[i]).collect();
            resources.gpu.write_image(&image, &texels)?;
        }
        let mut commands = resources.gpu.record("solve")?;
        volumes.record_depth(resources, &mut commands)?;
        volumes.record_source(resources, &mut commands)?;
        volumes.record_light(Start::Cold, sweeps, resources, &mut commands)?;
        volumes.record_moments(resources, &mut commands)?;
        commands.submit_and_wait()?;
        let image = |name| resources.existing_image(name).ok_or("solved");
        let read = |name| -> Result<Vec<[u16; 4]>, Box<dyn Error>> { Ok(resources.gpu.read_image(image(name)?)?) };
        let (sun, sky, beam) = (read("ordinates_sunlight")?, read("ordinates_skylight")?, read("ordinates_beam")?);
        let depth: Vec<f32> = resources.gpu.read_image(image("ordinates_depth")?)?;
        let wide = |texel: &[u16; 4]| texel.map(|bits| f64::from(half::f16::from_bits(bits)));
        let level = problem.grid.levels[0];
        Ok(LightField {
            size: level.size,
            cell_m: level.cell_m,
            moments: sun.iter().zip(&sky).zip(&beam).map(|((a, b), c)| [wide(a), wide(b), wide(c)]).collect(),
            extinction: extinction.iter().map(|texel| f64::from(texel[0])).collect(),
            depth: depth.into_iter().map(f64::from).collect(),
            forward_share: forward_share(phase),
            reduced_cosine: reduced_cosine(phase),
        })
    }
}

/// Extinction of texels times a share, from eight points in each: the mean, and that with which they let light through, as
/// `ordinates_extinction.wgsl` has it.
fn texels(cloud: &GridField, size: UVec3, texel_m: DVec3, share: f64) -> Vec<[f32; 2]> {
    let mut texels = Vec::with_capacity(size.element_product() as usize);
    for z in 0..size.z {
        for y in 0..size.y {
            for x in 0..size.x {
                let corner = UVec3::new(x, y, z).as_dvec3();
                let at = |i: u32| {
                    corner + DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 0.5 + 0.25
                };
                let points: [f64; 8] = std::array::from_fn(|i| share * cloud.density(at(i as u32) * texel_m));
                texels.push([points.iter().sum::<f64>() / 8.0, passing(&points, texel_m)].map(|c| c as f32));
            }
        }
    }
    texels
}

/// -ln ⟨e^-depth⟩ / length over the lines of two points, the mean of the three axes.
fn passing(points: &[f64; 8], texel_m: DVec3) -> f64 {
    let along = |axis: usize| {
        let firsts = (0..8).filter(|i| i >> axis & 1 == 0);
        let depths = firsts.map(|i| 0.5 * texel_m[axis] * (points[i] + points[i | 1 << axis]));
        -(depths.map(|depth| (-depth).exp()).sum::<f64>() / 4.0).max(1e-300).ln() / texel_m[axis]
    };
    (0..3).map(along).sum::<f64>() / 3.0
}

impl LightField {
    /// The place at a height in the middle of the first column.
    pub fn column_m(&self, height_m: f64) -> DVec3 {
        DVec3::new(0.5 * self.cell_m.x, 0.5 * self.cell_m.y, height_m)
    }

    /// Light scattered towards a view ray's observer by the similar medium, per unit of its scattering: sun and sky; the
    /// sun's beam is dimmed to a share. As `ordinates_light.wgsl` has it from a single level.
    pub fn scattered(&self, place_m: DVec3, direction: DVec3, beam: f64) -> [f64; 2] {
        let at = place_m / self.cell_m;
        let (fine, at) = (self.size * REFINEMENT, at * f64::from(REFINEMENT));
        let [fine_extinction] = interpolate(fine, at, |index| [self.extinction[index]]);
        let [sun, sky, falling] = [0, 1, 2].map(|of| interpolate(fine, at, |index| self.moments[index][of]));
        let light = |[x, y, z, mean]: [f64; 4]| mean - self.reduced_cosine * direction.dot(DVec3::new(x, y, z));
        let [x, y, z, mean] = falling;
        let taken = -3.0 * beam / (4.0 * PI) * light([-x, -y, -z, mean]);
        let weight = 100.0 * fine_extinction + 1e-3;
        let ([depth], a) = (interpolate(fine, at, |index| [self.depth[index]]), falloff(self.reduced_cosine));
        let nearer = ((1.0 + a * depth) / (1.0 - a * beam.max(1e-30).ln())).clamp(0.25, 4.0);
        [((nearer * light(sun) + taken) / weight).max(0.0), (light(sky) / weight).max(0.0)]
    }
}

/// Between the centres of texels, at a place in texels from the lowest corner.
fn interpolate<const N: usize>(size: UVec3, at: DVec3, texel: impl Fn(usize) -> [f64; N]) -> [f64; N] {
    let at = (at - 0.5).clamp(DVec3::ZERO, size.as_dvec3() - 1.0);
    let low = at.as_uvec3();
    let share = at - low.as_dvec3();
    let mut sum = [0.0; N];
    for i in 0..8_u32 {
        let corner = UVec3::new(i & 1, i >> 1 & 1, i >> 2);
        let cell = (low + corner).min(size - 1);
        let side = |c: u32, s: f64| if c == 1 { s } else { 1.0 - s };
        let weight = side(corner.x, share.x) * side(corner.y, share.y) * side(corner.z, share.z);
        let found = texel((cell.x + size.x * (cell.y + size.y * cell.z)) as usize);
        sum.iter_mut().zip(found).for_each(|(sum, value)| *sum += weight * value);
    }
    sum
}
