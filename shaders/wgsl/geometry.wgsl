#define_import_path welkin::geometry
// Altitude-first geometry near a sphere; the same functions as the host's welkin_lut::geometry, in f32.
//
// Legend
//   h, altitude_m   height above the ground, m
//   r               radius_m + h, distance from the planet's centre, m
//   mu              cosine of the zenith angle of a direction at the ray's start
//   mu_s            the same for the direction to the light
//   nu              cosine of the angle between view direction and direction to the light
// r² - R² is never formed from r: it is h (2R + h), which keeps the metres near the ground.

// Cosine of the zenith angle of the horizon: smaller mu hit the ground.
fn horizon_mu(radius_m: f32, altitude_m: f32) -> f32 {
    let h = max(altitude_m, 0.0);
    return -sqrt(h * (2.0 * radius_m + h)) / (radius_m + h);
}

// Altitude after a distance along a ray, m.
fn altitude_along(radius_m: f32, altitude_m: f32, mu: f32, distance_m: f32) -> f32 {
    let r = radius_m + altitude_m;
    let growth = distance_m * (distance_m + 2.0 * r * mu);
    return altitude_m + growth / (sqrt(max(r * r + growth, 0.0)) + r);
}

// Distance to a shell that encloses the ray's start, m; a start above it counts as lying on it.
fn distance_to_shell_from_below(radius_m: f32, altitude_m: f32, mu: f32, shell_m: f32) -> f32 {
    let gap = max((shell_m - altitude_m) * (2.0 * radius_m + shell_m + altitude_m), 0.0);
    let b = (radius_m + altitude_m) * mu;
    let root = sqrt(b * b + gap);
    // Of the two equal forms, the one without cancellation.
    return select(root - b, gap / max(root + b, 1e-20), b >= 0.0);
}

// Distance to the nearer intersection with a shell below the ray's start, m.
//
// The caller knows that the ray meets the shell: a discriminant that rounding made negative counts as grazing.
fn distance_to_shell_from_above(radius_m: f32, altitude_m: f32, mu: f32, shell_m: f32) -> f32 {
    let gap = (altitude_m - shell_m) * (2.0 * radius_m + shell_m + altitude_m);
    let b = (radius_m + altitude_m) * mu;
    let discriminant = max(b * b - gap, 0.0);
    // Grazing, the distance is √gap; no ray that meets the shell has a longer way.
    return gap / max(sqrt(discriminant) - b, max(sqrt(gap), 1e-20));
}

// Length of a view ray's part below the shell at top_m, m, also when it starts above; the caller knows whether the ray
// meets the ground.
fn air_length_m(radius_m: f32, top_m: f32, altitude_m: f32, mu: f32, hits_ground: bool) -> f32 {
    let sine = (radius_m + altitude_m) / (radius_m + top_m) * sqrt(max(1.0 - mu * mu, 0.0));
    let in_space = altitude_m > top_m;
    if in_space && (mu >= 0.0 || sine >= 1.0) {
        return 0.0;
    }
    let start_m = min(altitude_m, top_m);
    let start_mu = select(mu, -sqrt(max(1.0 - sine * sine, 0.0)), in_space);
    if hits_ground {
        return distance_to_shell_from_above(radius_m, start_m, start_mu, 0.0);
    }
    return distance_to_shell_from_below(radius_m, start_m, start_mu, top_m);
}

// Distances at which a ray enters and leaves the inside of a shell, m, as far as they lie ahead; equal when it does not.
fn shell_crossings_m(radius_m: f32, altitude_m: f32, mu: f32, shell_m: f32) -> vec2<f32> {
    let gap = (shell_m - altitude_m) * (2.0 * radius_m + shell_m + altitude_m);
    let b = (radius_m + altitude_m) * mu;
    let discriminant = b * b + gap;
    if discriminant <= 0.0 {
        return vec2<f32>(0.0);
    }
    // Stable quadratic roots: the smaller in magnitude through the product of both.
    let q = -(b + select(-1.0, 1.0, b >= 0.0) * sqrt(discriminant));
    let other = select(-gap / q, q, q == 0.0);
    return max(vec2<f32>(min(q, other), max(q, other)), vec2<f32>(0.0));
}

// The part of a ray on the side of the planet's centre away from the light, where r mu_s + t nu < 0, as distances (start, end)
// of the whole line; r is the distance of its start from the centre. A ray across the light stays on its side.
fn side_away_m(r: f32, mu_s: f32, nu: f32) -> vec2<f32> {
    let crossing_m = -r * mu_s / select(nu, 1e-20, abs(nu) < 1e-20);
    return select(vec2<f32>(crossing_m, 1e30), vec2<f32>(-1e30, crossing_m), nu > -1e-20);
}

// The part of a ray inside the planet's shadow, as distances (start, end) in [0, length_m]; start >= end when lit.
//
// The shadow of a sphere in parallel light is a half-infinite cylinder, a convex set: a ray meets it in one interval,
// whose ends solve |p_perp(t)|² = R² with p_perp the position's part normal to the light.
fn shadow_interval_m(radius_m: f32, altitude_m: f32, mu: f32, mu_s: f32, nu: f32, length_m: f32) -> vec2<f32> {
    let lit = vec2<f32>(1.0, 0.0);
    let r = radius_m + altitude_m;
    let sin2_nu = 1.0 - nu * nu;
    let half_b = r * (mu - nu * mu_s);
    // r² (1 - mu_s²) - R², without subtracting squares of radii.
    let c = altitude_m * (2.0 * radius_m + altitude_m) - r * r * mu_s * mu_s;
    if sin2_nu < 1e-12 {
        // Along the light's axis: all of the ray is inside the cylinder or none.
        return select(lit, vec2<f32>(0.0, length_m), c < 0.0 && mu_s < 0.0);
    }
    let discriminant = half_b * half_b - sin2_nu * c;
    if discriminant <= 0.0 {
        return lit;
    }
    let root = sqrt(discriminant);
    // Stable quadratic roots: the smaller in magnitude through the product of both.
    let q = -(half_b + select(-root, root, half_b >= 0.0));
    let t_0 = q / sin2_nu;
    let t_1 = select(c / q, t_0, q == 0.0);
    var start = min(t_0, t_1);
    var end = max(t_0, t_1);
    let dark_m = side_away_m(r, mu_s, nu);
    start = max(start, dark_m.x);
    end = min(end, dark_m.y);
    return vec2<f32>(max(start, 0.0), min(end, length_m));
}

// Distance at which a ray passes closest to the axis of the planet's shadow on the side away from the light, in [0, length_m]; an
// end of the ray where none of it lies there.
fn closest_to_shadow_m(radius_m: f32, altitude_m: f32, mu: f32, mu_s: f32, nu: f32, length_m: f32) -> f32 {
    let r = radius_m + altitude_m;
    let closest_m = r * (nu * mu_s - mu) / max(1.0 - nu * nu, 1e-12);
    let dark_m = side_away_m(r, mu_s, nu);
    return clamp(clamp(closest_m, dark_m.x, dark_m.y), 0.0, length_m);
}

// acos, within 2e-8 of its value before rounding: what devices have may be thousands of times farther off, which tables
// show. Abramowitz & Stegun, Handbook of Mathematical Functions, 4.4.46.
fn precise_acos(x: f32) -> f32 {
    let a = abs(x);
    var sum = -0.0012624911;
    sum = sum * a + 0.0066700901;
    sum = sum * a - 0.0170881256;
    sum = sum * a + 0.0308918810;
    sum = sum * a - 0.0501743046;
    sum = sum * a + 0.0889789874;
    sum = sum * a - 0.2145988016;
    sum = sum * a + 1.5707963050;
    let angle = sqrt(max(1.0 - a, 0.0)) * sum;
    return select(angle, 3.14159265 - angle, x < 0.0);
}
