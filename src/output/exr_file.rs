//! OpenEXR: linear radiance with its units and its camera.

use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels,
    ReadLayers, Text, WritableImage, read,
};

use super::{AtomicFile, OutputError};
use crate::frame::Frame;
use crate::scene::Scene;

/// The channels of a frame's spectral quantities, in order of storage.
const RADIANCE: [&str; 3] = ["R", "G", "B"];
const TRANSMITTANCE: [&str; 3] = ["transmittance.R", "transmittance.G", "transmittance.B"];
const STANDARD_ERROR: [&str; 3] = ["standard_error.R", "standard_error.G", "standard_error.B"];
const DISTANCE: &str = "distance_m";

/// Writes a frame as 32-bit floats: radiance in R, G and B; transmittance.R, .G and .B; distance_m; and, where the frame
/// has it, standard_error.R, .G and .B. The header says units, bands, scene, camera and program.
///
/// # Errors
/// [`OutputError::Encode`] or [`OutputError::Write`]; then nothing is left behind.
pub fn write_exr(mut file: AtomicFile, frame: &Frame, scene: &Scene) -> Result<(), OutputError> {
    let mut channels = bands(RADIANCE, &frame.radiance);
    channels.extend(bands(TRANSMITTANCE, &frame.transmittance));
    channels.push(AnyChannel::new(DISTANCE, FlatSamples::F32(frame.distance_m.clone())));
    channels.extend(frame.standard_error.iter().flat_map(|error| bands(STANDARD_ERROR, error)));
    let mut attributes = LayerAttributes::named("welkin");
    attributes.software_name = Some(Text::from(concat!("welkin ", env!("CARGO_PKG_VERSION"))));
    let size = (frame.width as usize, frame.height as usize);
    let channels = AnyChannels::sort(channels.into_iter().collect());
    let mut image = Image::from_layer(Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels));
    image.attributes.other = header(scene).into_iter().map(|(name, value)| (Text::from(name), value)).collect();
    let written = image.write().to_unbuffered(file.file());
    written.map_err(|source| OutputError::Encode { path: file.path().to_owned(), source: source.into() })?;
    file.commit()
}

fn bands(names: [&str; 3], pixels: &[[f32; 3]]) -> Vec<AnyChannel<FlatSamples>> {
    let samples = |band: usize| FlatSamples::F32(pixels.iter().map(|pixel| pixel[band]).collect());
    names.iter().enumerate().map(|(band, &name)| AnyChannel::new(name, samples(band))).collect()
}

fn header(scene: &Scene) -> Vec<(&'static str, AttributeValue)> {
    let text = |text: &str| AttributeValue::Text(Text::from(text));
    let camera = &scene.camera;
    vec![
        ("scene", text(&scene.name)),
        ("bands", text("R, G, B: the scene's three bands; in presets 680, 550 and 440 nm")),
        ("radiance_unit", text("W m^-2 sr^-1 nm^-1")),
        ("standard_error_unit", text("W m^-2 sr^-1 nm^-1")),
        ("camera_altitude_m", AttributeValue::F64(camera.altitude_m)),
        ("camera_elevation_deg", AttributeValue::F64(camera.direction.elevation_rad.to_degrees())),
        ("camera_azimuth_deg", AttributeValue::F64(camera.direction.azimuth_rad.to_degrees())),
        ("camera_vertical_field_of_view_deg", AttributeValue::F64(camera.vertical_field_of_view_rad.to_degrees())),
    ]
}

/// Reads a frame, also one that another program wrote: R, G and B are needed, everything else counts as in
/// [`Frame::new`] where it is missing.
///
/// # Errors
/// [`OutputError::Read`] where there is no image; [`OutputError::MissingChannel`].
pub fn read_exr(path: &Path) -> Result<Frame, OutputError> {
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let image = reader.from_file(path).map_err(|source| OutputError::Read { path: path.to_owned(), source })?;
    let layer = image.layer_data;
    let channel = |name: &str| -> Option<Vec<f32>> {
        let channel = layer.channel_data.list.iter().find(|channel| channel.name.eq_case_insensitive(name))?;
        Some(channel.sample_data.values_as_f32().collect())
    };
    let missing = |name: &str| OutputError::MissingChannel { path: path.to_owned(), channel: name.to_owned() };
    let spectral = |names: [&str; 3]| -> Result<Vec<[f32; 3]>, OutputError> {
        let bands = names.map(|name| channel(name).ok_or_else(|| missing(name)));
        let [r, g, b] = bands;
        let (r, g, b) = (r?, g?, b?);
        Ok(r.into_iter().zip(g).zip(b).map(|((r, g), b)| [r, g, b]).collect())
    };
    let mut frame = Frame::new(layer.size.x() as u32, layer.size.y() as u32);
    frame.radiance = spectral(RADIANCE)?;
    frame.transmittance = spectral(TRANSMITTANCE).unwrap_or(frame.transmittance);
    frame.distance_m = channel(DISTANCE).unwrap_or(frame.distance_m);
    frame.standard_error = spectral(STANDARD_ERROR).ok();
    Ok(frame)
}
