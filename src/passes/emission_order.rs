//! The radiance field of the air's own emission at every altitude, order after order.

use super::blocks::ZONAL_COUNT;
use super::{Pass, Recording, RenderError};
use crate::gpu::{GpuImage, ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};
use crate::probe::Orders;

const NAME: &str = "emission_order";

/// Rows of the table for each row of that of the lights' multiple scattering: one column of texels is cheap.
const ROWS_PER_ROW: u32 = 2;

/// Sums of orders that are computed; the rest of the series is geometric. The first is emission itself.
const SUMS: u32 = 6;

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        // The same air as that of the table of optical depth, though nothing is read from it.
        reads: &["optical_depth_table"],
        writes: &["emission_field"],
        inputs: |facts| {
            let (planet, settings) = (&facts.scene.planet, &facts.settings);
            Fingerprint::of(&(
                (&facts.emitters, planet, facts.orders),
                (settings.directions, settings.multiple_scattering_size),
            ))
        },
        bytes: |facts| shape(facts).texels() * ImageFormat::Rgba32Float.texel_bytes(),
    },
    record,
};

/// A column for each zonal harmonic and one for irradiance; a row for each altitude.
fn shape(facts: &Facts) -> ImageShape {
    ImageShape::D2(ZONAL_COUNT + 1, ROWS_PER_ROW * facts.settings.multiple_scattering_size[1])
}

fn need(facts: &Facts) -> Need {
    let not_needed = |reason: &str| Need::NotNeeded(reason.to_owned());
    if facts.emitters.is_empty() {
        return not_needed("no constituent emits");
    }
    let dark_ground = facts.orders == Orders::Single || facts.scene.planet.ground_albedo == [0.0; 3];
    if facts.scatterers().is_empty() && dark_ground {
        return not_needed("what is emitted is neither scattered nor reflected");
    }
    let names: Vec<_> = facts.emitters.iter().map(|emitter| emitter.name.as_str()).collect();
    Need::Needed(format!("the emission of {} is scattered", names.join(", ")))
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = shape(recording.facts);
    let format = ImageFormat::Rgba32Float;
    let work = Work::Workgroups([shape.extent()[1], 1, 1]);
    // Of single scattering, the field that is scattered is emission itself.
    let count = if recording.facts.orders == Orders::Single { 1 } else { SUMS };
    let mut sums: Vec<GpuImage> = Vec::new();
    for n in 1..=count {
        let sum = if n == count {
            recording.resources.image("emission_field", shape, format)?
        } else {
            recording.resources.gpu.image(&format!("emission_sum_{n}"), shape, format)?
        };
        let flags: &[&str] = match n {
            1 => &["EMITTED"],
            _ if n == count => &["EMITTED", "RESCATTERED", "CLOSE_SERIES"],
            _ => &["EMITTED", "RESCATTERED"],
        };
        let mut images = vec![("emission_sum", &sum)];
        let before = sums.iter().rev();
        images.extend(["emission_field", "sum_before_that"].into_iter().zip(before.clone()));
        images.extend(before.take(1).map(|image| ("sum_before", image)));
        recording.dispatch(NAME, flags, &images, work)?;
        sums.push(sum);
    }
    Ok(())
}
