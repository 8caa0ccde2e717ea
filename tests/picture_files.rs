//! EXR and PNG files: what is written is what is read.

use std::path::Path;

use exr::prelude::{AttributeValue, MetaData, Text};
use welkin::frame::Frame;
use welkin::output::{AtomicFile, OutputError, read_exr, write_exr, write_png};
use welkin::scene::Scene;

fn scene() -> Scene {
    let text = "name = \"test sky\"\npreset = \"earth\"\n[sun]\nelevation_deg = 30\nazimuth_deg = 0\n\
                [camera]\naltitude_m = 500\nelevation_deg = 12\nazimuth_deg = 34\nvertical_field_of_view_deg = 56\n";
    Scene::parse(text, Path::new("scene.toml")).unwrap()
}

fn frame() -> Frame {
    let mut frame = Frame::new(5, 3);
    for (index, pixel) in frame.radiance.iter_mut().enumerate() {
        // Numbers that half floats would round, overflow or lose.
        *pixel = [1.000_000_1, 1e9, 1e-30].map(|value: f32| value * (1.0 + index as f32));
    }
    frame.transmittance[7] = [0.25, 5e-5, 0.75];
    frame.distance_m[3] = 12_345.678;
    frame.standard_error = Some(frame.radiance.iter().map(|pixel| pixel.map(|value| value * 0.01)).collect());
    frame
}

#[test]
fn an_exr_holds_the_frame_to_the_last_bit() {
    let folder = tempfile::tempdir().unwrap();
    for standard_error in [frame().standard_error, None] {
        let (path, frame) = (folder.path().join("frame.exr"), Frame { standard_error, ..frame() });
        write_exr(AtomicFile::create(&path).unwrap(), &frame, &scene()).unwrap();
        assert_eq!(read_exr(&path).unwrap(), frame);
    }
    assert_eq!(folder.path().read_dir().unwrap().count(), 1);
}

#[test]
fn an_exr_says_its_units_its_camera_and_who_wrote_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.exr");
    write_exr(AtomicFile::create(&path).unwrap(), &frame(), &scene()).unwrap();
    let header = &MetaData::read_from_file(&path, true).unwrap().headers[0];
    let text = |name: &str| match &header.own_attributes.other[&Text::from(name)] {
        AttributeValue::Text(text) => text.to_string(),
        other => panic!("{name} is {other:?}"),
    };
    let number = |name: &str| match header.own_attributes.other[&Text::from(name)] {
        AttributeValue::F64(number) => number,
        ref other => panic!("{name} is {other:?}"),
    };
    assert_eq!((text("scene").as_str(), text("radiance_unit").as_str()), ("test sky", "W m^-2 sr^-1 nm^-1"));
    assert!(text("bands").contains("680, 550 and 440 nm"));
    let camera = ["altitude_m", "elevation_deg", "azimuth_deg", "vertical_field_of_view_deg"];
    for (field, expected) in camera.into_iter().zip([500.0, 12.0, 34.0, 56.0]) {
        assert!((number(&format!("camera_{field}")) - expected).abs() < 1e-9, "{field}");
    }
    let software = header.own_attributes.software_name.as_ref().unwrap().to_string();
    assert_eq!(software, concat!("welkin ", env!("CARGO_PKG_VERSION")));
}

#[test]
fn the_same_frame_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = |name: &str| {
        let path = folder.path().join(name);
        write_exr(AtomicFile::create(&path).unwrap(), &frame(), &scene()).unwrap();
        std::fs::read(path).unwrap()
    };
    // The encoder alone writes eight attributes in an order that is drawn anew each time.
    let first = bytes("first.exr");
    assert!((0..8).all(|i| bytes(&format!("{i}.exr")) == first));
}

#[test]
fn an_exr_of_another_program_needs_only_colour() {
    let folder = tempfile::tempdir().unwrap();
    let (rgb, grey) = (folder.path().join("rgb.exr"), folder.path().join("grey.exr"));
    exr::prelude::write_rgb_file(&rgb, 2, 2, |x, y| (x as f32, y as f32, 0.5_f32)).unwrap();
    let frame = read_exr(&rgb).unwrap();
    assert_eq!(frame.radiance, [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5], [0.0, 1.0, 0.5], [1.0, 1.0, 0.5]]);
    assert_eq!(frame.transmittance, Frame::new(2, 2).transmittance);
    let channel = exr::prelude::SpecificChannels::build().with_channel("Y").with_pixel_fn(|_| (0.5_f32,));
    let image = exr::prelude::Image::from_channels((2, 2), channel);
    exr::prelude::WritableImage::write(&image).to_file(&grey).unwrap();
    assert!(matches!(read_exr(&grey), Err(OutputError::MissingChannel { channel, .. }) if channel == "R"));
}

#[test]
fn a_png_holds_the_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture.png");
    let bytes: Vec<u8> = (0..5 * 3 * 3).map(|byte| byte * 5).collect();
    write_png(AtomicFile::create(&path).unwrap(), 5, 3, &bytes).unwrap();
    let picture = image::open(&path).unwrap().into_rgb8();
    assert_eq!((picture.dimensions(), picture.into_raw()), ((5, 3), bytes));
}
