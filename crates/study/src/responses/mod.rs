//! Responses: the events of sessions -> tables that scripts and statistics read.
//!
//! * [`tidy`]: one row a participant x trial x response; every factor is a column, and so is every
//!   answer about the participant, because analyses group by them.
//! * [`wide`]: one row a participant; one column a trial x response.
//!
//! A table is columns with their descriptions and rows of plain JSON values; who writes CSV, JSON or
//! Psych-DS does so from there ([`psych_ds_description`] is the data dictionary).

mod cells;
mod column;
mod fixed_columns;
mod psych_ds;
mod session;
mod tidy;
mod wide;

pub use cells::iso_time;
pub use column::{Column, ColumnKind, Table};
pub use fixed_columns::{ASSIGNED_CONDITION, EXCLUSION_COLUMNS, FIXED_COLUMNS, is_reserved_column};
pub use psych_ds::psych_ds_description;
pub use session::{SessionRecord, failed_attention_checks, session_status};
pub use tidy::tidy;
pub use wide::wide;
