//! Frames as EXR files, 32-bit float and lossless.
//!
//! Channels: `R`, `G`, `B` radiance; `Z` distance to the ground; `transmittance.R` … and, from backends that sample,
//! `standard_error.R` …. The attribute `welkin` says in JSON where the picture comes from.

use std::io::Write;
use std::path::{Path, PathBuf};

use exr::meta::attribute::AttributeValue;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatImage, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer,
    LayerAttributes, ReadChannels, ReadLayers, SmallVec, Text, WritableImage,
};

use super::Frame;

/// Name of the attribute.
const ATTRIBUTE: &str = "welkin";
/// Suffixes of the three bands.
const BANDS: [&str; 3] = ["R", "G", "B"];

/// Why there is no frame.
#[derive(Debug, thiserror::Error)]
pub enum ExrError {
    /// The file cannot be written.
    #[error("cannot write '{}'", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file cannot be read, or is no EXR file.
    #[error("cannot read '{}' as an EXR file: {problem}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
}

/// Writes a frame, whole or not at all. `origin` is JSON for the attribute `welkin`.
///
/// # Errors
/// [`ExrError::Write`].
pub fn write(path: &Path, frame: &Frame, origin: &str) -> Result<(), ExrError> {
    let failed = |source| ExrError::Write { path: path.into(), source };
    let mut bytes = std::io::Cursor::new(Vec::new());
    image(frame, origin).write().to_buffered(&mut bytes).map_err(|error| failed(std::io::Error::other(error)))?;
    let mut file = tempfile::NamedTempFile::new_in(directory_of(path)).map_err(failed)?;
    file.write_all(bytes.get_ref()).map_err(failed)?;
    file.as_file().sync_all().map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Fails early where [`write`] would fail late.
///
/// # Errors
/// [`ExrError::Write`].
pub fn check_writable(path: &Path) -> Result<(), ExrError> {
    let failed = |source| ExrError::Write { path: path.into(), source };
    if path.is_dir() {
        return Err(failed(std::io::ErrorKind::IsADirectory.into()));
    }
    tempfile::tempfile_in(directory_of(path)).map(drop).map_err(failed)
}

/// Reads a frame and the attribute `welkin` (empty where there is none). Files of other programs are frames without
/// air, as long as they have `R`, `G` and `B`.
///
/// # Errors
/// [`ExrError::Read`].
pub fn read(path: &Path) -> Result<(Frame, String), ExrError> {
    let failed = |problem: String| ExrError::Read { path: path.into(), problem };
    let bytes = std::fs::read(path).map_err(|error| failed(error.to_string()))?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(std::io::Cursor::new(bytes))
        .map_err(|error| failed(error.to_string()))?;
    let layer = &image.layer_data;
    let channel = |name: &str| -> Option<Vec<f32>> {
        let found = layer.channel_data.list.iter().find(|channel| channel.name.eq_case_insensitive(name))?;
        Some(found.sample_data.values_as_f32().collect())
    };
    let bands = |prefix: &str| -> Option<Vec<[f32; 3]>> {
        let [r, g, b] = BANDS.map(|band| channel(&format!("{prefix}{band}")));
        let (r, g, b) = (r?, g?, b?);
        Some((0..r.len()).map(|i| [r[i], g[i], b[i]]).collect())
    };
    let origin = match layer.attributes.other.get(ATTRIBUTE.as_bytes()) {
        Some(AttributeValue::Text(text)) => text.to_string(),
        _ => String::new(),
    };
    let mut frame = Frame::new(layer.size.width() as u32, layer.size.height() as u32);
    frame.radiance = bands("").ok_or_else(|| failed("it has no channels R, G and B".into()))?;
    frame.transmittance = bands("transmittance.").unwrap_or(frame.transmittance);
    frame.distance_m = channel("Z").unwrap_or(frame.distance_m);
    frame.standard_error = bands("standard_error.");
    Ok((frame, origin))
}

fn directory_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn image(frame: &Frame, origin: &str) -> FlatImage {
    let mut channels = SmallVec::new();
    let mut add = |name: String, values: Vec<f32>| {
        channels.push(AnyChannel::new(name.as_str(), FlatSamples::F32(values)));
    };
    let layers = [("", Some(&frame.radiance)), ("transmittance.", Some(&frame.transmittance))];
    for (prefix, values) in layers.into_iter().chain([("standard_error.", frame.standard_error.as_ref())]) {
        for (band, suffix) in BANDS.iter().enumerate() {
            if let Some(values) = values {
                add(format!("{prefix}{suffix}"), values.iter().map(|value| value[band]).collect());
            }
        }
    }
    add("Z".into(), frame.distance_m.clone());
    let mut attributes = LayerAttributes::named("");
    attributes.other.insert(Text::from(ATTRIBUTE), AttributeValue::Text(Text::from(origin)));
    let size = (frame.width as usize, frame.height as usize);
    let encoding = Encoding::SMALL_LOSSLESS;
    Image::from_layers(
        ImageAttributes::new(IntegerBounds::from_dimensions(size)),
        SmallVec::from_vec(vec![Layer::new(size, attributes, encoding, AnyChannels::sort(channels))]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> Frame {
        let mut frame = Frame::new(3, 2);
        for i in 0..6 {
            let value = i as f32 / 7.0;
            frame.radiance[i] = [value, 1e-9 * value, 1e9 * value];
            frame.transmittance[i] = [0.1 * value, 0.2 * value, 0.3 * value];
            frame.distance_m[i] = if i < 3 { f32::INFINITY } else { 1e6 * value };
        }
        frame
    }

    #[test]
    fn a_frame_comes_back_to_the_last_bit() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("out.exr");
        let plain = frame();
        let sampled = Frame { standard_error: Some(vec![[0.1, f32::INFINITY, 0.0]; 6]), ..frame() };
        for frame in [plain, sampled] {
            write(&path, &frame, r#"{"a":"ü"}"#).unwrap();
            assert_eq!(read(&path).unwrap(), (frame, r#"{"a":"ü"}"#.to_owned()));
            assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
        }
    }

    #[test]
    fn a_file_that_is_cut_short_or_no_picture_is_refused_by_name() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("out.exr");
        write(&path, &frame(), "").unwrap();
        let good = std::fs::read(&path).unwrap();
        for bad in [&good[..good.len() / 2], b"no picture"] {
            std::fs::write(&path, bad).unwrap();
            assert!(read(&path).unwrap_err().to_string().contains("out.exr"));
        }
    }

    #[test]
    fn a_place_where_nothing_can_be_written_is_found_before_the_work() {
        let directory = tempfile::tempdir().unwrap();
        assert!(check_writable(&directory.path().join("out.exr")).is_ok());
        assert!(check_writable(&directory.path().join("missing/out.exr")).is_err());
        assert!(check_writable(directory.path()).is_err());
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 0);
    }
}
