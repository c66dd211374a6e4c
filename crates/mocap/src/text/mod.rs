//! Text formats: decoding, lines, fields, numbers; a file a format.

mod document;
mod table;
pub(crate) mod wide_csv;

pub(crate) use document::{Delimiter, Document, coordinate, split_fields};
pub(crate) use table::Table;
