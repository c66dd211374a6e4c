#![doc = include_str!("../README.md")]

mod admission;
mod event;
pub mod flow;
mod panel;
mod plan;
mod record;
pub mod rows;
mod session_file;
mod site_file;
mod sound_answers;
mod standing;
mod tracked_face;
pub mod wire;

pub use admission::{Admission, Misfit, SessionLimits};
pub use event::{
    Calibrated, ChosenClips, Client, EventKind, LevelShown, PlayLog, ShownBeside, ShownInPanel,
    SoundLog, StageFailure,
};
pub use flow::SOUND_HEARD;
pub use record::{Attempt, CutShort, EarlyEnd, EndReason, FinishedStep, Record};
pub use session_file::{SessionFile, SessionFileError, WrongLine};
pub use site_file::SiteFile;
pub use standing::Standing;
pub use tracked_face::{TrackedFace, TrackedPicture};
