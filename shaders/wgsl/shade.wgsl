#define_import_path welkin::shade
// How much of the air along a ray the planet's shadow leaves lit, scatterer by scatterer, for an observer inside the shadow.
//
// Light scattered once falls with the altitude at which a ray leaves the shadow as the density does there: from row to row
// of the sky view by orders of magnitude, and not evenly. The table therefore holds it over this estimate, which who reads
// it knows exactly. It need not be right, but continuous: it comes in gradually as the observer sinks into the shadow.
// Observers in the light do without: the air has put out the light that grazes the ground, so that for them the shadow's
// edge, which this estimate knows, leaves no trace.
//
// A ray that lies in the shadow to its end is held as if it were about to leave it: between it and a lit neighbour the
// logarithm of nothing would be next to nothing as well. Beams of a disc count as much as they do in the light itself.
//
// Definitions: SHADE (some light's shadow holds the observer).

#import welkin::atmosphere::{atmosphere, exponential_density, SCATTERING_EXPONENTIAL_END}
#import welkin::disc::{beam_count, beam_mu_s, beam_weight, LAST_BEAM}
#import welkin::geometry::shadow_interval_m
#import welkin::march::{altitude_at, view_ray, AirRay}
#import welkin::observer::{light_mu_s, observer}
#import welkin::tables::optical_depth_to_top

// Depth in the shadow at which the estimate counts in full, over the height of the air: 4 km on Earth.
const FULL_DEPTH: f32 = 0.04;
// ln of the least share that is told from none: less is not seen beside light scattered many times.
const LEAST_LN: f32 = -30.0;
const LN_TWO: f32 = 0.69314718;
// Cosine of a zenith angle: a ray that ends level would have no end.
const LEAST_SLOPE: f32 = 0.01;

// A direction from the observer, or from where an observer's tables are filled.
struct View {
    altitude_m: f32,
    zenith_rad: f32,
    // From the light's azimuth.
    azimuth_rad: f32,
    hits_ground: bool,
}

// Cosine of the zenith angle of a light's beam that goes out last.
fn last_mu_s(light: u32) -> f32 {
    return beam_mu_s(light, min(beam_count(light) - 1u, LAST_BEAM), light_mu_s(light));
}

fn ray_along(view: View, mu_s: f32) -> AirRay {
    let mu = cos(view.zenith_rad);
    let nu = mu * mu_s + sin(view.zenith_rad) * sqrt(max(1.0 - mu_s * mu_s, 0.0)) * cos(view.azimuth_rad);
    return view_ray(view.altitude_m, mu, mu_s, clamp(nu, -1.0, 1.0), view.hits_ground);
}

// How much the estimate counts for a light, in [0, 1].
fn strength(light: u32) -> f32 {
    let mu_s = last_mu_s(light);
    let sine = sqrt(max(1.0 - mu_s * mu_s, 0.0));
    // Below the shadow's edge, across the light: radius - r sine.
    let depth_m = atmosphere.radius_m * mu_s * mu_s / (1.0 + sine) - observer.altitude_m * sine;
    return select(0.0, clamp(depth_m / (FULL_DEPTH * atmosphere.top_m), 0.0, 1.0), mu_s < 0.0);
}

struct Place {
    distance_m: f32,
    // Density over that at the ray's lowest point.
    density: f32,
}

// Density at a place on a ray, by its rise above the lowest point, which is no difference of two altitudes.
fn place_at(ray: AirRay, scatterer: u32, distance_m: f32, lowest_m: f32) -> Place {
    let r_lowest = atmosphere.radius_m + altitude_at(ray, lowest_m);
    let way_m = abs(distance_m - lowest_m);
    let growth = way_m * (way_m + 2.0 * abs(lowest_m - ray.tangent_m));
    let rise_m = growth / (sqrt(r_lowest * r_lowest + growth) + r_lowest);
    return Place(distance_m, exp2(atmosphere.constituents[scatterer].profile_a * rise_m));
}

// Air between two places, in units of that between the lowest point and space: as if it grew with altitude evenly along
// each leg.
fn column(a: Place, b: Place, lowest_m: f32) -> f32 {
    let across = 2.0 - a.density - b.density;
    let one_leg = b.distance_m <= lowest_m || a.distance_m >= lowest_m;
    return select(across, abs(a.density - b.density), one_leg);
}

// What a beam leaves lit of the air along a ray that starts in its shadow.
fn share_of_beam(ray: AirRay, scatterer: u32) -> f32 {
    let shadow_m = shadow_interval_m(atmosphere.radius_m, ray.altitude_m, ray.mu, ray.mu_s, ray.nu, ray.length_m);
    if shadow_m.x >= shadow_m.y {
        return 1.0;
    }
    let lowest_m = clamp(ray.tangent_m, 0.0, ray.length_m);
    let start = place_at(ray, scatterer, 0.0, lowest_m);
    let leave = place_at(ray, scatterer, shadow_m.y, lowest_m);
    let end = place_at(ray, scatterer, ray.length_m, lowest_m);
    return column(leave, end, lowest_m) / max(column(start, end, lowest_m), 1e-20);
}

// ln of the estimate; 0 where the observer does not stand in the shadow.
fn ln_lit_share(light: u32, view: View, scatterer: u32) -> vec3<f32> {
#ifdef SHADE
    let counts = strength(light);
    if scatterer >= SCATTERING_EXPONENTIAL_END || counts == 0.0 {
        return vec3<f32>(0.0);
    }
    var share = vec3<f32>(0.0);
    for (var beam = 0u; beam < beam_count(light); beam++) {
        let ray = ray_along(view, beam_mu_s(light, beam, light_mu_s(light)));
        share += beam_weight(light, beam) * share_of_beam(ray, scatterer);
    }
    return counts * clamp(log(share), vec3<f32>(LEAST_LN), vec3<f32>(0.0));
#else
    return vec3<f32>(0.0);
#endif
}

// The least that a scatterer is held to send along a view, without its phase function: the least share of what it would
// be if the end of the ray stood for all of it, lit by the beam that goes out last. tau: optical depth along the ray.
fn least_single(light: u32, view: View, scatterer: u32, tau: vec3<f32>) -> vec3<f32> {
#ifdef SHADE
    if scatterer < SCATTERING_EXPONENTIAL_END && strength(light) > 0.0 {
        let ray = ray_along(view, last_mu_s(light));
        let lowest_m = clamp(ray.tangent_m, 0.0, ray.length_m);
        let start = place_at(ray, scatterer, 0.0, lowest_m);
        let air = column(start, place_at(ray, scatterer, ray.length_m, lowest_m), lowest_m);
        let end_altitude_m = altitude_at(ray, ray.length_m);
        let r_start = atmosphere.radius_m + ray.altitude_m;
        let r_end = atmosphere.radius_m + end_altitude_m;
        let mu_end = (r_start * ray.mu + ray.length_m) / r_end;
        let mu_s_end = (r_start * ray.mu_s + ray.length_m * ray.nu) / r_end;
        let profile_a = atmosphere.constituents[scatterer].profile_a;
        let density = exponential_density(profile_a, altitude_at(ray, lowest_m));
        // The way along which density changes by a factor of e there.
        let e_folding_m = -1.0 / (LN_TWO * profile_a * max(abs(mu_end), LEAST_SLOPE));
        let light_at_end = exp(-tau - optical_depth_to_top(end_altitude_m, mu_s_end));
        let scattering_per_m = density * atmosphere.constituents[scatterer].scattering_per_m;
        return exp(LEAST_LN) * air * e_folding_m * scattering_per_m * light_at_end;
    }
#endif
    return vec3<f32>(0.0);
}
