//! Fits the numbers of the approximations of light in clouds, and measures them, against the path tracer.
//!
//! ```sh
//! cargo run --release --example fit_cloud_lighting -- fit 256      # the numbers, for several phase functions
//! cargo run --release --example fit_cloud_lighting -- table 768    # every method on clouds fitted and not fitted
//! cargo run --release --example fit_cloud_lighting -- slabs        # reflectance of homogeneous slabs
//! cargo run --release --example fit_cloud_lighting -- cells 64     # what the size of the cells costs; [SHADERS [METRES]...]
//! ```
//!
//! The number is that of walks a pixel. Pictures of the path tracer are kept in `target/cloud-truth`, by content.

mod cells;
mod field;
mod fields;
mod fit;
mod methods;
mod phase;
mod samples;
mod score;
mod slabs;
mod table;
mod truth;
mod views;

use std::error::Error;
use std::path::Path;

use fields::{Cloud, SIZE, extent_m};
use glam::{DVec3, UVec3};
use welkin::reference::GridField;

/// Where the path tracer's pictures are kept.
fn truth_folder() -> &'static Path {
    Path::new("target/cloud-truth")
}

/// The cloud as the reference interpolates it.
fn grid_field(cloud: &Cloud) -> Result<GridField, Box<dyn Error>> {
    let size = UVec3::from_array(SIZE.map(|n| n as u32));
    Ok(GridField::new(DVec3::ZERO, extent_m(), size, cloud.extinction_per_m.clone())?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let walks = match arguments.get(1) {
        Some(text) => text.parse().map_err(|_| format!("walks are '{text}'; they must be a number from 8"))?,
        None => 256,
    };
    match arguments.first().map(String::as_str) {
        Some("fit") => fit::run(walks),
        Some("table") => table::run(walks),
        Some("slabs") => slabs::run(),
        Some("cells") => {
            let mut cells_m = arguments.iter().skip(3).map(|text| text.parse()).collect::<Result<Vec<f64>, _>>()?;
            if cells_m.is_empty() {
                cells_m = vec![40.0, 64.0, 128.0, 256.0];
            }
            cells::run(&mut field::Solver::with_shaders(arguments.get(2))?, walks, &cells_m)
        }
        _ => Err("the first argument must be 'fit', 'table', 'slabs' or 'cells'".into()),
    }
}
