//! JSON read key by key, so that what is wrong is named by its place.

use serde_json::{Map, Value};

use crate::error::{ExertionError, finite};

/// A text as JSON.
pub(crate) fn parse(text: &str) -> Result<Value, ExertionError> {
    serde_json::from_str(text)
        .map_err(|error| ExertionError::Json { line: error.line(), column: error.column() })
}

/// An object at a place.
pub(crate) struct Object<'a> {
    place: &'a str,
    members: &'a Map<String, Value>,
}

impl<'a> Object<'a> {
    /// What must be an object.
    pub(crate) fn of(place: &'a str, value: &'a Value) -> Result<Self, ExertionError> {
        match value {
            Value::Object(members) => Ok(Self { place, members }),
            _ => Err(ExertionError::Shape { place: place.to_owned(), needed: "an object" }),
        }
    }

    /// Its members, each with its place and key.
    pub(crate) fn members(&self) -> impl Iterator<Item = (String, &'a str, &'a Value)> {
        self.members.iter().map(|(key, value)| (joined(self.place, key), key.as_str(), value))
    }

    /// A member that must be there.
    pub(crate) fn get(&self, key: &str) -> Result<(String, &'a Value), ExertionError> {
        let place = joined(self.place, key);
        match self.members.get(key) {
            Some(value) => Ok((place, value)),
            None => Err(ExertionError::Shape { place, needed: "a value" }),
        }
    }

    /// A member that may be missing.
    pub(crate) fn find(&self, key: &str) -> Option<(String, &'a Value)> {
        self.members.get(key).map(|value| (joined(self.place, key), value))
    }
}

/// A place and a key below it.
pub(crate) fn joined(place: &str, key: impl std::fmt::Display) -> String {
    if place.is_empty() { key.to_string() } else { format!("{place}/{key}") }
}

/// What must be a number.
pub(crate) fn number(place: &str, value: &Value) -> Result<f64, ExertionError> {
    finite(place, value.as_f64().unwrap_or(f64::NAN))
}

/// What must be a list.
pub(crate) fn list<'a>(place: &str, value: &'a Value) -> Result<&'a [Value], ExertionError> {
    match value {
        Value::Array(items) => Ok(items),
        _ => Err(ExertionError::Shape { place: place.to_owned(), needed: "a list" }),
    }
}

/// What must be a list of numbers.
pub(crate) fn numbers(place: &str, value: &Value) -> Result<Vec<f64>, ExertionError> {
    let items = list(place, value)?.iter().enumerate();
    items.map(|(i, item)| number(&joined(place, i), item)).collect()
}
