//! Reading and writing JSON by one way only: text, tree, type. A second way would double the readers
//! of every type in the module that participants download.

use mimique_study::from_json::{self, FromJson, Mistake};
use mimique_study::json_text;
use serde::Serialize;

/// Reads a type from text.
pub fn read<T: FromJson>(text: &str) -> Result<T, Mistake> {
    from_json::read(&json_text::read_with(text, number)?)
}

/// Writes a type.
pub fn write(from: &impl Serialize) -> String {
    json_text::write(&serde_json::to_value(from).unwrap_or_default())
}

fn number(text: &str) -> Option<f64> {
    text.parse().ok()
}
