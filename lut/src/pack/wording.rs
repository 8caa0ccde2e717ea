//! What a manifest says in words: conventions, and what each table holds.

use super::manifest::Conventions;

impl Conventions {
    pub(super) fn new() -> Self {
        let text = str::to_owned;
        Self {
            length: text("metres; altitudes above the ground, in no texel and no function kilometres"),
            angle: text("radians; directions enter only as cosines"),
            up: text(
                "no axis: up is the direction from the planet's centre to the observer; mu = dot(view, up), \
                 mu_s = dot(sun, up), nu = dot(view, sun), in any frame, left- or right-handed, Y-up or Z-up",
            ),
            light: text("radiance in 1/sr and irradiance for unit irradiance of the sun above the air"),
            colour: text(
                "linear values at three wavelengths; never sRGB-encoded: import without gamma, without compression",
            ),
            texel_order: text(
                "x fastest, then y, then z; the first row in memory is y = 0 and the first row of a picture, at its top; \
                 do not flip",
            ),
            texel_centres: text(
                "axis coordinate 0 is the centre of the first texel and 1 of the last: of n texels, texture coordinate \
                 (x (n - 1) + 1/2) / n",
            ),
            sampler: text("linear, clamped to the edge on all axes, no mip levels"),
        }
    }
}

/// What a table holds, how its values become the quantity, the unit, and parameter and place of each axis.
pub(super) type Meaning = (&'static str, &'static str, &'static str, &'static [(&'static str, &'static str)]);

const ALTITUDE: (&str, &str) = ("altitude h", "sqrt(h / top_m)");
const SUN: (&str, &str) = (
    "cosine mu_s of the sun's zenith angle",
    "(asinh(k s) - low) / range with s = 1 - sqrt(1 - mu_s), (k, low, range) = sky_parameters.sun_warp",
);

/// The words for a table of this name.
pub(super) fn meaning(name: &str) -> Meaning {
    match name {
        "transmittance" => (
            "optical depth from altitude h along mu to the top of the air; only directions above the horizon",
            "transmittance = exp(-value)",
            "1",
            &[("cosine mu of the zenith angle; mu_h that of the horizon", "sqrt((mu - mu_h) / (1 - mu_h))"), ALTITUDE],
        ),
        "irradiance" => (
            "irradiance of the sky, without the sun itself, on a horizontal plane that faces up",
            "irradiance = exp(value)",
            "1 (per unit irradiance of the sun)",
            &[SUN, ALTITUDE],
        ),
        "multiple_scattering" => (
            "the radiance of all orders, seen looking along a direction, as real orthonormal spherical harmonics in \
             the frame of the vertical with azimuth 0 towards the sun; one slice for each value",
            "slice 0: I_00 = exp(value); slice l (l + 1) / 2 + m: I_lm = value * I_00; last slice: irradiance = exp(value)",
            "sr^(1/2)/sr (per unit irradiance of the sun)",
            &[SUN, ALTITUDE, ("which value", "slices are not to be filtered: read slice k at (k + 1/2) / depth")],
        ),
        _ => (
            "scattered light over the length of air along the ray; layer 0: radiance of light scattered more than once, \
             layer 1 + c: that of light scattered once by scatterer c, without its phase function",
            "radiance = length_of_air * (exp(layer 0) + sum over c of phase_c(nu) exp(layer 1 + c))",
            "1/(m sr) in layer 0, 1/m in the others (per unit irradiance of the sun)",
            &[
                (
                    "tiles by azimuth phi between view and sun, 0 to pi; in each tile the sun's height",
                    "tile: phi / pi, two tiles interpolated by hand; within: as mu_s of the table irradiance",
                ),
                (
                    "zenith angle of the view, from the horizon to the zenith or to the nadir",
                    "sqrt(angle from the horizon / its range)",
                ),
                (
                    "blocks: sky half of the view sphere, then ground half; in each the layers; in each the altitudes",
                    "block (half * layers + layer) * altitude_count; within: sqrt(h / top_m)",
                ),
            ],
        ),
    }
}
