//! What a host has drawn before the sky: distances and colours, pixel by pixel.

use crate::scene::Camera;

/// Surfaces before the camera, row by row from the top left pixel, in a picture of the camera's size.
#[derive(Debug, Clone, PartialEq)]
pub struct Foreground {
    /// Distance along the pixel's ray, m; infinite where no surface is.
    distance_m: Vec<f32>,
    /// Radiance that leaves the surface towards the camera, W·m⁻²·sr⁻¹·nm⁻¹.
    radiance: Vec<[f32; 3]>,
}

/// Why distances and colours are not a foreground.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ForegroundError {
    /// They do not fill the picture.
    #[error("the foreground's {what} has {found} pixels; the scene's camera has {width} x {height}")]
    Size {
        /// Depth or colour.
        what: &'static str,
        /// Pixels found.
        found: usize,
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// A distance is not one.
    #[error(
        "the foreground's depth is {value} at column {column}, row {row}; it must be above 0, infinite for the sky"
    )]
    Distance {
        /// The value refused.
        value: f32,
        /// From the left, from 0.
        column: usize,
        /// From the top, from 0.
        row: usize,
    },
    /// No projection makes such depths.
    #[error(
        "a projection between planes at {near_m} and {far_m} m; the near one must be above 0, the far one beyond it"
    )]
    Projection {
        /// Of the near plane, m.
        near_m: f64,
        /// Of the far plane, m.
        far_m: f64,
    },
    /// A colour is not a radiance.
    #[error("the foreground's colour is {value:?} at column {column}, row {row}; it must be finite and at least 0")]
    Radiance {
        /// The value refused.
        value: [f32; 3],
        /// From the left, from 0.
        column: usize,
        /// From the top, from 0.
        row: usize,
    },
}

/// What a depth buffer's numbers are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Depth {
    /// Distance along the pixel's ray, m.
    #[default]
    Distance,
    /// Distance from the camera's plane, along its axis, m; what engines call linear or eye-space z.
    Planar,
}

impl Foreground {
    /// Surfaces at a depth; without colours they are black, and the picture is the light of the air alone.
    ///
    /// # Errors
    /// [`ForegroundError`] for sizes other than the camera's, and for numbers that are no depth or no radiance. Colours
    /// where no surface is are not looked at.
    pub fn new(
        camera: &Camera,
        depth: Depth,
        depth_m: &[f32],
        radiance: Option<&[[f32; 3]]>,
    ) -> Result<Self, ForegroundError> {
        let (width, height) = (camera.width, camera.height);
        let pixels = width as usize * height as usize;
        let size = |what, found| ForegroundError::Size { what, found, width, height };
        let place = |pixel: usize| (pixel % width as usize, pixel / width as usize);
        if depth_m.len() != pixels {
            return Err(size("depth", depth_m.len()));
        }
        if let Some((pixel, &value)) = depth_m.iter().enumerate().find(|(_, depth)| depth.is_nan() || **depth <= 0.0) {
            let (column, row) = place(pixel);
            return Err(ForegroundError::Distance { value, column, row });
        }
        let black = vec![[0.0; 3]; if radiance.is_some() { 0 } else { pixels }];
        let radiance = radiance.unwrap_or(&black);
        if radiance.len() != pixels {
            return Err(size("colour", radiance.len()));
        }
        let wrong = |pixel: &usize| {
            depth_m[*pixel].is_finite() && radiance[*pixel].iter().any(|band| !band.is_finite() || *band < 0.0)
        };
        if let Some(pixel) = (0..pixels).find(wrong) {
            let (column, row) = place(pixel);
            return Err(ForegroundError::Radiance { value: radiance[pixel], column, row });
        }
        let distance = |(pixel, &depth_m): (usize, &f32)| match depth {
            Depth::Distance => depth_m,
            Depth::Planar => {
                let (column, row) = place(pixel);
                let ray = camera.direction_through(column as f64 + 0.5, row as f64 + 0.5);
                (f64::from(depth_m) / ray.dot(camera.direction.to_vector())) as f32
            }
        };
        Ok(Self { distance_m: depth_m.iter().enumerate().map(distance).collect(), radiance: radiance.to_vec() })
    }

    /// Distance along each pixel's ray, m; infinite where no surface is.
    pub fn distance_m(&self) -> &[f32] {
        &self.distance_m
    }

    /// Radiance that leaves each surface towards the camera.
    pub fn radiance(&self) -> &[[f32; 3]] {
        &self.radiance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Direction;

    fn camera() -> Camera {
        Camera {
            altitude_m: 2.0,
            direction: Direction { elevation_rad: 0.1, azimuth_rad: 1.0 },
            vertical_field_of_view_rad: 1.0,
            width: 3,
            height: 1,
        }
    }

    #[test]
    fn planar_depth_is_the_distance_on_the_axis_and_less_beside_it() {
        let planar = Foreground::new(&camera(), Depth::Planar, &[100.0, 100.0, f32::INFINITY], None).unwrap();
        let half_width = 0.5_f32.tan() * 3.0;
        // The left pixel's centre lies two thirds of the way from the middle to the edge.
        let beside = 100.0 * (1.0 + (half_width * 2.0 / 3.0).powi(2)).sqrt();
        assert!((planar.distance_m()[0] - beside).abs() < 1e-3, "{}", planar.distance_m()[0]);
        assert_eq!(planar.distance_m()[1..], [100.0, f32::INFINITY]);
    }

    #[test]
    fn what_is_no_foreground_is_refused_where_it_stands() {
        let refused = |depth: &[f32], radiance: Option<&[[f32; 3]]>| {
            Foreground::new(&camera(), Depth::Distance, depth, radiance).unwrap_err().to_string()
        };
        assert!(refused(&[1.0; 4], None).contains("4 pixels"));
        assert!(refused(&[1.0, 0.0, 1.0], None).contains("column 1, row 0"));
        assert!(refused(&[1.0, 1.0, f32::NAN], None).contains("NaN"));
        assert!(refused(&[1.0; 3], Some(&[[-1.0; 3]; 3])).contains("column 0"));
        // Where no surface is, its colour does not matter.
        let sky = [f32::INFINITY; 3];
        assert!(Foreground::new(&camera(), Depth::Distance, &sky, Some(&[[f32::NAN; 3]; 3])).is_ok());
    }
}
