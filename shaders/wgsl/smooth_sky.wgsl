#define_import_path welkin::smooth_sky
// What a ray sees that changes little from one pixel to the next: all but phase functions, clouds and the discs of lights.
//
// Everything is linear in light, so that mixtures of it are what lies between.

#import welkin::atmosphere::SCATTERER_COUNT
#import welkin::mapping::PI
#import welkin::observer::{observer, LIGHT_COUNT}
#import welkin::sky::{
    emission_radiance, ground_radiance, multiple_scattering, single_scattering, view_transmittance, SkyDirection
}

#ifdef LIT
const SINGLE_COUNT: u32 = LIGHT_COUNT * SCATTERER_COUNT;
#else
const SINGLE_COUNT: u32 = 0u;
#endif
const SINGLE_SLOTS: u32 = max(SINGLE_COUNT, 1u);

// Radiance in W/m2/sr/nm.
struct SmoothSky {
    // Of the air.
    transmittance: vec3<f32>,
    // Light that was scattered more than once on its way through the air.
    diffuse: vec3<f32>,
    // The ground's, as it arrives: of light that reached it straight from the lights, and of the rest.
    ground_straight: vec3<f32>,
    ground_diffuse: vec3<f32>,
    // The air's own.
    glow: vec3<f32>,
    // Light that was scattered once, of each light by each scatterer, over its phase function: W/m2/nm.
    single: array<vec3<f32>, SINGLE_SLOTS>,
}

// A view direction as the tables of one light know it, in the half of the view sphere that the caller names.
fn relative_to_light(view: vec3<f32>, zenith_rad: f32, below_horizon: bool, light: u32) -> SkyDirection {
    var direction: SkyDirection;
    direction.zenith_rad = zenith_rad;
    let turn_rad = abs(atan2(view.x, view.y) - observer.lights[light].azimuth_rad);
    direction.azimuth_rad = min(turn_rad, 2.0 * PI - turn_rad);
    direction.nu = clamp(dot(view, observer.lights[light].direction), -1.0, 1.0);
    direction.below_horizon = below_horizon;
    return direction;
}

fn smooth_sky(view: vec3<f32>, zenith_rad: f32, below_horizon: bool) -> SmoothSky {
    let along = relative_to_light(view, zenith_rad, below_horizon, 0u);
    var sky: SmoothSky;
    sky.transmittance = view_transmittance(along);
    sky.glow = emission_radiance(along);
    for (var light = 0u; light < LIGHT_COUNT; light++) {
        let direction = relative_to_light(view, zenith_rad, below_horizon, light);
        let irradiance = observer.lights[light].irradiance;
        sky.diffuse += irradiance * multiple_scattering(light, direction);
        if below_horizon {
            let ground = ground_radiance(light, direction);
            sky.ground_straight += irradiance * sky.transmittance * ground.straight;
            sky.ground_diffuse += irradiance * sky.transmittance * ground.diffuse;
        }
#ifdef LIT
        for (var c = 0u; c < SCATTERER_COUNT; c++) {
            sky.single[light * SCATTERER_COUNT + c] = irradiance * single_scattering(light, c, direction);
        }
#endif
    }
    return sky;
}

// What lies at a share of the way from one to another.
fn mixed(a: SmoothSky, b: SmoothSky, share: f32) -> SmoothSky {
    var sky: SmoothSky;
    sky.transmittance = mix(a.transmittance, b.transmittance, share);
    sky.diffuse = mix(a.diffuse, b.diffuse, share);
    sky.ground_straight = mix(a.ground_straight, b.ground_straight, share);
    sky.ground_diffuse = mix(a.ground_diffuse, b.ground_diffuse, share);
    sky.glow = mix(a.glow, b.glow, share);
    for (var i = 0u; i < SINGLE_COUNT; i++) {
        sky.single[i] = mix(a.single[i], b.single[i], share);
    }
    return sky;
}
