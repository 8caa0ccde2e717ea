//! Air so thick that light from outside ends in a shell of it, which is thin beside the whole.
//!
//! There light falls to nothing within a scale height, while rays are sampled from their lowest point on, and rows of tables
//! are spread over all altitudes. So both are closer together, and more orders of scattering are computed one by one, as their
//! ratio becomes constant only after as many as light takes to wander through the shell. docs/stability.md has what that gains.

use welkin_lut::{BAND_COUNT, Constituent};

use super::Settings;

/// Vertical optical depth above which air is thick: less than 1/20 000 of a beam arrives at the ground.
const THICK: f64 = 10.0;
/// How many times as many nodes stand on each leg of a ray.
const NODES: u32 = 3;
/// Least rows of the tables of multiply scattered light.
const ROWS: u32 = 48;
/// Least rows of the table of optical depth.
const DEPTH_ROWS: u32 = 192;
/// Least orders that are computed one by one.
const ORDERS: u32 = 8;
/// Depth from which on rows and orders grow: the shell now lies near the top of the air, where rows are furthest apart.
const OPAQUE: f64 = 1e4;
/// How often rows double at most, once for each power of ten; orders half as often.
const DOUBLINGS: f64 = 2.0;

/// Vertical optical depth of all matter, the largest of the bands.
fn depth(constituents: &[&Constituent], top_m: f64) -> f64 {
    let in_band = |band: usize| -> f64 {
        constituents
            .iter()
            .map(|c| (c.scattering_per_m[band] + c.absorption_per_m[band]) * c.profile.column_m(top_m))
            .sum()
    };
    (0..BAND_COUNT).map(in_band).fold(0.0, f64::max)
}

/// The settings as air of this depth needs them.
pub fn settings(settings: Settings, constituents: &[&Constituent], top_m: f64) -> Settings {
    let depth = depth(constituents, top_m);
    if depth <= THICK {
        return settings;
    }
    let doublings = (depth / OPAQUE).log10().clamp(0.0, DOUBLINGS);
    let grown = |count: u32, doublings: f64| (f64::from(count) * doublings.exp2()).round() as u32;
    let rows = |[columns, rows]: [u32; 2], least: u32| [columns, rows.max(grown(least, doublings))];
    let orders = grown(ORDERS, 0.5 * doublings);
    Settings {
        nodes_per_leg: NODES * settings.nodes_per_leg,
        optical_depth_size: rows(settings.optical_depth_size, DEPTH_ROWS),
        multiple_scattering_size: rows(settings.multiple_scattering_size, ROWS),
        source_size: rows(settings.source_size, ROWS),
        orders: settings.orders.max(orders),
        source_orders: settings.source_orders.max(orders),
        ..settings
    }
}
