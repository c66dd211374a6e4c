//! The JSON Schema of the study file, generated from the Rust types.

use serde_json::Value;

use super::values::JsonType;
use crate::study_file::Study;

/// Where the schema lies, as the studies of `study-config` name it.
pub const SCHEMA_ADDRESS: &str = "./schema/study.schema.json";

/// The JSON Schema (2020-12) of the study file.
pub fn json_schema() -> Value {
    schemars::schema_for!(Study).to_value()
}

/// The JSON Schema whose parts refer to one another.
#[derive(Clone, Copy)]
pub(super) struct Schemas<'a> {
    /// The schema of the whole file.
    pub root: &'a Value,
}

impl<'a> Schemas<'a> {
    /// A schema and what it refers to.
    pub fn parts(&self, schema: &'a Value) -> Vec<&'a Value> {
        let mut parts = vec![schema];
        let mut at = schema;
        while let Some(target) = at.get("$ref").and_then(Value::as_str) {
            let Some(found) = target.strip_prefix('#').and_then(|path| self.root.pointer(path))
            else {
                break;
            };
            parts.push(found);
            at = found;
        }
        parts
    }

    /// The alternative of `anyOf` that a value is of, by its type.
    pub fn fitting(&self, alternatives: &'a [Value], value: &Value) -> Option<&'a Value> {
        alternatives.iter().find(|alternative| {
            let fits = self.parts(alternative).iter().any(|part| {
                part.get("type").is_some_and(|types| has_one(types, value))
                    || part.get("anyOf").is_some()
                    || part.get("oneOf").is_some()
            });
            fits && (!value.is_null() || accepts_null(alternative))
        })
    }
}

/// The words that a part allows: `enum`, or `oneOf` constants.
pub(super) fn words(part: &Value) -> Option<Vec<&str>> {
    if let Some(words) = part.get("enum").and_then(Value::as_array) {
        return Some(words.iter().filter_map(Value::as_str).collect());
    }
    if let Some(word) = part.get("const").and_then(Value::as_str) {
        return Some(vec![word]);
    }
    let alternatives = part.get("oneOf").and_then(Value::as_array)?;
    let words: Vec<&str> =
        alternatives.iter().filter_map(|each| each.get("const")?.as_str()).collect();
    (words.len() == alternatives.len()).then_some(words)
}

/// The types that a `type` of a schema allows; `null` is none of them.
pub(super) fn types_of(types: &Value) -> impl Iterator<Item = JsonType> {
    let list = types.as_array().map_or(std::slice::from_ref(types), Vec::as_slice);
    list.iter().filter_map(Value::as_str).filter_map(JsonType::of_schema)
}

/// Whether a value is of one of the types that a `type` of a schema allows.
pub(super) fn has_one(types: &Value, value: &Value) -> bool {
    (names_null(types) && value.is_null()) || types_of(types).any(|each| each.has(value))
}

/// The least and the greatest number of a schema of whole numbers.
pub(super) fn whole_range(part: &Value) -> Option<(f64, f64)> {
    if !types_of(part.get("type")?).any(|each| each == JsonType::WholeNumber) {
        return None;
    }
    let (least, most) = match part.get("format").and_then(Value::as_str) {
        Some("uint8") => (0.0, f64::from(u8::MAX)),
        Some("uint32") => (0.0, f64::from(u32::MAX)),
        Some("uint" | "uint64") => (0.0, 9_007_199_254_740_991.0),
        _ => (-9.1e15, 9.1e15),
    };
    Some((part.get("minimum").and_then(Value::as_f64).unwrap_or(least), most))
}

/// Whether a schema's own `type` allows null.
pub(super) fn accepts_null(schema: &Value) -> bool {
    schema.get("type").is_some_and(names_null)
}

fn names_null(types: &Value) -> bool {
    match types {
        Value::Array(types) => types.iter().any(|each| each == "null"),
        one => one == "null",
    }
}
