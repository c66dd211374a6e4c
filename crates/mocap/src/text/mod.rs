//! Text formats: decoding, lines, fields, numbers; a file a format.

pub(crate) mod bvh;
mod fields;
mod lines;
pub(crate) mod live_link;
pub(crate) mod long_csv;
pub(crate) mod motive_csv;
pub(crate) mod qtm_tsv;
mod table;
pub(crate) mod trc;
mod utf16;
pub(crate) mod vicon_csv;
pub(crate) mod wide_csv;
mod write_csv;

pub(crate) use fields::{Delimiter, coordinate, plain_row, split_fields};
pub(crate) use lines::{Lines, TextForm};
pub(crate) use table::Table;
pub use trc::write_trc;
pub(crate) use write_csv::check_label;
pub use write_csv::write_csv;
