//! OpenEXR: linear radiance with its units and its camera.

use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels,
    ReadLayers, Text, Vec2, WritableImage, read,
};

use welkin_lut::spectrum::{Channels, ColourSpace};

use super::{AtomicFile, OutputError};
use crate::frame::Frame;
use crate::scene::{CANDELA_PER_M2, Scene, White};

/// The channels of a frame's spectral quantities, in order of storage.
const RADIANCE: [&str; 3] = ["R", "G", "B"];
const TRANSMITTANCE: [&str; 3] = ["transmittance.R", "transmittance.G", "transmittance.B"];
const STANDARD_ERROR: [&str; 3] = ["standard_error.R", "standard_error.G", "standard_error.B"];
const DISTANCE: &str = "distance_m";

/// What an EXR file says about its frame besides the pixels: attributes by name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ExrHeader {
    attributes: HashMap<Text, AttributeValue>,
    chromaticities: Option<Chromaticities>,
}

impl ExrHeader {
    /// Units, bands, scene and camera.
    pub fn of_scene(scene: &Scene) -> Self {
        Self {
            attributes: attributes(scene).into_iter().map(|(name, value)| (Text::from(name), value)).collect(),
            chromaticities: match scene.spectrum.channels {
                Channels::Bands => None,
                Channels::Colour(space) => Some(chromaticities(space)),
            },
        }
    }

    /// The header with another text.
    pub fn with_text(mut self, name: &str, text: &str) -> Self {
        self.attributes.insert(Text::from(name), AttributeValue::Text(Text::from(text)));
        self
    }

    /// A text, where there is one with that name.
    pub fn text(&self, name: &str) -> Option<String> {
        match self.attributes.get(&Text::from(name)) {
            Some(AttributeValue::Text(text)) => Some(text.to_string()),
            _ => None,
        }
    }
}

/// Writes a frame as 32-bit floats: radiance in R, G and B; transmittance.R, .G and .B; distance_m; and, where the frame
/// has it, standard_error.R, .G and .B. The header says units, colour space, scene, camera and program. The same frame of the
/// same scene gives the same bytes.
///
/// # Errors
/// [`OutputError::Encode`] or [`OutputError::Write`]; then nothing is left behind.
pub fn write_exr(file: AtomicFile, frame: &Frame, scene: &Scene) -> Result<(), OutputError> {
    write_exr_with_header(file, frame, &ExrHeader::of_scene(scene))
}

/// The same with any header.
///
/// # Errors
/// As [`write_exr`].
pub fn write_exr_with_header(file: AtomicFile, frame: &Frame, header: &ExrHeader) -> Result<(), OutputError> {
    let mut channels = bands(RADIANCE, &frame.radiance);
    channels.extend(bands(TRANSMITTANCE, &frame.transmittance));
    channels.push(AnyChannel::new(DISTANCE, FlatSamples::F32(frame.distance_m.clone())));
    channels.extend(frame.standard_error.iter().flat_map(|error| bands(STANDARD_ERROR, error)));
    let mut attributes = LayerAttributes::named("welkin");
    attributes.software_name = Some(Text::from(concat!("welkin ", env!("CARGO_PKG_VERSION"))));
    let size = (frame.width as usize, frame.height as usize);
    let channels = AnyChannels::sort(channels.into_iter().collect());
    let mut image = Image::from_layer(Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels));
    image.attributes.other = header.attributes.clone();
    image.attributes.chromaticities = header.chromaticities;
    let mut bytes = Cursor::new(Vec::new());
    let written = image.write().to_buffered(&mut bytes);
    written.map_err(|source| OutputError::Encode { path: file.path().to_owned(), source: source.into() })?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes);
    file.write_all(&bytes)
}

/// Sorts the attributes of an encoded file by name: the encoder writes them in an order that changes from run to run.
/// They stay where they are as a whole, so no offset in the file changes.
fn sort_attributes(bytes: &mut [u8]) {
    // Magic number and version, then name, type and length of each attribute; an empty name ends them.
    const START: usize = 8;
    let end_of_text = |from: usize| from + bytes[from..].iter().position(|&byte| byte == 0).unwrap_or(0) + 1;
    let mut attributes = Vec::new();
    let mut at = START;
    while bytes[at] != 0 {
        let length_at = end_of_text(end_of_text(at));
        let length = bytemuck::pod_read_unaligned::<i32>(&bytes[length_at..length_at + 4]).to_le();
        let end = length_at + 4 + length as usize;
        attributes.push(bytes[at..end].to_vec());
        at = end;
    }
    attributes.sort();
    bytes[START..at].copy_from_slice(&attributes.concat());
}

fn bands(names: [&str; 3], pixels: &[[f32; 3]]) -> Vec<AnyChannel<FlatSamples>> {
    let samples = |band: usize| FlatSamples::F32(pixels.iter().map(|pixel| pixel[band]).collect());
    names.iter().enumerate().map(|(band, &name)| AnyChannel::new(name, samples(band))).collect()
}

/// Which of [`Channels`] a file holds.
const COLOUR_SPACE: &str = "colour_space";

/// What R, G and B are, in words.
fn meaning(scene: &Scene) -> String {
    let spectrum = &scene.spectrum;
    let Channels::Colour(space) = spectrum.channels else {
        return "R, G, B: the scene's three bands; in presets 680, 550 and 440 nm".to_owned();
    };
    let white = match spectrum.white {
        White::Sun => "the first directional light above the air",
        White::D65 => "D65",
    };
    format!(
        "R, G, B: linear {space} of {count} wavelengths, CIE 1931 2 degrees, with {white} as white; a spectral radiance \
         that is the same at all wavelengths is its own luminance, and 1 is {CANDELA_PER_M2:.0} cd/m^2; transmittance is \
         what is left of white light",
        space = space.name(),
        count = spectrum.wavelengths,
    )
}

fn chromaticities(space: ColourSpace) -> Chromaticities {
    let [red, green, blue, white] = space.chromaticities().map(|[x, y]| Vec2(x as f32, y as f32));
    Chromaticities { red, green, blue, white }
}

fn attributes(scene: &Scene) -> Vec<(&'static str, AttributeValue)> {
    let text = |text: &str| AttributeValue::Text(Text::from(text));
    let camera = &scene.camera;
    vec![
        ("scene", text(&scene.name)),
        (COLOUR_SPACE, text(scene.spectrum.channels.name())),
        ("bands", text(&meaning(scene))),
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
    read_exr_with_header(path).map(|(frame, _)| frame)
}

/// The same with the file's header.
///
/// # Errors
/// As [`read_exr`].
pub fn read_exr_with_header(path: &Path) -> Result<(Frame, ExrHeader), OutputError> {
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
    let header = ExrHeader { attributes: layer.attributes.other, chromaticities: image.attributes.chromaticities };
    frame.channels = header.text(COLOUR_SPACE).and_then(|name| name.parse().ok());
    Ok((frame, header))
}
