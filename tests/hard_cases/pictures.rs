//! Sizes of pictures, coarsest settings, and places and times far from the origin.

use welkin::plan::Settings;

use super::{Bound, Case};

pub fn cases() -> Vec<Case> {
    let sized = |name: &str, camera: &str| Case::new(name, format!("[camera]\n{camera}"));
    let relief = "hills hide light from each other in the reference alone";
    let terrain = |name: &str, position: &str| {
        let hills = format!("[terrain]\nheight_m = 1000\nwavelength_m = 10000\nposition_m = {position}");
        Case::new(name, format!("camera.altitude_m = 1500\n{hills}")).bound(Bound::LawsOnly(relief))
    };
    vec![
        sized("1 x 1 pixel", "width = 1\nheight = 1"),
        sized("7 x 5 pixels", "width = 7\nheight = 5"),
        sized("8192 x 2 pixels", "width = 8192\nheight = 2\nvertical_field_of_view_deg = 0.02"),
        Case {
            settings: |settings| Settings { nodes_per_leg: 1, ..settings },
            ..Case::new("one step along a ray", "").bound(Bound::LawsOnly("one step is no quadrature"))
        },
        terrain("hills at the origin", "[0, 0]"),
        terrain("hills 1e7 m away", "[1e7, -1e7]"),
        Case::new("clear air at 1e9 s", "time_s = 1e9"),
    ]
}
