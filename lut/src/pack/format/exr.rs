//! OpenEXR: R, G and B; slices side by side, then row by row of tiles. The first row of the picture is y = 0.

use std::io::Cursor;

use ::exr::compression::Compression;
use ::exr::meta::MetaData;
use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels, ReadLayers,
    WritableImage, read,
};
use half::f16;

use super::super::Precision;
use super::atlas;
use crate::table::Table;

/// The place of a pixel in the table, or none in a tile that no slice fills.
fn place(at: usize, [width, height, depth]: [u32; 3]) -> Option<[u32; 3]> {
    let columns = atlas([width, height, depth])[0];
    let row_length = width * columns;
    let (x, y) = (at as u32 % row_length, at as u32 / row_length);
    let slice = y / height * columns + x / width;
    (slice < depth).then_some([x % width, y % height, slice])
}

pub(super) fn encode(table: &Table, precision: Precision) -> Result<Vec<u8>, String> {
    let size = table.size();
    let [columns, rows] = atlas(size);
    let (width, height) = ((size[0] * columns) as usize, (size[1] * rows) as usize);
    let channel = |band: usize, name: &str| {
        let value = |at| place(at, size).map_or(0.0, |[x, y, z]| table.texel(x, y, z)[band]);
        let samples = match precision {
            Precision::F16 => FlatSamples::F16((0..width * height).map(|at| f16::from_f64(value(at))).collect()),
            Precision::F32 => FlatSamples::F32((0..width * height).map(|at| value(at) as f32).collect()),
        };
        AnyChannel::new(name, samples)
    };
    let channels = AnyChannels::sort([channel(0, "R"), channel(1, "G"), channel(2, "B")].into_iter().collect());
    let attributes = LayerAttributes::named("welkin");
    let image = Image::from_layer(Layer::new((width, height), attributes, Encoding::SMALL_LOSSLESS, channels));
    let mut bytes = Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

/// The most that deflate makes of a byte.
const MOST_INFLATED: u64 = 1032;

/// Refuses a picture of another size before there is memory for it, and compression that packs do not have: of some the crate's decoders
/// end the program on damaged data.
fn check_header(bytes: &[u8], expected: (usize, usize)) -> Result<(), String> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|error| error.to_string())?;
    let expected_compression = [Compression::Uncompressed, Compression::ZIP1, Compression::ZIP16];
    if let Some(other) = meta.headers.iter().find(|header| !expected_compression.contains(&header.compression)) {
        return Err(format!(
            "it is compressed with {}; a pack's pictures are with ZIP or not at all",
            other.compression
        ));
    }
    let other = meta.headers.iter().map(|header| header.layer_size).find(|size| (size.x(), size.y()) != expected);
    if let Some(size) = other {
        return Err(format!("it is of {size:?} pixels; the atlas of the table has {expected:?}"));
    }
    match (expected.0 as u64).checked_mul(expected.1 as u64) {
        Some(pixels) if pixels / MOST_INFLATED <= bytes.len() as u64 => Ok(()),
        _ => Err(format!("its {} bytes cannot hold {expected:?} pixels", bytes.len())),
    }
}

pub(super) fn decode(bytes: &[u8], size: [u32; 3], precision: Precision) -> Result<Table, String> {
    let [columns, rows] = atlas(size);
    let expected = (size[0] as usize * columns as usize, size[1] as usize * rows as usize);
    check_header(bytes, expected)?;
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    // A thread of the crate's that ends by a panic ends the program.
    let reader = reader.non_parallel();
    let image = reader.from_buffered(Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let layer = image.layer_data;
    let channel = |name: &str| {
        let found = layer.channel_data.list.iter().find(|channel| channel.name.eq_case_insensitive(name));
        let found = found.ok_or_else(|| format!("it has no channel {name}"))?;
        match (&found.sample_data, precision) {
            (FlatSamples::F16(_), Precision::F16) | (FlatSamples::F32(_), Precision::F32) => {
                Ok(found.sample_data.values_as_f32().map(f64::from).collect::<Vec<_>>())
            }
            _ => Err(format!("channel {name} is not of {precision}")),
        }
    };
    let [r, g, b] = [channel("R")?, channel("G")?, channel("B")?];
    // The picture's pixel of each texel, in the table's order.
    let ([width, height, depth], columns) = (size.map(|side| side as usize), columns as usize);
    let texel = |at: usize| {
        let (x, y, slice) = (at % width, at / width % height, at / (width * height));
        let (tile_x, tile_y) = (slice % columns * width, slice / columns * height);
        let pixel = (tile_y + y) * expected.0 + tile_x + x;
        [r[pixel], g[pixel], b[pixel]]
    };
    let texels = (0..width * height * depth).map(texel).collect();
    Ok(Table::new(size, texels))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compression_that_no_pack_has_is_refused() {
        // Its decoder in the crate subtracted more than there was (found by fuzzing).
        const B44: u8 = 6;
        let mut bytes = encode(&Table::new([2, 2, 2], vec![[0.5; 3]; 8]), Precision::F16).unwrap();
        let name = b"compression\0compression\0\x01\0\0\0";
        let at = bytes.windows(name.len()).position(|window| window == name).unwrap() + name.len();
        assert_eq!(bytes[at], 3, "written with ZIP16");
        bytes[at] = B44;
        let refusal = decode(&bytes, [2, 2, 2], Precision::F16).unwrap_err();
        assert!(refusal.contains("a pack's pictures are with ZIP"), "{refusal}");
    }
}
