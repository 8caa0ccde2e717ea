//! Legendre polynomials.

/// P_0 to P_{count-1} at a cosine.
pub fn legendre(count: usize, cosine: f64) -> impl Iterator<Item = f64> {
    let (mut before, mut value) = (0.0, 1.0);
    (0..count).map(move |l| {
        let here = value;
        let l = l as f64;
        (before, value) = (value, ((2.0 * l + 1.0) * cosine * value - l * before) / (l + 1.0));
        here
    })
}
