#define_import_path welkin::cloud_frame
// Which pixels of the clouds this frame marches, and how the frame before saw them.

#import welkin::cloud_field::CLOUD_LAYER_SLOTS

struct CloudFrame {
    // In each block the pixel that is marched.
    first_pixel: vec2<u32>,
    // Added to the place of samples in their steps; another one each time that a pixel comes round.
    jitter: f32,
    // 1 where camera, clouds and lights are those of the frame before, else 0.
    still: f32,
    // The camera of the frame before, as in welkin::camera.
    forward: vec3<f32>,
    half_width: f32,
    right: vec3<f32>,
    half_height: f32,
    up: vec3<f32>,
    altitude_m: f32,
    // How far wind has carried each layer since then: east and north, m.
    drift_m: array<vec2<f32>, CLOUD_LAYER_SLOTS>,
}

@group(1) @binding(20) var<storage, read> cloud_frame: CloudFrame;
