#define_import_path welkin::shade
// How much of the air along a ray the planet's shadow leaves lit, scatterer by scatterer, for an observer inside the shadow.
//
// Light scattered once falls with the altitude at which a ray leaves the shadow as the density does there: from row to row
// of the sky view by orders of magnitude, and not evenly. The table therefore holds it over this estimate, which who reads
// it knows exactly. It need not be right, but continuous: it comes in gradually as the observer sinks into the shadow.
// Observers in the light do without: the air has put out the light that grazes the ground, so that for them the shadow's
// edge, which this estimate knows, leaves no trace.
//
// Definitions: SHADE (some light's shadow holds the observer).

#import welkin::atmosphere::{atmosphere, SCATTERING_EXPONENTIAL_END}
#import welkin::geometry::shadow_interval_m
#import welkin::march::{altitude_at, AirRay}
#import welkin::observer::{light_mu_s, observer}

// Depth in the shadow at which the estimate counts in full, over the height of the air: 4 km on Earth.
const FULL_DEPTH: f32 = 0.04;
// ln of the least share that is told from none. Not less: where the middle of a disc leaves nothing lit its upper rim may, and
// that over next to nothing would be a peak that interpolation spreads.
const LEAST_LN: f32 = -16.0;

// How much the estimate counts for a light, in [0, 1].
fn strength(light: u32) -> f32 {
    let mu_s = light_mu_s(light);
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

// ln of the estimate; 0 where a ray does not start in the shadow.
fn ln_lit_share(light: u32, ray: AirRay, scatterer: u32) -> f32 {
#ifdef SHADE
    let counts = strength(light);
    let shadow_m = shadow_interval_m(
        atmosphere.radius_m, ray.altitude_m, ray.mu, ray.mu_s, ray.nu, ray.length_m
    );
    if scatterer >= SCATTERING_EXPONENTIAL_END || counts == 0.0 || shadow_m.x >= shadow_m.y {
        return 0.0;
    }
    let lowest_m = clamp(ray.tangent_m, 0.0, ray.length_m);
    let start = place_at(ray, scatterer, 0.0, lowest_m);
    let leave = place_at(ray, scatterer, shadow_m.y, lowest_m);
    let end = place_at(ray, scatterer, ray.length_m, lowest_m);
    let share = column(leave, end, lowest_m) / max(column(start, end, lowest_m), 1e-20);
    return counts * clamp(log(share), LEAST_LN, 0.0);
#else
    return 0.0;
#endif
}
