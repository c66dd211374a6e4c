//! Reading JSON by one way only: text to tree, tree to type. A second way would double the readers of
//! every type in the module that participants download.

use mimique_study::from_json::{FromJson, Mistake};
use serde_json::Value;

/// Reads a type from text.
pub fn read<T: FromJson>(text: &str) -> Result<T, Mistake> {
    let value: Value = serde_json::from_str(text).map_err(|e| Mistake::new(&e.to_string()))?;
    T::from_json(&value)
}
