//! Diffuse light inside a wide, even slab of matter on a Lambertian ground, under a beam and under an even sky.
//!
//! A point in the slab has one optical depth above it and another below. Both are nodes of a table, so that what happens near
//! either surface is resolved however thick the slab is. For each node the reflection and transmission of that much matter
//! are found by doubling, and the slabs above and below a point, the latter with the ground, are joined there by adding
//! (van de Hulst 1963; Hansen & Travis 1974, Space Science Reviews 16, section 3), with [`STREAMS`] directions in each hemisphere.
//!
//! The phase function has [`MOMENTS`] moments: those of the similar medium which stands for one that scatters forward (Joseph,
//! Wiscombe & Weinman 1976; Wiscombe 1977). What of radiance goes as the cosine of a multiple of the azimuth from the beam is followed
//! by itself, [`MODES`] of them (Chandrasekhar 1960, section 48). A ground that sends light up evenly takes all but the mean over azimuths.
//! Of the light at a point a table keeps what matter there scatters of it into each direction.

mod layer;
mod matrix;

use std::f64::consts::PI;

use layer::{Doubled, Layer, Source, Streams, associated};
use matrix::{Matrix, Vector};

/// Directions in each hemisphere.
pub const STREAMS: usize = 8;
/// Moments of a phase function.
pub const MOMENTS: usize = 2 * STREAMS;
/// Multiples of the azimuth, from 0.
pub const MODES: usize = 12;
/// Elevations of a table, from straight down to straight up.
pub const ELEVATIONS: usize = 17;
/// Azimuths of a beam's table, from the beam's own to the opposite.
pub const AZIMUTHS: usize = 13;
/// Optical depths of a table along each axis.
pub const DEPTHS: usize = 24;
/// Depths are nodes of ln(1 + depth / this).
pub const NEAR_DEPTH: f64 = 0.05;
/// The last of them; what lies deeper is as deep.
pub const LAST_DEPTH: f64 = 60.0;

/// The optical depth of a node.
pub fn node_depth(node: usize) -> f64 {
    NEAR_DEPTH * ((1.0 + LAST_DEPTH / NEAR_DEPTH).powf(node as f64 / (DEPTHS - 1) as f64) - 1.0)
}

/// The matter of a slab and the ground below it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlabMatter {
    /// Single-scattering albedo, in [0, 1].
    pub albedo: f64,
    /// Legendre moments of the phase function, the first of which is 1.
    pub moments: [f64; MOMENTS],
    /// Albedo of the ground, in [0, 1].
    pub ground_albedo: f64,
}

/// Where light comes from, with a flux of 1 through a horizontal plane above the slab.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SlabLight {
    /// Parallel light from a direction of this cosine with the vertical, in (0, 1].
    Beam(f64),
    /// Light of the same radiance from everywhere above.
    Sky,
}

/// The elevation of a table's node, rad.
pub fn node_elevation_rad(node: usize) -> f64 {
    PI * (node as f64 / (ELEVATIONS - 1) as f64 - 0.5)
}

/// The azimuth of a table's node, rad.
pub fn node_azimuth_rad(node: usize) -> f64 {
    PI * node as f64 / (AZIMUTHS - 1) as f64
}

/// Diffuse light at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct SlabField {
    /// Flux downwards through a horizontal plane.
    pub downward: f64,
    /// Flux upwards.
    pub upward: f64,
    /// Mean radiance of the directions upwards, 1/sr.
    pub mean_upward: f64,
    /// Radiance that matter sends on per scattering coefficient, 1/sr: for elevations of the direction in which it goes, and then azimuths, which
    /// come faster. Of the sky's light there is one azimuth.
    pub scattered_per_sr: Vec<f64>,
}

/// Layers of all depths of a table, for one mode.
#[derive(Debug, Clone)]
struct Layers {
    streams: Streams,
    layers: Vec<Doubled>,
    /// Λ_l^m at a table's elevations, of the cosine downwards.
    at_elevations: Vec<[f64; MOMENTS]>,
}

impl Layers {
    fn new(mode: usize, matter: &SlabMatter) -> Self {
        let streams = Streams::new(mode, matter.albedo.clamp(0.0, 1.0), &matter.moments);
        let layers = (0..DEPTHS).map(|node| Doubled::new(&streams, node_depth(node))).collect();
        let at_elevations = (0..ELEVATIONS).map(|node| associated(mode, -node_elevation_rad(node).sin())).collect();
        Self { streams, layers, at_elevations }
    }

    /// What each layer scatters out of a beam whose flux is 1 at its top.
    fn sources(&self, light: SlabLight) -> Vec<Source> {
        match light {
            SlabLight::Beam(mu) => self.layers.iter().map(|layer| layer.source(&self.streams, mu)).collect(),
            SlabLight::Sky => vec![Source::default(); DEPTHS],
        }
    }
}

/// Slabs of one kind of matter.
#[derive(Debug, Clone)]
pub struct Slabs {
    matter: SlabMatter,
    modes: Vec<Layers>,
}

impl Slabs {
    /// Of this matter, with all depths of a table.
    pub fn new(matter: SlabMatter) -> Self {
        Self { matter, modes: (0..MODES).map(|mode| Layers::new(mode, &matter)).collect() }
    }

    /// The table of a light: the diffuse field below one node's depth and above another's, the latter fastest.
    pub fn table(&self, light: SlabLight) -> Vec<SlabField> {
        let azimuths = if light == SlabLight::Sky { 1 } else { AZIMUTHS };
        let dark = SlabField {
            downward: 0.0,
            upward: 0.0,
            mean_upward: 0.0,
            scattered_per_sr: vec![0.0; ELEVATIONS * azimuths],
        };
        let mut table = vec![dark; DEPTHS * DEPTHS];
        let modes = if light == SlabLight::Sky { &self.modes[..1] } else { &self.modes };
        for (mode, layers) in modes.iter().enumerate() {
            let sources = layers.sources(light);
            let grounds: Vec<_> =
                (0..DEPTHS).map(|node| self.on_ground(layers, mode, node, &sources[node], light)).collect();
            let cosines: Vec<f64> = (0..azimuths).map(|node| (mode as f64 * node_azimuth_rad(node)).cos()).collect();
            for (index, field) in table.iter_mut().enumerate() {
                let (above, below) = (index / DEPTHS, index % DEPTHS);
                let layer = layers.layers[above].whole();
                let entering = match light {
                    SlabLight::Beam(_) => sources[above].down,
                    SlabLight::Sky => layer.transmitted.times(&[1.0 / PI; STREAMS]),
                };
                let (reflected, upward) = &grounds[below];
                let beam = beam_left(light, node_depth(above));
                let (down, up) = joined(layer, &entering, reflected, &upward.map(|radiance| beam * radiance));
                field.add(layers, mode, &down, &up, &cosines);
            }
        }
        table
    }

    /// Reflection of a layer that lies on the ground, and what it sends up of a beam whose flux is 1 at its top.
    fn on_ground(
        &self,
        layers: &Layers,
        mode: usize,
        node: usize,
        source: &Source,
        light: SlabLight,
    ) -> (Matrix, Vector) {
        let (streams, layer, albedo) = (&layers.streams, layers.layers[node].whole(), self.matter.ground_albedo);
        if mode > 0 {
            return (layer.reflected, source.up);
        }
        // The ground sends up its albedo of the flux that arrives, evenly; the layer returns some of that.
        let flux_of_even = streams.flux(&layer.reflected.times(&[1.0; STREAMS]));
        let per_flux = albedo / PI / (1.0 - albedo / PI * flux_of_even);
        let risen = layer.transmitted.times(&[1.0; STREAMS]);
        let returned =
            Matrix::from_fn(|row, column| risen[row] * per_flux * streams.flux(&layer.transmitted.column(column)));
        let arriving = streams.flux(&source.down) + beam_left(light, node_depth(node));
        let sent = std::array::from_fn(|i| source.up[i] + risen[i] * per_flux * arriving);
        (layer.reflected.sum(&returned), sent)
    }
}

impl SlabField {
    /// Adds radiances of a mode, of whose azimuths these are the cosines.
    fn add(&mut self, layers: &Layers, mode: usize, down: &Vector, up: &Vector, cosines: &[f64]) {
        if mode == 0 {
            // Where hardly any light arrives roundings are below nothing.
            let above_nothing = |value: f64| value.clamp(0.0, f64::INFINITY);
            self.downward = above_nothing(layers.streams.flux(down));
            self.upward = above_nothing(layers.streams.flux(up));
            self.mean_upward = above_nothing(layers.streams.mean(up));
        }
        let moments = layers.streams.moments(down, up);
        let rows = self.scattered_per_sr.chunks_exact_mut(cosines.len()).zip(&layers.at_elevations);
        for (row, at_elevation) in rows {
            let scattered = layers.streams.scattered(&moments, at_elevation);
            row.iter_mut().zip(cosines).for_each(|(value, cosine)| *value += scattered * cosine);
        }
    }
}

/// Radiances downwards and upwards between a layer and what lies below it.
fn joined(above: &Layer, entering: &Vector, below: &Matrix, sent: &Vector) -> (Vector, Vector) {
    let returned = above.reflected.times(sent);
    let arriving = std::array::from_fn(|i| entering[i] + returned[i]);
    let down = above.reflected.product(below).solve_from_identity(&arriving);
    let reflected = below.times(&down);
    (down, std::array::from_fn(|i| reflected[i] + sent[i]))
}

/// What is left of a beam's flux behind an optical depth.
fn beam_left(light: SlabLight, depth: f64) -> f64 {
    match light {
        SlabLight::Beam(mu) => (-depth / mu).exp(),
        SlabLight::Sky => 0.0,
    }
}
