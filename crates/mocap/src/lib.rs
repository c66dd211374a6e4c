//! Marker trajectories: the capture vocabulary, readers and writers, repair and filters.
//!
//! [`read_activity`] reads what a watch or a bicycle computer records: power, speed, heart rate.
//!
//! A file of any known system comes in through [`CaptureFile`], read as a stream (or from bytes,
//! [`read_bytes`]); what comes out is a [`Capture`]: labels, rate, unit and positions, a missing
//! marker NaN in all three coordinates. The format is recognised by content, never by name.
//!
//! ```
//! use mimique_mocap::{GapFill, LengthUnit, fill_gaps, read_bytes, resample};
//!
//! let text = "frame,time,chin_x [mm],chin_y [mm],chin_z [mm]\n\
//!             0,0.00,10,20,30\n1,0.01,11,20,30\n2,0.02,,,\n3,0.03,13,20,30\n4,0.04,14,20,30\n";
//! let mut capture = read_bytes(text.as_bytes())?;
//! assert_eq!((capture.rate_hz, capture.unit), (100.0, LengthUnit::Millimetre));
//!
//! // The marker is lost in one frame: a cubic goes through the others.
//! assert!(!capture.frame(2)[0].is_seen());
//! fill_gaps(&mut capture, &GapFill::default());
//! assert!((capture.frame(2)[0].x - 12.0).abs() < 1e-9);
//!
//! let twice_as_fast = resample(&capture, 200.0)?;
//! assert_eq!(twice_as_fast.frames(), 9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod activity;
mod body_joints;
mod capture;
mod error;
mod facts;
mod formats;
mod read;
mod repair;
mod write;

pub use activity::{
    Activity, ActivityColumn, ActivityFormat, Sport, activity_formats, is_activity, read_activity,
    read_activity_bytes, recognise_activity,
};
pub use body_joints::{BodyJoint, BodyJoints, BodyJointsError};
pub use capture::{Capture, Event, LengthUnit, Recording, WeightOptions, WeightsTable};
pub use error::{ReadError, WriteError};
pub use facts::{CaptureFacts, Frozen, Jump, MarkerPresence, Stillest, stillest};
pub use formats::{
    C3dOptions, C3dStorage, Format, Processor, VertexArray, WIDE_CSV, formats, npy_header,
    read_vertex_array, write_c3d, write_csv, write_trc,
};
pub use read::{
    CaptureFile, ReadOptions, read, read_bytes, read_recording, read_weights, read_weights_file,
    recognise,
};
pub use repair::{
    ChangedFrame, FilledGap, FilterError, Gap, GapFill, GapRepair, LowPass, RepairError,
    RepairPlan, RepairRecord, Repaired, RepairedGap, RepairedSwap, ResampleError, Spike,
    Stabilisation, StabiliseError, Swap, fill_gaps, gaps, repair, resample, stabilise,
};
pub use write::{capture_file, weights_files, written_columns};
