//! Light scattered many times in clouds, by discrete ordinates on their grids.

use super::{Pass, Recording, RenderError, clouds};
use crate::gpu::{GpuImage, ImageFormat, ImageShape, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "cloud_ordinates";

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["cloud_density_image", "cloud_light_image"],
        writes: &["cloud_moments_image", "cloud_flow_image", "cloud_moments_before", "cloud_flow_before"],
        inputs: |facts| Fingerprint::of(&(&facts.scene.clouds, facts.settings.clouds)),
        bytes: |facts| {
            let texels = moments_shape(facts).texels() + flow_shape(facts).texels();
            2 * texels * ImageFormat::Rgba32Float.texel_bytes()
        },
    },
    record,
};

fn need(facts: &Facts) -> Need {
    let needed = clouds::need(facts);
    match (needed, facts.cloud_scattering().ordinate_groups()) {
        (Need::Needed(_), 0) => Need::NotNeeded("light in clouds is found without a grid of ordinates".to_owned()),
        (Need::Needed(_), groups) => {
            let sweeps = facts.settings.clouds.sweeps;
            Need::Needed(format!("{sweeps} sweeps of {} ordinates", 4 * groups))
        }
        (not_needed, _) => not_needed,
    }
}

fn moments_shape(facts: &Facts) -> ImageShape {
    clouds::grid_shape(facts, facts.light_slots())
}

fn flow_shape(facts: &Facts) -> ImageShape {
    clouds::grid_shape(facts, facts.light_slots() * facts.cloud_scattering().ordinate_groups())
}

/// Sweeps in turn from one pair of images to the other, so that the last lands in the one that others read.
fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let (moments, flow) = (moments_shape(recording.facts), flow_shape(recording.facts));
    let mut image = |name, shape| recording.resources.image(name, shape, ImageFormat::Rgba32Float);
    let last: [GpuImage; 2] = [image("cloud_moments_image", moments)?, image("cloud_flow_image", flow)?];
    let other: [GpuImage; 2] = [image("cloud_moments_before", moments)?, image("cloud_flow_before", flow)?];
    let settings = recording.facts.settings.clouds;
    let columns = moments.extent()[2] / settings.grid_slices;
    let work = Work::Invocations([settings.grid_size, settings.grid_size, columns]);
    for sweep in (0..settings.sweeps).rev() {
        let (after, before) = if sweep % 2 == 0 { (&last, &other) } else { (&other, &last) };
        let written = [("moments_after", &after[0]), ("flow_after", &after[1])];
        if sweep + 1 == settings.sweeps {
            recording.dispatch(NAME, &["CLOUD_FIRST_SWEEP"], &written, work)?;
        } else {
            let [m, f] = [("moments_before", &before[0]), ("flow_before", &before[1])];
            recording.dispatch(NAME, &[], &[written[0], written[1], m, f], work)?;
        }
    }
    Ok(())
}
