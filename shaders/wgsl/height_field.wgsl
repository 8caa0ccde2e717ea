#define_import_path welkin::height_field
// Hills and mountains: the same field as the host's welkin_lut::height_field, in f32.
//
// Legend
//   at              (east, north) of a point's foot on the smooth sphere, seen from straight above, m
//   footprint_m     what one sample covers: waves that are too short for it have their mean height

struct Octave {
    // From (east, north) to lattice cells, a matrix row by row, 1/m.
    to_cells: vec4<f32>,
    // Where the origin lies in its cell, and the cell.
    fraction: vec2<f32>,
    cell: vec2<i32>,
    wavelength_m: f32,
    // Share of the field's height.
    share: f32,
    key: u32,
    padding: f32,
}

struct HeightField {
    albedo: vec3<f32>,
    // No point is higher, m.
    height_m: f32,
    snow_albedo: vec3<f32>,
    wavelength_m: f32,
    // Altitude above which snow lies, m.
    snow_line_m: f32,
    // How fast the ground may rise.
    steepest_slope: f32,
    octave_count: u32,
    padding: f32,
    octaves: array<Octave>,
}

@group(0) @binding(20) var<storage, read> height_field: HeightField;

// Mean of a folded octave; least weight of an octave in low ground, and how it grows with height.
const RIDGE_MEAN: f32 = 0.4467;
const LEAST_WEIGHT: f32 = 0.1;
const WEIGHT_GROWTH: f32 = 1.3;

// Permuted congruential hash (Jarzynski & Olano 2020).
fn hash(value: u32) -> u32 {
    let state = value * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn lattice_value(cell: vec2<i32>, key: u32) -> f32 {
    let hashed = hash(bitcast<u32>(cell.x) + hash(bitcast<u32>(cell.y) + key));
    return f32(hashed >> 8u) / 16777216.0;
}

// Folded noise in [0, 1]: 1 on ridges.
fn ridge(octave: u32, at: vec2<f32>) -> f32 {
    let wave = height_field.octaves[octave];
    let x = vec2<f32>(dot(wave.to_cells.xy, at), dot(wave.to_cells.zw, at)) + wave.fraction;
    let low = floor(x);
    let t = x - low;
    let u = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let cell = wave.cell + vec2<i32>(low);
    let south = mix(lattice_value(cell, wave.key), lattice_value(cell + vec2<i32>(1, 0), wave.key), u.x);
    let north =
        mix(lattice_value(cell + vec2<i32>(0, 1), wave.key), lattice_value(cell + vec2<i32>(1, 1), wave.key), u.x);
    let folded = 1.0 - abs(2.0 * mix(south, north, u.y) - 1.0);
    return folded * folded;
}

// How much of a wave is seen: all of it from four samples a wave on, nothing below two.
fn visible_share(wavelength_m: f32, footprint_m: f32) -> f32 {
    let octaves = clamp(log2(0.5 * wavelength_m / max(footprint_m, 1e-9)), 0.0, 1.0);
    return octaves * octaves * (3.0 - 2.0 * octaves);
}

// Share of the relief that is seen at all.
fn relief_share(footprint_m: f32) -> f32 {
    return visible_share(height_field.wavelength_m, footprint_m);
}

// Height above the sphere, m.
fn height_at(at: vec2<f32>, footprint_m: f32) -> f32 {
    return height_below(at, footprint_m, -1.0);
}

// The same, or, where the ground is far below an altitude, a height that is nowhere less and leaves half of the clearance:
// high above the ground most octaves need not be looked at.
fn height_below(at: vec2<f32>, footprint_m: f32, altitude_m: f32) -> f32 {
    let relief = relief_share(footprint_m);
    if relief == 0.0 {
        return 0.0;
    }
    let level = altitude_m / (height_field.height_m * relief);
    var sum = 0.0;
    var strongest = 0.0;
    var weight = 1.0;
    for (var i = 0u; i < height_field.octave_count; i++) {
        let share = visible_share(height_field.octaves[i].wavelength_m, footprint_m);
        var value = RIDGE_MEAN;
        if share > 0.0 {
            value += (ridge(i, at) - RIDGE_MEAN) * share;
        }
        sum += height_field.octaves[i].share * weight * value;
        strongest += height_field.octaves[i].share;
        let most = sum + 1.0 - strongest;
        if level - most > 0.5 * (level - sum) {
            return height_field.height_m * most * relief;
        }
        weight = LEAST_WEIGHT + (1.0 - LEAST_WEIGHT) * min(WEIGHT_GROWTH * sum / strongest, 1.0);
    }
    return height_field.height_m * sum * relief;
}

// Gradient by central differences.
fn gradient_at(at: vec2<f32>, footprint_m: f32) -> vec2<f32> {
    let half_m = 0.5 * footprint_m;
    let east = height_at(at + vec2<f32>(half_m, 0.0), footprint_m) - height_at(at - vec2<f32>(half_m, 0.0), footprint_m);
    let north = height_at(at + vec2<f32>(0.0, half_m), footprint_m) - height_at(at - vec2<f32>(0.0, half_m), footprint_m);
    return vec2<f32>(east, north) / footprint_m;
}
