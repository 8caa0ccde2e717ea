//! Diffuse light inside a wide, even slab of matter on a Lambertian ground, under a beam and under an even sky.
//!
//! A point in the slab has one optical depth above it and another below. Both are nodes of a table, so that what happens near
//! either surface is resolved however thick the slab is. For each node the reflection and transmission of that much matter
//! are found by doubling, and the slabs above and below a point, the latter with the ground, are joined there by adding
//! (van de Hulst 1963; Hansen & Travis 1974, Space Science Reviews 16, section 3), with [`STREAMS`] directions in each hemisphere.
//!
//! The phase function has two moments, 1 and g: that of the similar medium which stands for one that scatters forward (Joseph,
//! Wiscombe & Weinman 1976). Of radiance two parts are followed, each by itself: the mean over azimuths, of which means and vertical fluxes
//! are made, and what goes as the cosine of the azimuth from the beam, of which the flux along the slab is. A ground that sends light up evenly takes
//! the latter and returns nothing.

mod layer;

use std::f64::consts::PI;

use layer::{Layer, Matrix, Part, Source, Streams, Vector, source};

/// Directions in each hemisphere.
pub const STREAMS: usize = 8;
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
    /// Mean cosine of scattering, in (-1/3, 1): beyond, a phase function of two moments is negative somewhere.
    pub mean_cosine: f64,
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

/// Diffuse light at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlabField {
    /// Mean radiance over all directions, 1/sr.
    pub mean_radiance: f64,
    /// Flux downwards through a horizontal plane.
    pub downward: f64,
    /// Flux upwards.
    pub upward: f64,
    /// Net flux along the slab, in the direction in which the beam goes.
    pub along: f64,
}

/// Layers of all depths of a table, for one part of radiance.
#[derive(Debug, Clone)]
struct Layers {
    streams: Streams,
    layers: Vec<Layer>,
}

impl Layers {
    fn new(part: Part, matter: &SlabMatter) -> Self {
        let streams = Streams::new(part, matter.albedo.clamp(0.0, 1.0), matter.mean_cosine);
        let layers = (0..DEPTHS).map(|node| Layer::new(&streams, node_depth(node))).collect();
        Self { streams, layers }
    }

    /// What each layer scatters out of a beam whose flux is 1 at its top.
    fn sources(&self, light: SlabLight) -> Vec<Source> {
        match light {
            SlabLight::Beam(mu) => (0..DEPTHS).map(|node| source(&self.streams, node_depth(node), mu)).collect(),
            SlabLight::Sky => vec![Source::default(); DEPTHS],
        }
    }
}

/// Slabs of one kind of matter.
#[derive(Debug, Clone)]
pub struct Slabs {
    matter: SlabMatter,
    mean: Layers,
    cosine: Layers,
}

impl Slabs {
    /// Of this matter, with all depths of a table.
    pub fn new(matter: SlabMatter) -> Self {
        Self { matter, mean: Layers::new(Part::Mean, &matter), cosine: Layers::new(Part::Cosine, &matter) }
    }

    /// The table of a light: the diffuse field below one node's depth and above another's, the latter fastest.
    pub fn table(&self, light: SlabLight) -> Vec<SlabField> {
        let (sources, of_cosine) = (self.mean.sources(light), self.cosine.sources(light));
        let grounds: Vec<_> = (0..DEPTHS).map(|node| self.on_ground(node, &sources[node], light)).collect();
        let mut table = Vec::with_capacity(DEPTHS * DEPTHS);
        for (node, (above, source)) in self.mean.layers.iter().zip(&sources).enumerate() {
            let entering = match light {
                SlabLight::Beam(_) => source.down,
                SlabLight::Sky => above.transmitted.times(&[1.0 / PI; STREAMS]),
            };
            let beam = beam_left(light, node_depth(node));
            for (below, (reflected, upward)) in grounds.iter().enumerate() {
                let (down, up) = joined(above, &entering, reflected, &upward.map(|radiance| beam * radiance));
                let sum: Vector = std::array::from_fn(|i| 0.5 * (up[i] + down[i]));
                let streams = &self.mean.streams;
                table.push(SlabField {
                    mean_radiance: streams.mean(&sum),
                    downward: streams.flux(&down),
                    upward: streams.flux(&up),
                    along: self.along(node, below, &of_cosine, beam),
                });
            }
        }
        table
    }

    /// Net flux along the slab below one node's depth and above another's.
    fn along(&self, above: usize, below: usize, sources: &[Source], beam: f64) -> f64 {
        if beam == 0.0 {
            return 0.0;
        }
        let Layers { streams, layers } = &self.cosine;
        let sent = sources[below].up.map(|radiance| beam * radiance);
        let (down, up) = joined(&layers[above], &sources[above].down, &layers[below].reflected, &sent);
        streams.flux_along(&down) + streams.flux_along(&up)
    }

    /// Reflection of a layer that lies on the ground, and what it sends up of a beam whose flux is 1 at its top.
    fn on_ground(&self, node: usize, source: &Source, light: SlabLight) -> (Matrix, Vector) {
        let Layers { streams, layers } = &self.mean;
        let (layer, albedo) = (&layers[node], self.matter.ground_albedo);
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
