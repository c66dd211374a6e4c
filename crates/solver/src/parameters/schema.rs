//! The JSON Schema (2020-12) of a parameter.

use serde_json::{Map, Value, json};

use crate::parameters::kind::{Kind, Quantity, Range};
use crate::parameters::table::Parameter;

impl Parameter {
    /// Type, range, default and description.
    pub fn json_schema(&self) -> Value {
        let number = || ranged(json!({ "type": "number" }), &self.about.range);
        // softBounds and bounds: the order of the two ends is more than a schema can say.
        let interval = json!({
            "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2,
        });
        let by_name = |of: Value| json!({ "type": "object", "additionalProperties": of });
        let mut schema = match self.kind {
            Kind::Number => or_null(number()),
            Kind::WholeNumber => {
                or_null(ranged(json!({ "type": "integer", "format": "uint32" }), &self.about.range))
            }
            Kind::Interval => or_null(interval),
            Kind::Word(words) => {
                json!({ "anyOf": [{ "type": "string", "enum": words }, { "type": "null" }] })
            }
            Kind::Names => json!({ "type": "array", "items": { "type": "string" } }),
            Kind::NumberByName => by_name(number()),
            Kind::IntervalByName => by_name(interval),
        };
        schema["description"] = Value::String(self.description());
        if let Some(default) = self.common_default() {
            schema["default"] = default;
        }
        schema
    }

    /// The help text with unit, default and users.
    fn description(&self) -> String {
        let mut text = self.help.to_owned();
        if self.about.quantity != Quantity::Ratio {
            text += &format!(" Unit: {}.", self.about.quantity.symbol());
        }
        if let Some(zero) = self.about.zero {
            text += &format!(" 0: {zero}.");
        }
        if let Some(default) = self.default_text() {
            text += &format!(" Default: {default}.");
        }
        let methods: Vec<&str> = self.methods().map(|method| method.name()).collect();
        text + &format!(" Used by {}.", methods.join(", "))
    }

    /// The default, where it is the same for all methods that use the parameter.
    fn common_default(&self) -> Option<Value> {
        let mut defaults = self.methods().map(|method| self.default_of(method));
        let first = defaults.next()??;
        defaults.all(|other| other.as_ref() == Some(&first)).then_some(first)
    }

    /// The default in words: `0.3 for lsts, otherwise 0.5`; `None` where there is none.
    pub fn default_text(&self) -> Option<String> {
        if let Some(found_by) = self.about.found_by {
            return Some(found_by.to_owned());
        }
        let mut groups: Vec<(Value, Vec<&str>)> = Vec::new();
        for method in self.methods() {
            let default = self.default_of(method)?;
            match groups.iter_mut().find(|(value, _)| *value == default) {
                Some((_, methods)) => methods.push(method.name()),
                None => groups.push((default, vec![method.name()])),
            }
        }
        // The value of most methods last.
        groups.sort_by_key(|(_, methods)| methods.len());
        let (usual, others) = groups.split_last()?;
        let words =
            others.iter().map(|(value, of)| format!("{} for {}", plain(value), of.join(", ")));
        let usual = match others {
            [] => plain(&usual.0),
            _ => format!("otherwise {}", plain(&usual.0)),
        };
        Some(words.chain([usual]).collect::<Vec<_>>().join(", "))
    }
}

/// A value without quotes, and whole numbers without a decimal point.
fn plain(value: &Value) -> String {
    match value {
        Value::String(word) => word.clone(),
        Value::Number(number) => number.as_f64().map_or_else(String::new, |x| x.to_string()),
        Value::Array(items) => items.iter().map(plain).collect::<Vec<_>>().join(":"),
        other => other.to_string(),
    }
}

fn ranged(mut schema: Value, range: &Range) -> Value {
    if range.low.is_finite() {
        let key = if range.low_included { "minimum" } else { "exclusiveMinimum" };
        schema[key] = number(range.low);
    }
    if range.high.is_finite() {
        schema["maximum"] = number(range.high);
    }
    schema
}

/// Whole numbers without a decimal point.
fn number(x: f64) -> Value {
    if x.fract() == 0.0 { json!(x as i64) } else { json!(x) }
}

/// The same, or null for what is not given.
fn or_null(mut schema: Value) -> Value {
    schema["type"] = json!([schema["type"], "null"]);
    schema
}

/// The schema of every parameter by its key.
pub fn parameter_schemas() -> Map<String, Value> {
    let rows = crate::parameters::table::PARAMETERS.iter();
    rows.map(|row| (row.key.to_owned(), row.json_schema())).collect()
}
