//! OpenEXR: R, G and B; slices side by side, then row by row of tiles. The first row of the picture is y = 0.

use std::io::Cursor;

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

pub(super) fn decode(bytes: &[u8], size: [u32; 3], precision: Precision) -> Result<Table, String> {
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let image = reader.from_buffered(Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let layer = image.layer_data;
    let [columns, rows] = atlas(size);
    let expected = ((size[0] * columns) as usize, (size[1] * rows) as usize);
    if (layer.size.x(), layer.size.y()) != expected {
        return Err(format!("it is of {:?} pixels; the atlas of {size:?} texels has {expected:?}", layer.size));
    }
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
    let ([r, g, b], row_length) = ([channel("R")?, channel("G")?, channel("B")?], expected.0 as u32);
    // The picture's pixel of each texel, in the table's order.
    let texel = |at: u32| {
        let (x, y, slice) = (at % size[0], at / size[0] % size[1], at / (size[0] * size[1]));
        let (tile_x, tile_y) = (slice % columns * size[0], slice / columns * size[1]);
        let pixel = ((tile_y + y) * row_length + tile_x + x) as usize;
        [r[pixel], g[pixel], b[pixel]]
    };
    let texels = (0..size.iter().product()).map(texel).collect();
    Ok(Table::new(size, texels))
}
