//! What the text formats share: decoding, lines, fields, numbers, rows of a table.

mod fields;
mod lines;
mod table;
mod utf16;
mod write;

pub(crate) use fields::{Delimiter, Row, coordinate, plain_row, split_fields};
pub(crate) use lines::{Lines, TextForm};
pub(crate) use table::{Table, frame_number, snapped_rate};
pub(crate) use write::{check_label, push};
