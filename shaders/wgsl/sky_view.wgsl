// Pass: the integrals that the sky seen from one point is made of, for every direction and light.
//
// Phase functions depend on a pixel's angle from the light alone, so they are left out here and applied exactly, per
// pixel, by welkin::sky: what remains is smooth, and a small table is enough even around the sun. So are the length of
// air that a ray passes, whose kink at the horizontal and zero at the air's limb no table could hold, and the planet's
// shadow on it: see welkin::shade.
//
// Definitions: FANS (an invocation fills FAN_COUNT columns, whose rays pass the same air; else one).

#import welkin::atmosphere::{SCATTERER_COUNT, SCATTERER_SLOTS}
#import welkin::disc::{beam_count, beam_mu_s, beam_weight}
#import welkin::loops::counted
#import welkin::mapping
#import welkin::march::{air_length_m, cut_at_shadow, is_cut_by_shadow, table_altitude_m, view_ray, AirRay}
#import welkin::observer::{light_mu_s, observer}
#import welkin::shade::{least_single, ln_lit_share, View}
#import welkin::sky::{
    layer_of, ln_mean_transmittance, LN_SCALE, multiple_scattering_table, SINGLE_LAYER, SkyDirection,
    view_optical_depth
}
#ifdef FANS
#import welkin::view_integrals::{integrate_fan, FAN_COUNT}
#endif
#import welkin::view_integrals::{integrate, logarithm, Integrals}

#ifdef HALF_TABLES
@group(0) @binding(8) var sky_view_image: texture_storage_2d_array<rgba16float, write>;
#else
@group(0) @binding(8) var sky_view_image: texture_storage_2d_array<rgba32float, write>;
#endif

// Cosine of the angle between a view and a light.
fn nu_of(view: mapping::ZenithAzimuth, mu_s: f32) -> f32 {
    let sines = sin(view.zenith_rad) * sqrt(max(1.0 - mu_s * mu_s, 0.0));
    return clamp(cos(view.zenith_rad) * mu_s + sines * cos(view.azimuth_rad), -1.0, 1.0);
}

struct Half {
    light: u32,
    below_horizon: bool,
    altitude_m: f32,
}

fn view_of(texel: vec2<u32>, half: Half) -> mapping::ZenithAzimuth {
    let unit = mapping::unit_from_texel(texel, vec2<f32>(textureDimensions(sky_view_image)));
    return mapping::sky_view_from_unit(unit, half.below_horizon, observer.view);
}

// The ray along a view, with its light from a point of the disc.
fn ray_of(view: mapping::ZenithAzimuth, half: Half, mu_s: f32) -> AirRay {
    let nu = nu_of(view, mu_s);
    return cut_at_shadow(view_ray(half.altitude_m, cos(view.zenith_rad), mu_s, nu, half.below_horizon));
}

fn plus(sum: Integrals, part: Integrals, weight: vec3<f32>) -> Integrals {
    var total = sum;
    var terms = part;
    total.multiple += weight * terms.multiple;
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        total.single[c] += weight * terms.single[c];
    }
    return total;
}

fn integrals_of(view: mapping::ZenithAzimuth, half: Half) -> Integrals {
    var sum: Integrals;
    for (var beam = 0u; beam < beam_count(half.light); beam++) {
        let ray = ray_of(view, half, beam_mu_s(half.light, beam, light_mu_s(half.light)));
#ifdef MULTIPLE_SCATTERING
        sum = plus(sum, integrate(ray, multiple_scattering_table), beam_weight(half.light, beam));
#else
        sum = plus(sum, integrate(ray), beam_weight(half.light, beam));
#endif
    }
    return sum;
}

fn put(texel: vec2<u32>, view: mapping::ZenithAzimuth, half: Half, integrals: Integrals) {
    var sum = integrals;
    let mu = cos(view.zenith_rad);
    let per_m = 1.0 / max(air_length_m(half.altitude_m, mu, half.below_horizon), 1e-3);
    let first = layer_of(half.light, half.below_horizon);
    var ln_scale = vec3<f32>(LN_SCALE);
#ifdef EDGE_OF_SHADOW
    let direction = SkyDirection(view.zenith_rad, view.azimuth_rad, 0.0, half.below_horizon);
    ln_scale -= ln_mean_transmittance(half.light, direction);
#endif
    let multiple = logarithm(sum.multiple * per_m) + ln_scale;
    var single: array<vec3<f32>, SCATTERER_SLOTS>;
    let seen = View(half.altitude_m, view.zenith_rad, view.azimuth_rad, half.below_horizon);
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
#ifdef SHADE
        let tau = view_optical_depth(SkyDirection(view.zenith_rad, view.azimuth_rad, 0.0, half.below_horizon));
        sum.single[c] = max(sum.single[c], least_single(half.light, seen, c, tau));
#endif
        single[c] = logarithm(sum.single[c] * per_m) + ln_scale - ln_lit_share(half.light, seen, c);
    }
    // One place that stores for all layers, and in `fill_fan` for all columns: drivers make much code of a store. What is stored
    // is chosen and not indexed, of which they make as much.
    for (var layer = 0u; layer < counted(SINGLE_LAYER + SCATTERER_COUNT); layer++) {
        var value = multiple;
        for (var c = 0u; c < SCATTERER_COUNT; c++) {
            value = select(value, single[c], layer == SINGLE_LAYER + c);
        }
        textureStore(sky_view_image, texel, first + layer, vec4<f32>(value, 0.0));
    }
}

#ifdef FANS
// Whether the planet's shadow, or its nearness, cuts some ray of a fan: each then has legs of its own.
fn meets_shadow(first: vec2<u32>, half: Half) -> bool {
    var meets = false;
    for (var beam = 0u; beam < beam_count(half.light); beam++) {
        let mu_s = beam_mu_s(half.light, beam, light_mu_s(half.light));
        for (var k = 0u; k < FAN_COUNT; k++) {
            let ray = ray_of(view_of(first + vec2<u32>(k, 0u), half), half, mu_s);
            meets |= is_cut_by_shadow(ray);
        }
    }
    return meets;
}

// The texels of a fan, which the shadow does not meet.
fn fill_fan(first: vec2<u32>, half: Half, width: u32) {
    var sums: array<Integrals, FAN_COUNT>;
    for (var beam = 0u; beam < beam_count(half.light); beam++) {
        let mu_s = beam_mu_s(half.light, beam, light_mu_s(half.light));
        var rays: array<AirRay, FAN_COUNT>;
        for (var k = 0u; k < FAN_COUNT; k++) {
            rays[k] = ray_of(view_of(first + vec2<u32>(k, 0u), half), half, mu_s);
        }
#ifdef MULTIPLE_SCATTERING
        var parts = integrate_fan(rays, multiple_scattering_table);
#else
        var parts = integrate_fan(rays);
#endif
        for (var k = 0u; k < FAN_COUNT; k++) {
            sums[k] = plus(sums[k], parts[k], beam_weight(half.light, beam));
        }
    }
    for (var column = 0u; column < counted(min(FAN_COUNT, width - first.x)); column++) {
        var sum = sums[0];
        for (var k = 1u; k < FAN_COUNT; k++) {
            if k == column {
                sum = sums[k];
            }
        }
        let texel = first + vec2<u32>(column, 0u);
        put(texel, view_of(texel, half), half, sum);
    }
}
#else
const FAN_COUNT: u32 = 1u;
#endif

// x, y: direction, FAN_COUNT columns at once; z: which half of the view sphere, of which light.
@compute @workgroup_size(4, 16)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(sky_view_image);
    let first = vec2<u32>(FAN_COUNT * id.x, id.y);
    if any(first >= size) {
        return;
    }
    let half = Half(id.z / 2u, id.z % 2u == 1u, table_altitude_m(observer.altitude_m));
#ifdef FANS
    if !meets_shadow(first, half) {
        fill_fan(first, half, size.x);
        return;
    }
#endif
    for (var column = first.x; column < min(first.x + FAN_COUNT, size.x); column++) {
        let texel = vec2<u32>(column, first.y);
        let view = view_of(texel, half);
        put(texel, view, half, integrals_of(view, half));
    }
}
