//! A value for each spectral band, one for all of them, or a list of wavelengths and values.

use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor, value};
use welkin_lut::{BAND_COUNT, BAND_NAMES, BAND_WAVELENGTHS_NM, Bands};

use super::number::{Interval, Number, Wavelength};
use crate::scene::spectrum::listed_value;

/// `[r, g, b]`, a single number that counts for every band, or `[[nm, value], ..]` with rising wavelengths.
pub struct PerBand<I> {
    bands: Bands,
    points: Option<Vec<[f64; 2]>>,
    interval: PhantomData<I>,
}

impl<I: Interval> PerBand<I> {
    /// The values in the bands in order of storage.
    pub fn get(&self) -> Bands {
        self.bands
    }

    /// The list (wavelength in nm, value), where there is one; linear between its points, constant beyond.
    pub fn points(&self) -> Option<&[[f64; 2]]> {
        self.points.as_deref()
    }

    fn from_bands(bands: Bands) -> Self {
        Self { bands, points: None, interval: PhantomData }
    }

    fn from_points(points: Vec<[f64; 2]>) -> Self {
        let bands = BAND_WAVELENGTHS_NM.map(|nm| listed_value(&points, nm));
        Self { bands, points: Some(points), interval: PhantomData }
    }
}

impl<I> fmt::Debug for PerBand<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (&self.bands, &self.points).fmt(f)
    }
}

impl<I> Clone for PerBand<I> {
    fn clone(&self) -> Self {
        Self { bands: self.bands, points: self.points.clone(), interval: PhantomData }
    }
}

/// What a list holds.
enum Entry<I> {
    Value(Number<I>),
    Point([f64; 2]),
}

struct EntryVisitor<I>(PhantomData<I>);

impl<'de, I: Interval> Visitor<'de> for EntryVisitor<I> {
    type Value = Entry<I>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, or [nm, value] of such", Number::<I>::allowed())
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Entry<I>, E> {
        Number::deserialize(value::F64Deserializer::new(value)).map(Entry::Value)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Entry<I>, E> {
        Number::deserialize(value::I64Deserializer::new(value)).map(Entry::Value)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Entry<I>, A::Error> {
        let mut count = 0;
        let missing = |count| A::Error::invalid_length(count, &"[nm, value]");
        let wavelength: Number<Wavelength> = seq.next_element()?.ok_or_else(|| missing(0))?;
        let value: Number<I> = seq.next_element()?.ok_or_else(|| missing(1))?;
        while seq.next_element::<serde::de::IgnoredAny>()?.is_some() {
            count += 1;
        }
        if count > 0 { Err(missing(2 + count)) } else { Ok(Entry::Point([wavelength.get(), value.get()])) }
    }
}

impl<'de, I: Interval> Deserialize<'de> for Entry<I> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EntryVisitor(PhantomData))
    }
}

struct PerBandVisitor<I>(PhantomData<I>);

impl<'de, I: Interval> Visitor<'de> for PerBandVisitor<I> {
    type Value = PerBand<I>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, [{}] or [[nm, value], ..] of such", Number::<I>::allowed(), BAND_NAMES.join(", "))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<PerBand<I>, E> {
        let number: Number<I> = Number::deserialize(value::F64Deserializer::new(value))?;
        Ok(PerBand::from_bands([number.get(); BAND_COUNT]))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<PerBand<I>, E> {
        let number: Number<I> = Number::deserialize(value::I64Deserializer::new(value))?;
        Ok(PerBand::from_bands([number.get(); BAND_COUNT]))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<PerBand<I>, A::Error> {
        let (mut values, mut points) = (Vec::new(), Vec::<[f64; 2]>::new());
        while let Some(entry) = seq.next_element::<Entry<I>>()? {
            match entry {
                Entry::Value(number) => values.push(number.get()),
                Entry::Point(point) => points.push(point),
            }
        }
        if points.is_empty() {
            let bands = Bands::try_from(values);
            return bands.map(PerBand::from_bands).map_err(|values| A::Error::invalid_length(values.len(), &self));
        }
        if !values.is_empty() {
            return Err(A::Error::custom(format!("invalid value: numbers beside pairs, expected {}", Expected(&self))));
        }
        match points.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
            Some(pair) => Err(A::Error::custom(format!(
                "invalid value: `{}` nm after {} nm, expected rising wavelengths",
                pair[1][0], pair[0][0]
            ))),
            None => Ok(PerBand::from_points(points)),
        }
    }
}

/// What a visitor expects, in words.
struct Expected<'a, I>(&'a PerBandVisitor<I>);

impl<I: Interval> fmt::Display for Expected<'_, I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.expecting(f)
    }
}

impl<'de, I: Interval> Deserialize<'de> for PerBand<I> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PerBandVisitor(PhantomData))
    }
}

impl<I: Interval> JsonSchema for PerBand<I> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "PerBand".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = Number::<I>::json_schema(generator);
        let wavelength = Number::<Wavelength>::json_schema(generator);
        let list = json_schema!({ "type": "array", "items": number, "minItems": BAND_COUNT, "maxItems": BAND_COUNT });
        let point =
            json_schema!({ "type": "array", "prefixItems": [wavelength, number], "minItems": 2, "maxItems": 2 });
        let points = json_schema!({ "type": "array", "items": point, "minItems": 1 });
        json_schema!({ "anyOf": [number, list, points] })
    }
}
