#![doc = include_str!("../README.md")]

mod event;
pub mod flow;
mod plan;
mod record;
pub mod rows;
mod session_file;
mod site_file;
mod standing;
pub mod wire;

pub use event::{Calibrated, Client, EventKind, PlayLog, ShownBeside};
pub use record::{Attempt, EarlyEnd, EndReason, FinishedStep, Record};
pub use session_file::{SessionFile, SessionFileError, WrongLine};
pub use site_file::SiteFile;
pub use standing::Standing;
