//! Which pixels the sky is interpolated between.

use super::Facts;

/// Sides of a cell, pixels, from the largest.
const CELLS: [u32; 3] = [16, 8, 4];

/// Widest angle of a cell, rad: over it the sky away from the horizon is a parabola to a few ten-thousandths.
const WIDEST_CELL_RAD: f64 = 0.0131;

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
    let pixel_rad = 2.0 * (0.5 * camera.vertical_field_of_view_rad).tan() / f64::from(camera.height);
    let fits =
        |cell: &u32| f64::from(*cell) * pixel_rad <= WIDEST_CELL_RAD && 4 * *cell <= camera.width.min(camera.height);
    CELLS.into_iter().find(fits).ok_or_else(|| {
        let degrees = pixel_rad.to_degrees();
        format!(
            "{} x {} pixels of {degrees:.2}°, too few or too wide to interpolate between",
            camera.width, camera.height
        )
    })
}
