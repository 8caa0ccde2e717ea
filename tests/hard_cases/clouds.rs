//! Clouds that are degenerate. Nearly all have the same shaders.

use super::{Bound, Case};

const APPROXIMATE: &str = "docs/clouds.md has what clouds are off by";

pub fn cases() -> Vec<Case> {
    let with = |name: &str, scene: &str, layer: &str| {
        Case::new(name, format!("{scene}\n[[clouds]]\n{layer}")).bound(Bound::LawsOnly(APPROXIMATE))
    };
    let heaps = |name: &str, scene: &str, layer: &str| with(name, scene, &format!("kind = \"cumulus\"\n{layer}"));
    let from = |name: &str, scene: &str| heaps(name, scene, "base_m = 1000\ntop_m = 2300");
    let layer = |name: &str, layer: &str| heaps(name, "", layer);
    vec![
        from("clouds, camera on their base", "camera.altitude_m = 1000"),
        from("clouds, camera on their tops", "camera.altitude_m = 2300\ncamera.elevation_deg = -5"),
        from("clouds from 300 km", "camera.altitude_m = 3e5\ncamera.elevation_deg = -17"),
        with(
            "an anvil under cirrus from 300 km",
            "camera.altitude_m = 3e5\ncamera.elevation_deg = -17\n[[clouds]]\nkind = \"cirrus\"",
            "kind = \"cumulonimbus\"",
        ),
        from("clouds, sun below the ground's horizon", "camera.altitude_m = 11000\nsun.elevation_deg = -2"),
        from("8192 x 1 pixels of clouds", "[camera]\nwidth = 8192\nheight = 1\nvertical_field_of_view_deg = 0.01"),
        layer("clouds of no thickness", "base_m = 1000\ntop_m = 1000"),
        layer("clouds, coverage 1", "coverage = 1"),
        // Extinction is 3/2 of the water over density and radius.
        layer("clouds of 10 /m", "water_g_per_m3 = 66.7\neffective_radius_um = 10"),
        layer("clouds of 15 000 /m", "water_g_per_m3 = 1000\neffective_radius_um = 0.1"),
        layer("clouds of 1e-9 /m", "water_g_per_m3 = 6.7e-9\neffective_radius_um = 10"),
        layer("black clouds", "albedo = 0"),
        heaps("clouds at 1e9 s, calm", "time_s = 1e9", ""),
        heaps("clouds at 1e9 s in a storm", "time_s = 1e9", "wind_m_per_s = [1000, -1000]\nevolution_m_per_s = 1000"),
    ]
}
