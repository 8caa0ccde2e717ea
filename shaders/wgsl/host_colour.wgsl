// Pass: linear radiance into the image of a host, in its unit and colours.
//
// Definitions: HALF (the image holds half floats).

@group(0) @binding(0) var radiance_image: texture_2d<f32>;
#ifdef HALF
@group(0) @binding(1) var host_target_image: texture_storage_2d<rgba16float, write>;
// The largest half float: a sun's disc must not become infinite.
const BRIGHTEST: f32 = 65504.0;
#else
@group(0) @binding(1) var host_target_image: texture_storage_2d<rgba32float, write>;
const BRIGHTEST: f32 = 3e38;
#endif

struct HostColour {
    // From spectral radiance, W/m2/sr/nm, to the host's colour.
    from_radiance: mat3x3<f32>,
}

@group(0) @binding(2) var<uniform> host_colour: HostColour;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(host_target_image)) {
        return;
    }
    let colour = host_colour.from_radiance * textureLoad(radiance_image, id.xy, 0).rgb;
    textureStore(host_target_image, id.xy, vec4<f32>(min(colour, vec3<f32>(BRIGHTEST)), 1.0));
}
