//! Keys and types, against the schema that the Rust types generate: all mistakes, not the first.

use serde_json::{Map, Value};

use super::damage::Damage;
use super::issue::{Issues, below};
use super::nearest::nearest;
use super::problem::Problem;
use super::schema::{Schemas, has_one, types_of, whole_range, words};
use super::values::{Counted, JsonType, Names, Nearest, Shown, Wanted};

/// Examines a file; returns the pointers of all its localised texts, and what cannot be read.
pub(super) fn examine(schema: &Value, value: &Value, issues: &mut Issues) -> (Vec<String>, Damage) {
    let schemas = Schemas { root: schema };
    let mut walk = Walk { schemas, issues, texts: Vec::new(), damage: Damage::default() };
    walk.value(schema, value, "");
    (walk.texts, walk.damage)
}

struct Walk<'a> {
    schemas: Schemas<'a>,
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
        let parts = self.schemas.parts(schema);
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

    fn any_of(&mut self, alternatives: &'a [Value], value: &Value, pointer: &str) {
        let fitting = self.schemas.fitting(alternatives, value);
        match fitting {
            Some(alternative) => self.value(alternative, value, pointer),
            None => {
                let mut types: Vec<JsonType> = Vec::new();
                for alternative in alternatives {
                    for part in self.schemas.parts(alternative) {
                        types.extend(part.get("type").into_iter().flat_map(types_of));
                    }
                }
                types.dedup();
                self.wrong_type(Wanted::Types(types), value, pointer);
            }
        }
    }

    fn has_type(&mut self, types: &Value, part: &Value, value: &Value, pointer: &str) -> bool {
        if !has_one(types, value) {
            self.wrong_type(Wanted::Types(types_of(types).collect()), value, pointer);
            return false;
        }
        let Some(number) = value.as_f64() else { return true };
        let Some((least, most)) = whole_range(part) else { return true };
        if !(least..=most).contains(&number) {
            self.fault(pointer, Problem::WholeNotInRange { found: value.clone(), least, most });
            return false;
        }
        true
    }

    fn wrong_type(&mut self, wanted: Wanted, value: &Value, pointer: &str) {
        self.fault(pointer, Problem::WrongType { found: Shown(value.clone()), wanted });
    }

    /// Says that a value cannot be read as it stands.
    fn fault(&mut self, pointer: &str, problem: Problem) {
        self.damage.place(pointer.to_owned());
        self.issues.error(pointer, problem);
    }

    fn wrong_word(&mut self, words: &[&str], value: &Value, pointer: &str) {
        let names = Names::of(words);
        match value.as_str() {
            Some(word) => {
                let (word, known) = (word.to_owned(), Nearest::to(word, words));
                self.fault(pointer, Problem::UnknownWord { word, words: names, known });
            }
            None => self.wrong_type(Wanted::Words(names), value, pointer),
        }
    }

    fn array(&mut self, part: &'a Value, items: &[Value], pointer: &str) {
        let limit = |key| part.get(key).and_then(Value::as_u64).map(|count| count as usize);
        if limit("minItems").is_some_and(|least| items.len() < least)
            || limit("maxItems").is_some_and(|most| items.len() > most)
        {
            let wanted = limit("minItems").unwrap_or_default();
            self.fault(pointer, Problem::ItemCount { found: Counted(items.len(), "item"), wanted });
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
                let problem =
                    Problem::UnknownKey { key: key.clone(), known: Nearest::to(key, &known) };
                self.issues.error(&place, problem);
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
                self.damage.place(below(pointer, key));
                self.issues.error(pointer, Problem::MissingKey { key: key.to_owned() });
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
            self.damage.place(below(pointer, "type"));
            self.issues.error(pointer, Problem::MissingType { words: Names::of(&words) });
            return false;
        };
        let chosen = alternatives.iter().find(|each| word_of(each) == given.as_str());
        let Some(chosen) = chosen.filter(|_| given.is_string()) else {
            self.wrong_word(&words, given, &below(pointer, "type"));
            return false;
        };
        self.schemas.parts(chosen).into_iter().all(|each| self.gather(each, map, pointer, rules))
    }
}

fn refers_to(schema: &Value, name: &str) -> bool {
    let target = schema.get("$ref").and_then(Value::as_str);
    target.is_some_and(|target| target.rsplit('/').next() == Some(name))
}
