//! Random scene files of every kind that the schema knows, valid and invalid: what is added to scene files is in them at
//! once. They shrink to a file with fewer and simpler fields.

#![allow(dead_code, reason = "the test and the command use different parts")]

pub mod shrink;
pub mod trial;
pub mod values;

use std::str::FromStr;

use proptest::prelude::*;
use proptest::strategy::Union;
use serde_json::Value as Json;
use toml::Value;

/// A field that may be left out is there this often.
const PRESENT: f64 = 0.25;
/// One number in so many is none that the schema allows.
const VALID_TO_INVALID: u32 = 300;

/// Any scene file.
pub fn scene_file() -> BoxedStrategy<toml::Table> {
    let schema = welkin::scene::schema();
    let any = Part { root: &schema, is_pixels: false }.strategy(&schema);
    // Most have a sun, whose two angles the schema does not demand, and a small picture.
    (any, prop::bool::weighted(0.9), -20.0..90.0)
        .prop_map(|(value, repaired, elevation_deg)| repair(value, repaired, elevation_deg))
        .boxed()
}

fn repair(value: Value, repaired: bool, elevation_deg: f64) -> toml::Table {
    let Value::Table(mut table) = value else { unreachable!("a scene is a table") };
    if !repaired {
        return table;
    }
    if let Some(Value::Table(sun)) = table.get_mut("sun") {
        sun.remove("when");
        sun.entry("elevation_deg").or_insert(Value::Float(elevation_deg));
        sun.entry("azimuth_deg").or_insert(Value::Float(100.0));
    }
    table
}

/// A field of a table.
type Field = (String, Value);

/// A part of the schema.
#[derive(Clone, Copy)]
struct Part<'a> {
    root: &'a Json,
    is_pixels: bool,
}

impl Part<'_> {
    fn strategy(self, schema: &Json) -> BoxedStrategy<Value> {
        if let Some(name) = schema["$ref"].as_str() {
            return self.strategy(self.root.pointer(name.trim_start_matches('#')).expect("the schema's own reference"));
        }
        if let Some(kinds) = schema["anyOf"].as_array().or(schema["oneOf"].as_array()) {
            let kinds = kinds.iter().filter(|kind| kind["type"] != "null");
            return Union::new(kinds.map(|kind| self.strategy(kind)).collect::<Vec<_>>()).boxed();
        }
        if let Some(only) = schema["const"].as_str() {
            return Just(Value::String(only.to_owned())).boxed();
        }
        if let Some(words) = schema["enum"].as_array() {
            let words: Vec<_> = words.iter().filter_map(|word| word.as_str().map(str::to_owned)).collect();
            return prop::sample::select(words).prop_map(Value::String).boxed();
        }
        let kind = schema["type"].as_str().or_else(|| {
            schema["type"].as_array()?.iter().find_map(|kind| kind.as_str().filter(|kind| *kind != "null"))
        });
        match kind.expect("a schema has a type") {
            "object" => self.object(schema),
            "array" => self.array(schema),
            "number" => number(schema),
            "integer" => self.integer(schema),
            "boolean" => any::<bool>().prop_map(Value::Boolean).boxed(),
            "string" => string(schema),
            other => panic!("the strategy does not know the schema's type '{other}'"),
        }
    }

    fn object(self, schema: &Json) -> BoxedStrategy<Value> {
        let required: Vec<_> = schema["required"].as_array().into_iter().flatten().filter_map(Json::as_str).collect();
        let fields = schema["properties"].as_object().into_iter().flatten().map(|(name, field)| {
            let part = Part { is_pixels: name == "width" || name == "height", ..self };
            let value = part.strategy(field);
            let name = name.clone();
            let odds = if required.contains(&name.as_str()) { 0.9995 } else { PRESENT };
            // A picture's size is always said: its default takes long.
            let odds = if part.is_pixels { 0.999 } else { odds };
            prop::option::weighted(odds, value).prop_map(move |value| Some((name.clone(), value?))).boxed()
        });
        let fields: Vec<_> = fields.collect();
        let more = match schema["additionalProperties"] {
            Json::Object(_) => {
                let names = prop::sample::select(vec!["rayleigh", "mie", "ozone", "airglow", "smoke", "dust"]);
                prop::collection::vec((names, self.strategy(&schema["additionalProperties"])), 0..3).boxed()
            }
            _ => prop::option::weighted(0.002, Just(("no_such_field", Value::Integer(1))))
                .prop_map(|field| field.into_iter().collect())
                .boxed(),
        };
        let table = |(fields, more): (Vec<Option<Field>>, Vec<(&str, Value)>)| {
            let more = more.into_iter().map(|(name, value)| (name.to_owned(), value));
            Value::Table(fields.into_iter().flatten().chain(more).collect())
        };
        (fields, more).prop_map(table).boxed()
    }

    fn array(self, schema: &Json) -> BoxedStrategy<Value> {
        if let Some(items) = schema["prefixItems"].as_array() {
            let items: Vec<_> = items.iter().map(|item| self.strategy(item)).collect();
            return items.prop_map(Value::Array).boxed();
        }
        let (least, most) = (schema["minItems"].as_u64().unwrap_or(0), schema["maxItems"].as_u64().unwrap_or(2));
        prop::collection::vec(self.strategy(&schema["items"]), least as usize..=(most.max(least)) as usize)
            .prop_map(Value::Array)
            .boxed()
    }

    fn integer(self, schema: &Json) -> BoxedStrategy<Value> {
        let (low, high) =
            (schema["minimum"].as_i64().unwrap_or(0), schema["maximum"].as_i64().unwrap_or(i64::from(u32::MAX)));
        let most = if self.is_pixels { 3 } else { high };
        let low_or_high = prop_oneof![3 => low..=most, 1 => Just(low)];
        prop_oneof![VALID_TO_INVALID => low_or_high, 1 => Just(high + 1), 1 => Just(low - 1)]
            .prop_map(Value::Integer)
            .boxed()
    }
}

/// Numbers of every size in the schema's range, its ends, and now and then one outside it.
fn number(schema: &Json) -> BoxedStrategy<Value> {
    let bound = |included: &str, excluded: &str| schema[included].as_f64().or(schema[excluded].as_f64());
    let (low, high) =
        (bound("minimum", "exclusiveMinimum").unwrap_or(-1e30), bound("maximum", "exclusiveMaximum").unwrap_or(1e30));
    let inside = move |value: f64| value.clamp(low, high);
    let open = schema.get("exclusiveMinimum").is_some();
    let smallest = if open { low + (high - low) * 1e-9 } else { low };
    let largest = if schema.get("exclusiveMaximum").is_some() { high - (high - low) * 1e-9 } else { high };
    let any_size = (any::<bool>(), -9.0..12.0_f64).prop_map(move |(negative, exponent)| {
        let size = 10_f64.powf(exponent);
        inside(if negative && low < 0.0 { -size } else { size })
    });
    let valid = prop_oneof![
        4 => any_size.prop_map(move |value| value.clamp(smallest, largest)),
        4 => (0.0..1.0_f64).prop_map(move |share| smallest + share * (largest - smallest)),
        1 => Just(smallest),
        1 => Just(largest),
        1 => Just(inside(0.0).clamp(smallest, largest)),
    ];
    let invalid = prop_oneof![
        Just(Value::Float(f64::NAN)),
        Just(Value::Float(f64::INFINITY)),
        Just(Value::Float(high * 2.0 + 1.0)),
        Just(Value::Float(low - low.abs() - 1.0)),
        Just(Value::String("much".to_owned())),
        Just(Value::Array(vec![])),
    ];
    prop_oneof![VALID_TO_INVALID => valid.prop_map(Value::Float), 1 => invalid].boxed()
}

fn string(schema: &Json) -> BoxedStrategy<Value> {
    if schema["format"] == "date-time" {
        let dates = [
            "2026-06-21T12:00:00+02:00",
            "1700-01-01T00:00:00Z",
            "2026-02-29T12:00:00Z",
            "2026-06-21",
            "9999-12-31T23:59:59Z",
        ];
        let date =
            |text: &str| toml::value::Datetime::from_str(text).map_or(Value::String(text.to_owned()), Value::Datetime);
        return prop::sample::select(dates.to_vec()).prop_map(date).boxed();
    }
    prop_oneof![Just("a"), Just("b"), Just("smoke"), Just("no such file.csv"), Just(""), Just("ü\n\"")]
        .prop_map(|text| Value::String(text.to_owned()))
        .boxed()
}
