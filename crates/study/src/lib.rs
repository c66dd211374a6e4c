#![doc = include_str!("../README.md")]

mod answer;
mod canonical;
mod check;
mod event;
pub mod flow;
mod json_reader;
mod order;
pub mod responses;
mod study_file;
mod tagged;
pub mod text;
pub mod wire;

pub use answer::{AnswerProblem, LONG_TEXT, SHORT_TEXT};
pub use canonical::{canonical, config_hash};
pub use check::{
    CheckedStudy, FileLookup, Issue, Report, SCHEMA_ADDRESS, Severity, check, json_schema,
};
pub use event::{Answers, Client, EventKind, PlayLog, ShownBeside};
pub use order::{Draw, OrderError, OrderedItem, Stream, option_order, order};
pub use study_file::*;
