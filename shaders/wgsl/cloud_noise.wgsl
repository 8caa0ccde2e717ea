#define_import_path welkin::cloud_noise
// Gradient and cellular noise in whole numbers: every device makes the same bytes, and so does the host
// (welkin_lut::cloud).
//
// Legend
//   position   256ths of a cell;  cells: cells along a tile, a power of two, after which noise repeats
//   value      4096ths

const ONE: i32 = 4096;

// 32 well-mixed bits of a cell (Teschner et al. 2003, Wellons 2018).
fn hash(cell: vec3<i32>, seed: u32) -> u32 {
    let c = vec3<u32>(cell) * vec3<u32>(73856093u, 19349663u, 83492791u);
    var h = c.x ^ c.y ^ c.z ^ (seed * 0x9e3779b9u);
    h = (h ^ (h >> 16u)) * 0x7feb352du;
    h = (h ^ (h >> 15u)) * 0x846ca68bu;
    return h ^ (h >> 16u);
}

// 6t^5 - 15t^4 + 10t^3 of t in 256ths.
fn fade(t: vec3<i32>) -> vec3<i32> {
    let cube = (t * t * t) >> vec3<u32>(12u);
    let rest = (6 * t * t - 3840 * t + 655360) >> vec3<u32>(4u);
    return (cube * rest) >> vec3<u32>(12u);
}

fn lerp(a: i32, b: i32, weight: i32) -> i32 {
    return a + (((b - a) * weight) >> 12u);
}

// An offset's component along one of Perlin's twelve gradients, four of them twice.
fn along_gradient(bits: u32, offset: vec3<i32>) -> i32 {
    let h = bits & 15u;
    let u = select(offset.y, offset.x, h < 8u);
    let v = select(select(offset.z, offset.x, h == 12u || h == 14u), offset.y, h < 4u);
    return 16 * (select(u, -u, (h & 1u) != 0u) + select(v, -v, (h & 2u) != 0u));
}

fn corner(cell: vec3<i32>, share: vec3<i32>, step: vec3<i32>, wrap: i32, seed: u32) -> i32 {
    return along_gradient(hash((cell + step) & vec3<i32>(wrap), seed), share - 256 * step);
}

fn perlin(position: vec3<i32>, cells: i32, seed: u32) -> i32 {
    let wrap = cells - 1;
    let cell = position >> vec3<u32>(8u);
    let share = position & vec3<i32>(255);
    let weight = fade(share);
    var slices: array<i32, 2>;
    for (var k = 0; k < 2; k++) {
        let near = lerp(
            corner(cell, share, vec3<i32>(0, 0, k), wrap, seed), corner(cell, share, vec3<i32>(1, 0, k), wrap, seed),
            weight.x
        );
        let far = lerp(
            corner(cell, share, vec3<i32>(0, 1, k), wrap, seed), corner(cell, share, vec3<i32>(1, 1, k), wrap, seed),
            weight.x
        );
        slices[k] = lerp(near, far, weight.y);
    }
    return lerp(slices[0], slices[1], weight.z);
}

// Octaves, each with twice the cells and half the amplitude of the one before.
fn perlin_octaves(position: vec3<i32>, cells: i32, octaves: u32, seed: u32) -> i32 {
    var sum = 0;
    for (var o = 0u; o < octaves; o++) {
        sum += perlin(position << vec3<u32>(o), cells << o, seed + o) >> o;
    }
    return sum;
}

// Perlin octaves around one half.
fn smooth_octaves(position: vec3<i32>, cells: i32, octaves: u32, seed: u32) -> i32 {
    return clamp(ONE / 2 + perlin_octaves(position, cells, octaves, seed) * 3 / 4, 0, ONE);
}

// The largest whole number whose square is at most x; the device's root may be off by a few roundings.
fn whole_root(x: i32) -> i32 {
    var root = i32(sqrt(f32(x)));
    root -= select(0, 1, root * root > x);
    root -= select(0, 1, root * root > x);
    root += select(0, 1, (root + 1) * (root + 1) <= x);
    root += select(0, 1, (root + 1) * (root + 1) <= x);
    return root;
}

// Worley noise: 1 at a cell's point, falling to 0 at the distance of one cell from the nearest.
fn worley(position: vec3<i32>, cells: i32, seed: u32) -> i32 {
    let wrap = vec3<i32>(cells - 1);
    let cell = position >> vec3<u32>(8u);
    let share = position & vec3<i32>(255);
    var nearest = 0x7fffffff;
    for (var k = -1; k <= 1; k++) {
        for (var j = -1; j <= 1; j++) {
            for (var i = -1; i <= 1; i++) {
                let step = vec3<i32>(i, j, k);
                let bits = hash((cell + step) & wrap, seed);
                let point = vec3<i32>((vec3<u32>(bits) >> vec3<u32>(0u, 8u, 16u)) & vec3<u32>(255u));
                let apart = 256 * step + point - share;
                nearest = min(nearest, apart.x * apart.x + apart.y * apart.y + apart.z * apart.z);
            }
        }
    }
    return max(ONE - whole_root(nearest << 8u), 0);
}

// The sum of three octaves of Worley noise.
fn joined(first: i32, second: i32, third: i32) -> i32 {
    return (5 * first + 2 * second + third) / 8;
}

// A texel's centre in 256ths of a cell.
fn position_of(texel: vec3<i32>, cells: i32, texels: i32) -> vec3<i32> {
    return (2 * texel + 1) * cells * 128 / texels;
}

// The byte of a value of which `low` becomes 0 and `high` 255, as a number in [0, 1].
fn unit_byte(value: i32, low: i32, high: i32) -> f32 {
    return f32((clamp(value, low, high) - low) * 255 / (high - low)) / 255.0;
}
