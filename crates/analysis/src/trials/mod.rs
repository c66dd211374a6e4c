//! The trials of an export, with the study's exclusions applied, and what was measured in them.

pub(crate) mod answer_distribution;
pub(crate) mod asked_question;
pub(crate) mod column;
pub(crate) mod combinations;
pub(crate) mod error;
pub(crate) mod exclusion_rates;
pub(crate) mod export;
pub(crate) mod matching;
pub(crate) mod measure;
mod omission;
pub(crate) mod reason;
pub(crate) mod rule;
pub(crate) mod screening;
mod sessions;
pub(crate) mod stimulus_measures;
pub(crate) mod straight_lining;
pub(crate) mod trial_rows;
pub(crate) mod versions;
