// Pass: light that the air and all media send, and what they let through, up to each slice of a host's froxels, for what it draws that
// light passes through: colour = colour * transmittance + radiance.
//
// Definitions: OVERLAY (there are clouds or local media); HALF (the host's images hold half floats).

#import welkin::aerial::{air_radiance_before_of, reach_of}
#import welkin::froxel_grid::{column_direction, froxel_grid, slice_distance_m}
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::sky::{shares_before, Shares, ALL}
#import welkin::smooth_sky::relative_to_light

#ifdef OVERLAY
@group(1) @binding(50) var froxel_media_radiance: texture_3d<f32>;
@group(1) @binding(51) var froxel_media_transmittance: texture_3d<f32>;
@group(1) @binding(52) var froxel_media_beam: texture_3d<f32>;
@group(1) @binding(53) var froxel_media_diffuse: texture_3d<f32>;
#endif

#ifdef HALF
// In the host's unit and colours; the fourth is the mean of the transmittances.
@group(0) @binding(34) var host_radiance_volume: texture_storage_3d<rgba16float, write>;
@group(0) @binding(35) var host_transmittance_volume: texture_storage_3d<rgba16float, write>;
const BRIGHTEST: f32 = 65504.0;
#else
@group(0) @binding(34) var host_radiance_volume: texture_storage_3d<rgba32float, write>;
@group(0) @binding(35) var host_transmittance_volume: texture_storage_3d<rgba32float, write>;
const BRIGHTEST: f32 = 3e38;
#endif

// Clouds, fog and volumes up to a slice: their light, what they let through, and what they leave of the air's light.
struct Media {
    radiance: vec3<f32>,
    transmittance: vec3<f32>,
    air: Shares,
}

fn media_before(froxel: vec3<u32>, air_transmittance: vec3<f32>) -> Media {
#ifdef OVERLAY
    let transmittance = textureLoad(froxel_media_transmittance, froxel, 0).rgb;
    let beam = textureLoad(froxel_media_beam, froxel, 0).rgb;
    let diffuse = textureLoad(froxel_media_diffuse, froxel, 0).rgb;
    let air = shares_before(beam, diffuse, transmittance, air_transmittance);
    return Media(textureLoad(froxel_media_radiance, froxel, 0).rgb, transmittance, air);
#else
    return Media(vec3<f32>(0.0), vec3<f32>(1.0), ALL);
#endif
}

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) froxel: vec3<u32>) {
    let size = textureDimensions(host_radiance_volume);
    if any(froxel >= size) {
        return;
    }
    let view = column_direction(froxel.xy, size.xy);
    let zenith_rad = atan2(length(view.xy), view.z);
    let below_horizon = zenith_rad > observer.view.horizon_rad;
    let reach = reach_of(relative_to_light(view, zenith_rad, below_horizon, 0u), slice_distance_m(froxel.z));
    let media = media_before(froxel, reach.transmittance);
    var radiance = media.radiance + media.transmittance * reach.emission;
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let direction = relative_to_light(view, zenith_rad, below_horizon, light);
        radiance += observer.lights[light].irradiance * air_radiance_before_of(light, direction, reach, media.air);
    }
    let transmittance = media.transmittance * reach.transmittance;
    let mean = dot(transmittance, vec3<f32>(1.0 / 3.0));
    let colour = froxel_grid.from_radiance * radiance;
    textureStore(host_radiance_volume, froxel, vec4<f32>(min(colour, vec3<f32>(BRIGHTEST)), mean));
    textureStore(host_transmittance_volume, froxel, vec4<f32>(transmittance, mean));
}
