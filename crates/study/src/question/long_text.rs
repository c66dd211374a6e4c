//! Several lines of text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::free_text::FreeText;

/// Most characters, if the study does not say.
pub const LONG_TEXT: usize = 5_000;

/// Several lines of text. The answer is the text.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase")]
pub struct LongText {
    /// Most characters; 5,000 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_length: Option<usize>,
}

impl FreeText for LongText {
    const LONG: bool = true;
    const MOST: usize = LONG_TEXT;

    fn max_length(&self) -> Option<usize> {
        self.max_length
    }
}
