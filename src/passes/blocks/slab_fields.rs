//! Light that fog scatters again and again, as tables for the shaders: for each bank one for each light and one for the sky.

use welkin_lut::forward_peak::moments_of_rest;
use welkin_lut::slab_field::{AZIMUTHS, DEPTHS, ELEVATIONS, SlabField, SlabLight, SlabMatter, Slabs};
use welkin_lut::volume::Volume;
use welkin_lut::{BAND_COUNT, Bands};

use super::volumes::Similar;
use crate::plan::Facts;

/// Cosines of a light's elevation for which tables are solved, from [`LOWEST`] to 1; between them they are interpolated.
const COSINES: usize = 12;
/// A lower light counts as this high.
const LOWEST: f64 = 0.02;

/// Texels of a table: those of all pairs of depths, then the flux downwards on the ground below each depth and the mean
/// radiance upwards above it.
fn table_texels(light: SlabLight) -> usize {
    let azimuths = if light == SlabLight::Sky { 1 } else { AZIMUTHS };
    (DEPTHS * ELEVATIONS * azimuths + 2) * DEPTHS
}

type Texels = Vec<[f32; 4]>;

/// What tables depend on beside the light.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Matter([SlabMatter; BAND_COUNT]);

/// Slabs of one bank's matter with the tables that have been asked for.
#[derive(Debug)]
struct Bank {
    matter: Matter,
    slabs: Vec<Slabs>,
    sky: Texels,
    beams: [Option<Texels>; COSINES],
}

/// Tables of a scene's banks of fog; those that are there already are not made anew.
#[derive(Debug, Default)]
pub struct SlabFields(Vec<Bank>);

fn matter(fog: &Volume, ground_albedo: Bands) -> Matter {
    let (similar, moments) = (Similar::new(fog), moments_of_rest(&fog.phase));
    Matter(std::array::from_fn(|band| SlabMatter {
        albedo: similar.albedo[band],
        moments,
        ground_albedo: ground_albedo[band],
    }))
}

fn cosine(node: usize) -> f64 {
    LOWEST + (1.0 - LOWEST) * (node as f64 / (COSINES - 1) as f64).powi(2)
}

impl Bank {
    fn new(matter: Matter) -> Self {
        // Most fog is grey, and most ground nearly so.
        let mut slabs: Vec<Slabs> = Vec::with_capacity(BAND_COUNT);
        for (band, of_band) in matter.0.iter().enumerate() {
            let same = matter.0[..band].iter().position(|other| other == of_band);
            slabs.push(same.map_or_else(|| Slabs::new(*of_band), |other| slabs[other].clone()));
        }
        let mut bank = Self { matter, slabs, sky: Vec::new(), beams: Default::default() };
        bank.sky = bank.texels(SlabLight::Sky);
        bank
    }

    fn texels(&self, light: SlabLight) -> Texels {
        let mut texels = vec![[0.0; 4]; table_texels(light)];
        let mut tables: Vec<Vec<SlabField>> = Vec::with_capacity(BAND_COUNT);
        for (band, slabs) in self.slabs.iter().enumerate() {
            let same = self.matter.0[..band].iter().position(|other| *other == self.matter.0[band]);
            let table = same.map_or_else(|| slabs.table(light), |other| tables[other].clone());
            let scattered = table.iter().flat_map(|field| field.scattered_per_sr.iter());
            let on_ground = (0..DEPTHS).map(|above| &table[above * DEPTHS].downward);
            let above = table[..DEPTHS].iter().map(|field| &field.mean_upward);
            let values = scattered.chain(on_ground).chain(above);
            texels.iter_mut().zip(values).for_each(|(texel, value)| texel[band] = *value as f32);
            tables.push(table);
        }
        texels
    }

    /// The table of a beam, between those of two cosines.
    fn beam(&mut self, mu: f64) -> Texels {
        let place = ((mu.clamp(LOWEST, 1.0) - LOWEST) / (1.0 - LOWEST)).sqrt() * (COSINES - 1) as f64;
        let low = (place as usize).min(COSINES - 2);
        for node in [low, low + 1] {
            if self.beams[node].is_none() {
                self.beams[node] = Some(self.texels(SlabLight::Beam(cosine(node))));
            }
        }
        let [Some(below), Some(above)] = [&self.beams[low], &self.beams[low + 1]] else {
            unreachable!("both were made above")
        };
        let share = ((mu.clamp(LOWEST, 1.0) - cosine(low)) / (cosine(low + 1) - cosine(low))) as f32;
        let between = |(a, b): (&[f32; 4], &[f32; 4])| std::array::from_fn(|i| a[i] + share * (b[i] - a[i]));
        below.iter().zip(above).map(between).collect()
    }
}

impl SlabFields {
    /// WGSL `array<vec4<f32>>`: bank by bank the lights' tables, then the sky's. One texel where there is no fog.
    pub fn to_texels(&mut self, facts: &Facts) -> Texels {
        let fog = &facts.volumes[..facts.fog_count() as usize];
        let wanted: Vec<Matter> = fog.iter().map(|bank| matter(bank, facts.scene.planet.ground_albedo)).collect();
        self.0.retain(|bank| wanted.contains(&bank.matter));
        let mut all = Vec::new();
        for matter in wanted {
            let known = self.0.iter().position(|bank| bank.matter == matter).unwrap_or_else(|| {
                self.0.push(Bank::new(matter));
                self.0.len() - 1
            });
            for slot in 0..facts.light_slots() as usize {
                let mu = facts.lights.get(slot).map_or(1.0, |light| light.direction.elevation_rad.sin());
                all.append(&mut self.0[known].beam(mu));
            }
            all.extend_from_slice(&self.0[known].sky);
        }
        all.resize(all.len().max(1), [0.0; 4]);
        all
    }
}
