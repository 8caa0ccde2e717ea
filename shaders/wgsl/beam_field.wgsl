#define_import_path welkin::beam_field
// What the forward peak of matter makes of a beam, as welkin_lut::forward_peak sums it: tables over the optical depth along the beam and
// the angle to it.
//
// Legend: welkin::angular_field. What tables hold is over the beam's irradiance, over 1 - e^(-depth), and over what is left of the beam
// behind the depth of the similar medium.

#import welkin::angular_field::{angular_fields, last_columns, scattered_before, NO_FIELD}
#import welkin::attenuation::opacity

const NO_CEILING: f32 = 3.4e38;

// What of the phase function rises above it is its forward peak.
fn ceiling_per_sr(field: u32) -> f32 {
    if field == NO_FIELD {
        return NO_CEILING;
    }
    return angular_fields[last_columns(field, 0u)].r;
}

// K over e^(-q depth): what the peak scatters a second time or more, per b and irradiance, 1/sr.
fn peak_again_per_sr(field: u32, depth: vec3<f32>, nu: f32) -> vec3<f32> {
    if field == NO_FIELD {
        return vec3<f32>(0.0);
    }
    return scattered_before(field, depth, nu) * opacity(depth);
}
