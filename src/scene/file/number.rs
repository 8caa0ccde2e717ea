//! Numbers that know their range: one declaration serves the check, its message and the schema.

use std::fmt;
use std::marker::PhantomData;
use std::ops::Bound::{self, Excluded, Included};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};

/// An interval of `f64`; NaN lies in none.
pub trait Interval {
    /// Where it begins.
    const LOW: Bound<f64>;
    /// Where it ends.
    const HIGH: Bound<f64>;
}

/// A number in the interval `I`.
pub struct Number<I> {
    value: f64,
    interval: PhantomData<I>,
}

impl<I: Interval> Number<I> {
    /// The number, or `None` where it lies outside the interval.
    pub fn new(value: f64) -> Option<Self> {
        let above = match I::LOW {
            Included(low) => value >= low,
            Excluded(low) => value > low,
            Bound::Unbounded => value > f64::NEG_INFINITY,
        };
        let below = match I::HIGH {
            Included(high) => value <= high,
            Excluded(high) => value < high,
            Bound::Unbounded => value < f64::INFINITY,
        };
        (above && below).then_some(Self { value, interval: PhantomData })
    }

    /// The number.
    pub fn get(self) -> f64 {
        self.value
    }

    /// The interval in words.
    pub fn allowed() -> String {
        match (I::LOW, I::HIGH) {
            (Included(low), Included(high)) => format!("a number from {} to {}", Plain(low), Plain(high)),
            (Excluded(low), Included(high)) => format!("a number above {} and up to {}", Plain(low), Plain(high)),
            (Included(low), Excluded(high)) => format!("a number from {} to below {}", Plain(low), Plain(high)),
            (Excluded(low), Excluded(high)) => format!("a number above {} and below {}", Plain(low), Plain(high)),
            _ => "a finite number".to_owned(),
        }
    }
}

/// Large numbers as 1e10, small ones as they are.
struct Plain(f64);

impl fmt::Display for Plain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.abs() < 1e6 { write!(f, "{}", self.0) } else { write!(f, "{:e}", self.0) }
    }
}

impl<I> Clone for Number<I> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<I> Copy for Number<I> {}

impl<I> fmt::Debug for Number<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value.fmt(f)
    }
}

struct NumberVisitor<I>(PhantomData<I>);

impl<I: Interval> Visitor<'_> for NumberVisitor<I> {
    type Value = Number<I>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&Number::<I>::allowed())
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        Number::new(value).ok_or_else(|| E::invalid_value(Unexpected::Float(value), &self))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        Number::new(value as f64).ok_or_else(|| E::invalid_value(Unexpected::Signed(value), &self))
    }
}

impl<'de, I: Interval> Deserialize<'de> for Number<I> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_f64(NumberVisitor(PhantomData))
    }
}

impl<I: Interval> JsonSchema for Number<I> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Number".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut schema = json_schema!({ "type": "number" });
        let mut limit = |bound: Bound<f64>, included: &str, excluded: &str| match bound {
            Included(value) => drop(schema.insert(included.to_owned(), value.into())),
            Excluded(value) => drop(schema.insert(excluded.to_owned(), value.into())),
            Bound::Unbounded => {}
        };
        limit(I::LOW, "minimum", "exclusiveMinimum");
        limit(I::HIGH, "maximum", "exclusiveMaximum");
        schema
    }
}

/// Declares intervals: `Name: from, to;`.
macro_rules! intervals {
    ($($(#[$doc:meta])* $name:ident: $low:expr, $high:expr;)*) => {
        $($(#[$doc])* pub enum $name {}
        impl Interval for $name {
            const LOW: Bound<f64> = $low;
            const HIGH: Bound<f64> = $high;
        })*
    };
}

// The finite ends keep sums and squares of any accepted numbers finite in f32, in which a GPU computes.
intervals! {
    /// A length that is not zero, m: up to the size of a star.
    Length: Excluded(0.0), Included(1e10);
    /// A span of time, s.
    Duration: Excluded(0.0), Included(1e10);
    /// The size of a local medium or of what is in it, m.
    VolumeLength: Included(1e-3), Included(1e7);
    /// Half of a cone's opening, degrees.
    ConeAngle: Included(0.0), Included(180.0);
    /// The height of mountains, or the distance between them, m.
    TerrainLength: Excluded(0.0), Included(1e6);
    /// An altitude or a coordinate, m.
    Altitude: Included(-1e10), Included(1e10);
    /// A coefficient, 1/m, or a factor on one.
    Coefficient: Included(0.0), Included(1e6);
    /// Water in a cubic metre of cloud, g.
    WaterContent: Included(0.0), Included(1e3);
    /// The effective radius of droplets or crystals, µm.
    DropRadius: Included(0.1), Included(1e4);
    /// A component of a velocity, m/s.
    Speed: Included(-1e3), Included(1e3);
    /// Seconds, to either side of the start: three centuries.
    Time: Included(-1e10), Included(1e10);
    /// An amount of light in any unit.
    Light: Included(0.0), Included(1e12);
    /// A reflectance.
    Fraction: Included(0.0), Included(1.0);
    /// The asymmetry of a phase function; at ±1 all light keeps its line and the function is no longer one.
    Asymmetry: Excluded(-1.0), Excluded(1.0);
    /// The diameter of a water droplet, µm: the range of the published fit.
    DropletDiameter: Included(5.0), Included(50.0);
    /// An angle above the horizontal, or a latitude, degrees.
    Elevation: Included(-90.0), Included(90.0);
    /// An azimuth, degrees.
    Azimuth: Included(-360.0), Included(360.0);
    /// A longitude, degrees.
    Longitude: Included(-180.0), Included(180.0);
    /// A pinhole camera's field of view, degrees.
    FieldOfView: Included(0.001), Included(170.0);
    /// A disc's angular radius, degrees.
    AngularRadius: Included(0.0), Included(45.0);
    /// A phase angle, degrees.
    PhaseAngle: Included(0.0), Included(180.0);
    /// A wavelength at which a spectrum is listed, nm.
    Wavelength: Included(100.0), Included(10_000.0);
    /// An exposure, powers of two.
    Exposure: Included(-50.0), Included(50.0);
}

/// The width or height of a picture, pixels.
#[derive(Debug, Clone, Copy)]
pub struct Pixels(u32);

impl Pixels {
    const MAX: u32 = 16_384;

    /// The number of pixels.
    pub fn get(self) -> u32 {
        self.0
    }
}

struct PixelsVisitor;

impl Visitor<'_> for PixelsVisitor {
    type Value = Pixels;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a whole number of pixels from 1 to {}", Pixels::MAX)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Pixels, E> {
        let pixels = u32::try_from(value).ok().filter(|pixels| (1..=Pixels::MAX).contains(pixels));
        pixels.map(Pixels).ok_or_else(|| E::invalid_value(Unexpected::Signed(value), &self))
    }
}

impl<'de> Deserialize<'de> for Pixels {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_i64(PixelsVisitor)
    }
}

impl JsonSchema for Pixels {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Pixels".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "integer", "minimum": 1, "maximum": Self::MAX })
    }
}
