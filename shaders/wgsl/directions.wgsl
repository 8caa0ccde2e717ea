#define_import_path welkin::directions
// The directions in which a radiance field is sampled at a table's texel, and the field's projection.
//
// Zenith angles are cut at the horizon, where radiance has a kink, and at the horizontal: Gauss-Legendre below the
// horizon, in the band between both, and above. Azimuths are midpoints on half a turn: the field is symmetric.
//
// Definitions: BELOW_COUNT, BAND_COUNT, ABOVE_COUNT (cosines in each part), AZIMUTH_COUNT; INVOCATION_COUNT, the
// workgroup's: invocation i takes the directions i, i + INVOCATION_COUNT, ..

#import welkin::loops::counted
#import welkin::march::GaussNode
#import welkin::spherical_harmonics::{associated_legendre, degree_of, DEGREE_COUNT}

const PI: f32 = 3.14159265358979;
const BELOW_COUNT: u32 = #{BELOW_COUNT}u;
const BAND_COUNT: u32 = #{BAND_COUNT}u;
const ABOVE_COUNT: u32 = #{ABOVE_COUNT}u;
const AZIMUTH_COUNT: u32 = #{AZIMUTH_COUNT}u;
const COSINE_COUNT: u32 = BELOW_COUNT + BAND_COUNT + ABOVE_COUNT;
const DIRECTION_COUNT: u32 = COSINE_COUNT * AZIMUTH_COUNT;
const INVOCATION_COUNT: u32 = #{INVOCATION_COUNT}u;

// Gauss-Legendre nodes on [0, 1] for the three parts, one after the other.
@group(0) @binding(2) var<uniform> cosine_nodes: array<GaussNode, COSINE_COUNT>;

struct Direction {
    mu: f32,
    cos_phi: f32,
    // What the direction stands for, both of its mirror images counted, sr.
    solid_angle_sr: f32,
    hits_ground: bool,
}

fn azimuth_rad(index: u32) -> f32 {
    return (f32(index) + 0.5) * PI / f32(AZIMUTH_COUNT);
}

fn direction_of(index: u32, horizon_mu: f32) -> Direction {
    let node = cosine_nodes[index / AZIMUTH_COUNT];
    let x = node.abscissa;
    var direction: Direction;
    var d_mu = node.weight;
    if index / AZIMUTH_COUNT < BELOW_COUNT {
        direction.hits_ground = true;
        direction.mu = horizon_mu - (1.0 + horizon_mu) * x * x;
        d_mu *= 2.0 * x * (1.0 + horizon_mu);
    } else if index / AZIMUTH_COUNT < BELOW_COUNT + BAND_COUNT {
        direction.mu = horizon_mu * (1.0 - x);
        d_mu *= -horizon_mu;
    } else {
        direction.mu = x * x;
        d_mu *= 2.0 * x;
    }
    direction.cos_phi = cos(azimuth_rad(index % AZIMUTH_COUNT));
    direction.solid_angle_sr = d_mu * 2.0 * PI / f32(AZIMUTH_COUNT);
    return direction;
}

// Radiance seen along each direction, filled by all invocations before a barrier.
var<workgroup> field: array<vec3<f32>, DIRECTION_COUNT>;

// For each cosine, int I cos(m phi) dw over its ring of directions, m = 0 .. DEGREE_COUNT - 1: coefficients of one m share it.
const RING_SUM_COUNT: u32 = COSINE_COUNT * DEGREE_COUNT;
var<workgroup> ring_sums: array<vec3<f32>, RING_SUM_COUNT>;

// Keeps them; called by all invocations after the barrier behind the field, and before another.
fn keep_ring_sums(invocation: u32, horizon_mu: f32) {
    for (var i = invocation; i < RING_SUM_COUNT; i += INVOCATION_COUNT) {
        let first = i / DEGREE_COUNT * AZIMUTH_COUNT;
        let m = f32(i % DEGREE_COUNT);
        var sum = vec3<f32>(0.0);
        for (var k = 0u; k < AZIMUTH_COUNT; k++) {
            sum += cos(m * azimuth_rad(k)) * field[first + k];
        }
        ring_sums[i] = direction_of(first, horizon_mu).solid_angle_sr * sum;
    }
}

// I_lm of the field for one coefficient, from its ring sums.
fn project(coefficient: u32, horizon_mu: f32) -> vec3<f32> {
    let l = degree_of(coefficient);
    let m = coefficient - l * (l + 1u) / 2u;
    var sum = vec3<f32>(0.0);
    for (var j = 0u; j < counted(COSINE_COUNT); j++) {
        let mu = direction_of(j * AZIMUTH_COUNT, horizon_mu).mu;
        sum += associated_legendre(l, m, mu) * ring_sums[j * DEGREE_COUNT + m];
    }
    return sum;
}

// The field's irradiance on a horizontal plane from above, from its ring sums.
fn irradiance(horizon_mu: f32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var j = BELOW_COUNT; j < counted(COSINE_COUNT); j++) {
        let mu = direction_of(j * AZIMUTH_COUNT, horizon_mu).mu;
        sum += max(mu, 0.0) * ring_sums[j * DEGREE_COUNT];
    }
    return sum;
}
