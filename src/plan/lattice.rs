//! Which pixels the sky, and which marched media are interpolated between.

use super::{Facts, Surface};
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

/// Layers of the froxels that keep what media send and leave up to several distances: slots, two parts of a cell, and four images;
/// `media_froxels.wgsl`.
const MEDIA_FROXEL_LAYERS: u32 = 41 * 2 * 4;

/// The most memory that they take, bytes: enough for 1920 x 1080 pixels.
const MOST_MEDIA_FROXEL_BYTES: u64 = 256 << 20;

/// Columns, rows and layers of the froxels that keep what media send and leave up to several distances, so that edges of what stands before
/// the camera need no march of their own. Not before hills alone: those took 0.2 to 0.25 more time than without (docs/fog.md).
///
/// # Errors
/// Why there are none.
pub fn media_froxels(facts: &Facts) -> Result<[u32; 3], String> {
    if !facts.has_local_media() {
        return Err("neither fog nor volumes nor local lights".to_owned());
    }
    match facts.surface {
        Some(Surface::Given(_)) => {}
        Some(Surface::Terrain) => {
            return Err("hills: far, and cells over which fog changes are marched faster".to_owned());
        }
        Some(Surface::Rays) | None => return Err("nothing stands before the camera".to_owned()),
    }
    let fog = &facts.volumes[..facts.fog_count() as usize];
    if fog.iter().any(|bank| bank.noise.is_some_and(|noise| noise.strength > 0.0)) {
        return Err("fog is uneven: neighbouring pixels look at unlike places of it".to_owned());
    }
    let cell = media_cell(facts)?;
    let camera = &facts.scene.camera;
    let [columns, rows] = [camera.width, camera.height].map(|pixels| pixels.div_ceil(cell));
    let bytes = 16 * u64::from(columns) * u64::from(rows) * u64::from(MEDIA_FROXEL_LAYERS);
    if bytes > MOST_MEDIA_FROXEL_BYTES {
        return Err(format!("they would take {} MiB; the most is {}", bytes >> 20, MOST_MEDIA_FROXEL_BYTES >> 20));
    }
    Ok([columns, rows, MEDIA_FROXEL_LAYERS])
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
