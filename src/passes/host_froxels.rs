//! Light that the air and all media send, and what they let through, into froxels of a host's.

use bytemuck::{Pod, Zeroable};

use super::colour::padded_columns;
use super::{HostFrame, Pass, Recording, RenderError};
use crate::gpu::{ImageFormat, Work};
use crate::plan::{Declaration, Facts, Fingerprint, Need};

const NAME: &str = "host_froxels";

/// The pass. The host's images are others, or hold something else, in every frame.
pub const PASS: Pass = Pass {
    declaration: Declaration {
        name: NAME,
        need: |facts| match facts.froxels {
            None => Need::NotNeeded("the host asks for no froxels".to_owned()),
            Some(grid) => {
                let [columns, rows, slices] = grid.size;
                Need::Needed(format!("what lies before the host's {columns} x {rows} x {slices} froxels"))
            }
        },
        reads: &[],
        writes: &[],
        inputs: |_| Fingerprint::of(&()),
        bytes: |_| 0,
    },
    record,
};

/// WGSL `FroxelGrid`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FroxelGridBlock {
    from_radiance: [[f32; 4]; 3],
    near_m: f32,
    log_growth: f32,
    padding: [f32; 2],
}

impl FroxelGridBlock {
    /// The block of a host's frame, if it asks for froxels.
    pub(super) fn new(facts: &Facts, frame: &HostFrame) -> Option<Self> {
        let (grid, colour) = (facts.froxels?, frame.colour_matrix(facts.scene));
        Some(Self {
            from_radiance: padded_columns(colour),
            near_m: grid.near_m as f32,
            log_growth: grid.log_growth() as f32,
            padding: [0.0; 2],
        })
    }
}

/// What the shader is compiled with besides the frame's definitions.
pub(super) fn flags(recording: &Recording) -> Vec<&'static str> {
    let froxels = recording.resources.host_frame().and_then(|frame| frame.froxels.as_ref());
    match froxels.map(|froxels| froxels.radiance.image.format()) {
        Some(ImageFormat::Rgba16Float) => vec!["HALF"],
        _ => Vec::new(),
    }
}

fn record(recording: &mut Recording) -> Result<(), RenderError> {
    let Some(frame) = recording.resources.host_frame().cloned() else { return Ok(()) };
    let Some(froxels) = frame.froxels else { return Ok(()) };
    let (radiance, transmittance) = (&froxels.radiance.image, &froxels.transmittance.image);
    let images = [("host_radiance_volume", radiance), ("host_transmittance_volume", transmittance)];
    let flags = flags(recording);
    recording.dispatch(NAME, &flags, &images, Work::Invocations(radiance.shape().extent()))
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;
    use std::path::Path;

    use super::*;
    use crate::passes::definitions;
    use crate::plan::{Outputs, Quality, Settings};
    use crate::probe::Orders;
    use crate::scene::Scene;

    #[test]
    fn the_block_lies_in_memory_as_the_shader_declares_it() {
        let scene = Scene::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/noon.toml")).unwrap();
        let facts = Facts::new(&scene, Settings::of(Quality::Low), Orders::All, Outputs::default()).unwrap();
        let shader = welkin_shaders::compile(NAME, &definitions(&facts)).unwrap();
        let layout = shader.struct_layout("FroxelGrid").unwrap();
        let offset = |name: &str| layout.fields.iter().find(|field| field.name == name).unwrap().offset as usize;
        assert_eq!(offset("from_radiance"), offset_of!(FroxelGridBlock, from_radiance));
        assert_eq!(offset("near_m"), offset_of!(FroxelGridBlock, near_m));
        assert_eq!(offset("log_growth"), offset_of!(FroxelGridBlock, log_growth));
        assert_eq!(layout.size as usize, size_of::<FroxelGridBlock>());
    }
}
