#define_import_path welkin::convolution
// The source function of a texel from the radiance field there: the field convolved with the phase functions.
//
// The sum over directions cannot resolve a peak narrower than their spacing, so the peak is subtracted: with p of
// integral 1, int p I dw' = I + int p (I(w') - I) dw', whose integrand vanishes where p is largest. Phase functions that
// have no more than a square of nu, as that of molecules, need no such sum for each direction: five moments of the field
// do for all.
//
// Of matter that throws light back the peak lies in the opposite direction: there it is the field around that direction that
// is subtracted. A peak elsewhere is not, and a direction in it may count for more than the whole of p. The sum is then divided
// by what it counts: a mean over directions is never larger than all of them.

#import welkin::atmosphere::{atmosphere, peak_side, phase_per_sr, LOBE_COUNT, PI, PROFILE_GROUP_COUNT, SCATTERER_COUNT}
#import welkin::loops::counted
#import welkin::source_grid::{
    direction_of, moment_texel, texel_of, DIRECTION_COUNT, IRRADIANCE_TILE, MEAN_TILE
}
#import welkin::spherical_harmonics::harmonics

// Radiance seen along each direction of the grid, filled by all invocations before a barrier.
var<workgroup> field: array<vec3<f32>, DIRECTION_COUNT>;
// The directions: x towards the light's azimuth, y across, z up; w: solid angle, sr.
var<workgroup> directions: array<vec4<f32>, DIRECTION_COUNT>;

fn keep_direction(index: u32, horizon_mu: f32, mu_s: f32) {
    let direction = direction_of(index, horizon_mu, mu_s);
    let sine = sqrt(max(1.0 - direction.mu * direction.mu, 0.0));
    let horizontal = sine * vec2<f32>(cos(direction.phi_rad), sin(direction.phi_rad));
    directions[index] = vec4<f32>(horizontal, direction.mu, direction.solid_angle_sr);
}

// Mean over both mirror images of nu² is a sum over xx, yy, zz and xz of one direction times those of the other; last: 1.
const MOMENT_COUNT: u32 = 5u;
var<workgroup> field_moments: array<vec3<f32>, MOMENT_COUNT>;
var<workgroup> direction_moments: array<f32, MOMENT_COUNT>;

fn products(direction: vec3<f32>) -> array<f32, MOMENT_COUNT> {
    let squares = direction * direction;
    return array<f32, MOMENT_COUNT>(squares.x, squares.y, squares.z, direction.x * direction.z, 1.0);
}

// One of the moments, found by one invocation of each between two barriers.
fn keep_moment(index: u32) {
    var of_field = vec3<f32>(0.0);
    var of_directions = 0.0;
    for (var i = 0u; i < counted(DIRECTION_COUNT); i++) {
        var product = products(directions[i].xyz);
        of_field += directions[i].w * product[index] * field[i];
        of_directions += directions[i].w * product[index];
    }
    field_moments[index] = of_field;
    direction_moments[index] = of_directions;
}

// Whether a phase function is a lobe or two of the form scale (1 + quadratic nu²).
fn is_quadratic(constituent: u32) -> bool {
    var slope = 0.0;
    for (var i = 0u; i < LOBE_COUNT; i++) {
        slope += abs(atmosphere.constituents[constituent].lobes[i].slope);
    }
    return slope == 0.0;
}

// int p (I(w') - I) dw' of such a function.
fn quadratic_convolution(constituent: u32, here: vec3<f32>, radiance: vec3<f32>) -> vec3<f32> {
    var product = products(here);
    var squares = vec3<f32>(0.0);
    for (var m = 0u; m < 4u; m++) {
        let twice = select(1.0, 2.0, m == 3u);
        squares += twice * product[m] * (field_moments[m] - radiance * direction_moments[m]);
    }
    let even = field_moments[4] - radiance * direction_moments[4];
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < LOBE_COUNT; i++) {
        let lobe = atmosphere.constituents[constituent].lobes[i];
        sum += lobe.scale_per_sr * (even + lobe.quadratic * squares);
    }
    return sum;
}

// Cosines of the angles between two directions, to both mirror images of the second.
fn cosines_between(here: vec3<f32>, there: vec3<f32>) -> vec2<f32> {
    let level = here.x * there.x + here.z * there.z;
    let across = here.y * there.y;
    return clamp(vec2<f32>(level + across, level - across), vec2<f32>(-1.0), vec2<f32>(1.0));
}

// The field opposite to a direction: a mean over all, by the inverse fourth power of the distance (Shepard's).
fn radiance_opposite(here: vec3<f32>) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var j = 0u; j < counted(DIRECTION_COUNT); j++) {
        let distance2 = 1.0 + cosines_between(here, directions[j].xyz) + 1e-6;
        let weight = directions[j].w * (1.0 / (distance2.x * distance2.x) + 1.0 / (distance2.y * distance2.y));
        sum += weight * field[j];
        weights += weight;
    }
    return sum / weights;
}

// For each group of scatterers with one density profile: sum_c b_c int p_c I dw' / sum_c b_c.
fn source_function(index: u32) -> array<vec3<f32>, PROFILE_GROUP_COUNT> {
    let here = directions[index].xyz;
    let radiance = field[index];
    var convolved: array<vec3<f32>, PROFILE_GROUP_COUNT>;
    var scattering: array<vec3<f32>, PROFILE_GROUP_COUNT>;
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        var sum = vec3<f32>(0.0);
        let quadratic = is_quadratic(c);
        if quadratic {
            sum = quadratic_convolution(c, here, radiance);
        }
        // A bound of zero leaves the loop out also where devices run both sides of a branch.
        let count = select(DIRECTION_COUNT, 0u, quadratic);
        let is_thrown_back = !quadratic && peak_side(c) < 0.0;
        var at_peak = radiance;
        if is_thrown_back {
            at_peak = radiance_opposite(here);
        }
        // How much of p, of 1, the sum counts.
        var share = 0.0;
        for (var j = 0u; j < count; j++) {
            let there = directions[j];
            // In the peak itself nothing is left to count.
            let half_sr = select(0.5 * there.w, 0.0, j == index && !is_thrown_back);
            let nu = cosines_between(here, there.xyz);
            let phase = phase_per_sr(c, nu.x) + phase_per_sr(c, nu.y);
            sum += phase * half_sr * (field[j] - at_peak);
            share += phase * half_sr;
        }
        let group = atmosphere.constituents[c].profile_group;
        let change = at_peak - radiance + sum / max(share, 1.0);
        convolved[group] += change * atmosphere.constituents[c].scattering_per_m;
        scattering[group] += atmosphere.constituents[c].scattering_per_m;
    }
    for (var g = 0u; g < PROFILE_GROUP_COUNT; g++) {
        convolved[g] = radiance + convolved[g] / max(scattering[g], vec3<f32>(1e-30));
    }
    return convolved;
}

// The field's irradiance on a horizontal plane from above.
fn irradiance() -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < counted(DIRECTION_COUNT); i++) {
        sum += directions[i].w * max(directions[i].z, 0.0) * field[i];
    }
    return sum;
}

// The field's mean over directions.
fn mean_of_field() -> vec3<f32> {
    return field_moments[4] / (4.0 * PI);
}

// The field's coefficient of a spherical harmonic, k from 1 to HARMONIC_COUNT, over that of degree 0.
fn harmonic_of_field(k: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < counted(DIRECTION_COUNT); i++) {
        let direction = directions[i];
        let sine = sqrt(max(1.0 - direction.z * direction.z, 0.0));
        var y = harmonics(direction.z, direction.x / max(sine, 1e-6));
        sum += direction.w * y[k] * field[i];
    }
    // Y_00 is sqrt(1 / (4 pi)).
    return sum / max(sqrt(0.25 / PI) * field_moments[4], vec3<f32>(1e-30));
}

// What is tabulated as logarithms: the source function in each direction, then the field's irradiance and its mean.
const LOGARITHM_COUNT: u32 = DIRECTION_COUNT + 2u;

// One of them: its values, the first layer_count of which count, and their texel at a place of every tile.
struct Positive {
    texel: vec2<u32>,
    layer_count: u32,
    values: array<vec3<f32>, PROFILE_GROUP_COUNT>,
}

fn positive(index: u32, place: vec2<u32>) -> Positive {
    var found: Positive;
    if index < DIRECTION_COUNT {
        found.texel = texel_of(index, place);
        found.layer_count = PROFILE_GROUP_COUNT;
        found.values = source_function(index);
        return found;
    }
    let is_mean = index > DIRECTION_COUNT;
    found.texel = moment_texel(select(IRRADIANCE_TILE, MEAN_TILE, is_mean), place);
    found.layer_count = 1u;
    found.values[0] = select(irradiance(), mean_of_field(), is_mean);
    return found;
}
