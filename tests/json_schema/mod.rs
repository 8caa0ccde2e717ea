//! JSON Schema validation for the keywords that the scene schema uses; on any other keyword it panics.
//!
//! The validator crates cost one to three minutes of build time, most of it for what this schema does without.

use serde_json::Value;

/// What is wrong with an instance, nothing where it is valid.
pub fn error(root: &Value, schema: &Value, instance: &Value) -> Option<String> {
    let check = |(keyword, wanted): (&String, &Value)| {
        let fits = match keyword.as_str() {
            "$ref" => return error(root, definition(root, wanted), instance),
            "properties" | "items" | "additionalProperties" => return members(root, schema, keyword, wanted, instance),
            "anyOf" => options_that_fit(root, wanted, instance) > 0,
            "oneOf" => options_that_fit(root, wanted, instance) == 1,
            "prefixItems" => {
                return wanted.as_array()?.iter().zip(instance.as_array()?).find_map(|(s, item)| error(root, s, item));
            }
            "type" => type_names(wanted).any(|name| has_type(instance, name)),
            "const" => instance == wanted,
            "enum" => wanted.as_array()?.contains(instance),
            "required" => wanted.as_array()?.iter().all(|key| instance.get(key.as_str().unwrap()).is_some()),
            "minimum" => instance.as_f64()? >= wanted.as_f64()?,
            "maximum" => instance.as_f64()? <= wanted.as_f64()?,
            "exclusiveMinimum" => instance.as_f64()? > wanted.as_f64()?,
            "exclusiveMaximum" => instance.as_f64()? < wanted.as_f64()?,
            "minItems" => instance.as_array()?.len() as u64 >= wanted.as_u64()?,
            "maxItems" => instance.as_array()?.len() as u64 <= wanted.as_u64()?,
            "$schema" | "$defs" | "title" | "description" | "default" | "format" => true,
            other => panic!("the schema uses '{other}', which this validator does not know"),
        };
        (!fits).then(|| format!("{instance} does not satisfy {keyword}: {wanted}"))
    };
    match schema {
        Value::Bool(allowed) => (!allowed).then(|| format!("{instance} has no place here")),
        _ => schema.as_object().expect("a schema is an object").iter().find_map(check),
    }
}

fn options_that_fit(root: &Value, options: &Value, instance: &Value) -> usize {
    options.as_array().unwrap().iter().filter(|option| error(root, option, instance).is_none()).count()
}

fn definition<'a>(root: &'a Value, reference: &Value) -> &'a Value {
    let pointer = reference.as_str().unwrap().strip_prefix('#').expect("a reference within the schema");
    root.pointer(pointer).expect("a definition of the schema")
}

fn members(root: &Value, schema: &Value, keyword: &str, wanted: &Value, instance: &Value) -> Option<String> {
    match keyword {
        "items" => instance.as_array()?.iter().find_map(|item| error(root, wanted, item)),
        "properties" => wanted.as_object()?.iter().find_map(|(key, schema)| error(root, schema, instance.get(key)?)),
        _ => {
            let known = |key: &String| schema.get("properties").is_some_and(|named| named.get(key).is_some());
            let others = instance.as_object()?.iter().filter(|(key, _)| !known(key));
            others
                .map(|(key, value)| (key, error(root, wanted, value)))
                .find_map(|(key, error)| error.map(|error| format!("{key}: {error}")))
        }
    }
}

fn type_names(wanted: &Value) -> impl Iterator<Item = &str> {
    let list = wanted.as_array().map_or(std::slice::from_ref(wanted), Vec::as_slice);
    list.iter().map(|name| name.as_str().unwrap())
}

fn has_type(instance: &Value, name: &str) -> bool {
    match name {
        "null" => instance.is_null(),
        "boolean" => instance.is_boolean(),
        "integer" => instance.is_i64() || instance.is_u64(),
        "number" => instance.is_number(),
        "string" => instance.is_string(),
        "array" => instance.is_array(),
        "object" => instance.is_object(),
        other => panic!("there is no type '{other}'"),
    }
}
