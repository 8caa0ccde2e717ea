#define_import_path welkin::phase
// Phase functions in closed form, as lobes.

// scale * (1 + quadratic nu²) * (gap + slope (1 - peak_nu nu))^(-exponent): Henyey-Greenstein, Rayleigh, Cornette-Shanks,
// Draine and Schlick are all of this form. gap is (1 - |g|)² exactly, so that the peak survives f32, forward or backward.
struct PhaseLobe {
    scale_per_sr: f32,
    quadratic: f32,
    gap: f32,
    slope: f32,
    exponent: f32,
    // 1 where the peak is forward, -1 where it is backward.
    peak_nu: f32,
    padding_a: f32,
    padding_b: f32,
}

// One lobe's part of a phase function, 1/sr; nu = 1 is forward.
fn lobe_per_sr(lobe: PhaseLobe, nu: f32) -> f32 {
    let base = lobe.gap + lobe.slope * (1.0 - lobe.peak_nu * nu);
    // The exponents are 0, 3/2 and 2: products of a root, which is nearer and cheaper than a power.
    let root = inverseSqrt(base);
    let power = select(root * root * root, root * root * root * root, lobe.exponent > 1.75);
    return lobe.scale_per_sr * (1.0 + lobe.quadratic * nu * nu) * select(power, 1.0, lobe.exponent < 0.75);
}
