// Pass: multiply scattered light as a geometric series of isotropic orders, at every altitude and sun.
//
// Hillaire 2020, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique", CGF 39, section 5.5: light of
// the second order L_2 is the mean over directions of light that was scattered once, isotropically, or reflected by the
// ground (his eq. 5); every later order is the one before times f, the mean share of unit light from everywhere around
// that scatters towards the point (eqs. 7 and 8); so all of them are L_2 / (1 - f) (eqs. 9 and 10). Diffuse irradiance, which
// he leaves out, is that of the same light: first order plus the series' light scattered once more towards the point.
//
// Rays of one zenith angle pass the same air at every azimuth: an invocation walks it once for all azimuths of a cosine, and
// what belongs to one of them is how its light comes in. The result is for unit irradiance of the light, and laid out as
// spherical harmonics of degree 0.

#import welkin::atmosphere::{atmosphere, densities, PI, SCATTERER_COUNT}
#import welkin::directions::{azimuth_rad, direction_of, Direction, AZIMUTH_COUNT, COSINE_COUNT}
#import welkin::field_radiance::ray_from
#import welkin::geometry::{horizon_mu, shadow_interval_m}
#import welkin::mapping
#import welkin::loops::counted
#import welkin::march::{
    leg_advance, leg_finish, leg_is_empty, leg_of, local_directions, ground_mu_s, AirRay, LEG_COUNT, NODE_COUNT
}
#import welkin::tables::{direct_ground_irradiance, optical_depth_to_top, IRRADIANCE_LAYER}

#ifdef HALF_TABLES
@group(0) @binding(6) var isotropic_series: texture_storage_2d_array<rgba16float, write>;
#else
@group(0) @binding(6) var isotropic_series: texture_storage_2d_array<rgba32float, write>;
#endif

// Below this, light is dark; it keeps logarithms finite.
const DARK: f32 = 1e-30;
// Texels of a workgroup, side by side: neighbours whose rays of one cosine have the same legs, so that invocations in lockstep
// walk the same nodes.
const TEXEL_COUNT: u32 = 8u;
// Y_00, whose coefficient times it is a mean over directions.
const Y_CONSTANT: f32 = 0.282094792;

// Of all directions of one cosine.
struct Ring {
    // Mean over azimuths of the light that isotropic air has scattered once, or the ground has reflected.
    radiance: vec3<f32>,
    // What unit radiance from everywhere becomes.
    transfer: vec3<f32>,
}

// How much of a stretch of ray lies outside the planet's shadow.
fn lit_share(start_m: f32, length_m: f32, shadow_m: vec2<f32>) -> f32 {
    let dark_m = min(start_m + length_m, shadow_m.y) - max(start_m, shadow_m.x);
    return 1.0 - clamp(dark_m / length_m, 0.0, 1.0);
}

// The shadow's edge cuts no ray here, as it lies at another distance for every azimuth: light that grazes the ground is faint,
// and a node in whose stretch the edge falls counts by the share that is lit.
fn ring_along(altitude_m: f32, mu_s: f32, direction: Direction) -> Ring {
    var rays: array<AirRay, AZIMUTH_COUNT>;
    for (var k = 0u; k < AZIMUTH_COUNT; k++) {
        rays[k] = ray_from(altitude_m, mu_s, direction.mu, cos(azimuth_rad(k)), direction.hits_ground);
        rays[k].shadow_m = shadow_interval_m(
            atmosphere.radius_m, altitude_m, rays[k].mu, mu_s, rays[k].nu, rays[k].length_m
        );
    }
    var sum: Ring;
    var tau = vec3<f32>(0.0);
    for (var i = 0u; i < counted(LEG_COUNT); i++) {
        var leg = leg_of(rays[0], i);
        if leg_is_empty(leg) {
            continue;
        }
        var stretch_start_m = leg.start_m;
        for (var n = 0u; n < NODE_COUNT; n++) {
            let node = leg_advance(&leg, rays[0], n, &tau);
            var density = densities(node.altitude_m);
            var scattering = vec3<f32>(0.0);
            for (var c = 0u; c < SCATTERER_COUNT; c++) {
                scattering += density[c] * atmosphere.constituents[c].scattering_per_m;
            }
            let transfer = node.weight_m * scattering * exp(-tau);
            var arriving = vec3<f32>(0.0);
            for (var k = 0u; k < AZIMUTH_COUNT; k++) {
                let lit = lit_share(stretch_start_m, node.weight_m, rays[k].shadow_m);
                let local_mu_s = local_directions(rays[k], node).mu_s;
                arriving += lit * exp(-optical_depth_to_top(node.altitude_m, local_mu_s));
            }
            sum.transfer += transfer;
            sum.radiance += transfer * arriving / (4.0 * PI);
            stretch_start_m += node.weight_m;
        }
        leg_finish(&leg, rays[0], &tau);
    }
    if direction.hits_ground {
        var arriving = vec3<f32>(0.0);
        for (var k = 0u; k < AZIMUTH_COUNT; k++) {
            arriving += direct_ground_irradiance(ground_mu_s(rays[k]));
        }
        sum.radiance += exp(-tau) * atmosphere.ground_albedo / PI * arriving;
    }
    sum.radiance /= f32(AZIMUTH_COUNT);
    return sum;
}

var<workgroup> rings: array<array<Ring, COSINE_COUNT>, TEXEL_COUNT>;

// x, z: a texel, y: a cosine.
@compute @workgroup_size(TEXEL_COUNT, #{COSINE_COUNT})
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let size = textureDimensions(isotropic_series);
    // The last workgroup may reach beyond the table: its invocations must meet the barrier too.
    let texel = id.xz;
    let unit = mapping::unit_from_texel(texel, vec2<f32>(size));
    let here = mapping::multiple_scattering_from_unit(unit, atmosphere.top_m, atmosphere.sun_warp);
    let mu_h = horizon_mu(atmosphere.radius_m, here.altitude_m);
    rings[local.x][local.y] = ring_along(here.altitude_m, here.mu, direction_of(local.y * AZIMUTH_COUNT, mu_h));
    workgroupBarrier();
    if local.y > 0u || texel.x >= size.x {
        return;
    }
    // Sums over all directions, and of what comes down through a horizontal plane.
    var all: Ring;
    var downward: Ring;
    for (var j = 0u; j < COSINE_COUNT; j++) {
        let direction = direction_of(j * AZIMUTH_COUNT, mu_h);
        let solid_angle_sr = direction.solid_angle_sr * f32(AZIMUTH_COUNT);
        let ring = rings[local.x][j];
        all.radiance += solid_angle_sr * ring.radiance;
        all.transfer += solid_angle_sr * ring.transfer;
        downward.radiance += solid_angle_sr * max(direction.mu, 0.0) * ring.radiance;
        downward.transfer += solid_angle_sr * max(direction.mu, 0.0) * ring.transfer;
    }
    let series = Y_CONSTANT * all.radiance / (1.0 - all.transfer / (4.0 * PI));
    let irradiance = downward.radiance + Y_CONSTANT * series * downward.transfer;
    textureStore(isotropic_series, texel, 0u, vec4<f32>(log(max(series, vec3<f32>(DARK))), 0.0));
    textureStore(isotropic_series, texel, IRRADIANCE_LAYER, vec4<f32>(log(max(irradiance, vec3<f32>(DARK))), 0.0));
}
