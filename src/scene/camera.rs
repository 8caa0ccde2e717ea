//! Where the picture is taken from and how it is shown.

use glam::DVec3;

use super::Direction;

/// A pinhole camera on the vertical through the local frame's origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Height of the pinhole above the ground, m; below the ground it sees what one sees from the ground.
    pub altitude_m: f64,
    /// Where the centre of the picture looks.
    pub direction: Direction,
    /// Angle between the picture's lower and upper edge, rad.
    pub vertical_field_of_view_rad: f64,
    /// Width of the picture, pixels.
    pub width: u32,
    /// Height of the picture, pixels.
    pub height: u32,
}

impl Camera {
    /// Unit vectors to the picture's right, to its top and through its centre, in the local frame. The picture's right
    /// is horizontal, also where the camera looks straight up or down.
    pub fn basis(&self) -> [DVec3; 3] {
        let (sin_azimuth, cos_azimuth) = self.direction.azimuth_rad.sin_cos();
        let right = DVec3::new(cos_azimuth, -sin_azimuth, 0.0);
        let forward = self.direction.to_vector();
        [right, right.cross(forward), forward]
    }

    /// Unit vector through a point of the picture, in pixels from its top left corner.
    pub fn direction_through(&self, x: f64, y: f64) -> DVec3 {
        let [right, up, forward] = self.basis();
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        let half_height = (0.5 * self.vertical_field_of_view_rad).tan();
        let (across, upward) = ((2.0 * x - width) / height, 1.0 - 2.0 * y / height);
        (forward + half_height * (across * right + upward * up)).normalize()
    }
}

/// From linear radiance to a picture on a screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Display {
    /// Exposure: radiance is multiplied by 2^exposure_ev before the tone map.
    pub exposure_ev: f64,
    /// The curve that brings it into [0, 1].
    pub tone_map: ToneMap,
}

/// Curves from [0, ∞) to [0, 1].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ToneMap {
    /// Clip at 1.
    None,
    /// A filmic curve that keeps hue towards white; see `output::display`.
    Filmic,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(elevation_deg: f64, azimuth_deg: f64) -> Camera {
        Camera {
            altitude_m: 2.0,
            direction: Direction { elevation_rad: elevation_deg.to_radians(), azimuth_rad: azimuth_deg.to_radians() },
            vertical_field_of_view_rad: 60_f64.to_radians(),
            width: 301,
            height: 101,
        }
    }

    #[test]
    fn the_middle_pixel_looks_where_the_camera_does() {
        for (elevation, azimuth) in [(0.0, 0.0), (30.0, 250.0), (90.0, 40.0), (-90.0, 0.0)] {
            let camera = camera(elevation, azimuth);
            assert!((camera.direction_through(150.5, 50.5) - camera.direction.to_vector()).length() < 1e-15);
        }
    }

    #[test]
    fn the_picture_is_upright_and_not_mirrored() {
        // Looking north, east is on the right.
        let north = camera(0.0, 0.0);
        assert!(north.direction_through(300.5, 50.5).x > 0.8 && north.direction_through(150.5, 0.5).z > 0.4);
    }

    #[test]
    fn the_field_of_view_spans_the_picture_from_edge_to_edge() {
        // Pixel centres lie half a pixel inside the edges, and pixels are square.
        let camera = camera(20.0, 100.0);
        let tangent = 30_f64.to_radians().tan() * 100.0 / 101.0;
        let cosine = camera.direction_through(150.5, 0.5).dot(camera.direction.to_vector());
        assert!((cosine.acos().tan() - tangent).abs() < 1e-12);
        let sideways = camera.direction_through(200.5, 50.5).dot(camera.direction.to_vector());
        assert!((sideways.acos().tan() - tangent).abs() < 1e-12);
    }
}
