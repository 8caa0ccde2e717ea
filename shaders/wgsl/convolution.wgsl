#define_import_path welkin::convolution
// The source function of a texel from the radiance field there: the field convolved with the phase functions.
//
// The sum over directions cannot resolve a peak narrower than their spacing, so the peak is subtracted: with p of
// integral 1, int p I dw' = I + int p (I(w') - I) dw', whose integrand vanishes where p is largest.
//
// A peak elsewhere, as of light that is thrown back, is not subtracted, and a direction in it may count for more than
// the whole of p. The sum is then divided by what it counts: a mean over directions is never larger than all of them.

#import welkin::atmosphere::{atmosphere, phase_per_sr, PI, PROFILE_GROUP_COUNT, SCATTERER_COUNT, SCATTERER_SLOTS}
#import welkin::source_grid::{direction_of, DIRECTION_COUNT}
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

// For each group of scatterers with one density profile: sum_c b_c int p_c I dw' / sum_c b_c.
fn source_function(index: u32) -> array<vec3<f32>, PROFILE_GROUP_COUNT> {
    let here = directions[index].xyz;
    let radiance = field[index];
    var sums: array<vec3<f32>, SCATTERER_SLOTS>;
    // How much of each p, of 1, the sums count.
    var counted: array<f32, SCATTERER_SLOTS>;
    for (var j = 0u; j < DIRECTION_COUNT; j++) {
        let there = directions[j];
        let half_sr = select(0.5 * there.w, 0.0, j == index);
        let difference = half_sr * (field[j] - radiance);
        // Both mirror images of the other direction.
        let level = here.x * there.x + here.z * there.z;
        let across = here.y * there.y;
        let nu = min(vec2<f32>(level + across, level - across), vec2<f32>(1.0));
        for (var c = 0u; c < SCATTERER_COUNT; c++) {
            let phase = phase_per_sr(c, nu.x) + phase_per_sr(c, nu.y);
            sums[c] += phase * difference;
            counted[c] += phase * half_sr;
        }
    }
    var convolved: array<vec3<f32>, PROFILE_GROUP_COUNT>;
    var scattering: array<vec3<f32>, PROFILE_GROUP_COUNT>;
    for (var c = 0u; c < SCATTERER_COUNT; c++) {
        let group = atmosphere.constituents[c].profile_group;
        convolved[group] += sums[c] / max(counted[c], 1.0) * atmosphere.constituents[c].scattering_per_m;
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
    for (var i = 0u; i < DIRECTION_COUNT; i++) {
        sum += directions[i].w * max(directions[i].z, 0.0) * field[i];
    }
    return sum;
}

// The field's mean over directions.
fn mean_of_field() -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < DIRECTION_COUNT; i++) {
        sum += directions[i].w * field[i];
    }
    return sum / (4.0 * PI);
}

// The field's coefficient of a spherical harmonic, k from 1 to HARMONIC_COUNT, over that of degree 0.
fn harmonic_of_field(k: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    var all = vec3<f32>(0.0);
    for (var i = 0u; i < DIRECTION_COUNT; i++) {
        let direction = directions[i];
        let sine = sqrt(max(1.0 - direction.z * direction.z, 0.0));
        var y = harmonics(direction.z, direction.x / max(sine, 1e-6));
        sum += direction.w * y[k] * field[i];
        all += direction.w * y[0] * field[i];
    }
    return sum / max(all, vec3<f32>(1e-30));
}
