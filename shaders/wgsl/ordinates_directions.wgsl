#define_import_path welkin::ordinates_directions
// The directions in which light travels in the clouds' solution: eight octants, and in each one or two directions.
//
// Gauss-Legendre in the cosine of the zenith angle and azimuths of 45° + 90° n: moments up to the third (S8) or, along
// the vertical, the seventh (S16) are exact. No direction is horizontal; such sets run bright in layers.
//
// Definitions: ORDINATES_SIXTEEN, sixteen directions and not eight.

#ifdef ORDINATES_SIXTEEN
const RING_COUNT: u32 = 2u;
#else
const RING_COUNT: u32 = 1u;
#endif
const DIRECTION_COUNT: u32 = 8u * RING_COUNT;
// Of each cell are kept its directions and, in three more slots, how light rises from its centre to its higher face along
// each axis.
const SLOT_COUNT: u32 = DIRECTION_COUNT + 3u;

// The components of a ring's directions without their signs.
fn ring_components(ring: u32) -> vec3<f32> {
#ifdef ORDINATES_SIXTEEN
    return select(vec3<f32>(0.359474793, 0.359474793, 0.861136312), vec3<f32>(0.664986049, 0.664986049, 0.339981044), ring == 1u);
#else
    return vec3<f32>(0.577350269);
#endif
}

// The share of the sphere that one of a ring's directions stands for.
fn ring_weight(ring: u32) -> f32 {
#ifdef ORDINATES_SIXTEEN
    return select(0.0434818556, 0.0815181444, ring == 1u);
#else
    return 0.125;
#endif
}

// The signs of an octant's directions.
fn octant_signs(octant: u32) -> vec3<f32> {
    return vec3<f32>(vec3<u32>(octant, octant >> 1u, octant >> 2u) & vec3<u32>(1u)) * 2.0 - 1.0;
}
