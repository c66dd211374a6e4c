//! Reading JSON by one way only: text to tree, tree to type. A second way would double the readers of
//! every type in the module that participants download.

use serde::de::DeserializeOwned;
use serde_json::Value;

/// Reads a type from text.
pub fn read<T: DeserializeOwned>(text: &str) -> Result<T, serde_json::Error> {
    T::deserialize(&serde_json::from_str::<Value>(text)?)
}
