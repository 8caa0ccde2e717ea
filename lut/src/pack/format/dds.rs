//! DDS with the header of Direct3D 10: a texture, or a volume where there are slices.

use ddsfile::{AlphaMode, Caps2, D3D10ResourceDimension, Dds, DxgiFormat, NewDxgiParams};

use super::super::Precision;
use super::super::texels::{from_rgba, to_rgba};
use crate::table::Table;

fn format(precision: Precision) -> DxgiFormat {
    match precision {
        Precision::F16 => DxgiFormat::R16G16B16A16_Float,
        Precision::F32 => DxgiFormat::R32G32B32A32_Float,
    }
}

pub(super) fn encode(table: &Table, precision: Precision) -> Result<Vec<u8>, String> {
    let [width, height, depth] = table.size();
    let volume = depth > 1;
    let mut dds = Dds::new_dxgi(NewDxgiParams {
        height,
        width,
        depth: volume.then_some(depth),
        format: format(precision),
        mipmap_levels: None,
        array_layers: None,
        caps2: volume.then_some(Caps2::VOLUME),
        is_cubemap: false,
        resource_dimension: match volume {
            true => D3D10ResourceDimension::Texture3D,
            false => D3D10ResourceDimension::Texture2D,
        },
        alpha_mode: AlphaMode::Opaque,
    })
    .map_err(|error| error.to_string())?;
    dds.data = to_rgba(table, precision);
    let mut bytes = Vec::new();
    dds.write(&mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes)
}

pub(super) fn decode(bytes: &[u8], size: [u32; 3], precision: Precision) -> Result<Table, String> {
    let dds = Dds::read(bytes).map_err(|error| error.to_string())?;
    if dds.get_dxgi_format() != Some(format(precision)) {
        return Err(format!("its format is {:?}; {precision} is {:?}", dds.get_dxgi_format(), format(precision)));
    }
    let found = [dds.get_width(), dds.get_height(), dds.get_depth().max(1)];
    if found != size {
        return Err(format!("it is of {found:?} texels; the table has {size:?}"));
    }
    from_rgba(&dds.data, size, precision)
}
