//! What is worth saying of a computation that succeeded: codes with values; remedies are the edges', which know
//! what their readers can do.

use mimique_mocap::{Capture, LengthUnit};
use serde::Serialize;

use crate::body::Body;
use crate::chain::{Clip, Series};
use crate::heart::WORK_LIMIT;
use crate::person::Person;

/// How far the unit of a file may be from the one that fits the legs before it is said.
const UNIT: f64 = 0.2;

/// Something worth saying of a computation.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error, Serialize)]
#[serde(tag = "code", rename_all = "kebab-case", rename_all_fields = "camelCase")]
pub enum Finding {
    /// The law of the thesis takes the heart to its maximum.
    #[error(
        "the heart passes nine tenths of its reserve at {second} s; the law of the thesis has no steady state, \
         constant work takes it to its maximum"
    )]
    NearMaximum {
        /// The first second over nine tenths.
        second: usize,
    },
    /// Work that no body does.
    #[error(
        "{seconds} seconds, from {first} s on, have more than {WORK_LIMIT} J/kg, and count as that for the heart; \
         look for a fault of the motion, or of its rate"
    )]
    OverLimit {
        /// How many seconds.
        seconds: usize,
        /// The first of them.
        first: usize,
    },
    /// Curves that expressivity takes out of their range.
    #[error("{cut} of {frames} frames have a curve that is cut at the end of its range")]
    CutFrames {
        /// Frames with a curve that is cut.
        cut: usize,
        /// Frames of the clip.
        frames: usize,
    },
    /// A motion that is shorter than was asked for.
    #[error(
        "repeated {times:.1} times: the work is repeated, not the motion, whose jump back would be work"
    )]
    Repeated {
        /// What was asked for, in lengths of the motion.
        times: f64,
    },
    /// The unit of the file does not fit the person's legs.
    #[error(
        "the legs are made those of a person of {stature_m} m; by the file's unit ({}) the person would be \
         {by_unit_m:.2} m tall",
        LengthUnit::symbol(*.unit)
    )]
    OtherUnit {
        /// The unit of the file.
        unit: LengthUnit,
        /// The person's stature, m.
        stature_m: f64,
        /// What the stature would be by the file's unit, m.
        by_unit_m: f64,
    },
    /// Noise that the low-pass takes away.
    #[error("the motion jitters: without the low-pass its work would be {ratio:.1} times as much")]
    Jitter {
        /// Work without the low-pass in works with it.
        ratio: f64,
    },
}

impl Finding {
    /// Whether the numbers may be wrong, rather than that something should be known of them.
    pub fn is_warning(self) -> bool {
        matches!(self, Self::NearMaximum { .. } | Self::OverLimit { .. } | Self::CutFrames { .. })
    }

    /// Of a series and a clip of it.
    pub fn of_clip(series: &Series, clip: &Clip) -> Vec<Self> {
        let mut all = Vec::new();
        all.extend(series.near_maximum.map(|second| Self::NearMaximum { second }));
        let seconds = series.over_limit.len();
        all.extend(series.over_limit.first().map(|&first| Self::OverLimit { seconds, first }));
        let (cut, frames) = (clip.controls.cut_frames, clip.times.len());
        all.extend((cut > 0).then_some(Self::CutFrames { cut, frames }));
        all
    }

    /// That the capture's unit would make somebody of another stature, where the legs gave the unit.
    pub fn of_unit(capture: &Capture, body: &Body, person: &Person) -> Option<Self> {
        let own = capture.unit.metres() / body.metres_per_unit();
        let stature_m = person.spec().height_m;
        let (unit, by_unit_m) = (capture.unit, stature_m * own);
        ((own - 1.0).abs() > UNIT).then_some(Self::OtherUnit { unit, stature_m, by_unit_m })
    }
}
