//! RGB spaces and chromatic adaptation.

use glam::{DMat3, DVec3};

/// A linear RGB space. Values may be negative (colours that its primaries cannot mix) and above 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ColourSpace {
    /// Primaries and white (D65) of IEC 61966-2-1, without its curve; also those of Rec. 709.
    #[default]
    LinearSrgb,
    /// ITU-R BT.2020, white D65.
    Rec2020,
    /// ACEScg: primaries AP1 and the white of the Academy Color Encoding System (S-2014-004), about D60.
    AcesCg,
}

impl ColourSpace {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::LinearSrgb, Self::Rec2020, Self::AcesCg];

    /// Its name on the command line, in scene files and in EXR headers.
    pub fn name(self) -> &'static str {
        match self {
            Self::LinearSrgb => "linear-srgb",
            Self::Rec2020 => "rec2020",
            Self::AcesCg => "acescg",
        }
    }

    /// Chromaticities x, y of red, green, blue and white.
    pub fn chromaticities(self) -> [[f64; 2]; 4] {
        const D65: [f64; 2] = [0.3127, 0.3290];
        match self {
            Self::LinearSrgb => [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], D65],
            Self::Rec2020 => [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046], D65],
            Self::AcesCg => [[0.713, 0.293], [0.165, 0.830], [0.128, 0.044], [0.321_68, 0.337_67]],
        }
    }

    /// X, Y and Z of white, (1, 1, 1); Y is 1.
    pub fn white_xyz(self) -> DVec3 {
        xyz_of(self.chromaticities()[3])
    }

    /// From RGB to XYZ (SMPTE RP 177): the primaries' columns, scaled so that (1, 1, 1) is the white.
    pub fn to_xyz(self) -> DMat3 {
        let [red, green, blue, white] = self.chromaticities().map(xyz_of);
        let primaries = DMat3::from_cols(red, green, blue);
        primaries * DMat3::from_diagonal(primaries.inverse() * white)
    }

    /// From XYZ to RGB.
    pub fn from_xyz(self) -> DMat3 {
        self.to_xyz().inverse()
    }

    /// From colours of this space to another's, adapted from the one's white to the other's.
    pub fn to_space(self, other: Self) -> DMat3 {
        other.from_xyz() * adaptation(self.white_xyz(), other.white_xyz()) * self.to_xyz()
    }
}

fn xyz_of([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// The linear Bradford transform (Lam 1985; ICC.1:2022, annex E): takes XYZ as seen under one white to XYZ that looks the
/// same under another. Both whites must have positive cone responses, as every light has.
pub fn adaptation(from_white: DVec3, to_white: DVec3) -> DMat3 {
    let cones =
        DMat3::from_cols_array_2d(&[[0.8951, -0.7502, 0.0389], [0.2664, 1.7135, -0.0685], [-0.1614, 0.0367, 1.0296]]);
    cones.inverse() * DMat3::from_diagonal((cones * to_white) / (cones * from_white)) * cones
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows as publications print them.
    fn assert_matrix(matrix: DMat3, rows: [[f64; 3]; 3], tolerance: f64) {
        for (i, row) in rows.iter().enumerate() {
            for (j, published) in row.iter().enumerate() {
                let computed = matrix.col(j)[i];
                assert!((computed - published).abs() <= tolerance, "row {i}, column {j}: {computed}, not {published}");
            }
        }
    }

    #[test]
    fn srgb_is_as_published() {
        // IEC 61966-2-1:2003, amendment 1, with four and seven digits.
        let to_xyz = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
        assert_matrix(ColourSpace::LinearSrgb.to_xyz(), to_xyz, 6e-5);
        let from_xyz = [
            [3.2406255, -1.5372080, -0.4986286],
            [-0.9689307, 1.8757561, 0.0415175],
            [0.0557101, -0.2040211, 1.0569959],
        ];
        // The standard inverts its own rounded matrix.
        assert_matrix(ColourSpace::LinearSrgb.from_xyz(), from_xyz, 6e-4);
    }

    #[test]
    fn rec2020_is_as_published() {
        // ITU-R BT.2020-2, table 4: luma of red, green, blue.
        let [r, g, b] = ColourSpace::Rec2020.to_xyz().transpose().col(1).to_array();
        assert!((r - 0.2627).abs() < 5e-5 && (g - 0.6780).abs() < 5e-5 && (b - 0.0593).abs() < 5e-5, "{r} {g} {b}");
        // ITU-R BT.2087-0: from BT.709 to BT.2020.
        let from_709 = [[0.6274, 0.3293, 0.0433], [0.0691, 0.9195, 0.0114], [0.0164, 0.0880, 0.8956]];
        assert_matrix(ColourSpace::LinearSrgb.to_space(ColourSpace::Rec2020), from_709, 6e-5);
    }

    #[test]
    fn acescg_is_as_published() {
        // S-2014-004: from ACEScg to XYZ, and the matrix that the ACES configurations of OpenColorIO have for sRGB
        // textures, adapted by Bradford from D65.
        let to_xyz = [
            [0.662_454_18, 0.134_004_21, 0.156_187_69],
            [0.272_228_72, 0.674_081_77, 0.053_689_52],
            [-0.005_574_65, 0.004_060_73, 1.010_339_10],
        ];
        assert_matrix(ColourSpace::AcesCg.to_xyz(), to_xyz, 1e-7);
        let from_srgb = [[0.6131, 0.3395, 0.0474], [0.0702, 0.9164, 0.0134], [0.0206, 0.1096, 0.8698]];
        assert_matrix(ColourSpace::LinearSrgb.to_space(ColourSpace::AcesCg), from_srgb, 1e-4);
    }

    #[test]
    fn white_stays_white_on_any_way_through_the_spaces() {
        for from in ColourSpace::ALL {
            for to in ColourSpace::ALL {
                let white = from.to_space(to) * DVec3::ONE;
                assert!((white - DVec3::ONE).length() < 1e-12, "{} to {}: {white}", from.name(), to.name());
            }
        }
    }

    #[test]
    fn adaptation_through_a_third_white_is_the_same() {
        let [a, b, c] = [[0.44, 0.40], [0.3127, 0.3290], [0.25, 0.26]].map(xyz_of);
        let difference = adaptation(b, c) * adaptation(a, b) - adaptation(a, c);
        assert!(difference.to_cols_array().iter().all(|value| value.abs() < 1e-12));
    }
}
