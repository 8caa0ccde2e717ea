// The program's own part of the shader: `shaders/wgsl/sky.wgsl` of the pack stands before it.

struct View {
    // Unit vectors of the camera in the program's axes: x right, y up, z towards the viewer.
    forward: vec3<f32>,
    // tan of half the horizontal field of view.
    half_width: f32,
    right: vec3<f32>,
    // tan of half the vertical field of view.
    half_height: f32,
    up: vec3<f32>,
    // Above the ground, m.
    altitude_m: f32,
    // Unit vector to the sun.
    sun: vec3<f32>,
    padding: f32,
    // Of the sun above the air, W/m2/nm.
    irradiance: vec3<f32>,
    padding_end: f32,
    // Pixels.
    size: vec2<f32>,
    padding_size: vec2<f32>,
}

@group(1) @binding(0) var<uniform> view: View;

// One triangle over the whole picture.
@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(4.0 * corner - 1.0, 0.0, 1.0);
}

@fragment
fn draw(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let place = (2.0 * position.xy / view.size - 1.0) * vec2<f32>(view.half_width, -view.half_height);
    let direction = normalize(view.forward + place.x * view.right + place.y * view.up);
    // On a flat map, y is up; on a globe it would be the direction from its centre.
    let up = vec3<f32>(0.0, 1.0, 0.0);
    let mu = dot(direction, up);
    let mu_s = dot(view.sun, up);
    let nu = dot(direction, view.sun);
    let radiance = sky_radiance(view.altitude_m, mu, mu_s, nu) + ground_radiance(view.altitude_m, mu, mu_s, nu);
    return vec4<f32>(view.irradiance * radiance, 1.0);
}
