//! What a repair changed, as a whole and frame by frame.

use super::{RepairPlan, RepairedSwap, Spike};
use crate::{GapRepair, Stabilisation};
use std::collections::BTreeMap;

/// A gap of one marker, and what was done about it.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct RepairedGap {
    /// Label of the marker.
    pub label: String,
    /// First missing frame, 0 = the first of the capture.
    pub first: usize,
    /// First frame after the gap.
    pub end: usize,
    /// How it was filled.
    pub repair: GapRepair,
}

/// What was changed in one frame of the capture as it was read.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct ChangedFrame {
    /// The frame, 0 = the first of the capture.
    pub frame: usize,
    /// Markers that got their own label back.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub swapped: Vec<String>,
    /// Markers that were elsewhere for an instant.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spike: Vec<String>,
    /// Markers filled in by a spline.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spline: Vec<String>,
    /// Markers filled in by their neighbours' rigid motion.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rigid: Vec<String>,
}

/// Everything that a repair did.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RepairRecord {
    /// What was asked for.
    pub plan: RepairPlan,
    /// Markers of the capture.
    pub markers: usize,
    /// Frames of the capture as it was read; all frames below are counted in these.
    pub frames: usize,
    /// Frames per second of the capture as it was read.
    pub rate_hz: f64,
    /// Frames that came out.
    pub frames_out: usize,
    /// Frames per second that came out.
    pub rate_hz_out: f64,
    /// Swaps.
    pub swaps: Vec<RepairedSwap>,
    /// Spikes.
    pub spikes: Vec<Spike>,
    /// Gaps, those that spikes left included.
    pub gaps: Vec<RepairedGap>,
    /// The head, where it was held still; its frames are those that came out.
    pub head: Option<Stabilisation>,
    /// What was changed, frame by frame. Filter, rate and head change every frame.
    pub changed: Vec<ChangedFrame>,
}

impl RepairRecord {
    /// What was done, in a sentence.
    pub fn summary(&self) -> String {
        let of = |how: GapRepair| self.gaps.iter().filter(|g| g.repair == how).count();
        let mut text = format!(
            "{} swapped stretches, {} spikes, {} gaps ({} by spline, {} by neighbours, {} left \
             missing), {} of {} frames changed",
            self.swaps.iter().filter(|s| s.repaired).count(),
            self.spikes.len(),
            self.gaps.len(),
            of(GapRepair::Spline),
            of(GapRepair::RigidNeighbourhood),
            of(GapRepair::LeftMissing),
            self.changed.len(),
            self.frames,
        );
        match self.plan.low_pass {
            Some(crate::LowPass::Butterworth { cutoff_hz }) => {
                text.push_str(&format!("; Butterworth at {cutoff_hz} Hz"));
            }
            Some(crate::LowPass::RaisedCosine { cutoff_hz, width_hz }) => {
                text.push_str(&format!("; raised cosine at {cutoff_hz} Hz, flank {width_hz} Hz"));
            }
            None => {}
        }
        if self.rate_hz_out != self.rate_hz {
            text.push_str(&format!("; {} to {} Hz", self.rate_hz, self.rate_hz_out));
        }
        if let Some(head) = &self.head {
            text.push_str(&format!(
                "; head held by {} markers, {:.3} mm rms, {:.3} mm at worst",
                head.labels.len(),
                head.residual_rms_mm,
                head.residual_worst_mm
            ));
        }
        text
    }
}

/// The changes gathered by frame.
pub(super) fn changed_frames(
    swaps: &[RepairedSwap],
    spikes: &[Spike],
    gaps: &[RepairedGap],
) -> Vec<ChangedFrame> {
    let mut frames: BTreeMap<usize, ChangedFrame> = BTreeMap::new();
    let mut of = |frame: usize, add: &dyn Fn(&mut ChangedFrame)| {
        let changed = frames.entry(frame);
        add(changed.or_insert_with(|| ChangedFrame { frame, ..ChangedFrame::default() }));
    };
    for swap in swaps.iter().filter(|s| s.repaired) {
        for frame in swap.first..swap.end {
            of(frame, &|c| c.swapped.extend(swap.labels.iter().cloned()));
        }
    }
    for spike in spikes {
        for frame in spike.first..spike.end {
            of(frame, &|c| c.spike.push(spike.label.clone()));
        }
    }
    for gap in gaps {
        for frame in gap.first..gap.end {
            match gap.repair {
                GapRepair::Spline => of(frame, &|c| c.spline.push(gap.label.clone())),
                GapRepair::RigidNeighbourhood => of(frame, &|c| c.rigid.push(gap.label.clone())),
                GapRepair::LeftMissing => {}
            }
        }
    }
    frames.into_values().collect()
}
