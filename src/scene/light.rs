//! What shines on the scene.

use glam::DVec3;
use welkin_lut::{BAND_COUNT, Bands};

use super::{Direction, LitSphere};

/// A source of light outside the medium.
#[derive(Debug, Clone, PartialEq)]
pub enum Light {
    /// So far away that its rays are parallel, but for the width of its disc: the sun, a moon.
    Directional(DirectionalLight),
    /// A point that shines equally in all directions, or into a cone.
    Point(PointLight),
    /// Uniform radiance from every direction of the surrounding space.
    Environment(EnvironmentLight),
}

/// A disc at infinity.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectionalLight {
    /// What it is called in reports: "sun", "moon".
    pub name: String,
    /// Where its centre stands in the sky, without refraction.
    pub direction: Direction,
    /// Irradiance on a plane normal to the beam, above the atmosphere, W·m⁻²·nm⁻¹.
    pub irradiance: Bands,
    /// Angular radius of the disc, rad; 0 is an exactly parallel beam with no visible disc.
    pub angular_radius_rad: f64,
    /// Whether the disc darkens towards its limb as the sun's does.
    pub limb_darkening: bool,
    /// Light spread over the disc as over a sphere lit from one side, in place of limb darkening: a moon.
    pub sphere: Option<LitSphere>,
    /// Wavelengths of the three bands, nm, on which limb darkening depends.
    pub wavelengths_nm: Bands,
}

impl DirectionalLight {
    /// How the disc's radiance falls towards its limb: as μ^k, μ the cosine of the angle at which the line of sight
    /// leaves the sun; zero for a disc without limb darkening. The mean of μ^k over a disc is 2 / (2 + k).
    ///
    /// k = -0.023 + 0.292 µm / λ: Hestroffer & Magnan 1998, A&A 333, 338, eq. 5.
    pub fn limb_exponent(&self) -> Bands {
        match self.limb_darkening {
            true => self.wavelengths_nm.map(|wavelength_nm| -0.023 + 292.0 / wavelength_nm),
            false => [0.0; BAND_COUNT],
        }
    }
}

/// A point source.
#[derive(Debug, Clone, PartialEq)]
pub struct PointLight {
    /// What it is called in reports.
    pub name: String,
    /// Position in the local frame (east, north, up) from the ground point below the camera, m.
    pub position_m: DVec3,
    /// Radiant intensity, W·sr⁻¹·nm⁻¹: in all directions, or along the axis of the cone.
    pub intensity: Bands,
    /// What it shines into; none is everywhere.
    pub cone: Option<Cone>,
    /// When it shines, for a moment; none is always.
    pub flash: Option<Flash>,
}

impl PointLight {
    /// Radiant intensity at a time of the scene, W·sr⁻¹·nm⁻¹.
    pub fn intensity_at(&self, time_s: f64) -> Bands {
        let share = self.flash.map_or(1.0, |flash| flash.share(time_s));
        self.intensity.map(|intensity| share * intensity)
    }
}

/// Light that comes at once and fades: a stroke of lightning, an explosion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flash {
    /// When it is brightest, s of the scene's time.
    pub start_s: f64,
    /// In which time it fades to 1/e, s; above 0.
    pub decay_s: f64,
}

impl Flash {
    /// Share of the intensity at a time: none before the start, and e^(-(t - start) / decay) after it. Less than a millionth
    /// counts as none.
    pub fn share(&self, time_s: f64) -> f64 {
        let share = ((self.start_s - time_s) / self.decay_s).exp();
        if (1e-6..=1.0).contains(&share) { share } else { 0.0 }
    }
}

/// Directions that a spot light shines into.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// Where its axis points.
    pub axis: Direction,
    /// Cosine of the angle up to which it shines in full.
    pub inner_cosine: f64,
    /// Cosine of the angle beyond which it does not shine; below the inner.
    pub outer_cosine: f64,
}

impl Cone {
    /// Share of the intensity in a direction away from the light whose angle from the axis has this cosine: a cubic
    /// between the two angles.
    pub fn share(&self, cosine: f64) -> f64 {
        let x = ((cosine - self.outer_cosine) / (self.inner_cosine - self.outer_cosine)).clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    }
}

/// Uniform surroundings.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentLight {
    /// Radiance arriving from every direction of space, W·m⁻²·sr⁻¹·nm⁻¹.
    pub radiance: Bands,
}
