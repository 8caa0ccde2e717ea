#define_import_path welkin::camera
// From a pixel to the direction it looks in.

struct Camera {
    // Unit vectors in the local frame: east, north, up.
    forward: vec3<f32>,
    // tan of half the vertical field of view, times the picture's width over height.
    half_width: f32,
    right: vec3<f32>,
    // tan of half the vertical field of view.
    half_height: f32,
    up: vec3<f32>,
    // What radiance is multiplied with where pixels are half floats.
    pre_exposure: f32,
    // Pixels.
    size: vec2<f32>,
    padding_a: f32,
    padding_b: f32,
}

@group(0) @binding(13) var<uniform> camera: Camera;

// Unit vector through a place in the picture, in pixels from its top left corner.
fn view_through(place: vec2<f32>) -> vec3<f32> {
    let x = (2.0 * place / camera.size - 1.0) * vec2<f32>(camera.half_width, -camera.half_height);
    return normalize(camera.forward + x.x * camera.right + x.y * camera.up);
}

// Unit vector through the centre of a pixel; pixel (0, 0) is at the top left.
fn view_direction(pixel: vec2<u32>) -> vec3<f32> {
    return view_through(vec2<f32>(pixel) + 0.5);
}

// Angle between neighbouring pixels around a direction, rad: the mean of those along and across the picture's radius.
fn pixel_angle_rad(view: vec3<f32>) -> f32 {
    let cosine = dot(view, camera.forward);
    return 2.0 * camera.half_height / camera.size.y * cosine * sqrt(cosine);
}
