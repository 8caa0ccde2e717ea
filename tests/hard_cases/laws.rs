//! What holds in every picture, whatever the scene: finite, not negative, transmittance in [0, 1], falling with distance.

use std::fmt;

use welkin::frame::Frame;
use welkin::scene::Scene;
use welkin_lut::spectrum::Channels;

/// A value that breaks a law, with what it was made from.
#[derive(Debug, Clone, PartialEq)]
pub struct Broken {
    /// What does not hold.
    pub law: &'static str,
    /// Where, from the top left.
    pub pixel: [u32; 2],
    /// The value in the three bands or channels.
    pub value: [f64; 3],
    /// Where the pixel looks, degrees above the horizontal and clockwise from north.
    pub view_deg: [f64; 2],
    /// What the scene is, in short.
    pub inputs: String,
}

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([x, y], [elevation, azimuth]) = (self.pixel, self.view_deg);
        write!(f, "{}: {:?} at column {x}, row {y}, ", self.law, self.value)?;
        write!(f, "looking {elevation:.6}° up towards {azimuth:.4}°; {}", self.inputs)
    }
}

/// Where a pixel's centre looks: elevation and azimuth, degrees.
pub fn view_deg(scene: &Scene, [x, y]: [u32; 2]) -> [f64; 2] {
    let view = scene.camera.direction_through(f64::from(x) + 0.5, f64::from(y) + 0.5);
    [view.z.clamp(-1.0, 1.0).asin().to_degrees(), view.x.atan2(view.y).to_degrees()]
}

/// What a value was made from, for messages.
pub fn inputs(scene: &Scene) -> String {
    let (planet, camera) = (&scene.planet, &scene.camera);
    let constituents: Vec<_> = scene.medium.constituents.iter().map(|c| format!("{c:?}")).collect();
    format!(
        "camera at {} m, planet {} m, air {} m; lights {:?}; medium {}",
        camera.altitude_m,
        planet.radius_m,
        planet.atmosphere_height_m,
        scene.lights,
        constituents.join(", ")
    )
}

/// What must hold for every texel.
type Law = (&'static str, fn([f32; 3]) -> bool);

/// Of bands, each of which is light of its own.
const OF_BANDS: [Law; 2] = [
    ("radiance must not be negative", |v| v.iter().all(|v| v.is_nan() || *v >= 0.0)),
    ("transmittance must lie in [0, 1]", |v| v.iter().all(|v| (0.0..=1.0).contains(v))),
];

/// Of colours, whose channels may leave these ranges where a colour lies beyond their gamut, as that of a sun on the horizon does. What
/// spectra add up to without negative weights may not: luminance, and so one channel at least. Weights of white are rounded.
const OF_COLOURS: [Law; 2] = [
    ("some channel of radiance must not be negative", |v| v.iter().any(|v| v.is_nan() || *v >= 0.0)),
    ("some channel of transmittance must be 0 or more, and some 1 or less", |v| {
        v.iter().any(|v| *v >= 0.0) && v.iter().any(|v| *v <= 1.0 + 4.0 * f32::EPSILON)
    }),
];

/// What a picture breaks, the first pixel of each law.
pub fn broken(scene: &Scene, frame: &Frame) -> Vec<Broken> {
    let [radiance, transmittance] = match scene.spectrum.channels {
        Channels::Bands => OF_BANDS,
        Channels::Colour(_) => OF_COLOURS,
    };
    let finite: Law = ("radiance must be finite", |v| v.iter().all(|v| v.is_finite()));
    let finite_transmittance: Law = ("transmittance must be finite", |v| v.iter().all(|v| v.is_finite()));
    let mut broken = first_broken(scene, &frame.radiance, &[finite, radiance]);
    broken.extend(first_broken(scene, &frame.transmittance, &[finite_transmittance, transmittance]));
    let distances: Vec<_> = frame.distance_m.iter().map(|&distance_m| [distance_m; 3]).collect();
    broken.extend(first_broken(scene, &distances, &[("distance must not be negative", |v| v[0] >= 0.0)]));
    broken
}

fn first_broken(scene: &Scene, texels: &[[f32; 3]], laws: &[Law]) -> Vec<Broken> {
    let width = scene.camera.width;
    let breaks = |&(law, holds): &Law| {
        let at = texels.iter().position(|&texel| !holds(texel))?;
        let pixel = [at as u32 % width, at as u32 / width];
        let (value, view_deg) = (texels[at].map(f64::from), view_deg(scene, pixel));
        Some(Broken { law, pixel, value, view_deg, inputs: inputs(scene) })
    };
    laws.iter().filter_map(breaks).collect()
}

/// The first texel in which two pictures of one scene are not the same to the last bit: by how much the second is more.
pub fn differs(scene: &Scene, first: &Frame, second: &Frame) -> Option<Broken> {
    let distances = |frame: &Frame| frame.distance_m.iter().map(|&distance_m| [distance_m; 3]).collect::<Vec<_>>();
    first_difference(scene, "radiance must not depend on what was drawn before", &first.radiance, &second.radiance)
        .or_else(|| {
            let law = "transmittance must not depend on what was drawn before";
            first_difference(scene, law, &first.transmittance, &second.transmittance)
        })
        .or_else(|| {
            let law = "distance must not depend on what was drawn before";
            first_difference(scene, law, &distances(first), &distances(second))
        })
}

fn first_difference(scene: &Scene, law: &'static str, first: &[[f32; 3]], second: &[[f32; 3]]) -> Option<Broken> {
    let at = first.iter().zip(second).position(|(a, b)| a.map(f32::to_bits) != b.map(f32::to_bits))?;
    let pixel = [at as u32 % scene.camera.width, at as u32 / scene.camera.width];
    let value = std::array::from_fn(|i| f64::from(second[at][i]) - f64::from(first[at][i]));
    Some(Broken { law, pixel, value, view_deg: view_deg(scene, pixel), inputs: inputs(scene) })
}

/// How much transmittance rises, at most, from one distance to the next longer one.
pub fn rise(transmittances: &[[f64; 3]]) -> f64 {
    let pairs = transmittances.windows(2).flat_map(|pair| (0..3).map(|band| pair[1][band] - pair[0][band]));
    pairs.fold(0.0, f64::max)
}
