#define_import_path welkin::observer
// Who looks, from where, and which directional lights shine on them.
//
// Definitions: LIGHT_COUNT; FAINT_COUNT, lights after these of which only the disc is seen; SPHERE (some disc is a
// sphere lit from one side).

#import welkin::mapping::SkyViewRange

const LIGHT_COUNT: u32 = #{LIGHT_COUNT}u;
const DISC_COUNT: u32 = LIGHT_COUNT + #{FAINT_COUNT}u;

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
#ifdef SPHERE
    // Of a sphere lit from one side: unit vector to what lights it, one over the integral of its radiance over a disc of
    // unit radius (0 where the disc is none), and the share of its light that comes evenly from the whole disc.
    toward_source: vec3<f32>,
    sphere_scale: f32,
    even_share: vec3<f32>,
    padding: f32,
#endif
}

struct Observer {
    altitude_m: f32,
    padding_a: f32,
    padding_b: f32,
    padding_c: f32,
    view: SkyViewRange,
    lights: array<DirectionalLight, DISC_COUNT>,
}

@group(0) @binding(10) var<uniform> observer: Observer;

// Cosine of a light's zenith angle at the observer.
fn light_mu_s(light: u32) -> f32 {
    return observer.lights[light].direction.z;
}
