// Pass: from linear radiance to an 8-bit sRGB picture; the same curve as the host's output::display.
//
// Definitions: FILMIC (else radiance is clipped at 1).

@group(0) @binding(0) var radiance_image: texture_2d<f32>;
@group(0) @binding(1) var picture_image: texture_storage_2d<rgba8unorm, write>;

struct Display {
    // From the image's channels to exposed linear sRGB.
    to_srgb: mat3x3<f32>,
}

@group(0) @binding(2) var<uniform> display: Display;

// The filmic curve's exponent; the constant that keeps 0.18 where it is; light above which everything is white.
const CONTRAST: f32 = 1.3;
const MIDDLE_GREY: f32 = 0.49022517;
const WHITEST: f32 = 1e9;

// IEC 61966-2-1.
const LUMINANCE: vec3<f32> = vec3<f32>(0.2126, 0.7152, 0.0722);

// A colour that sRGB cannot mix moves towards grey of the same luminance until it can.
fn into_gamut(linear: vec3<f32>) -> vec3<f32> {
    let least = min(linear.r, min(linear.g, linear.b));
    if least >= 0.0 {
        return linear;
    }
    let luminance = max(dot(linear, LUMINANCE), 0.0);
    let kept = luminance / max(luminance - least, 1e-30);
    return max(mix(vec3<f32>(luminance), linear, kept), vec3<f32>(0.0));
}

// From [0, inf[ to [0, 1].
fn tone_map(exposed: vec3<f32>) -> vec3<f32> {
#ifdef FILMIC
    // The strongest primary follows the curve, the others keep their ratio to it, and all move to white with it.
    let strongest = max(exposed.r, max(exposed.g, exposed.b));
    if strongest <= 0.0 {
        return vec3<f32>(0.0);
    }
    let powered = pow(min(strongest, WHITEST), CONTRAST);
    let t = powered / (powered + MIDDLE_GREY);
    return t * mix(exposed / strongest, vec3<f32>(1.0), t * t * t * t);
#else
    return min(exposed, vec3<f32>(1.0));
#endif
}

// IEC 61966-2-1.
fn srgb_encoded(linear: vec3<f32>) -> vec3<f32> {
    let power = 1.055 * pow(linear, vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(power, 12.92 * linear, linear <= vec3<f32>(0.0031308));
}

// Integer hash of a pixel and a channel (Jarzynski & Olano 2020, pcg), in [0, 1[.
fn hashed(seed: u32) -> f32 {
    let state = seed * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

// Triangular noise of one 8-bit step: it turns the steps of smooth skies into grain too fine to see.
fn dither(pixel: vec2<u32>) -> vec3<f32> {
    var noise: vec3<f32>;
    for (var channel = 0u; channel < 3u; channel++) {
        let seed = 2u * (channel + 3u * (pixel.x + 65536u * pixel.y));
        noise[channel] = (hashed(seed) + hashed(seed + 1u) - 1.0) / 255.0;
    }
    return noise;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(picture_image)) {
        return;
    }
    let exposed = display.to_srgb * textureLoad(radiance_image, id.xy, 0).rgb;
    let encoded = srgb_encoded(tone_map(into_gamut(exposed)));
    textureStore(picture_image, id.xy, vec4<f32>(encoded + dither(id.xy), 1.0));
}
