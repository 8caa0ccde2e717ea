#define_import_path welkin::disc
// A light's width where it matters: around sunrise and in twilight light varies across the disc.
//
// The disc's light by height y above its centre, in units of its radius, is (1 - y²)^((k + 1) / 2) for a radiance that
// falls towards the limb as the cosine to the power k. Where light is smooth in y three beams stand for it: the Gauss
// rule of that weight for the mean of all bands' k, with weights that keep each band's own second moment, 1 / (k + 4).
// Where the horizon cuts the disc, only what is above it is integrated.
//
// Definitions: DISC (some light's width matters).

#import welkin::observer::observer
#import welkin::tables::direct_ground_irradiance

#ifdef DISC
const BEAM_COUNT: u32 = 3u;
#else
const BEAM_COUNT: u32 = 1u;
#endif

// The highest of several beams.
const LAST_BEAM: u32 = 2u;

// Beams that stand for a light.
fn beam_count(light: u32) -> u32 {
#ifdef DISC
    return select(1u, BEAM_COUNT, observer.lights[light].averaged_radius_rad > 0.0);
#else
    return 1u;
#endif
}

// The outer beams' height, in radii.
fn beam_height(light: u32) -> f32 {
    let k = dot(observer.lights[light].limb_exponent, vec3<f32>(1.0 / 3.0));
    return sqrt(3.0 / (k + 6.0));
}

// Cosine of the zenith angle of a beam where that of the disc's centre is mu_s.
fn beam_mu_s(light: u32, beam: u32, mu_s: f32) -> f32 {
#ifdef DISC
    let side = select(select(-1.0, 1.0, beam == LAST_BEAM), 0.0, beam == 0u);
    let offset_rad = side * beam_height(light) * observer.lights[light].averaged_radius_rad;
    return clamp(mu_s * cos(offset_rad) + sqrt(max(1.0 - mu_s * mu_s, 0.0)) * sin(offset_rad), -1.0, 1.0);
#else
    return mu_s;
#endif
}

// A beam's share of the light.
fn beam_weight(light: u32, beam: u32) -> vec3<f32> {
#ifdef DISC
    if beam_count(light) > 1u {
        let height = beam_height(light);
        let outer = 0.5 / ((observer.lights[light].limb_exponent + 4.0) * height * height);
        return select(outer, 1.0 - 2.0 * outer, beam == 0u);
    }
#endif
    return vec3<f32>(1.0);
}

// Direct irradiance on horizontal ground per unit irradiance of a light whose centre stands at mu_s there.
fn direct_irradiance_of_disc(light: u32, mu_s: f32) -> vec3<f32> {
#ifdef DISC
    let radius_rad = observer.lights[light].averaged_radius_rad;
    if abs(mu_s) < sin(radius_rad) {
        return irradiance_of_cut_disc(mu_s, radius_rad, observer.lights[light].limb_exponent);
    }
#endif
    return direct_ground_irradiance(mu_s);
}

#ifdef DISC
// Gauss-Legendre nodes on [0, 1] by half, their weights.
const CUT_NODES = array<vec2<f32>, 3>(
    vec2<f32>(0.0337652429, 0.0856622462), vec2<f32>(0.1693953068, 0.1803807865), vec2<f32>(0.3806904070, 0.2339569673)
);

// Six nodes that are even in x, with the height below the disc's top ∝ x²: there the weight's slope is infinite.
fn irradiance_of_cut_disc(mu_s: f32, radius_rad: f32, k: vec3<f32>) -> vec3<f32> {
    let bottom = max(-mu_s / radius_rad, -1.0);
    var sum = vec3<f32>(0.0);
    var norm = vec3<f32>(0.0);
    for (var i = 0u; i < 6u; i++) {
        let node = CUT_NODES[min(i, 5u - i)];
        let x = select(node.x, 1.0 - node.x, i > 2u);
        let y = 1.0 - (1.0 - bottom) * x * x;
        let weight = pow(vec3<f32>(max(1.0 - y * y, 0.0)), 0.5 * (k + 1.0)) * 2.0 * x * (1.0 - bottom) * node.y;
        sum += weight * direct_ground_irradiance(mu_s + radius_rad * y);
        // The upper half of the disc by the same nodes, twice.
        let z = 1.0 - x * x;
        norm += pow(vec3<f32>(1.0 - z * z), 0.5 * (k + 1.0)) * 4.0 * x * node.y;
    }
    return sum / norm;
}
#endif
