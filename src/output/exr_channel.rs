//! One channel of an OpenEXR file that another program wrote.

use std::path::Path;

use exr::prelude::{ReadChannels, ReadLayers, read};

use super::OutputError;

/// Names under which programs keep depth, in the order in which they are looked for.
pub const DEPTH_CHANNELS: [&str; 5] = ["distance_m", "Z", "depth", "Y", "R"];

/// An image of one number a pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row by row from the top left.
    pub values: Vec<f32>,
}

/// Reads the first channel there is of some names, upper and lower case alike.
///
/// # Errors
/// [`OutputError::Read`] where there is no image; [`OutputError::NoChannel`].
pub fn read_exr_channel(path: &Path, names: &'static [&'static str]) -> Result<Plane, OutputError> {
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let image = reader.from_file(path).map_err(|source| OutputError::Read { path: path.to_owned(), source })?;
    let (size, channels) = (image.layer_data.size, &image.layer_data.channel_data.list);
    let named = |name: &&str| channels.iter().find(|channel| channel.name.eq_case_insensitive(name));
    let channel = names.iter().find_map(named).ok_or_else(|| OutputError::NoChannel {
        path: path.to_owned(),
        names: names.join(", "),
        found: channels.iter().map(|channel| channel.name.to_string()).collect::<Vec<_>>().join(", "),
    })?;
    let values = channel.sample_data.values_as_f32().collect();
    Ok(Plane { width: size.x() as u32, height: size.y() as u32, values })
}
