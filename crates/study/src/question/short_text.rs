//! A line of text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::free_text::FreeText;

/// Most characters, if the study does not say.
pub const SHORT_TEXT: usize = 200;

/// A line of text. The answer is the text.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct ShortText {
    /// Most characters; 200 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_length: Option<usize>,
}

impl FreeText for ShortText {
    const LONG: bool = false;
    const MOST: usize = SHORT_TEXT;

    fn max_length(&self) -> Option<usize> {
        self.max_length
    }
}
