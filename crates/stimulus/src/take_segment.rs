//! A segment of a take as the pack that browsers solve.

use std::ops::Range;

use mimique_solver::{MethodSpec, Operators};

use crate::SolveError;
use crate::joined_take::JoinedTake;
use crate::take_pack::{SegmentMarkers, TakeContent, TakePack};

/// Seconds of margin on both sides of a segment, for the head's low-pass to settle.
const MARGIN_SECONDS: f64 = 0.25;

impl JoinedTake<'_> {
    /// The pack of frames `first..end` (counted from 0), with a margin for the head's low-pass.
    ///
    /// # Errors
    /// [`SolveError`]: a segment outside, or a head or neutral that cannot be found.
    pub fn segment(
        &self,
        operators: &Operators,
        spec: &MethodSpec,
        segment: Range<usize>,
    ) -> Result<TakePack, SolveError> {
        let frames = self.frame_count();
        let Range { start: first, end } = segment;
        if first >= end || end > frames {
            return Err(SolveError::Segment { first, end, frames });
        }
        let (front_end, poses) = self.front_end(operators, spec)?;
        let margin = (MARGIN_SECONDS * self.rate_hz).ceil() as usize;
        let stored = first.saturating_sub(margin)..(end + margin).min(frames);
        let width = 3 * self.labels.len();
        let (driven_shapes, driven_weights) = self.lid_tracks(&front_end, &poses, stored.clone());
        let markers = SegmentMarkers {
            driven_shapes,
            driven_weights,
            labels: self.labels.clone(),
            face: self.columns.face.clone(),
            head: self.columns.head.clone(),
            head_reference: front_end.head_reference().to_vec(),
            neutral: front_end.neutral().to_vec(),
            scales: front_end.scales().cloned(),
            depth: front_end.depth().cloned(),
            positions: self.positions[stored.start * width..stored.end * width].to_vec(),
        };
        Ok(TakePack {
            rate_hz: self.rate_hz,
            first_frame: self.first_frame + first as u64,
            played: first - stored.start..end - stored.start,
            content: TakeContent::Markers(markers),
        })
    }
}
