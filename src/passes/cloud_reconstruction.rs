//! Clouds of every pixel, where a frame of a sequence marches only some.

use super::{Pass, Recording, RenderError, clouds};
use crate::gpu::{DeviceKind, Filtering, ImageFormat, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "cloud_reconstruction";

/// What is reconstructed, by the names of the frame before and of this one.
const IMAGES: [([&str; 2], ImageFormat); 3] = [
    (["cloud_radiance_history", "cloud_radiance_image"], ImageFormat::Rgba32Float),
    (["cloud_air_history", "cloud_air_image"], clouds::FOLLOWED_SHARES),
    (["cloud_diffuse_history", "cloud_diffuse_image"], clouds::FOLLOWED_SHARES),
];

/// The pass.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need,
        reads: &["cloud_radiance_image", "cloud_air_image", "cloud_diffuse_image"],
        writes: &[
            "cloud_radiance_image",
            "cloud_air_image",
            "cloud_diffuse_image",
            "cloud_distance_image",
            "cloud_radiance_history",
            "cloud_air_history",
            "cloud_diffuse_history",
        ],
        inputs: |facts| Fingerprint::of(&facts.sequence),
        bytes: |facts| {
            let images: u64 = IMAGES.iter().map(|(_, format)| 2 * format.texel_bytes()).sum();
            let distance = if facts.outputs.capture { ImageFormat::R32Float.texel_bytes() } else { 0 };
            clouds::whole_shape(facts).texels() * (images + distance)
        },
    },
    record,
};

fn need(facts: &Facts) -> Need {
    match (clouds::need(facts), facts.cloud_block()) {
        (Need::NotNeeded(reason), _) => Need::NotNeeded(reason),
        (_, 1) => Need::NotNeeded("all pixels of the clouds are marched".to_owned()),
        (_, block) => Need::Needed(format!("one pixel of {} is marched, the others are followed", block * block)),
    }
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let shape = clouds::whole_shape(recording.facts);
    for ([history, image], format) in IMAGES {
        // The frame before becomes history, and what was history is written over.
        recording.resources.exchange(history, image);
        recording.resources.image(history, shape, format)?;
        recording.resources.image(image, shape, format)?;
    }
    if recording.facts.outputs.capture {
        recording.resources.image("cloud_distance_image", shape, ImageFormat::R32Float)?;
    }
    // A processor reads what is around a sample once for all pixels nearest to it. A GPU wants more invocations than that, and
    // neighbours that write side by side.
    let block = recording.facts.cloud_block();
    let whole_blocks = recording.resources.gpu.info().kind == DeviceKind::Cpu;
    let columns = if whole_blocks { block } else { 1 };
    let filtered = recording.resources.gpu.filtering(ImageFormat::Rgba32Float) == Filtering::Linear;
    let flags = [("WHOLE_BLOCKS", whole_blocks), ("FILTERED", filtered)];
    let flags: Vec<_> = flags.into_iter().filter_map(|(flag, is_set)| is_set.then_some(flag)).collect();
    let [width, height, _] = shape.extent();
    // Half a block lies beyond the outermost samples at each end, wherever in their blocks they are.
    let [across, down] = [(width + 2 * block).div_ceil(columns), (height + 2 * block).div_ceil(block)];
    recording.dispatch(NAME, &flags, &[], Work::Invocations([across, down, 1]))
}
