//! Figures that several reports share, each with alternative text and its data as a table.

mod confusion;
pub mod courses;
mod forest;
mod ranking;

pub use confusion::{ConfusionRow, ConfusionWords, confusion_matrix};
pub use courses::{CoursePanel, LINES, time_courses};
pub use forest::{DrawnInterval, forest_row};
pub use ranking::{Ranked, ranking};

use crate::svg::WIDTH;

/// Left edge of the plotting area beside row labels.
pub const LEFT: f64 = 116.0;
/// Its right edge.
pub const RIGHT: f64 = WIDTH - 10.0;
