//! What looks wrong: labels, head markers, shapes of a bank.

mod bank;
mod gaze;
mod head;
mod labels;
mod smoothing;
mod take;

pub use bank::{BankDiagnosis, DependentShape, MarkerDiagnosis};
pub use gaze::{GazeBeyond, GazeFault, GazeStatistics};
pub(crate) use head::moving_skin;
pub use head::{HeadMarker, STILL_MM};
pub use labels::{LabelFault, LabelProblem};
pub use smoothing::{ADVISED_SMOOTHING, SmoothingAdvice, SmoothingReason};
pub(crate) use take::is_fitted;
