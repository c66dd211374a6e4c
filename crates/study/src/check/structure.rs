//! Keys and types, against the schema that the Rust types generate: all mistakes, not the first.

use serde_json::{Map, Value};

use super::damage::Damage;
use super::issue::{Issues, below, listed};
use super::nearest::{nearest, suggestion};
use super::schema::json_schema;

/// Examines a file; returns the pointers of all its localised texts, and what cannot be read.
pub(super) fn examine(value: &Value, issues: &mut Issues) -> (Vec<String>, Damage) {
    let schema = json_schema();
    let mut walk = Walk { root: &schema, issues, texts: Vec::new(), damage: Damage::default() };
    walk.value(&schema, value, "");
    (walk.texts, walk.damage)
}

struct Walk<'a> {
    root: &'a Value,
    issues: &'a mut Issues,
    texts: Vec<String>,
    damage: Damage,
}

/// What the parts of a schema say about an object.
#[derive(Default)]
struct ObjectRules<'a> {
    properties: Vec<(&'a String, &'a Value)>,
    required: Vec<&'a str>,
    others: Option<&'a Value>,
    closed: bool,
}

impl<'a> Walk<'a> {
    fn value(&mut self, schema: &'a Value, value: &Value, pointer: &str) {
        let parts = self.parts(schema);
        if refers_to(schema, "LocalText") {
            self.texts.push(pointer.to_owned());
        }
        for part in &parts {
            if let Some(alternatives) = part.get("anyOf").and_then(Value::as_array) {
                self.any_of(alternatives, value, pointer);
            }
            if let Some(words) = words(part)
                && !value.as_str().is_some_and(|word| words.contains(&word))
            {
                self.wrong_word(&words, value, pointer);
                return;
            }
            if let Some(kinds) = part.get("type")
                && !self.has_type(kinds, part, value, pointer)
            {
                return;
            }
        }
        match value {
            Value::Object(map) => self.object(&parts, map, pointer),
            Value::Array(items) => {
                for part in &parts {
                    self.array(part, items, pointer);
                }
            }
            _ => {}
        }
    }

    /// A schema and what it refers to.
    fn parts(&self, schema: &'a Value) -> Vec<&'a Value> {
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

    fn any_of(&mut self, alternatives: &'a [Value], value: &Value, pointer: &str) {
        let fitting = alternatives.iter().find(|alternative| {
            self.parts(alternative).iter().any(|part| {
                part.get("type").is_some_and(|kinds| names(kinds).any(|kind| is_a(value, kind)))
                    || part.get("anyOf").is_some()
                    || part.get("oneOf").is_some()
            }) && !(value.is_null() && alternative.get("type") != Some(&Value::from("null")))
        });
        match fitting {
            Some(alternative) => self.value(alternative, value, pointer),
            None => {
                let mut kinds: Vec<&str> = Vec::new();
                for alternative in alternatives {
                    for part in self.parts(alternative) {
                        kinds.extend(part.get("type").into_iter().flat_map(names).map(kind_name));
                    }
                }
                kinds.retain(|kind| *kind != "null");
                kinds.dedup();
                self.wrong_type(&kinds.join(" or "), value, pointer);
            }
        }
    }

    fn has_type(&mut self, kinds: &Value, part: &Value, value: &Value, pointer: &str) -> bool {
        if !names(kinds).any(|kind| is_a(value, kind)) {
            let wanted: Vec<&str> =
                names(kinds).filter(|kind| *kind != "null").map(kind_name).collect();
            self.wrong_type(&wanted.join(" or "), value, pointer);
            return false;
        }
        let Some(number) = value.as_f64() else { return true };
        let format = part.get("format").and_then(Value::as_str);
        let (least, most) = match format {
            Some("uint8") => (0.0, f64::from(u8::MAX)),
            Some("uint32") => (0.0, f64::from(u32::MAX)),
            Some("uint" | "uint64") => (0.0, 9_007_199_254_740_991.0),
            _ => (-9.1e15, 9.1e15),
        };
        let least = part.get("minimum").and_then(Value::as_f64).unwrap_or(least);
        if names(kinds).any(|kind| kind == "integer") && !(least..=most).contains(&number) {
            let message = format!("{value} is out of range");
            let hint = format!("write a whole number from {least} to {most}");
            self.fault(pointer, "out-of-range", message, hint);
            return false;
        }
        true
    }

    fn wrong_type(&mut self, wanted: &str, value: &Value, pointer: &str) {
        let message = format!("{} where {wanted} belongs", shown(value));
        self.fault(pointer, "wrong-type", message, format!("write {wanted}"));
    }

    /// Says that a value cannot be read as it stands.
    fn fault(&mut self, pointer: &str, code: &'static str, message: String, hint: String) {
        self.damage.place(pointer.to_owned());
        self.issues.error(pointer, code, message, hint);
    }

    fn wrong_word(&mut self, words: &[&str], value: &Value, pointer: &str) {
        match value.as_str() {
            Some(word) => {
                let hint = suggestion(word, words);
                let message = format!("\"{word}\" is not one of {}", listed(words));
                self.fault(pointer, "unknown-word", message, hint);
            }
            None => self.wrong_type(&format!("one of {}", listed(words)), value, pointer),
        }
    }

    fn array(&mut self, part: &'a Value, items: &[Value], pointer: &str) {
        let limit = |key| part.get(key).and_then(Value::as_u64).map(|count| count as usize);
        if limit("minItems").is_some_and(|least| items.len() < least)
            || limit("maxItems").is_some_and(|most| items.len() > most)
        {
            let wanted = limit("minItems").unwrap_or_default();
            let message = format!("{} items where {wanted} belong", items.len());
            self.fault(pointer, "wrong-length", message, format!("write {wanted} items"));
        }
        if let Some(schema) = part.get("items") {
            for (index, item) in items.iter().enumerate() {
                self.value(schema, item, &below(pointer, index));
            }
        }
    }

    fn object(&mut self, parts: &[&'a Value], map: &Map<String, Value>, pointer: &str) {
        let mut rules = ObjectRules::default();
        for part in parts {
            if !self.gather(part, map, pointer, &mut rules) {
                return;
            }
        }
        if rules.properties.is_empty() && rules.others.is_none() && !rules.closed {
            return;
        }
        let mut meant = Vec::new();
        for (key, value) in map {
            let place = below(pointer, key);
            if let Some((_, schema)) = rules.properties.iter().find(|(name, _)| *name == key) {
                self.value(schema, value, &place);
            } else if let Some(schema) = rules.others {
                self.value(schema, value, &place);
            } else if rules.closed {
                let known: Vec<&str> =
                    rules.properties.iter().map(|(name, _)| name.as_str()).collect();
                let message = format!("unknown key \"{key}\"");
                self.issues.error(&place, "unknown-key", message, suggestion(key, &known));
                let Some(name) = nearest(key, &known) else { continue };
                // It is read as the key that is meant, so that what it holds is checked too.
                if !map.contains_key(name) && !meant.contains(&name) {
                    self.damage.misspelt(place.clone(), name);
                    if let Some((_, schema)) = rules.properties.iter().find(|(key, _)| *key == name)
                    {
                        self.value(schema, value, &place);
                    }
                }
                meant.push(name);
            }
        }
        for key in rules.required {
            // A misspelt key is one mistake, not two.
            if !map.contains_key(key) && !meant.contains(&key) {
                let message = format!("\"{key}\" is missing");
                self.damage.place(below(pointer, key));
                self.issues.error(pointer, "missing-key", message, format!("add \"{key}\""));
            }
        }
    }

    /// Gathers what a part says about an object; false if its `type` fits no alternative.
    fn gather(
        &mut self,
        part: &'a Value,
        map: &Map<String, Value>,
        pointer: &str,
        rules: &mut ObjectRules<'a>,
    ) -> bool {
        if let Some(properties) = part.get("properties").and_then(Value::as_object) {
            // The tag of a chosen alternative was checked when it was chosen.
            rules.properties.extend(properties);
        }
        if let Some(required) = part.get("required").and_then(Value::as_array) {
            rules.required.extend(required.iter().filter_map(Value::as_str));
        }
        match part.get("additionalProperties").or(part.get("unevaluatedProperties")) {
            Some(Value::Bool(false)) => rules.closed = true,
            Some(schema) => rules.others = Some(schema),
            None => {}
        }
        let Some(alternatives) = part.get("oneOf").and_then(Value::as_array) else { return true };
        let word_of = |alternative: &'a Value| {
            alternative.pointer("/properties/type/const").and_then(Value::as_str)
        };
        let words: Vec<&str> = alternatives.iter().filter_map(word_of).collect();
        if words.is_empty() {
            return true;
        }
        let Some(given) = map.get("type") else {
            let hint = format!("add \"type\": {}", listed(&words));
            self.damage.place(below(pointer, "type"));
            self.issues.error(pointer, "missing-key", "\"type\" is missing", hint);
            return false;
        };
        let chosen = alternatives.iter().find(|each| word_of(each) == given.as_str());
        let Some(chosen) = chosen.filter(|_| given.is_string()) else {
            self.wrong_word(&words, given, &below(pointer, "type"));
            return false;
        };
        self.parts(chosen).into_iter().all(|each| self.gather(each, map, pointer, rules))
    }
}

fn refers_to(schema: &Value, name: &str) -> bool {
    let target = schema.get("$ref").and_then(Value::as_str);
    target.is_some_and(|target| target.rsplit('/').next() == Some(name))
}

/// The words that a part allows: `enum`, or `oneOf` constants.
fn words(part: &Value) -> Option<Vec<&str>> {
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

fn names(kinds: &Value) -> impl Iterator<Item = &str> {
    let list = kinds.as_array().map_or(std::slice::from_ref(kinds), Vec::as_slice);
    list.iter().filter_map(Value::as_str)
}

fn is_a(value: &Value, kind: &str) -> bool {
    match kind {
        "string" => value.is_string(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "boolean" => value.is_boolean(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        "null" => value.is_null(),
        _ => false,
    }
}

fn kind_name(kind: &str) -> &str {
    match kind {
        "string" => "text",
        "integer" => "a whole number",
        "number" => "a number",
        "boolean" => "true or false",
        "array" => "a list [...]",
        "object" => "an object {...}",
        other => other,
    }
}

/// A value, short enough for a message.
fn shown(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}
