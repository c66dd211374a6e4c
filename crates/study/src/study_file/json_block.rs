//! Blocks that pages carry as JSON.

use std::marker::PhantomData;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A block as pages carry it: JSON, of which they read a few words and hand on the rest to a module that studies with
/// such a block alone load, or of which they are sent the trials that it makes. A reader of its own would weigh on every
/// study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent, bound = "")]
pub struct JsonBlock<T>(pub Value, #[serde(skip)] PhantomData<fn() -> T>);

impl<T> JsonBlock<T> {
    /// The block of this JSON.
    pub fn new(json: Value) -> Self {
        Self(json, PhantomData)
    }

    /// Identifier of the question of every trial.
    pub fn question(&self) -> &str {
        self.0["question"].as_str().unwrap_or_default()
    }
}

impl<T: DeserializeOwned> JsonBlock<T> {
    /// The block.
    ///
    /// # Errors
    /// What is wrong with it, where nobody has checked the study.
    pub fn read(&self) -> Result<T, serde_json::Error> {
        T::deserialize(&self.0)
    }
}
