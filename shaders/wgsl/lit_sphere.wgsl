#define_import_path welkin::lit_sphere
// The disc of a sphere that is lit from one side, the moon; the same as the host's scene::LitSphere.
//
// Lommel and Seeliger's law, mu_0 / (mu_0 + mu), which makes the full disc even; earthshine comes evenly from all of it.

#import welkin::camera::camera
#import welkin::observer::observer

const PI: f32 = 3.14159265358979;
// Points of a pixel, in each direction, over which its mean is taken.
const POINTS: u32 = 4u;

fn is_sphere(light: u32) -> bool {
    return observer.lights[light].sphere_scale > 0.0;
}

// Mean radiance over a pixel of angular width pixel_rad, per unit irradiance, 1/sr, of a disc drawn with radius_rad.
fn sphere_radiance(view: vec3<f32>, light: u32, radius_rad: f32, pixel_rad: f32) -> vec3<f32> {
    let disc = observer.lights[light];
    let centre = (view - dot(view, disc.direction) * disc.direction) / radius_rad;
    let step = pixel_rad / (radius_rad * f32(POINTS));
    var lit = 0.0;
    var inside = 0.0;
    for (var i = 0u; i < POINTS * POINTS; i++) {
        let x = vec2<f32>(vec2<u32>(i % POINTS, i / POINTS)) - 0.5 * f32(POINTS - 1u);
        let offset = centre + step * (x.x * camera.right + x.y * camera.up);
        let squared = dot(offset, offset);
        if squared <= 1.0 {
            let mu = sqrt(1.0 - squared);
            let mu_source = max(dot(offset - mu * disc.direction, disc.toward_source), 0.0);
            lit += mu_source / max(mu_source + mu, 1e-6);
            inside += 1.0;
        }
    }
    let share = disc.even_share;
    let sum = (1.0 - share) * lit * disc.sphere_scale + share * inside / PI;
    return sum / (f32(POINTS * POINTS) * radius_rad * radius_rad);
}
