//! Texels as files hold them.

use std::fmt;
use std::str::FromStr;

use half::f16;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Bands;
use crate::table::Table;

/// How a table's numbers are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// 16-bit floats.
    F16,
    /// 32-bit floats.
    F32,
}

/// A precision of that name does not exist.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("precision is '{0}'; it must be one of f16, f32")]
pub struct UnknownPrecision(String);

impl Precision {
    /// Both.
    pub const ALL: [Self; 2] = [Self::F16, Self::F32];

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::F16 => "f16",
            Self::F32 => "f32",
        }
    }

    /// Bytes of a number.
    pub fn bytes(self) -> usize {
        match self {
            Self::F16 => 2,
            Self::F32 => 4,
        }
    }

    /// The number that is kept, in f64.
    pub fn rounded(self, value: f64) -> f64 {
        match self {
            Self::F16 => f16::from_f64(value).to_f64(),
            Self::F32 => f64::from(value as f32),
        }
    }

    /// A table as it is kept.
    pub fn of_table(self, table: &Table) -> Table {
        let rounded = |texel: &Bands| texel.map(|value| self.rounded(value));
        Table::new(table.size(), table.texels().iter().map(rounded).collect())
    }
}

impl fmt::Display for Precision {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl FromStr for Precision {
    type Err = UnknownPrecision;

    fn from_str(name: &str) -> Result<Self, UnknownPrecision> {
        Self::ALL
            .into_iter()
            .find(|precision| precision.name() == name)
            .ok_or_else(|| UnknownPrecision(name.to_owned()))
    }
}

/// All texels as red, green, blue and 1, little-endian, in the table's order.
pub(super) fn to_rgba(table: &Table, precision: Precision) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(table.texels().len() * 4 * precision.bytes());
    for &[r, g, b] in table.texels() {
        for value in [r, g, b, 1.0] {
            match precision {
                Precision::F16 => bytes.extend(f16::from_f64(value).to_le_bytes()),
                Precision::F32 => bytes.extend((value as f32).to_le_bytes()),
            }
        }
    }
    bytes
}

/// The table of such bytes.
pub(super) fn from_rgba(bytes: &[u8], size: [u32; 3], precision: Precision) -> Result<Table, String> {
    let texels: u64 = size.iter().map(|&side| u64::from(side)).product();
    let expected = texels * 4 * precision.bytes() as u64;
    if bytes.len() as u64 != expected || texels == 0 {
        return Err(format!(
            "it holds {} bytes of texels; {size:?} texels in {precision} have {expected}",
            bytes.len()
        ));
    }
    let number = |bytes: &[u8]| match precision {
        Precision::F16 => f16::from_le_bytes([bytes[0], bytes[1]]).to_f64(),
        Precision::F32 => f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])),
    };
    let width = precision.bytes();
    let texel = |bytes: &[u8]| std::array::from_fn(|band| number(&bytes[band * width..]));
    Ok(Table::new(size, bytes.chunks_exact(4 * width).map(texel).collect()))
}
