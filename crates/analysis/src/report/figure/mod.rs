//! The figures of a report, each with alternative text and its data as a table.

mod boxes;
pub(crate) mod conditions;
mod confusion;
mod courses;
mod detection;
mod differences;
mod equivalence;
pub(crate) mod flow_chart;
mod likert;
mod mixed_model;
pub(crate) mod people;
mod ranking;
mod roc;
mod scatter;
mod shares;
mod stacked;
pub(crate) mod svg;
mod traces;

pub(crate) use boxes::boxes;
pub(crate) use confusion::confusion;
pub use confusion::{ConfusionRow, ConfusionWords, confusion_matrix};
pub(crate) use courses::LINES;
pub use courses::{CoursePanel, time_courses};
pub(crate) use detection::{DetectionPanel, DetectionPoints, detection_planes};
pub(crate) use differences::differences;
pub(crate) use equivalence::{EquivalenceInterval, equivalence_zone};
pub(crate) use likert::likert;
pub(crate) use mixed_model::{deviations, model_shares};
pub(crate) use ranking::ranking;
pub(crate) use roc::roc_curves;
pub(crate) use scatter::{ScatterPanel, scatter};
pub(crate) use shares::shares;
pub(crate) use traces::traces;

use crate::report::figure::svg::WIDTH;

/// Left edge of the plotting area beside row labels.
const LEFT: f64 = 116.0;
/// Its right edge.
const RIGHT: f64 = WIDTH - 10.0;
