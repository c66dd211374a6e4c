//! Marker trajectories: the capture vocabulary, readers and writers, repair and filters.
//!
//! A file of any known system comes in through [`CaptureFile`], read as a stream (or from bytes,
//! [`read_bytes`]); what comes out is a [`Capture`]: labels, rate, unit and positions, a missing
//! marker NaN in all three coordinates. The format is recognised by content, never by name.

mod c3d;
mod capture;
mod error;
mod facts;
mod format;
mod gaps;
mod low_pass;
mod neutral;
mod plausibility;
mod read;
mod recording;
mod repair;
mod resample;
mod rigid_fit;
mod source;
mod stabilise;
mod sudden;
mod text;
mod unit;
mod weight_take;

pub use c3d::{C3dOptions, C3dStorage, Processor, write_c3d};
pub use capture::{Capture, LengthUnit};
pub use error::{ReadError, WriteError};
pub use facts::{CaptureFacts, Frozen, Jump, MarkerPresence};
pub use format::Format;
pub use gaps::{FilledGap, Gap, GapFill, GapRepair, fill_gaps, gaps};
pub use low_pass::{FilterError, LowPass};
pub use neutral::{Stillest, stillest};
pub use read::{
    CaptureFile, ReadOptions, read, read_bytes, read_recording, read_weights, recognise,
};
pub use recording::{Event, Recording};
pub use repair::{
    ChangedFrame, MendedSwap, RepairError, RepairPlan, RepairRecord, Repaired, RepairedGap, Spike,
    Swap, repair,
};
pub use resample::{ResampleError, resample};
pub use stabilise::{Stabilisation, StabiliseError, stabilise};
pub use text::{write_csv, write_trc};
pub use weight_take::WeightTake;
