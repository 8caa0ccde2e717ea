//! What a few settings take for a scene on a device.

use welkin::goal::{CALIBRATION_STEPS, Calibration};
use welkin::plan::{LadderStep, Outputs, Rung, SceneKind, SceneTraits};
use welkin::renderer::Renderer;
use welkin::scene::Scene;

use super::kept::Kept;
use crate::cli::Failure;
use crate::cli::backend::failure;

/// Times of a few settings for a scene on a device, from the cache or measured now.
pub fn calibration(renderer: &mut Renderer, scene: &Scene, outputs: Outputs) -> Result<Calibration, Failure> {
    let kept = Kept::new(calibration_key(renderer, scene, outputs));
    if let Some(calibration) = kept.read() {
        return Ok(calibration);
    }
    eprintln!("measuring the device with {} settings", CALIBRATION_STEPS.len());
    let mut calibration = Calibration::default();
    for (quality, treatment) in CALIBRATION_STEPS {
        let step = LadderStep { rung: Rung::of(quality), treatment };
        calibration.add(step, renderer.step_times(scene, step, outputs).map_err(failure)?);
    }
    kept.write(&calibration);
    Ok(calibration)
}

/// The device, driver, program, and all of a scene that its time depends on.
fn calibration_key(renderer: &Renderer, scene: &Scene, outputs: Outputs) -> String {
    let (info, camera) = (renderer.gpu().info(), &scene.camera);
    let device = (&info.name, &info.driver, &info.driver_version);
    let sky = (scene.medium.constituents.len(), scene.lights.len(), scene.spectrum.group_count());
    // What stands in clear air costs as much wherever one looks; clouds and mountains do not.
    let seen = match SceneTraits::of(scene).kind {
        SceneKind::Clear => String::new(),
        SceneKind::Terrain | SceneKind::Clouds | SceneKind::Fog => format!("{scene:?}"),
    };
    format!("calibration {:?}", (device, sky, (camera.width, camera.height), outputs, seen))
}
