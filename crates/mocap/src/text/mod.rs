//! Text formats: decoding, lines, fields, numbers; a file a format.

mod document;
mod table;
pub(crate) mod wide_csv;
mod write_csv;

pub(crate) use document::{Delimiter, Document, coordinate, split_fields};
pub(crate) use table::Table;
pub(crate) use write_csv::check_label;
pub use write_csv::write_csv;
