//! A value for each spectral band, or one for all of them.

use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor, value};
use welkin_lut::{BAND_COUNT, BAND_NAMES, Bands};

use super::number::{Interval, Number};

/// `[r, g, b]`, or a single number that counts for every band.
pub struct PerBand<I>([Number<I>; BAND_COUNT]);

impl<I: Interval> PerBand<I> {
    /// The values in order of storage.
    pub fn get(&self) -> Bands {
        self.0.map(Number::get)
    }
}

impl<I> fmt::Debug for PerBand<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<I> Clone for PerBand<I> {
    fn clone(&self) -> Self {
        Self(self.0)
    }
}

struct PerBandVisitor<I>(PhantomData<I>);

impl<I: Interval> PerBandVisitor<I> {
    fn all_bands<E: Error>(number: Result<Number<I>, E>) -> Result<PerBand<I>, E> {
        number.map(|number| PerBand([number; BAND_COUNT]))
    }
}

impl<'de, I: Interval> Visitor<'de> for PerBandVisitor<I> {
    type Value = PerBand<I>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, or [{}] of such", Number::<I>::allowed(), BAND_NAMES.join(", "))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<PerBand<I>, E> {
        Self::all_bands(Number::deserialize(value::F64Deserializer::new(value)))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<PerBand<I>, E> {
        Self::all_bands(Number::deserialize(value::I64Deserializer::new(value)))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<PerBand<I>, A::Error> {
        let mut numbers = Vec::new();
        while let Some(number) = seq.next_element()? {
            numbers.push(number);
        }
        let bands = <[Number<I>; BAND_COUNT]>::try_from(numbers);
        bands.map(PerBand).map_err(|numbers| A::Error::invalid_length(numbers.len(), &self))
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
        let list = json_schema!({ "type": "array", "items": number, "minItems": BAND_COUNT, "maxItems": BAND_COUNT });
        json_schema!({ "anyOf": [number, list] })
    }
}
