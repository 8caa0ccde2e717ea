//! Hills and mountains on the planet.

use welkin_lut::Bands;
use welkin_lut::height_field::HeightField;

/// Height of the eyes over a mountain that the camera was inside of, m.
const EYE_HEIGHT_M: f64 = 1.0;

/// Ground that is not smooth.
#[derive(Debug, Clone, PartialEq)]
pub struct Terrain {
    /// Its height above the sphere.
    pub field: HeightField,
    /// Lambertian reflectance.
    pub albedo: Bands,
    /// Altitude above which snow lies where it is not steep, m; infinite without snow.
    pub snow_line_m: f64,
    /// Lambertian reflectance of snow.
    pub snow_albedo: Bands,
}

impl Terrain {
    /// Altitude from which a camera sees, m: its own, or, inside a mountain, that of eyes a metre over the ground.
    pub fn eye_altitude_m(&self, camera_altitude_m: f64) -> f64 {
        camera_altitude_m.max(self.height_below_camera_m() + EYE_HEIGHT_M)
    }

    /// Height of the ground below the camera, m.
    pub fn height_below_camera_m(&self) -> f64 {
        self.field.height_at([0.0; 2], 0.0)
    }
}
