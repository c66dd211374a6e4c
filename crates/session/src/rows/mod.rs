//! Rows: the events of sessions -> tables that scripts and statistics read.
//!
//! * [`tidy`]: one row a participant x trial x response; every factor is a column, and so is every
//!   answer about the participant, because analyses group by them.
//! * [`wide`]: one row a participant; one column a trial x response.
//!
//! Both have a form that is made once for a version of a study ([`TidyForm`], [`WideForm`]) and gives the rows
//! of one session at a time.
//!
//! A table is columns with their descriptions and rows of plain JSON values; who writes CSV, JSON or
//! Psych-DS does so from there ([`psych_ds_description`] is the data dictionary).

mod cells;
mod column;
mod faces;
mod levels;
mod pairs;
mod panels;
mod psych_ds;
mod scaling;
mod step_cells;
mod study_columns;
mod tidy;
mod wide;

pub use column::{Column, Table};
pub use psych_ds::{psych_ds_data_file, psych_ds_description, psych_ds_keyword};
pub use study_columns::exclusion_columns;
pub use tidy::{TidyForm, tidy};
pub use wide::{WideForm, wide};

use crate::wire::{Event, SessionStarted};

/// One session as it is stored.
#[derive(Debug, Clone, Copy)]
pub struct SessionRecord<'a> {
    /// As at its start.
    pub started: &'a SessionStarted,
    /// Its events, in ascending order of sequence.
    pub events: &'a [Event],
}
