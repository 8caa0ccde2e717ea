//! Which pixels the sky, and which marched media are interpolated between.

use super::Facts;
use crate::scene::Camera;

/// Sides of a cell, pixels, from the largest.
const CELLS: [u32; 3] = [16, 8, 4];

/// Widest angle of a cell, rad: over it the sky away from the horizon is a parabola to a few ten-thousandths.
const WIDEST_CELL_RAD: f64 = 0.0131;

/// The same for marched media. A workgroup fills one, and every device has workgroups of 128 invocations.
const MEDIA_CELLS: [u32; 2] = [8, 4];

/// Widest angle of such a cell, rad: wider ones are rarely smooth (docs/fog.md).
const WIDEST_MEDIA_CELL_RAD: f64 = 0.03;

/// The side of the cells of pixels over which a picture of the sky is interpolated, pixels.
///
/// # Errors
/// Why every pixel is evaluated for itself.
pub fn lattice_cell(facts: &Facts) -> Result<u32, String> {
    let (camera, tolerance) = (&facts.scene.camera, facts.settings.lattice_tolerance);
    if tolerance <= 0.0 {
        return Err("every pixel is to be evaluated".to_owned());
    }
    if !facts.has_air() {
        return Err("vacuum: nothing is worth interpolating".to_owned());
    }
    fitting(camera, &CELLS, WIDEST_CELL_RAD)
}

/// The side of the cells of pixels over which marched media are interpolated, pixels.
///
/// # Errors
/// Why every pixel is marched.
pub fn media_cell(facts: &Facts) -> Result<u32, String> {
    if facts.settings.volumes.lattice_permille == 0 {
        return Err("every pixel is to be marched".to_owned());
    }
    fitting(&facts.scene.camera, &MEDIA_CELLS, WIDEST_MEDIA_CELL_RAD)
}

/// The largest of some cells that is no wider than an angle, and of which the picture has four each way.
fn fitting(camera: &Camera, cells: &[u32], widest_rad: f64) -> Result<u32, String> {
    let pixel_rad = 2.0 * (0.5 * camera.vertical_field_of_view_rad).tan() / f64::from(camera.height);
    let fits =
        |cell: &&u32| f64::from(**cell) * pixel_rad <= widest_rad && 4 * **cell <= camera.width.min(camera.height);
    cells.iter().find(fits).copied().ok_or_else(|| {
        let degrees = pixel_rad.to_degrees();
        format!(
            "{} x {} pixels of {degrees:.2}°, too few or too wide to interpolate between",
            camera.width, camera.height
        )
    })
}
