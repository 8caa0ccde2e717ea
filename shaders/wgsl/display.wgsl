// Pass: from linear radiance to a picture for a screen; the same curves as the host's output::display and output::screen.
//
// Definitions: FILMIC (else radiance is clipped at the brightest that the screen shows); HDR (extended linear sRGB in half
// floats, else 8-bit sRGB), with PQ (HDR10 in place of it).

@group(0) @binding(0) var radiance_image: texture_2d<f32>;
#ifdef HDR
@group(0) @binding(1) var picture_image: texture_storage_2d<rgba16float, write>;
#else
@group(0) @binding(1) var picture_image: texture_storage_2d<rgba8unorm, write>;
#endif

struct Display {
    // From the image's channels to exposed linear sRGB.
    to_srgb: mat3x3<f32>,
}

@group(0) @binding(2) var<uniform> display: Display;

// The filmic curve's exponent; light above which everything is as bright as can be.
const CONTRAST: f32 = 1.3;
const WHITEST: f32 = 1e9;
// cd/m2 of white.
const WHITE_CD_PER_M2: f32 = 203.0;
#ifdef HDR
// Whites of the brightest light, which is 1000 cd/m2.
const HEADROOM: f32 = 4.926108;
#else
const HEADROOM: f32 = 1.0;
#endif
// 0.18^1.3 (HEADROOM / 0.18 - 1), which leaves middle grey, 0.18, where it is.
const HALF_POINT: f32 = 0.107610405 * (HEADROOM / 0.18 - 1.0);

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

// From [0, inf[ to [0, HEADROOM].
fn tone_map(exposed: vec3<f32>) -> vec3<f32> {
#ifdef FILMIC
    // The strongest primary follows the curve, the others keep their ratio to it, and all move to white with it.
    let strongest = max(exposed.r, max(exposed.g, exposed.b));
    if strongest <= 0.0 {
        return vec3<f32>(0.0);
    }
    let powered = pow(min(strongest, WHITEST), CONTRAST);
    let t = powered / (powered + HALF_POINT);
    return HEADROOM * t * mix(exposed / strongest, vec3<f32>(1.0), t * t * t * t);
#else
    return min(exposed, vec3<f32>(HEADROOM));
#endif
}

#ifdef PQ
// SMPTE ST 2084, of light over 10 000 cd/m2, in the primaries of BT.2020 (ITU-R BT.2087).
const BT2020_FROM_SRGB: mat3x3<f32> = mat3x3<f32>(
    vec3<f32>(0.6274, 0.0691, 0.0164), vec3<f32>(0.3293, 0.9195, 0.0880), vec3<f32>(0.0433, 0.0114, 0.8956)
);

fn encoded(linear: vec3<f32>) -> vec3<f32> {
    let wide = BT2020_FROM_SRGB * linear * (WHITE_CD_PER_M2 / 10000.0);
    let y = pow(clamp(wide, vec3<f32>(0.0), vec3<f32>(1.0)), vec3<f32>(0.15930176));
    return pow((0.8359375 + 18.8515625 * y) / (1.0 + 18.6875 * y), vec3<f32>(78.84375));
}

// Of one step of 10 bits.
const DITHER: f32 = 1.0 / 1023.0;
#else
#ifdef HDR
// Extended linear sRGB, in which 1 is 80 cd/m2.
fn encoded(linear: vec3<f32>) -> vec3<f32> {
    return linear * (WHITE_CD_PER_M2 / 80.0);
}

const DITHER: f32 = 0.0;
#else
// IEC 61966-2-1.
fn encoded(linear: vec3<f32>) -> vec3<f32> {
    let power = 1.055 * pow(linear, vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(power, 12.92 * linear, linear <= vec3<f32>(0.0031308));
}

// Of one step of 8 bits.
const DITHER: f32 = 1.0 / 255.0;
#endif
#endif

// Integer hash of a pixel and a channel (Jarzynski & Olano 2020, pcg), in [0, 1[.
fn hashed(seed: u32) -> f32 {
    let state = seed * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

// Triangular noise of one step: it turns the steps of smooth skies into grain too fine to see.
fn dither(pixel: vec2<u32>) -> vec3<f32> {
    var noise: vec3<f32>;
    for (var channel = 0u; channel < 3u; channel++) {
        let seed = 2u * (channel + 3u * (pixel.x + 65536u * pixel.y));
        noise[channel] = (hashed(seed) + hashed(seed + 1u) - 1.0) * DITHER;
    }
    return noise;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(picture_image)) {
        return;
    }
    let exposed = display.to_srgb * textureLoad(radiance_image, id.xy, 0).rgb;
    let shown = encoded(tone_map(into_gamut(exposed)));
    textureStore(picture_image, id.xy, vec4<f32>(shown + dither(id.xy), 1.0));
}
