//! A capture repaired: swaps, spikes, gaps; then filtered, resampled, its head held still. What was
//! changed is recorded frame by frame.

pub(crate) mod abrupt_steps;
pub(crate) mod gaps;
mod low_pass;
mod record;
mod resample;
mod spikes;
mod stabilise;
mod swaps;

use crate::Capture;
use mimique_geometry::Point;

pub use gaps::{FilledGap, Gap, GapFill, GapRepair, fill_gaps, gaps};
pub use low_pass::{FilterError, LowPass};
pub use record::{ChangedFrame, RepairRecord, RepairedGap};
pub use resample::{ResampleError, resample};
pub use spikes::Spike;
pub use stabilise::{Stabilisation, StabiliseError, stabilise};
pub(crate) use swaps::swaps_and_others;
pub use swaps::{RepairedSwap, Swap};

/// What is done to a capture, in this order.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RepairPlan {
    /// Put labels that changed places back.
    pub repair_swaps: bool,
    /// Take spikes out; what they leave is filled as a gap.
    pub repair_spikes: bool,
    /// How far gaps are filled.
    pub gaps: GapFill,
    /// Low-pass of every coordinate.
    pub low_pass: Option<LowPass>,
    /// Frames per second of what comes out.
    pub resample_hz: Option<f64>,
    /// Labels of the markers that hold the head still; none = the head is left alone.
    pub head: Vec<String>,
}

impl Default for RepairPlan {
    /// Swaps, spikes and gaps; no filter, no resampling, the head left alone.
    fn default() -> Self {
        Self {
            repair_swaps: true,
            repair_spikes: true,
            gaps: GapFill::default(),
            low_pass: None,
            resample_hz: None,
            head: Vec::new(),
        }
    }
}

/// Why a capture cannot be repaired as planned.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RepairError {
    /// The low-pass does not fit the rate.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// The rate is none.
    #[error(transparent)]
    Resample(#[from] ResampleError),
    /// The head's markers cannot be used.
    #[error(transparent)]
    Stabilise(#[from] StabiliseError),
}

/// A repaired capture and what was done.
#[derive(Debug, Clone, PartialEq)]
pub struct Repaired {
    /// The capture.
    pub capture: Capture,
    /// What was done to it.
    pub record: RepairRecord,
}

/// Repair a capture.
///
/// # Errors
/// [`RepairError`] when filter, rate or head markers of the plan cannot be used.
pub fn repair(mut capture: Capture, plan: &RepairPlan) -> Result<Repaired, RepairError> {
    if let Some(low_pass) = plan.low_pass {
        low_pass.check(capture.rate_hz)?;
    }
    let (frames, rate_hz) = (capture.frames(), capture.rate_hz);
    let swaps = if plan.repair_swaps { swaps::repair_swaps(&mut capture) } else { Vec::new() };
    let spikes = if plan.repair_spikes { spikes::find_spikes(&capture) } else { Vec::new() };
    let markers = capture.labels.len();
    for (marker, spike) in &spikes {
        for frame in spike.first..spike.end {
            capture.positions[frame * markers + marker] = Point::UNSEEN;
        }
    }
    let gaps: Vec<RepairedGap> = fill_gaps(&mut capture, &plan.gaps)
        .into_iter()
        .map(|filled| RepairedGap {
            label: capture.labels[filled.gap.marker].clone(),
            first: filled.gap.first,
            end: filled.gap.end,
            repair: filled.repair,
        })
        .collect();
    let spikes: Vec<Spike> = spikes.into_iter().map(|(_, spike)| spike).collect();
    if let Some(low_pass) = plan.low_pass {
        low_pass.filter_capture(&mut capture)?;
    }
    if let Some(rate_hz) = plan.resample_hz.filter(|hz| *hz != capture.rate_hz) {
        capture = resample(&capture, rate_hz)?;
    }
    let head = match plan.head.as_slice() {
        [] => None,
        head => Some(stabilise(&mut capture, head)?),
    };
    let record = RepairRecord {
        plan: plan.clone(),
        markers,
        frames,
        rate_hz,
        frames_out: capture.frames(),
        rate_hz_out: capture.rate_hz,
        changed: record::changed_frames(&swaps, &spikes, &gaps),
        swaps,
        spikes,
        gaps,
        head,
    };
    capture.notes.push(format!("repaired: {}", record.summary()));
    Ok(Repaired { capture, record })
}
