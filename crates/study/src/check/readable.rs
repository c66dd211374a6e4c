//! What can be read of a damaged file: every value that fits the schema as it is, a stand-in of the
//! right type for every other that must be there, and no key that the schema does not know.
//!
//! [`super::structure`] has said by then what is wrong; the later stages run on what stands here, and
//! [`super::damage`] leaves out what they find at the stand-ins.

use serde_json::{Map, Value, json};

use super::schema::{Schemas, accepts_null, has_one, types_of, whole_range, words};
use super::values::JsonType;

/// The file with stand-ins where it cannot be read.
pub(super) fn readable(schemas: &Schemas<'_>, file: &Value) -> Value {
    fitted(schemas, schemas.root, file)
}

/// A value as its schema wants it.
fn fitted<'a>(schemas: &Schemas<'a>, schema: &'a Value, value: &Value) -> Value {
    let parts = schemas.parts(schema);
    for part in &parts {
        if let Some(alternatives) = part.get("anyOf").and_then(Value::as_array) {
            return match schemas.fitting(alternatives, value) {
                Some(alternative) => fitted(schemas, alternative, value),
                None => stand_in(schemas, schema),
            };
        }
        if let Some(words) = words(part)
            && !value.as_str().is_some_and(|word| words.contains(&word))
        {
            return stand_in(schemas, schema);
        }
        if let Some(types) = part.get("type")
            && !(has_one(types, value) && is_in_range(part, value))
        {
            return stand_in(schemas, schema);
        }
    }
    match value {
        Value::Object(map) => object(schemas, &parts, map),
        Value::Array(items) => {
            let part = parts.iter().find(|part| part.get("items").is_some());
            part.map_or_else(|| value.clone(), |part| list(schemas, part, items))
        }
        _ => value.clone(),
    }
}

/// Whether a number is in the range of its type.
fn is_in_range(part: &Value, value: &Value) -> bool {
    let number = value.as_f64().zip(whole_range(part));
    number.is_none_or(|(number, (least, most))| (least..=most).contains(&number))
}

/// A list of the length that its schema wants.
fn list<'a>(schemas: &Schemas<'a>, part: &'a Value, items: &[Value]) -> Value {
    let schema = &part["items"];
    let limit = |key| part.get(key).and_then(Value::as_u64).map(|count| count as usize);
    let most = limit("maxItems").unwrap_or(usize::MAX);
    let mut list: Vec<Value> =
        items.iter().take(most).map(|item| fitted(schemas, schema, item)).collect();
    while list.len() < limit("minItems").unwrap_or(0) {
        list.push(stand_in(schemas, schema));
    }
    list.into()
}

/// An object with every key that must be there and none that is not known.
fn object<'a>(schemas: &Schemas<'a>, parts: &[&'a Value], map: &Map<String, Value>) -> Value {
    let mut found = Map::new();
    let mut parts = parts.to_vec();
    // What stands in an alternative that the key `type` chooses is a part like any other.
    if let Some(alternatives) =
        parts.iter().find_map(|part| part.get("oneOf").and_then(Value::as_array))
    {
        let kind = map.get("type");
        let chosen = alternatives.iter().find(|each| each.pointer(TAG) == kind);
        let Some(chosen) = chosen.or(alternatives.first()) else { return json!({}) };
        if let Some(word) = chosen.pointer(TAG) {
            found.insert("type".to_owned(), word.clone());
        }
        parts.extend(schemas.parts(chosen));
    }
    for (key, value) in map {
        if found.contains_key(key) {
            continue;
        }
        let known = parts.iter().find_map(|part| part.get("properties")?.get(key));
        let others = parts.iter().find_map(|part| {
            part.get("additionalProperties").or(part.get("unevaluatedProperties"))
        });
        match (known, others) {
            (Some(schema), _) => found.insert(key.clone(), fitted(schemas, schema, value)),
            (None, Some(Value::Bool(false))) => None,
            (None, Some(schema)) => found.insert(key.clone(), fitted(schemas, schema, value)),
            (None, None) => found.insert(key.clone(), value.clone()),
        };
    }
    for part in parts {
        for key in part.get("required").and_then(Value::as_array).into_iter().flatten() {
            let Some(key) = key.as_str().filter(|key| !found.contains_key(*key)) else { continue };
            if let Some(schema) = part.pointer(&format!("/properties/{key}")) {
                found.insert(key.to_owned(), stand_in(schemas, schema));
            }
        }
    }
    found.into()
}

/// Where an alternative says which `type` chooses it.
const TAG: &str = "/properties/type/const";

/// The plainest value that a schema accepts and that says something: not null.
fn stand_in<'a>(schemas: &Schemas<'a>, schema: &'a Value) -> Value {
    let parts = schemas.parts(schema);
    for part in &parts {
        if let Some(alternatives) = part.get("anyOf").and_then(Value::as_array) {
            let some = alternatives.iter().find(|each| !accepts_null(each));
            return some.map_or(Value::Null, |some| stand_in(schemas, some));
        }
        if let Some(word) = words(part).and_then(|words| words.first().copied()) {
            return word.into();
        }
    }
    let types = parts.iter().find_map(|part| part.get("type"));
    let Some(types) = types else { return object(schemas, &parts, &Map::new()) };
    match types_of(types).next() {
        Some(JsonType::Text) => "".into(),
        Some(JsonType::Boolean) => false.into(),
        Some(JsonType::Number | JsonType::WholeNumber) => 0.into(),
        Some(JsonType::List) => {
            let part = parts.iter().find(|part| part.get("items").is_some());
            part.map_or_else(|| json!([]), |part| list(schemas, part, &[]))
        }
        Some(JsonType::Object) => object(schemas, &parts, &Map::new()),
        None => Value::Null,
    }
}
