//! What the writers of text formats share.

use crate::WriteError;
use std::fmt::Write as _;

/// Refuse a label that a line of text cannot hold as it is.
pub(crate) fn check_label(label: &str) -> Result<(), WriteError> {
    let what = if label.is_empty() {
        "a label without characters"
    } else if label.chars().any(char::is_control) {
        "a control character in the label"
    } else if label.trim() != label {
        "blanks around the label"
    } else {
        return Ok(());
    };
    Err(WriteError::Label { label: label.to_owned(), what })
}

/// Append formatted text.
pub(crate) fn push(text: &mut String, arguments: std::fmt::Arguments<'_>) {
    // Writing to a String does not fail.
    let _ = text.write_fmt(arguments);
}
