//! Containers of texels that engines import.

mod dds;
mod exr;
mod ktx2;

use std::fmt;
use std::str::FromStr;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Precision;
use super::texels::{from_rgba, to_rgba};
use crate::table::Table;

/// A container of texels. None of them compresses with loss, and all but EXR keep slices as slices of a volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FileFormat {
    /// OpenEXR: slices lie beside each other as tiles of one picture.
    Exr,
    /// Khronos' KTX 2.0: Vulkan's formats R16G16B16A16_SFLOAT and R32G32B32A32_SFLOAT.
    Ktx2,
    /// Microsoft's DDS with the header of Direct3D 10: the same formats.
    Dds,
    /// Nothing but the texels: red, green, blue, 1, little-endian.
    Raw,
}

/// A format of that name does not exist.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("format is '{0}'; it must be one of exr, ktx2, dds, raw")]
pub struct UnknownFormat(String);

/// Widest atlas that every engine imports, in texels.
const MAX_ATLAS_WIDTH: u32 = 4096;

/// How slices lie in one picture: row by row of tiles.
pub(super) fn atlas([width, _, depth]: [u32; 3]) -> [u32; 2] {
    let columns = (MAX_ATLAS_WIDTH / width).clamp(1, depth);
    [columns, depth.div_ceil(columns)]
}

impl FileFormat {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Exr, Self::Ktx2, Self::Dds, Self::Raw];

    /// Its name on the command line, and the ending of its files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exr => "exr",
            Self::Ktx2 => "ktx2",
            Self::Dds => "dds",
            Self::Raw => "raw",
        }
    }

    /// The file of a table.
    pub(super) fn encode(self, table: &Table, precision: Precision) -> Result<Vec<u8>, String> {
        match self {
            Self::Exr => exr::encode(table, precision),
            Self::Ktx2 => ktx2::encode(table, precision),
            Self::Dds => dds::encode(table, precision),
            Self::Raw => Ok(to_rgba(table, precision)),
        }
    }

    /// The table of a file, of which size and precision are known from elsewhere and checked where the file says them.
    pub(super) fn decode(self, bytes: &[u8], size: [u32; 3], precision: Precision) -> Result<Table, String> {
        match self {
            Self::Exr => exr::decode(bytes, size, precision),
            Self::Ktx2 => ktx2::decode(bytes, size, precision),
            Self::Dds => dds::decode(bytes, size, precision),
            Self::Raw => from_rgba(bytes, size, precision),
        }
    }
}

impl fmt::Display for FileFormat {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl FromStr for FileFormat {
    type Err = UnknownFormat;

    fn from_str(name: &str) -> Result<Self, UnknownFormat> {
        Self::ALL.into_iter().find(|format| format.name() == name).ok_or_else(|| UnknownFormat(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every texel holds its own place, so that any transposition or flip shows; whole numbers, which half floats hold.
    fn places(size: [u32; 3]) -> Table {
        let [width, height, depth] = size;
        let texels = (0..depth).flat_map(|z| (0..height).flat_map(move |y| (0..width).map(move |x| [x, y, z])));
        Table::new(size, texels.map(|place| place.map(|i| 1.0 - f64::from(i))).collect())
    }

    #[test]
    fn every_format_gives_back_the_texels_it_was_given_in_their_order() {
        for format in FileFormat::ALL {
            for precision in Precision::ALL {
                // Flat, and deep enough for several rows of tiles.
                for size in [[7, 4, 1], [1500, 3, 5]] {
                    let table = places(size);
                    let bytes = format.encode(&table, precision).unwrap();
                    let back = format.decode(&bytes, size, precision).unwrap();
                    assert!(back == table, "{format} {precision} {size:?}");
                    // The same table gives the same bytes: hashes of packs can be compared.
                    assert!(bytes == format.encode(&table, precision).unwrap(), "{format}");
                }
            }
        }
    }

    #[test]
    fn a_damaged_file_is_refused_or_read_and_nothing_else() {
        let table = places([2, 2, 2]);
        for format in FileFormat::ALL {
            let whole = format.encode(&table, Precision::F16).unwrap();
            for at in 0..whole.len() {
                // 255 of the sides of a KTX file's texel block, less one, ended a crate's reader (found by fuzzing).
                for byte in [0, 1, 127, 255] {
                    let mut damaged = whole.clone();
                    damaged[at] = byte;
                    let _ = format.decode(&damaged, [2, 2, 2], Precision::F16);
                }
            }
        }
    }

    #[test]
    fn a_file_of_another_size_or_cut_short_is_refused() {
        let size = [6, 5, 4];
        for format in FileFormat::ALL {
            let bytes = format.encode(&places(size), Precision::F16).unwrap();
            for other in [[5, 6, 4], [6, 5, 5]] {
                let refused = format.decode(&bytes, other, Precision::F16).is_err();
                // Raw texels say nothing of their sides.
                assert!(refused || format == FileFormat::Raw && other == [5, 6, 4], "{format} as {other:?}");
            }
            assert!(format.decode(&bytes, size, Precision::F32).is_err(), "{format} as f32");
            assert!(format.decode(&bytes[..bytes.len() - 9], size, Precision::F16).is_err(), "{format} cut short");
            assert!(format.decode(&[], size, Precision::F16).is_err(), "{format} empty");
        }
    }
}
