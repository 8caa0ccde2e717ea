//! Every parameter of the scene file, from its schema: name with unit, range, and what it means.

use egui::{CollapsingHeader, ComboBox, DragValue, RichText, TextEdit, Ui};
use serde_json::Value as Json;
use toml::{Table, Value};

use crate::window::document::as_number;
use crate::window::fly::rounded;
use crate::window::session::Session;

/// The schema of scene files.
pub struct Schema(Json);

impl Default for Schema {
    fn default() -> Self {
        Self(crate::scene::schema())
    }
}

/// A change that somebody has made: a field and its new value.
type Change = (String, Option<Value>);

impl Schema {
    /// What a schema stands for: references followed, `null` beside it left out.
    fn resolve<'a>(&'a self, schema: &'a Json) -> &'a Json {
        if let Some(name) = schema["$ref"].as_str().and_then(|name| name.strip_prefix("#/$defs/")) {
            return self.resolve(&self.0["$defs"][name]);
        }
        if let Some(options) = schema["anyOf"].as_array() {
            let mut real = options.iter().filter(|option| option["type"] != "null");
            if let (Some(only), None) = (real.next(), real.next()) {
                return self.resolve(only);
            }
        }
        schema
    }

    /// A value that the reader accepts where nothing is said yet.
    fn first_value(&self, schema: &Json) -> Value {
        let schema = self.resolve(schema);
        if let Some(first) = variants(schema).first() {
            return match first.1 {
                Some(inner) => Value::Table(Table::from_iter([(first.0.clone(), self.first_value(inner))])),
                None => Value::String(first.0.clone()),
            };
        }
        if let Some(options) = schema["anyOf"].as_array() {
            return options.first().map_or(Value::Table(Table::new()), |first| self.first_value(first));
        }
        match kind(schema) {
            "integer" => Value::Integer(bound(schema, 0.0) as i64),
            "number" => Value::Float(bound(schema, 0.0)),
            "boolean" => Value::Boolean(true),
            "string" if schema["format"] == "date-time" => Value::Datetime(crate::window::day::equinox()),
            "string" => Value::String("new".to_owned()),
            "array" => {
                let item = self.first_value(&schema["items"]);
                Value::Array(vec![item; schema["minItems"].as_u64().unwrap_or(0) as usize])
            }
            _ => {
                let required = schema["required"].as_array().into_iter().flatten().filter_map(Json::as_str);
                let field = |name: &str| (name.to_owned(), self.first_value(&schema["properties"][name]));
                Value::Table(required.map(field).collect())
            }
        }
    }
}

fn kind(schema: &Json) -> &str {
    match &schema["type"] {
        Json::String(kind) => kind,
        Json::Array(kinds) => kinds.iter().filter_map(Json::as_str).find(|kind| *kind != "null").unwrap_or(""),
        _ => "",
    }
}

/// The value nearest to zero, or to one, that a number's range has.
fn bound(schema: &Json, wanted: f64) -> f64 {
    let low = schema["minimum"].as_f64().unwrap_or(f64::NEG_INFINITY);
    let high = schema["maximum"].as_f64().unwrap_or(f64::INFINITY);
    match schema["exclusiveMinimum"].as_f64() {
        Some(edge) if edge >= wanted => (edge + 1.0).min(high),
        _ => wanted.clamp(low, high),
    }
}

/// The words that a choice has, each with the schema of what goes with it.
fn variants(schema: &Json) -> Vec<(String, Option<&Json>)> {
    let plain = schema["enum"].as_array().into_iter().flatten().filter_map(Json::as_str);
    let mut variants: Vec<_> = plain.map(|word| (word.to_owned(), None)).collect();
    for option in schema["oneOf"].as_array().into_iter().flatten() {
        variants.extend(option["const"].as_str().map(|word| (word.to_owned(), None)));
        variants.extend(
            option["enum"].as_array().into_iter().flatten().filter_map(|word| Some((word.as_str()?.to_owned(), None))),
        );
        if let Some(properties) = option["properties"].as_object() {
            variants.extend(properties.iter().map(|(word, inner)| (word.clone(), Some(inner))));
        }
    }
    variants
}

/// All parameters; what the file does not say is the preset's, and can be said.
pub fn show(ui: &mut Ui, session: &mut Session, schema: &Schema) {
    ui.label(RichText::new("What is not said is the preset's. Lengths m, coefficients 1/m, angles degrees.").small());
    let mut change = None;
    let table = Value::Table(session.document.table().clone());
    object(ui, schema, &schema.0, &table, "", &mut change);
    if let Some((path, value)) = change {
        session.set(&path, value);
    }
}

fn object(ui: &mut Ui, schema: &Schema, shape: &Json, value: &Value, path: &str, change: &mut Option<Change>) {
    let required: Vec<_> = shape["required"].as_array().into_iter().flatten().filter_map(Json::as_str).collect();
    for (name, property) in shape["properties"].as_object().into_iter().flatten() {
        let inner = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        let about = property["description"].as_str().or_else(|| schema.resolve(property)["description"].as_str());
        let about = about.unwrap_or_default();
        match value.get(name) {
            Some(value) => {
                present(ui, schema, property, (name, about), value, &inner, required.contains(&name.as_str()), change);
            }
            None => {
                ui.horizontal(|ui| {
                    ui.label(RichText::new(name).weak()).on_hover_text(about);
                    if ui.small_button("say").on_hover_text(about).clicked() {
                        *change = Some((inner, Some(schema.first_value(property))));
                    }
                });
            }
        }
    }
    if let Some(any) = shape["additionalProperties"].as_object() {
        named(ui, schema, &Json::Object(any.clone()), value, path, change);
    }
}

/// Fields of any name: constituents of the air.
fn named(ui: &mut Ui, schema: &Schema, shape: &Json, value: &Value, path: &str, change: &mut Option<Change>) {
    for (name, inner) in value.as_table().into_iter().flatten() {
        present(ui, schema, shape, (name, ""), inner, &format!("{path}.{name}"), false, change);
    }
    let id = ui.id().with(path).with("new");
    let mut name = ui.data_mut(|data| data.get_temp::<String>(id)).unwrap_or_default();
    ui.horizontal(|ui| {
        ui.add(TextEdit::singleline(&mut name).desired_width(110.0).hint_text("name"));
        if ui.small_button("say").clicked() && !name.is_empty() {
            *change = Some((format!("{path}.{name}"), Some(schema.first_value(shape))));
            name.clear();
        }
    });
    ui.data_mut(|data| data.insert_temp(id, name));
}

/// A field that the file says.
#[allow(clippy::too_many_arguments)]
fn present(
    ui: &mut Ui,
    schema: &Schema,
    property: &Json,
    (name, about): (&str, &str),
    value: &Value,
    path: &str,
    required: bool,
    change: &mut Option<Change>,
) {
    let shape = schema.resolve(property);
    let remove = |ui: &mut Ui, change: &mut Option<Change>| {
        if !required && ui.small_button("×").on_hover_text("leave it to the preset").clicked() {
            *change = Some((path.to_owned(), None));
        }
    };
    match value {
        Value::Table(_) | Value::Array(_) if !is_short(value) => {
            ui.horizontal(|ui| remove(ui, change));
            CollapsingHeader::new(name)
                .id_salt(path)
                .show(ui, |ui| nested(ui, schema, shape, value, path, change))
                .header_response
                .on_hover_text(about);
        }
        _ => {
            ui.horizontal(|ui| {
                scalar(ui, shape, value, path, change);
                ui.label(name).on_hover_text(about);
                remove(ui, change);
            });
        }
    }
}

/// Lists of a few numbers stand in one line.
fn is_short(value: &Value) -> bool {
    value
        .as_array()
        .is_some_and(|list| list.len() <= 3 && !list.is_empty() && list.iter().all(|item| as_number(item).is_some()))
}

fn nested(ui: &mut Ui, schema: &Schema, shape: &Json, value: &Value, path: &str, change: &mut Option<Change>) {
    let choices = variants(shape);
    if let Some((word, inner)) = choices
        .iter()
        .find_map(|(word, inner)| Some((word, (*inner)?, value.get(word)?)))
        .map(|(word, inner, value)| (word, (inner, value)))
    {
        choose(ui, schema, &choices, word, path, change);
        let (inner, value) = inner;
        return object(ui, schema, schema.resolve(inner), value, &format!("{path}.{word}"), change);
    }
    let options = shape["anyOf"].as_array();
    let fitting = |kind_wanted: &str| {
        options.into_iter().flatten().map(|option| schema.resolve(option)).find(|option| kind(option) == kind_wanted)
    };
    match value {
        Value::Array(list) => {
            let items = fitting("array").unwrap_or(shape)["items"].clone();
            for (index, item) in list.iter().enumerate() {
                let name = item.get("name").or_else(|| item.get("kind")).and_then(Value::as_str);
                let name = name.map_or_else(|| index.to_string(), |name| format!("{index}: {name}"));
                present(ui, schema, &items, (&name, ""), item, &format!("{path}[{index}]"), false, change);
            }
            if ui.small_button("add").clicked() {
                *change = Some((format!("{path}[{}]", list.len()), Some(schema.first_value(&items))));
            }
        }
        _ => object(ui, schema, fitting("object").unwrap_or(shape), value, path, change),
    }
}

fn scalar(ui: &mut Ui, shape: &Json, value: &Value, path: &str, change: &mut Option<Change>) {
    let choices = variants(shape);
    if let (Some(word), false) = (value.as_str(), choices.is_empty()) {
        let schema = Schema(Json::Null);
        return choose(ui, &schema, &choices, word, path, change);
    }
    let numeric = shape["anyOf"].as_array().and_then(|options| options.first()).unwrap_or(shape);
    match value {
        Value::Boolean(before) => {
            let mut after = *before;
            if ui.checkbox(&mut after, "").changed() {
                *change = Some((path.to_owned(), Some(after.into())));
            }
        }
        Value::Array(list) => {
            for (index, item) in list.iter().enumerate() {
                let range = if shape["items"].is_object() { &shape["items"] } else { numeric };
                if let Some(new) = as_number(item).and_then(|before| number(ui, range, before)) {
                    let mut list = list.clone();
                    list[index] = rounded_like(new);
                    *change = Some((path.to_owned(), Some(Value::Array(list))));
                }
            }
        }
        Value::Integer(_) | Value::Float(_) => {
            if let Some(new) = as_number(value).and_then(|before| number(ui, numeric, before)) {
                let whole = kind(numeric) == "integer";
                let new = if whole { Value::Integer(new.round() as i64) } else { rounded_like(new) };
                *change = Some((path.to_owned(), Some(new)));
            }
        }
        other => text(ui, other, path, change),
    }
}

/// Coefficients are small: rounding must not take their digits.
fn rounded_like(value: f64) -> Value {
    Value::Float(if value.abs() < 1e-3 { value } else { rounded(value) })
}

/// A number with its range; the new one, if it was changed.
fn number(ui: &mut Ui, shape: &Json, before: f64) -> Option<f64> {
    let low = shape["minimum"].as_f64().or_else(|| shape["exclusiveMinimum"].as_f64().map(f64::next_up));
    let high = shape["maximum"].as_f64().or_else(|| shape["exclusiveMaximum"].as_f64().map(f64::next_down));
    let (low, high) = (low.unwrap_or(f64::NEG_INFINITY), high.unwrap_or(f64::INFINITY));
    let mut after = before;
    let speed = (before.abs() * 0.01).max(if high <= 1.0 { 0.003 } else { 1e-7 });
    let field =
        DragValue::new(&mut after).range(low..=high).speed(speed).max_decimals(9).custom_formatter(|value, _| {
            if value != 0.0 && value.abs() < 1e-3 {
                format!("{value:.3e}")
            } else {
                format!("{value:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
            }
        });
    ui.add(field).on_hover_text(format!("{low:e} to {high:e}")).changed().then_some(after)
}

/// Words and dates, taken when one leaves the field.
fn text(ui: &mut Ui, value: &Value, path: &str, change: &mut Option<Change>) {
    let shown = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let id = ui.id().with(path).with("text");
    let mut text = ui.data_mut(|data| data.get_temp::<String>(id)).unwrap_or(shown);
    let field = ui.add(TextEdit::singleline(&mut text).desired_width(150.0));
    if field.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, text.clone()));
    }
    if field.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        let date = if value.is_datetime() { text.parse().ok().map(Value::Datetime) } else { None };
        *change = Some((path.to_owned(), Some(date.unwrap_or(Value::String(text)))));
    }
}

fn choose(
    ui: &mut Ui,
    schema: &Schema,
    choices: &[(String, Option<&Json>)],
    present: &str,
    path: &str,
    change: &mut Option<Change>,
) {
    ComboBox::from_id_salt((path, "choice")).selected_text(present).show_ui(ui, |ui| {
        for (word, inner) in choices {
            if ui.selectable_label(word == present, word).clicked() && word != present {
                let new = match inner {
                    Some(inner) => Value::Table(Table::from_iter([(word.clone(), schema.first_value(inner))])),
                    None => Value::String(word.clone()),
                };
                *change = Some((path.to_owned(), Some(new)));
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::window::document::Document;

    const TEXT: &str = "preset = \"earth\"\n[sun]\nelevation_deg = 30\nazimuth_deg = 180\n[camera]\naltitude_m = 2\n\
                        elevation_deg = 10\nazimuth_deg = 180\n";

    /// Every field of the root and of the tables in it, with its schema.
    fn fields(schema: &Schema) -> Vec<(String, Json)> {
        let mut all = Vec::new();
        for (name, property) in schema.0["properties"].as_object().unwrap() {
            all.push((name.clone(), property.clone()));
            let shape = schema.resolve(property);
            for (inner, property) in shape["properties"].as_object().into_iter().flatten() {
                all.push((format!("{name}.{inner}"), property.clone()));
            }
        }
        all
    }

    #[test]
    fn whatever_the_panel_says_first_is_accepted_or_refused_with_its_reason() {
        let schema = Schema::default();
        let (mut accepted, mut refused) = (0, Vec::new());
        for (path, property) in fields(&schema) {
            let mut document = Document::new(TEXT, Path::new("scene.toml")).unwrap();
            match document.set(&path, schema.first_value(&property)) {
                Ok(()) => accepted += 1,
                Err(problem) => refused.push((path, problem)),
            }
        }
        // What only goes with other fields: two ways to say where the sun stands, mountains above their hills' half
        // distance, a moon that nothing says the place of, bands of more wavelengths.
        let reasoned = refused.iter().all(|(_, problem)| problem.contains("expected") || problem.contains("missing"));
        assert!(accepted > 25 && reasoned, "{accepted} accepted, refused: {refused:#?}");
    }

    #[test]
    fn the_choices_of_a_phase_function_are_found() {
        let schema = Schema::default();
        let phase = &schema.0["$defs"]["CloudFile"]["properties"]["phase"];
        let words: Vec<_> = variants(schema.resolve(phase)).into_iter().map(|(word, _)| word).collect();
        assert!(words.contains(&"isotropic".to_owned()) && words.contains(&"draine".to_owned()), "{words:?}");
    }
}
