//! Linear interpolation in tiles that repeat. Coordinates count tiles; a texel's value holds at its centre.

/// The two texels around a coordinate along one axis, and the share of the second.
fn around(tiles: f64, size: usize) -> (usize, usize, f64) {
    let texel = (tiles - tiles.floor()) * size as f64 - 0.5;
    let low = texel.floor();
    let first = (low as i64).rem_euclid(size as i64) as usize;
    (first, (first + 1) % size, texel - low)
}

fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

/// A byte as a number in [0, 1].
pub fn unit(byte: u8) -> f64 {
    f64::from(byte) / 255.0
}

/// Four-point interpolation of one channel of a square tile.
pub fn bilinear(size: usize, [x, y]: [f64; 2], texel: impl Fn(usize) -> u8) -> f64 {
    let ((x0, x1, sx), (y0, y1, sy)) = (around(x, size), around(y, size));
    let row = |y: usize| mix(unit(texel(y * size + x0)), unit(texel(y * size + x1)), sx);
    mix(row(y0), row(y1), sy)
}

/// Eight-point interpolation of a volume.
pub fn trilinear(size: usize, [x, y, z]: [f64; 3], bytes: &[u8]) -> f64 {
    let ((x0, x1, sx), (y0, y1, sy), (z0, z1, sz)) = (around(x, size), around(y, size), around(z, size));
    let row = |y: usize, z: usize| {
        let start = (z * size + y) * size;
        mix(unit(bytes[start + x0]), unit(bytes[start + x1]), sx)
    };
    let slice = |z: usize| mix(row(y0, z), row(y1, z), sy);
    mix(slice(z0), slice(z1), sz)
}
