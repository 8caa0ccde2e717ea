//! The uniform block `sky` of the shaders that read a pack.

use super::manifest::SkyParameters;
use crate::BAND_COUNT;
use crate::bake::MAX_SCATTERERS;
use crate::phase::PhaseLobe;

/// The uniform block `sky` as shaders read it, std140.
pub(super) fn uniform_block(parameters: &SkyParameters) -> Vec<u8> {
    const LOBES: usize = 2;
    let mut bytes = Vec::with_capacity(48 + MAX_SCATTERERS * LOBES * 32);
    let mut number = |value: f64| bytes.extend((value as f32).to_le_bytes());
    (0..BAND_COUNT).for_each(|band| number(parameters.ground_albedo[band]));
    number(parameters.radius_m);
    parameters.sun_warp.into_iter().for_each(&mut number);
    number(parameters.top_m);
    for count in [parameters.scatterers.len() as u32, parameters.azimuth_count, parameters.altitude_count, 0] {
        bytes.extend(count.to_le_bytes());
    }
    for scatterer in 0..MAX_SCATTERERS {
        let lobes = parameters.scatterers.get(scatterer).map(|s| s.phase_function.as_slice()).unwrap_or_default();
        for index in 0..LOBES {
            let lobe = lobes.get(index).copied().unwrap_or(PhaseLobe::ABSENT.into());
            let lobe = PhaseLobe::from(lobe);
            let gap = f64::from(lobe.gap_in_single_precision());
            for value in [lobe.scale_per_sr, lobe.quadratic, gap, lobe.slope, lobe.exponent, lobe.peak_nu, 0.0, 0.0] {
                bytes.extend((value as f32).to_le_bytes());
            }
        }
    }
    bytes
}
