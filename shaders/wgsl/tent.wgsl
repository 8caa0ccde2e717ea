#define_import_path welkin::tent
// Optical depth of constituents whose density is a tent (ozone), in closed form.
//
// A tent is three ramps: density times half width is (h - h_0)+ - 2 (h - h_1)+ + (h - h_2)+, with h_0 its foot, h_1 its
// centre, h_2 its other foot, and (x)+ = max(x, 0). Along a stretch of ray that only rises or only falls, h grows from a
// ramp's foot like a parabola, whose integral has a closed form: so no kink lies between two points of a quadrature, where
// moving the observer would let it pass under them one by one.
//
// The parabola bends by (sine of the zenith angle)² / r, taken in the middle of the stretch: what that leaves is of fifth
// order in the stretch's length, as what Simpson's rule leaves.

#import welkin::atmosphere::{atmosphere, constituent_of_tent, TENT_COUNT, TENT_SLOTS}

// Altitudes of a tent's three kinks, m.
fn kinks_m(constituent: u32) -> vec3<f32> {
    let centre_m = atmosphere.constituents[constituent].profile_a;
    let half_width_m = 1.0 / atmosphere.constituents[constituent].profile_b;
    return centre_m + half_width_m * vec3<f32>(-1.0, 0.0, 1.0);
}

// How far from its lowest point a ray crosses the kinks of each tent, m; 0 of those that lie below it.
fn distances_of_kinks_m(altitude_m: f32, mu: f32) -> array<vec3<f32>, TENT_SLOTS> {
    let b = (atmosphere.radius_m + altitude_m) * mu;
    var distances_m: array<vec3<f32>, TENT_SLOTS>;
    for (var tent = 0u; tent < TENT_COUNT; tent++) {
        let kink_m = kinks_m(constituent_of_tent(tent));
        let gap = (kink_m - altitude_m) * (2.0 * atmosphere.radius_m + kink_m + altitude_m);
        distances_m[tent] = sqrt(max(b * b + gap, vec3<f32>(0.0)));
    }
    return distances_m;
}

// A stretch of ray on which altitude only rises or only falls.
struct Stretch {
    length_m: f32,
    // Distance of its high end from the ray's lowest point, m.
    high_m: f32,
    // Altitudes of its ends in either order, m.
    end_altitudes_m: vec2<f32>,
    // Second derivative of altitude by distance, 1/m.
    curvature_per_m: f32,
}

fn optical_depth_of_tents(stretch: Stretch, kink_distances_m: array<vec3<f32>, TENT_SLOTS>) -> vec3<f32> {
    let low_m = min(stretch.end_altitudes_m.x, stretch.end_altitudes_m.y);
    let high_m = max(stretch.end_altitudes_m.x, stretch.end_altitudes_m.y);
    var tau = vec3<f32>(0.0);
    for (var tent = 0u; tent < TENT_COUNT; tent++) {
        let i = constituent_of_tent(tent);
        let kink_m = kinks_m(i);
        // The part of the stretch above each ramp's foot.
        let above_m = clamp(stretch.high_m - kink_distances_m[tent], vec3<f32>(0.0), vec3<f32>(stretch.length_m));
        let ends_m = max(low_m - kink_m, vec3<f32>(0.0)) + max(high_m - kink_m, vec3<f32>(0.0));
        let ramps = above_m * (0.5 * ends_m - stretch.curvature_per_m / 12.0 * above_m * above_m);
        let density_m = atmosphere.constituents[i].profile_b * (ramps.x - 2.0 * ramps.y + ramps.z);
        tau += max(density_m, 0.0) * atmosphere.constituents[i].extinction_per_m;
    }
    return tau;
}
