#![doc = include_str!("../README.md")]

// The derived readers name this crate.
extern crate self as mimique_study;

mod answer;
mod canonical;
mod check;
mod event;
pub mod flow;
pub mod from_json;
mod instant;
mod json_reader;
pub mod json_text;
mod order;
pub mod responses;
mod session_file;
mod sorted_map;
mod study_file;
mod tagged;
pub mod text;
pub mod wire;

pub use answer::{AnswerProblem, LONG_TEXT, SHORT_TEXT};
pub use canonical::{canonical, config_hash};
pub use check::{
    CheckedStudy, FileLookup, Issue, Report, SCHEMA_ADDRESS, Severity, check, json_schema,
};
pub use event::{Answers, Calibrated, Client, Display, EventKind, PlayLog, ShownBeside};
pub use instant::instant_ms;
pub use mimique_solver::number_text;
pub use order::{Draw, OrderError, OrderedItem, Stream, drawn_condition, option_order, order};
pub use session_file::{SessionFile, SessionFileError};
pub use sorted_map::SortedMap;
pub use study_file::*;
