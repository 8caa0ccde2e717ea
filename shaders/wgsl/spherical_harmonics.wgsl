#define_import_path welkin::spherical_harmonics
// Real spherical harmonics that are even in azimuth, which is all that a field symmetric about the light's plane has.
//
// Legend
//   (l, m), m >= 0, in the order 00, 10, 11, 20, 21, 22, 30, ..: coefficient index l (l + 1) / 2 + m
//   mu         cosine of the zenith angle;  cos_phi: cosine of the azimuth from the light
//   Y_lm = associated_legendre(l, m, mu) cos(m phi), orthonormal on the sphere
//
// Definitions: DEGREE_COUNT, degrees 0 .. DEGREE_COUNT - 1 (1, 3 or 5); COEFFICIENT_COUNT = DEGREE_COUNT (DEGREE_COUNT + 1) / 2.

const PI: f32 = 3.14159265358979;
const DEGREE_COUNT: u32 = #{DEGREE_COUNT}u;
const COEFFICIENT_COUNT: u32 = #{COEFFICIENT_COUNT}u;

// The next degree of an orthonormal associated Legendre function from the two before it.
fn next_degree(l: u32, m: u32, mu: f32, value: f32, before: f32) -> f32 {
    let a = f32(l * l);
    let b = f32(m * m);
    let c = f32((l - 1u) * (l - 1u));
    return sqrt((4.0 * a - 1.0) / (a - b)) * (mu * value - sqrt(max((c - b) / (4.0 * c - 1.0), 0.0)) * before);
}

// The function of degree m and order m, from that of m - 1; without Condon and Shortley's sign.
fn next_sectoral(m: u32, sine: f32, value: f32) -> f32 {
    // From order 0 to 1 the cosine's norm brings a factor of two more.
    let norm = select(1.0, 2.0, m == 1u);
    return sqrt(norm * (1.0 + 0.5 / f32(m))) * sine * value;
}

// One orthonormal associated Legendre function, the norm of cos(m phi) included.
fn associated_legendre(l: u32, m: u32, mu: f32) -> f32 {
    let sine = sqrt(max(1.0 - mu * mu, 0.0));
    var value = sqrt(0.25 / PI);
    for (var order = 1u; order <= m; order++) {
        value = next_sectoral(order, sine, value);
    }
    var before = 0.0;
    for (var degree = m + 1u; degree <= l; degree++) {
        let next = next_degree(degree, m, mu, value, before);
        before = value;
        value = next;
    }
    return value;
}

// Y_lm(mu, phi) for all coefficients: written out, as every node of every ray needs them.
fn harmonics(mu: f32, cos_phi: f32) -> array<f32, COEFFICIENT_COUNT> {
    var y: array<f32, COEFFICIENT_COUNT>;
    y[0] = 0.282094792;
#if DEGREE_COUNT >= 3
    let s2 = max(1.0 - mu * mu, 0.0);
    let s = sqrt(s2);
    let cos_2phi = 2.0 * cos_phi * cos_phi - 1.0;
    y[1] = 0.488602512 * mu;
    y[2] = 0.488602512 * s * cos_phi;
    y[3] = 0.315391565 * (3.0 * mu * mu - 1.0);
    y[4] = 1.092548431 * mu * s * cos_phi;
    y[5] = 0.546274215 * s2 * cos_2phi;
#endif
#if DEGREE_COUNT >= 5
    let mu2 = mu * mu;
    let cos_3phi = cos_phi * (2.0 * cos_2phi - 1.0);
    let cos_4phi = 2.0 * cos_2phi * cos_2phi - 1.0;
    y[6] = 0.373176333 * mu * (5.0 * mu2 - 3.0);
    y[7] = 0.457045799 * s * (5.0 * mu2 - 1.0) * cos_phi;
    y[8] = 1.445305721 * mu * s2 * cos_2phi;
    y[9] = 0.590043590 * s * s2 * cos_3phi;
    y[10] = 0.105785547 * ((35.0 * mu2 - 30.0) * mu2 + 3.0);
    y[11] = 0.669046544 * mu * s * (7.0 * mu2 - 3.0) * cos_phi;
    y[12] = 0.473087348 * s2 * (7.0 * mu2 - 1.0) * cos_2phi;
    y[13] = 1.770130769 * mu * s * s2 * cos_3phi;
    y[14] = 0.625835735 * s2 * s2 * cos_4phi;
#endif
    return y;
}

// The degree l of a coefficient's index.
fn degree_of(coefficient: u32) -> u32 {
    return u32((sqrt(8.0 * f32(coefficient) + 1.0) - 1.0) * 0.5 + 1e-4);
}
