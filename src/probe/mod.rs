//! Single rays through a scene: the question that `welkin probe` puts to every backend.

mod ray_table;
mod rays_error;

use welkin_lut::Bands;

pub use ray_table::RayTable;
pub use rays_error::RaysError;

/// A view ray and where the scene's first directional light stands for it. Angles as in a rays file, but in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Height of the observer above the ground, m.
    pub altitude_m: f64,
    /// Angle between the view direction and the observer's zenith, in [0, π], rad.
    pub view_zenith_rad: f64,
    /// Azimuth of the view direction, clockwise from north, rad.
    pub view_azimuth_rad: f64,
    /// Angle between the direction to the light and the observer's zenith, in [0, π], rad.
    pub sun_zenith_rad: f64,
    /// Azimuth of the direction to the light, clockwise from north, rad.
    pub sun_azimuth_rad: f64,
    /// Where a black surface ends the ray, above 0, m; infinite where the ray runs to the ground or to space. What lies
    /// behind is not seen, and light reaches the air before it as if the surface were not there.
    pub distance_m: f64,
}

/// Which orders of scattering count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Orders {
    /// All of them, and light from the ground.
    #[default]
    All,
    /// Light scattered exactly once in the medium; nothing from the ground.
    Single,
}

/// What a backend answers for one ray; the light's own disc is left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayRadiance {
    /// Spectral radiance arriving at the observer, W·m⁻²·sr⁻¹·nm⁻¹.
    pub radiance: Bands,
    /// Transmittance from the observer to the surface, to the ground or to space.
    pub transmittance: Bands,
    /// One standard error of `radiance`; zero from backends that do not sample.
    pub standard_error: Bands,
}
