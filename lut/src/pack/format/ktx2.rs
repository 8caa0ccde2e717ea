//! KTX 2.0, one level, without supercompression. Linear values without primaries: the data format descriptor says so.

use ::ktx2::dfd::{Basic, Block};
use ::ktx2::{Format, Header, Index, LevelIndex, TransferFunction};

use super::super::Precision;
use super::super::texels::{from_rgba, to_rgba};
use crate::table::Table;

fn format(precision: Precision) -> Format {
    match precision {
        Precision::F16 => Format::R16G16B16A16_SFLOAT,
        Precision::F32 => Format::R32G32B32A32_SFLOAT,
    }
}

/// One entry of key/value data, padded to four bytes.
fn key_value(key: &str, value: &str) -> Vec<u8> {
    let entry = format!("{key}\0{value}\0");
    let mut bytes = (entry.len() as u32).to_le_bytes().to_vec();
    bytes.extend(entry.as_bytes());
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes
}

pub(super) fn encode(table: &Table, precision: Precision) -> Result<Vec<u8>, String> {
    let [width, height, depth] = table.size();
    let (mut basic, type_size) = Basic::from_format(format(precision)).map_err(|error| format!("{error:?}"))?;
    basic.transfer_function = Some(TransferFunction::Linear);
    let block = Block::Basic(basic).to_vec();
    let dfd = [&(4 + block.len() as u32).to_le_bytes()[..], &block].concat();
    // Entries are sorted by key. Right, down, and into the volume: the first texel in memory is (0, 0, 0).
    let orientation = if depth > 1 { "rdi" } else { "rd" };
    let writer = concat!("welkin-lut ", env!("CARGO_PKG_VERSION"));
    let kvd = [key_value("KTXorientation", orientation), key_value("KTXwriter", writer)].concat();
    let texels = to_rgba(table, precision);
    let dfd_at = Header::LENGTH + LevelIndex::LENGTH;
    let kvd_at = dfd_at + dfd.len();
    let data_at = (kvd_at + kvd.len()).next_multiple_of(4 * precision.bytes());
    let header = Header {
        format: Some(format(precision)),
        type_size,
        pixel_width: width,
        pixel_height: height,
        pixel_depth: if depth > 1 { depth } else { 0 },
        layer_count: 0,
        face_count: 1,
        level_count: 1,
        supercompression_scheme: None,
        index: Index {
            dfd_byte_offset: dfd_at as u32,
            dfd_byte_length: dfd.len() as u32,
            kvd_byte_offset: kvd_at as u32,
            kvd_byte_length: kvd.len() as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let length = texels.len() as u64;
    let level = LevelIndex { byte_offset: data_at as u64, byte_length: length, uncompressed_byte_length: length };
    let mut bytes = [&header.as_bytes()[..], &level.as_bytes(), &dfd, &kvd].concat();
    bytes.resize(data_at, 0);
    bytes.extend(texels);
    Ok(bytes)
}

/// The header and the bytes of the first level. The crate's reader looks at the data format descriptor too, which says nothing that
/// the format does not, and panics where that is damaged.
fn parts(bytes: &[u8]) -> Result<(Header, &[u8]), String> {
    const CUT_SHORT: &str = "it ends too early";
    let (header, rest) = bytes.split_first_chunk::<{ Header::LENGTH }>().ok_or(CUT_SHORT)?;
    let header = Header::from_bytes(header).map_err(|error| error.to_string())?;
    let level = LevelIndex::from_bytes(rest.first_chunk::<{ LevelIndex::LENGTH }>().ok_or(CUT_SHORT)?);
    let end = level.byte_offset.checked_add(level.byte_length).and_then(|end| usize::try_from(end).ok());
    let start = usize::try_from(level.byte_offset).ok();
    let texels = start.zip(end).and_then(|(start, end)| bytes.get(start..end)).ok_or(CUT_SHORT)?;
    Ok((header, texels))
}

pub(super) fn decode(bytes: &[u8], size: [u32; 3], precision: Precision) -> Result<Table, String> {
    let (header, texels) = parts(bytes)?;
    if header.format != Some(format(precision)) || header.supercompression_scheme.is_some() {
        return Err(format!("its format is {:?}; {precision} is {:?}", header.format, format(precision)));
    }
    let found = [header.pixel_width, header.pixel_height, header.pixel_depth.max(1)];
    if found != size {
        return Err(format!("it is of {found:?} texels; the table has {size:?}"));
    }
    from_rgba(texels, size, precision)
}
