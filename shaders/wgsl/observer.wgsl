#define_import_path welkin::observer
// Who looks, from where, and which directional lights shine on them.
//
// Definitions: LIGHT_COUNT.

#import welkin::mapping::SkyViewRange

const LIGHT_COUNT: u32 = #{LIGHT_COUNT}u;

struct DirectionalLight {
    // Unit vector towards the light: east, north, up.
    direction: vec3<f32>,
    // Clockwise from north, rad.
    azimuth_rad: f32,
    // Above the air, on a plane normal to the beam, W/m2/nm.
    irradiance: vec3<f32>,
    // Of the disc; 0 is a light without one.
    angular_radius_rad: f32,
    // The disc's radiance falls towards its limb as the cosine to this power.
    limb_exponent: vec3<f32>,
    // Of the disc where light is averaged over it; 0 where its width does not matter.
    averaged_radius_rad: f32,
}

struct Observer {
    altitude_m: f32,
    padding_a: f32,
    padding_b: f32,
    padding_c: f32,
    view: SkyViewRange,
    lights: array<DirectionalLight, LIGHT_COUNT>,
}

@group(0) @binding(10) var<uniform> observer: Observer;

// Cosine of a light's zenith angle at the observer.
fn light_mu_s(light: u32) -> f32 {
    return observer.lights[light].direction.z;
}
