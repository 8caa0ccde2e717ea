#define_import_path welkin::volume_field
// From a place to the density of fog and local volumes: the chain that defines them, as in welkin_lut::volume, and its
// integral along straight ways.
//
// Legend
//   p          east, north, up from the ground below the camera, m
//   place      p with its point on the clouds' map and its altitude
//   q          p from a local volume's middle, in the volume's own axes, m
//   depth      how far a point lies below the surface, as a share of the half size or of the thickness
//   length     density integrated over a way, m: times a coefficient it is an optical depth
// Fog stands before the local volumes.
//
// Definitions: VOLUME_COUNT, of which FOG_COUNT are fog; VOLUME_NOISE (some volume has billows); VOLUME_GRIDS (some volume
// has samples).

#import welkin::atmosphere::atmosphere
#import welkin::cloud_field::{cloud_erosion_volume, cloud_shape_volume, to_map, volume, EROSION_TEXELS, SHAPE_TEXELS}
#import welkin::geometry::distance_to_shell_from_below

const VOLUME_COUNT: u32 = #{VOLUME_COUNT}u;
const FOG_COUNT: u32 = #{FOG_COUNT}u;

// welkin_lut::volume::VolumeParameters says what each is, and welkin_lut::volume::Volume.
struct Volume {
    centre_m: vec3<f32>,
    kind: u32,
    half_size_m: vec3<f32>,
    per_edge: f32,
    noise_offset: vec3<f32>,
    noise_per_m: f32,
    scattering_per_m: vec3<f32>,
    noise_strength: f32,
    extinction_per_m: vec3<f32>,
    // Longest step in which density may be taken for constant.
    detail_m: f32,
    emission_per_m: vec3<f32>,
    per_scale_height: f32,
    turn: vec2<f32>,
    bottom_m: f32,
    top_m: f32,
    grid_size: vec3<u32>,
    // Where its samples begin.
    grid_first: u32,
    // Extinction of the similar medium over the extinction, 1 - w f with f the share of scattering that hardly turns light from its line:
    // the forward peak's.
    similar_extinction: vec3<f32>,
    // 1 - f, the share of scattering that turns light from its line.
    similarity: f32,
    // 1 - the whole mean cosine.
    backward: f32,
    // Whether density is 1 all through a local volume.
    is_even: u32,
    // First block of its grid of light.
    first_block: u32,
    // Its table of lamps' scattered light: welkin::lamp_field.
    lamp_field: u32,
    // Of the light that it scatters once, what it scatters again, and again: over the light itself.
    again: vec3<f32>,
    // Its table of what its forward peak makes of a beam: welkin::beam_field.
    beam_field: u32,
    // Volumes that may stand between it and a light, in `local_lists`: where they begin, and how many.
    occluders_first: u32,
    occluder_count: u32,
}

@group(1) @binding(40) var<storage, read> volumes: array<Volume>;
#ifdef VOLUME_GRIDS
@group(1) @binding(41) var<storage, read> volume_samples: array<f32>;
#endif

const BOX: u32 = 0u;
const ELLIPSOID: u32 = 1u;
const EXPONENTIAL_FOG: u32 = 2u;

const FINE_TILES: f32 = 4.0;
const FINE_SHARE: f32 = 0.25;
const NOISE_FROM: f32 = 0.3;
const NOISE_SLOPE: f32 = 2.5;

struct Place {
    p: vec3<f32>,
    altitude_m: f32,
    map: vec2<f32>,
}

fn altitude_of(p: vec3<f32>) -> f32 {
    let growth = dot(p, p) + 2.0 * atmosphere.radius_m * p.z;
    return growth / (sqrt(max(growth + atmosphere.radius_m * atmosphere.radius_m, 0.0)) + atmosphere.radius_m);
}

fn place_of(p: vec3<f32>) -> Place {
    return Place(p, altitude_of(p), to_map(atmosphere.radius_m, p));
}

fn turned(index: u32, v: vec3<f32>) -> vec3<f32> {
    let turn = volumes[index].turn;
    return vec3<f32>(v.x * turn.x - v.y * turn.y, v.x * turn.y + v.y * turn.x, v.z);
}

// What the distance to the surface leaves of the density.
fn edge(index: u32, depth: f32) -> f32 {
    let per_edge = volumes[index].per_edge;
    return select(saturate(depth * per_edge), 1.0, per_edge == 0.0);
}

fn billows(index: u32, at_m: vec3<f32>) -> f32 {
#ifdef VOLUME_NOISE
    let strength = volumes[index].noise_strength;
    if strength > 0.0 {
        let tiles = at_m * volumes[index].noise_per_m + volumes[index].noise_offset;
        let coarse = volume(cloud_shape_volume, SHAPE_TEXELS, tiles);
        let fine = volume(cloud_erosion_volume, EROSION_TEXELS, tiles * FINE_TILES);
        let full = saturate((mix(coarse, fine, FINE_SHARE) - NOISE_FROM) * NOISE_SLOPE);
        return 1.0 - strength * (1.0 - full);
    }
#endif
    return 1.0;
}

#ifdef VOLUME_GRIDS
fn sample_at(index: u32, voxel: vec3<u32>) -> f32 {
    let size = volumes[index].grid_size;
    let kept = min(voxel, size - 1u);
    return volume_samples[volumes[index].grid_first + (kept.z * size.y + kept.y) * size.x + kept.x];
}

// A local volume's samples at a place in [0, 1]³ of its box.
fn samples(index: u32, share: vec3<f32>) -> f32 {
    let size = volumes[index].grid_size;
    if size.x == 0u {
        return 1.0;
    }
    let voxel = clamp(share * vec3<f32>(size) - 0.5, vec3<f32>(0.0), vec3<f32>(size - 1u));
    let low = vec3<u32>(voxel);
    let t = voxel - vec3<f32>(low);
    var slices: array<f32, 2>;
    for (var z = 0u; z < 2u; z++) {
        let near = mix(sample_at(index, low + vec3<u32>(0u, 0u, z)), sample_at(index, low + vec3<u32>(1u, 0u, z)), t.x);
        let far = mix(sample_at(index, low + vec3<u32>(0u, 1u, z)), sample_at(index, low + vec3<u32>(1u, 1u, z)), t.x);
        slices[z] = mix(near, far, t.y);
    }
    return mix(slices[0], slices[1], t.z);
}
#endif

// Density of fog without its billows.
fn fog_profile(index: u32, altitude_m: f32) -> f32 {
    let bottom_m = volumes[index].bottom_m;
    let top_m = volumes[index].top_m;
    if !(altitude_m >= bottom_m && altitude_m <= top_m) {
        return 0.0;
    }
    if volumes[index].kind == EXPONENTIAL_FOG {
        return exp(-(altitude_m - bottom_m) * volumes[index].per_scale_height);
    }
    return edge(index, (top_m - altitude_m) / (top_m - bottom_m));
}

// Density relative to the volume's coefficients, at least 0.
fn volume_density(index: u32, place: Place) -> f32 {
    if index < FOG_COUNT {
        let profile = fog_profile(index, place.altitude_m);
        if profile <= 0.0 {
            return 0.0;
        }
        return profile * billows(index, vec3<f32>(place.map, place.altitude_m));
    }
    let q = turned(index, place.p - volumes[index].centre_m);
    let share = q / volumes[index].half_size_m;
    let reach = select(max(abs(share.x), max(abs(share.y), abs(share.z))), length(share), volumes[index].kind == ELLIPSOID);
    if reach > 1.0 {
        return 0.0;
    }
    var density = edge(index, 1.0 - reach) * billows(index, q);
#ifdef VOLUME_GRIDS
    density *= samples(index, 0.5 + 0.5 * share);
#endif
    return density;
}

// Mean density of fog over a step in whose middle a place lies, with a rise of twice half_rise_m from end to end: exact where
// the fog is even.
fn fog_density(index: u32, place: Place, half_rise_m: f32) -> f32 {
    let density = volume_density(index, place);
    if volumes[index].kind != EXPONENTIAL_FOG || volumes[index].noise_strength > 0.0 {
        return density;
    }
    let x = half_rise_m * volumes[index].per_scale_height;
    return density * select(sinh(x) / x, 1.0 + x * x / 6.0, abs(x) < 0.1);
}

// Distances along a ray between which it lies in a local volume, not below 0; the second is not above the first where it
// does not.
fn local_span_m(index: u32, p: vec3<f32>, direction: vec3<f32>) -> vec2<f32> {
    let half_size_m = volumes[index].half_size_m;
    let start = turned(index, p - volumes[index].centre_m) / half_size_m;
    let along = turned(index, direction) / half_size_m;
    if volumes[index].kind == ELLIPSOID {
        let a = dot(along, along);
        let nearest = -dot(start, along) / a;
        // The chord from the ray's nearest point: no difference of large squares.
        let off = start + along * nearest;
        let half_chord = sqrt(max(1.0 - dot(off, off), 0.0) / a);
        return max(vec2<f32>(nearest - half_chord, nearest + half_chord), vec2<f32>(0.0));
    }
    let steep = select(along, vec3<f32>(1e-20), abs(along) < vec3<f32>(1e-20));
    let low = (-1.0 - start) / steep;
    let high = (1.0 - start) / steep;
    let first = min(low, high);
    let last = max(low, high);
    let enter = max(first.x, max(first.y, first.z));
    return max(vec2<f32>(enter, min(last.x, min(last.y, last.z))), vec2<f32>(0.0));
}

fn local_length_m(index: u32, p: vec3<f32>, direction: vec3<f32>, to_m: f32, samples_count: u32) -> f32 {
    let whole = local_span_m(index, p, direction);
    let span = min(whole, vec2<f32>(to_m));
    let chord_m = span.y - span.x;
    if chord_m <= 0.0 || volumes[index].is_even == 1u {
        return max(chord_m, 0.0);
    }
    var sum = 0.0;
    for (var i = 0u; i < samples_count; i++) {
        let at_m = span.x + chord_m * (f32(i) + 0.5) / f32(samples_count);
        sum += volume_density(index, Place(p + direction * at_m, 0.0, vec2<f32>(0.0)));
    }
    return sum * chord_m / f32(samples_count);
}

// Way to the top of the air, behind which no matter is.
fn way_to_top_m(place: Place, direction: vec3<f32>) -> f32 {
    let up = normalize(vec3<f32>(place.p.xy, place.p.z + atmosphere.radius_m));
    let altitude_m = min(place.altitude_m, atmosphere.top_m);
    return distance_to_shell_from_below(atmosphere.radius_m, altitude_m, dot(up, direction), atmosphere.top_m);
}

// Way to a change of altitude along a direction with this slope above ground that curves away, m.
fn way_up_m(slope: f32, rise_m: f32) -> f32 {
    let root = sqrt(max(slope * slope + 2.0 * rise_m / atmosphere.radius_m, 0.0));
    return 2.0 * rise_m / max(root + slope, 1e-9);
}

// Density of fog along a way, m. `local` is its direction as east, north and up of its start.
fn fog_length_m(index: u32, place: Place, local: vec3<f32>, to_m: f32, samples_count: u32) -> f32 {
    let bottom_m = volumes[index].bottom_m;
    let top_m = volumes[index].top_m;
    var from_m = 0.0;
    var end_m = to_m;
    if local.z >= 0.0 {
        if place.altitude_m >= top_m {
            return 0.0;
        }
        from_m = select(0.0, way_up_m(local.z, bottom_m - place.altitude_m), place.altitude_m < bottom_m);
        end_m = min(to_m, way_up_m(local.z, top_m - place.altitude_m));
    } else {
        if place.altitude_m <= bottom_m {
            return 0.0;
        }
        from_m = max((place.altitude_m - top_m) / -local.z, 0.0);
        end_m = min(to_m, (place.altitude_m - bottom_m) / -local.z);
    }
    if end_m <= from_m {
        return 0.0;
    }
    let way_m = end_m - from_m;
    if volumes[index].kind == EXPONENTIAL_FOG && volumes[index].noise_strength == 0.0 {
        let per_m = volumes[index].per_scale_height;
        let start = exp(-(place.altitude_m + from_m * local.z - bottom_m) * per_m);
        // Along the horizon the ground curves away: Chapman's function there is √(π R H / 2).
        let curved = sqrt(0.25 * local.z * local.z + 0.63662 / (per_m * atmosphere.radius_m));
        let slope = select(local.z, 0.5 * local.z + curved, local.z >= 0.0);
        let x = slope * way_m * per_m;
        let mean = select((1.0 - exp(-x)) / x, 1.0 - 0.5 * x, abs(x) < 1e-3);
        return start * way_m * mean;
    }
    var sum = 0.0;
    for (var i = 0u; i < samples_count; i++) {
        // Steps grow with distance: what is near counts in detail.
        let share = (f32(i) + 0.5) / f32(samples_count);
        let at_m = from_m + way_m * share * share;
        let altitude_m = place.altitude_m + at_m * (local.z + 0.5 * at_m / atmosphere.radius_m);
        let map = place.map + local.xy * at_m;
        sum += 2.0 * share * volume_density(index, Place(vec3<f32>(0.0), altitude_m, map));
    }
    return sum * way_m / f32(samples_count);
}
