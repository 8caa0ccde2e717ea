// Pass: what three wavelengths add to linear colour.
//
// Radiance in W/(m^2 sr nm) at a group's wavelengths, or transmittance, becomes its share of the picture's channels; the
// shares of all groups add up to the colour.
//
// Definitions: FIRST (the group that the sum begins with).

@group(0) @binding(0) var seen_image: texture_2d<f32>;
@group(0) @binding(1) var colour_image: texture_storage_2d<rgba32float, read_write>;

struct Share {
    // From the group's wavelengths to the channels.
    to_colour: mat3x3<f32>,
}

@group(0) @binding(2) var<uniform> share: Share;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(colour_image)) {
        return;
    }
    var colour = share.to_colour * textureLoad(seen_image, id.xy, 0).rgb;
#ifndef FIRST
    colour += textureLoad(colour_image, id.xy).rgb;
#endif
    textureStore(colour_image, id.xy, vec4<f32>(colour, 1.0));
}
