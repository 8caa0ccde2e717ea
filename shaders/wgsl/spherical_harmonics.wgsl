#define_import_path welkin::spherical_harmonics
// Real spherical harmonics that are even in azimuth, which is all that a field symmetric about the light's plane has.
//
// Legend
//   (l, m), m >= 0, in the order 00, 10, 11, 20, 21, 22, 30, ..: coefficient index l (l + 1) / 2 + m
//   mu         cosine of the zenith angle;  cos_phi: cosine of the azimuth from the light
//   orthonormal on the sphere
//
// Definitions: DEGREE_COUNT, degrees 0 .. DEGREE_COUNT - 1 (3 or 5).

const DEGREE_COUNT: u32 = #{DEGREE_COUNT}u;
const COEFFICIENT_COUNT: u32 = #{COEFFICIENT_COUNT}u;


// Y_lm(mu, phi) for all coefficients.
fn harmonics(mu: f32, cos_phi: f32) -> array<f32, COEFFICIENT_COUNT> {
    let s2 = max(1.0 - mu * mu, 0.0);
    let s = sqrt(s2);
    let cos_2phi = 2.0 * cos_phi * cos_phi - 1.0;
    var y: array<f32, COEFFICIENT_COUNT>;
    y[0] = 0.282094792;
    y[1] = 0.488602512 * mu;
    y[2] = 0.488602512 * s * cos_phi;
    y[3] = 0.315391565 * (3.0 * mu * mu - 1.0);
    y[4] = 1.092548431 * mu * s * cos_phi;
    y[5] = 0.546274215 * s2 * cos_2phi;
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
