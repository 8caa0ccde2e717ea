//! The `[spectrum]` of a scene file, and the spectra that its fields list.

use std::collections::BTreeMap;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, Error, Unexpected, Visitor};
use welkin_lut::BAND_COUNT;
use welkin_lut::cloud::CloudKind;
use welkin_lut::spectrum::rule;

use super::number::Coefficient;
use super::{MediumFile, PerBand, SceneFile};

/// Which wavelengths are computed, and the colours they become.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpectrumFile {
    /// How many wavelengths; by default 3: the bands at 680, 550 and 440 nm. More are a Gauss rule for sunlight.
    pub wavelengths: Option<Wavelengths>,
    /// What the channels of an EXR file hold; by default "linear-srgb".
    pub colour_space: Option<ChannelsFile>,
    /// What is white; by default "sun".
    pub white: Option<WhiteFile>,
}

/// How many wavelengths.
#[derive(Debug, Clone, Copy)]
pub struct Wavelengths(usize);

impl Wavelengths {
    /// Their number.
    pub fn get(self) -> usize {
        self.0
    }
}

struct WavelengthsVisitor;

impl Visitor<'_> for WavelengthsVisitor {
    type Value = Wavelengths;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a whole number of wavelengths from {BAND_COUNT} to {}", rule::MOST)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Wavelengths, E> {
        let count = usize::try_from(value).ok().filter(|count| (BAND_COUNT..=rule::MOST).contains(count));
        count.map(Wavelengths).ok_or_else(|| E::invalid_value(Unexpected::Signed(value), &self))
    }
}

impl<'de> Deserialize<'de> for Wavelengths {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_i64(WavelengthsVisitor)
    }
}

impl JsonSchema for Wavelengths {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Wavelengths".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "integer", "minimum": BAND_COUNT, "maximum": rule::MOST })
    }
}

/// What the channels of an EXR file hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum ChannelsFile {
    /// Spectral radiance at 680, 550 and 440 nm; only with three wavelengths.
    #[serde(rename = "bands")]
    Bands,
    /// Primaries and white of sRGB and Rec. 709, linear.
    #[serde(rename = "linear-srgb")]
    LinearSrgb,
    /// ITU-R BT.2020, linear.
    #[serde(rename = "rec2020")]
    Rec2020,
    /// ACEScg.
    #[serde(rename = "acescg")]
    AcesCg,
}

/// What is white.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WhiteFile {
    /// The sun above the air, or the first directional light that shines.
    Sun,
    /// The CIE's daylight of 6500 K.
    D65,
}

/// The spectra that a file lists, by `planet.ground_albedo`, `medium.CONSTITUENT.FIELD`, `clouds.NAME.albedo`,
/// `volumes.NAME.FIELD` (fog's too) and `light.NAME`.
pub fn listed(file: &SceneFile) -> BTreeMap<String, Vec<[f64; 2]>> {
    let mut spectra = BTreeMap::new();
    let mut add = |name: String, points: Option<&[[f64; 2]]>| {
        if let Some(points) = points {
            spectra.insert(name, points.to_vec());
        }
    };
    add("planet.ground_albedo".to_owned(), file.planet.ground_albedo.as_ref().and_then(|value| value.points()));
    add("light.sun".to_owned(), file.sun.irradiance.as_ref().and_then(|value| value.points()));
    if let Some(terrain) = &file.terrain {
        add("terrain.albedo".to_owned(), terrain.albedo.as_ref().and_then(|value| value.points()));
        add("terrain.snow_albedo".to_owned(), terrain.snow_albedo.as_ref().and_then(|value| value.points()));
    }
    if let Some(moon) = &file.moon {
        add("light.moon".to_owned(), moon.irradiance.as_ref().and_then(|value| value.points()));
    }
    for cloud in &file.clouds {
        let name = cloud.name.clone().unwrap_or_else(|| CloudKind::from(cloud.kind).name().to_owned());
        add(format!("clouds.{name}.albedo"), cloud.albedo.as_ref().and_then(|value| value.points()));
    }
    for fog in &file.fog {
        let name = fog.name.as_deref().unwrap_or("fog");
        add(format!("volumes.{name}.extinction_per_m"), fog.extinction_per_m.points());
        add(format!("volumes.{name}.albedo"), fog.albedo.as_ref().and_then(|value| value.points()));
    }
    for file in &file.volumes {
        let fields = [&file.scattering_per_m, &file.absorption_per_m, &file.emission_per_m];
        for (field, value) in ["scattering_per_m", "absorption_per_m", "emission_per_m"].iter().zip(fields) {
            add(format!("volumes.{}.{field}", file.name), value.as_ref().and_then(|value| value.points()));
        }
    }
    for light in &file.light.spot {
        add(format!("light.{}", light.name), light.intensity.points());
    }
    for light in &file.light.directional {
        add(format!("light.{}", light.name), light.irradiance.points());
    }
    for light in &file.light.point {
        add(format!("light.{}", light.name), light.intensity.points());
    }
    if let Some(light) = &file.light.environment {
        add("light.environment".to_owned(), light.radiance.points());
    }
    let mut constituent = |name: &str, fields: [&Option<PerBand<Coefficient>>; 3]| {
        for (field, value) in ["scattering_per_m", "absorption_per_m", "emission_per_m"].iter().zip(fields) {
            add(format!("medium.{name}.{field}"), value.as_ref().and_then(|value| value.points()));
        }
    };
    match &file.medium {
        Some(MediumFile::Complete(list)) => {
            for file in list {
                constituent(&file.name, [&file.scattering_per_m, &file.absorption_per_m, &file.emission_per_m]);
            }
        }
        Some(MediumFile::Changes(changes)) => {
            for (name, file) in changes {
                constituent(name, [&file.scattering_per_m, &file.absorption_per_m, &file.emission_per_m]);
            }
        }
        None => {}
    }
    spectra
}
