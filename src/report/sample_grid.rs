//! Where a picture is compared with the truth: a coarse grid of its pixels.

use welkin_lut::BAND_COUNT;

use crate::frame::Frame;
use crate::scene::{Camera, Light, Scene};

/// Columns of the grid.
const COLUMNS: u32 = 24;
/// Pixels of the picture for each cell of the grid, across and down; odd, so that a cell's centre is a pixel's.
const STRIDE: u32 = 19;

/// A picture and the grid of pixels that are compared. Both cameras see the same, and the ray through the centre of a cell
/// is that through the centre of a pixel of the picture.
#[derive(Debug, Clone)]
pub struct SampleGrid {
    /// The scene with the camera of the picture.
    pub picture: Scene,
    /// The scene with a camera of one pixel for each cell.
    pub cells: Scene,
}

impl SampleGrid {
    /// For a scene's camera: as near to its proportions as whole cells come.
    pub fn new(scene: &Scene) -> Self {
        let Camera { width, height, .. } = scene.camera;
        let rows = (f64::from(COLUMNS * height) / f64::from(width)).round().max(1.0) as u32;
        let with_size = |width, height| Scene { camera: Camera { width, height, ..scene.camera }, ..scene.clone() };
        Self { picture: with_size(COLUMNS * STRIDE, rows * STRIDE), cells: with_size(COLUMNS, rows) }
    }

    /// Radiance of a picture at the centres of the cells, row by row.
    pub fn sample(&self, picture: &Frame) -> Vec<[f32; BAND_COUNT]> {
        let Camera { width, height, .. } = self.cells.camera;
        let centre = |cell: u32| (cell * STRIDE + STRIDE / 2) as usize;
        let at = |row: u32, column: u32| picture.radiance[centre(row) * picture.width as usize + centre(column)];
        (0..height).flat_map(|row| (0..width).map(move |column| at(row, column))).collect()
    }

    /// Cells that do not count, row by row: those in which a light's disc stands. Their value would be the disc's, spread
    /// over the cell by the one picture and over a pixel by the other.
    pub fn left_out(&self) -> Vec<bool> {
        let camera = &self.cells.camera;
        let cell_rad = camera.vertical_field_of_view_rad / f64::from(camera.height);
        let disc = |light: &Light| match light {
            Light::Directional(light) => Some((light.direction.to_vector(), light.angular_radius_rad + cell_rad)),
            _ => None,
        };
        let lights: Vec<_> = self.cells.lights.iter().filter_map(disc).collect();
        let covered = |row: u32, column: u32| {
            let toward = camera.direction_through(f64::from(column) + 0.5, f64::from(row) + 0.5);
            lights.iter().any(|(light, radius_rad)| toward.angle_between(*light) < *radius_rad)
        };
        (0..camera.height)
            .flat_map(|row| (0..camera.width).map(move |column| (row, column)))
            .map(|(r, c)| covered(r, c))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        let text = "preset = \"earth\"\n[sun]\nelevation_deg = 10\nazimuth_deg = 5\n[camera]\naltitude_m = 2\n\
                    elevation_deg = 12\nazimuth_deg = 0\nwidth = 1280\nheight = 720\n";
        Scene::parse(text, "grid.toml".as_ref()).unwrap()
    }

    #[test]
    fn the_centre_of_a_cell_is_the_centre_of_a_pixel() {
        let grid = SampleGrid::new(&scene());
        let (cells, picture) = (grid.cells.camera, grid.picture.camera);
        for (column, row) in [(0, 0), (7, 3), (23, 13)] {
            let pixel = |cell: u32| f64::from(cell * STRIDE + STRIDE / 2) + 0.5;
            let of_cell = cells.direction_through(f64::from(column) + 0.5, f64::from(row) + 0.5);
            assert!((of_cell - picture.direction_through(pixel(column), pixel(row))).length() < 1e-12);
        }
        let mut frame = Frame::new(picture.width, picture.height);
        frame.radiance.iter_mut().enumerate().for_each(|(index, pixel)| *pixel = [index as f32; 3]);
        let sampled = grid.sample(&frame);
        assert_eq!(sampled.len(), (cells.width * cells.height) as usize);
        assert_eq!(sampled[25][0], (28 * picture.width + 28) as f32);
    }

    #[test]
    fn the_cells_around_the_sun_do_not_count_and_all_others_do() {
        let grid = SampleGrid::new(&scene());
        let left_out = grid.left_out().iter().filter(|out| **out).count();
        assert!((1..=6).contains(&left_out), "{left_out}");
        let night = Scene { lights: Vec::new(), ..scene() };
        assert!(SampleGrid::new(&night).left_out().iter().all(|out| !out));
    }
}
