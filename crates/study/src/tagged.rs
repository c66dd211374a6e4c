//! Reading and writing enums that are tagged by `type`, through one JSON value.
//!
//! serde's own tagged, untagged and flattened types buffer what they read in a type of their own,
//! and so compile every reader once more for it; in the participant's page that was a third of the
//! module. Here everything is read from one type, [`Value`], and the derived readers stay.

use serde::de::{DeserializeOwned, Deserializer, Error};
use serde::ser::{Serialize, Serializer};
use serde_json::{Map, Value};

use crate::json_reader::read_value;

/// `{"type": "likert", "numItems": 7}` -> `{"likert": {"numItems": 7}}`; without further keys ->
/// `"likert"`.
pub fn outside_from_inside(value: Value) -> Result<Value, &'static str> {
    let Value::Object(mut map) = value else { return Err("an object with a \"type\" is missing") };
    match map.remove("type") {
        Some(Value::String(word)) if map.is_empty() => Ok(Value::String(word)),
        Some(Value::String(word)) => Ok(Value::Object(Map::from_iter([(word, map.into())]))),
        _ => Err("\"type\" is missing"),
    }
}

/// The way back.
pub fn inside_from_outside(value: Value) -> Value {
    let (word, rest) = match value {
        Value::String(word) => (word, Map::new()),
        Value::Object(map) => match map.into_iter().next() {
            Some((word, Value::Object(rest))) => (word, rest),
            Some((word, _)) => (word, Map::new()),
            None => return Value::Null,
        },
        other => return other,
    };
    let mut map = rest;
    map.insert("type".to_owned(), Value::String(word));
    Value::Object(map)
}

/// Reads a JSON value, and from it what is wanted.
pub fn read<'de, D: Deserializer<'de>, T>(
    deserializer: D,
    from: impl FnOnce(Value) -> Result<T, serde_json::Error>,
) -> Result<T, D::Error> {
    let value = <Value as serde::Deserialize>::deserialize(deserializer)?;
    from(value).map_err(D::Error::custom)
}

/// Reads a value of a type.
pub fn from<T: DeserializeOwned>(value: Value) -> Result<T, serde_json::Error> {
    read_value(value)
}

/// A mistake with these words.
pub fn mistake(words: &str) -> serde_json::Error {
    serde_json::Error::custom(words)
}

/// Writes what was written with its tag outside.
pub fn write<S: Serializer>(
    outside: Result<Value, serde_json::Error>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    use serde::ser::Error as _;
    // What a `Value` cannot hold (a map whose keys are no texts) no type here has. The error's own words
    // would bring those of every error of reading and of files into the page.
    let outside = outside.map_err(|_| S::Error::custom("a value that is no JSON"))?;
    inside_from_outside(outside).serialize(serializer)
}

/// Reads and writes an enum with its tag inside. The enum derives both with
/// `#[serde(remote = "Self")]`, which leaves the tag outside.
#[macro_export]
macro_rules! tagged_by_type {
    ($name:ty) => {
        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                $crate::tagged::read(deserializer, |value| {
                    let outside = $crate::tagged::outside_from_inside(value)
                        .map_err($crate::tagged::mistake)?;
                    // The derived reader.
                    <$name>::deserialize($crate::json_reader::Json(outside))
                })
            }
        }

        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                // The derived writer.
                $crate::tagged::write(
                    <$name>::serialize(self, serde_json::value::Serializer),
                    serializer,
                )
            }
        }
    };
}
