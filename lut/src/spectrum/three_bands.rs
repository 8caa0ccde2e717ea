//! What the three bands at 680, 550 and 440 nm stand for as colour.
//!
//! Three wavelengths cannot measure a colour, but daylight comes in few families of spectra, and a matrix can be right for
//! those. This one is exact for sunlight and the least squares fit to what air makes of it: sunlight through 1 to 16 air
//! masses of molecules, haze and ozone; skies that scatter it with the spectrum of molecules, of haze, or of air so deep
//! that every colour is scattered, lit through up to 3 air masses of molecules and of ozone (molecules also through 10 of
//! ozone, as in twilight); and coloured ground in the light of a high sun.

use std::sync::LazyLock;

use glam::{DMat3, DVec3};

use super::{cie, molecular, ozone, scaled_between_bands, solar};
use crate::{BAND_WAVELENGTHS_NM, Bands};

/// Sunlight in the bands as the presets have it: means over the 10 nm above the wavelengths, W·m⁻²·nm⁻¹.
pub const SOLAR_IRRADIANCE: Bands = [1.474, 1.8504, 1.91198];

/// Where the tables that engines share take the bands' sun and ozone from, nm: the middle of those means.
const MEANS_NM: Bands = [685.0, 555.0, 445.0];

/// From spectral radiance in the bands to X, Y and Z.
pub fn to_xyz() -> DMat3 {
    *TO_XYZ
}

static TO_XYZ: LazyLock<DMat3> = LazyLock::new(|| {
    let family = family();
    let white = DVec3::from_array(cie::tristimulus(solar::irradiance));
    let rows = [0, 1, 2].map(|component| {
        // Of the row, times sunlight, the parts add up to what sunlight has; the third is what the others leave.
        let (mut normal, mut right) = ([[0.0; 2]; 2], [0.0; 2]);
        for (bands, xyz) in &family {
            let weight = (xyz.element_sum() / white.element_sum()).powi(-2);
            let columns = [bands[0] - bands[2], bands[1] - bands[2]];
            let rest = xyz[component] - white[component] * bands[2];
            for i in 0..2 {
                right[i] += weight * columns[i] * rest;
                (0..2).for_each(|j| normal[i][j] += weight * columns[i] * columns[j]);
            }
        }
        let determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
        let red = (right[0] * normal[1][1] - right[1] * normal[0][1]) / determinant;
        let green = (normal[0][0] * right[1] - normal[1][0] * right[0]) / determinant;
        DVec3::new(red, green, white[component] - red - green) / DVec3::from_array(SOLAR_IRRADIANCE)
    });
    DMat3::from_cols(rows[0], rows[1], rows[2]).transpose()
});

/// What the optical depth of a column of each is at a wavelength.
struct Column {
    wavelength_nm: f64,
    molecules: f64,
    haze: f64,
    ozone: f64,
}

impl Column {
    /// Standard air, 300 Dobson units of ozone, clean continental haze.
    fn new(wavelength_nm: f64, ozone_nm: f64) -> Self {
        Self {
            wavelength_nm,
            molecules: molecular::standard_air_per_m(wavelength_nm, 360e-6) * 8434.6,
            haze: 0.064 * (wavelength_nm / 550.0).powf(-1.3),
            ozone: ozone::cross_section_m2(ozone_nm) * 8.06e22,
        }
    }

    /// What is left of sunlight from the zenith.
    fn sunlight(&self) -> f64 {
        (-self.molecules - self.haze - self.ozone).exp()
    }
}

/// Air's doing as a factor on sunlight: in the bands, and its X, Y and Z in sunlight.
fn family() -> Vec<(Bands, DVec3)> {
    let bands: [Column; 3] = std::array::from_fn(|band| Column::new(BAND_WAVELENGTHS_NM[band], MEANS_NM[band]));
    let member = |factor: &dyn Fn(&Column) -> f64| {
        let seen = cie::tristimulus(|nm| solar::irradiance(nm) * factor(&Column::new(nm, nm)));
        (std::array::from_fn(|band| factor(&bands[band])), DVec3::from_array(seen))
    };
    let mut family = Vec::new();
    for masses in [1.0, 2.0, 4.0, 8.0, 16.0] {
        family.push(member(&|c| (-masses * (c.molecules + c.haze + c.ozone)).exp()));
    }
    for masses in [0.0, 1.0, 3.0] {
        for ozone_masses in [1.0, 3.0, 10.0] {
            let lit = move |c: &Column| (-masses * c.molecules - ozone_masses * c.ozone).exp();
            family.push(member(&|c| c.molecules * lit(c)));
            // The light of twilight, which crosses much ozone, is scattered by the molecules of the upper air.
            if ozone_masses < 10.0 {
                family.push(member(&|c| c.haze * lit(c)));
                family.push(member(&|c| (1.0 - (-10.0 * (c.molecules + c.haze)).exp()) * lit(c)));
            }
        }
    }
    // Ground whose reflectance is linear between the bands, and twice as high in one of them.
    for band in 0..3 {
        let mut albedo = [0.5; 3];
        albedo[band] = 1.0;
        family.push(member(&|c| scaled_between_bands(|_| 1.0, [1.0; 3], albedo, c.wavelength_nm) * c.sunlight()));
    }
    family
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::ColourSpace;

    fn srgb(xyz: DVec3) -> DVec3 {
        ColourSpace::LinearSrgb.from_xyz() * xyz
    }

    #[test]
    fn sunlight_has_its_own_colour() {
        let white = DVec3::from_array(cie::tristimulus(solar::irradiance));
        let difference = to_xyz() * DVec3::from_array(SOLAR_IRRADIANCE) - white;
        assert!(difference.length() < 1e-12 * white.length(), "{difference}");
    }

    #[test]
    fn skies_have_nearly_their_own_colour() {
        // Root mean square over the family, of the difference in linear sRGB over the colour itself.
        let error = |matrix: DMat3| {
            let family = family();
            let square = |(bands, xyz): &(Bands, DVec3)| {
                let seen = DVec3::from_array(std::array::from_fn(|band| bands[band] * SOLAR_IRRADIANCE[band]));
                (srgb(matrix * seen) - srgb(*xyz)).length_squared() / srgb(*xyz).length_squared()
            };
            (family.iter().map(square).sum::<f64>() / family.len() as f64).sqrt()
        };
        assert!(error(to_xyz()) < 0.07, "{}", error(to_xyz()));
        // The bands as if they were red, green and blue, balanced to sunlight: six times as far off.
        let white = ColourSpace::LinearSrgb.from_xyz() * DVec3::from_array(cie::tristimulus(solar::irradiance));
        let balance = white / DVec3::from_array(SOLAR_IRRADIANCE);
        let naive = ColourSpace::LinearSrgb.to_xyz() * DMat3::from_diagonal(balance);
        assert!(error(naive) > 3.0 * error(to_xyz()), "{}", error(naive));
    }
}
