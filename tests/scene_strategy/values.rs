//! Other numbers in the fields that a scene file has: the same words, as many constituents, clouds and lights, so that the same
//! shaders do.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use serde_json::Value as Json;
use toml::Value;

use super::number;

/// Of so many numbers one stays, one is changed within some decades, and one in twice as many is any that the schema allows.
const KINDS: u32 = 4;
/// Decades that a number is changed by at most.
const DECADES: f64 = 1.5;

/// The scene file with other numbers. What is nothing stays nothing, as shaders are specialised by what is not there.
pub fn with_other_numbers(schema: &Json, table: &toml::Table, runner: &mut TestRunner) -> toml::Table {
    let mut other = Value::Table(table.clone());
    Numbers { root: schema, runner }.change(schema, &mut other);
    let Value::Table(table) = other else { unreachable!("a scene stays a table") };
    table
}

fn draw<S: Strategy>(runner: &mut TestRunner, strategy: S) -> S::Value {
    strategy.new_tree(runner).expect("nothing is filtered").current()
}

struct Numbers<'a> {
    root: &'a Json,
    runner: &'a mut TestRunner,
}

impl<'a> Numbers<'a> {
    fn change(&mut self, schema: &'a Json, value: &mut Value) {
        let schema = deref(self.root, schema);
        if let Some(kinds) = kinds(schema) {
            let root = self.root;
            if let Some(kind) = kinds.iter().find(|kind| fits(root, kind, value)) {
                self.change(kind, value);
            }
            return;
        }
        match value {
            Value::Table(table) => {
                table.iter_mut().for_each(|(name, value)| match &schema["properties"][name.as_str()] {
                    Json::Null => self.change(&schema["additionalProperties"], value),
                    field => self.change(field, value),
                })
            }
            Value::Array(items) => items.iter_mut().enumerate().for_each(|(index, item)| {
                let of_item = schema["prefixItems"].get(index).unwrap_or(&schema["items"]);
                self.change(of_item, item);
            }),
            Value::Float(old) => *value = self.other(schema, *old),
            Value::Integer(old) if has_type(schema, "number") => *value = self.other(schema, *old as f64),
            _ => {}
        }
    }

    fn other(&mut self, schema: &Json, old: f64) -> Value {
        match draw(self.runner, 0..2 * KINDS) {
            _ if old == 0.0 => Value::Float(old),
            0 => match draw(self.runner, number(schema)) {
                Value::Float(0.0) => Value::Float(old),
                any => any,
            },
            1..KINDS => {
                let decades = draw(self.runner, -DECADES..DECADES);
                let ends =
                    ["minimum", "exclusiveMinimum", "maximum", "exclusiveMaximum"].map(|end| schema[end].as_f64());
                let (low, high) = (ends[0].or(ends[1]), ends[2].or(ends[3]));
                let new = old * 10_f64.powf(decades);
                Value::Float(new.clamp(low.unwrap_or(f64::MIN), high.unwrap_or(f64::MAX)))
            }
            _ => Value::Float(old),
        }
    }
}

fn deref<'a>(root: &'a Json, schema: &'a Json) -> &'a Json {
    match schema["$ref"].as_str() {
        Some(name) => deref(root, root.pointer(name.trim_start_matches('#')).expect("the schema's own reference")),
        None => schema,
    }
}

fn kinds(schema: &Json) -> Option<&Vec<Json>> {
    schema["anyOf"].as_array().or(schema["oneOf"].as_array())
}

fn has_type(schema: &Json, name: &str) -> bool {
    let is_it = |kind: &Json| kind == name;
    is_it(&schema["type"]) || schema["type"].as_array().is_some_and(|kinds| kinds.iter().any(is_it))
}

/// Whether a value has the form that a part of the schema describes.
fn fits(root: &Json, schema: &Json, value: &Value) -> bool {
    let schema = deref(root, schema);
    if let Some(kinds) = kinds(schema) {
        return kinds.iter().any(|kind| fits(root, kind, value));
    }
    match value {
        Value::String(word) if schema["const"].is_string() => schema["const"] == word.as_str(),
        Value::String(_) => has_type(schema, "string"),
        Value::Boolean(_) => has_type(schema, "boolean"),
        Value::Datetime(_) => schema["format"] == "date-time",
        Value::Float(_) => has_type(schema, "number"),
        Value::Integer(_) => has_type(schema, "number") || has_type(schema, "integer"),
        Value::Array(items) => {
            let item = |(index, item): (usize, &Value)| {
                let of_item = schema["prefixItems"].get(index).unwrap_or(&schema["items"]);
                fits(root, of_item, item)
            };
            has_type(schema, "array") && items.iter().enumerate().all(item)
        }
        Value::Table(table) => {
            let known = |(name, value): (&String, &Value)| match &schema["properties"][name.as_str()] {
                Json::Null => {
                    schema["additionalProperties"].is_object() && fits(root, &schema["additionalProperties"], value)
                }
                field => fits(root, field, value),
            };
            let required = schema["required"].as_array().into_iter().flatten().filter_map(Json::as_str);
            has_type(schema, "object")
                && table.iter().all(known)
                && required.into_iter().all(|name| table.contains_key(name))
        }
    }
}
