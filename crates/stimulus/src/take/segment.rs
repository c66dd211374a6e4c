//! Frames of a take as the pipeline solves them and as packs carry them.

use std::ops::Range;

use mimique_clip::{
    MarkerMotion, MarkerTake, SegmentMarkers, TakeContent, TakePack, marker_motion,
};
use mimique_solver::{MethodSpec, Operators};

use super::{JoinedTake, SolveError};

/// Seconds of margin on both sides of a segment, for the head's low-pass to settle.
const MARGIN_SECONDS: f64 = 0.25;

impl JoinedTake<'_> {
    /// The pack of frames `first..end` (counted from 0), with a margin of head markers for the head's
    /// low-pass.
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
        let margin = (MARGIN_SECONDS * self.rate_hz).ceil() as usize;
        let stored = first.saturating_sub(margin)..(end + margin).min(frames);
        let played = first - stored.start..end - stored.start;
        let mut markers = self.markers_of(operators, spec, stored)?;
        self.blank_margins(&mut markers, &played);
        Ok(TakePack {
            rate_hz: self.rate_hz,
            first_frame: self.first_frame + first as u64,
            played,
            content: TakeContent::Markers(markers),
        })
    }

    /// The markers of some frames, and what head, neutral, scale and lids were fitted to in the whole
    /// take.
    pub(crate) fn markers_of(
        &self,
        operators: &Operators,
        spec: &MethodSpec,
        frames: Range<usize>,
    ) -> Result<SegmentMarkers, SolveError> {
        let (front_end, poses) = self.front_end(operators, spec)?;
        let width = 3 * self.labels.len();
        let lids = self.lid_tracks(&front_end, &poses, frames.clone());
        let gaze = self.gaze_tracks(&front_end, &poses, frames.clone());
        let head = self.head_tracks(&front_end, &poses, frames.clone());
        let face = beside(lids, gaze, frames.len());
        let (driven_shapes, driven_weights) = beside(face, head, frames.len());
        Ok(SegmentMarkers {
            driven_shapes,
            driven_weights,
            labels: self.labels.clone(),
            face: self.columns.face.clone(),
            head: self.columns.head.clone(),
            head_reference: front_end.head_reference().to_vec(),
            neutral: front_end.neutral().to_vec(),
            scales: front_end.scales().cloned(),
            depth: front_end.depth().cloned(),
            positions: self.positions[frames.start * width..frames.end * width].to_vec(),
        })
    }

    /// All frames as the pipeline takes them.
    pub(crate) fn whole<'m>(&self, markers: &'m SegmentMarkers) -> MarkerTake<'m> {
        MarkerTake { markers, rate_hz: self.rate_hz, played: 0..self.frame_count() }
    }

    /// Where the markers of all frames ask the skin to go.
    ///
    /// # Errors
    /// [`SolveError`] of the front end.
    pub fn motion(
        &self,
        operators: &Operators,
        spec: &MethodSpec,
    ) -> Result<MarkerMotion, SolveError> {
        let markers = self.markers_of(operators, spec, 0..self.frame_count())?;
        Ok(marker_motion(operators, &self.whole(&markers), spec)?)
    }

    /// Takes out of the margins what is not played: only the head is filtered over time.
    fn blank_margins(&self, markers: &mut SegmentMarkers, played: &Range<usize>) {
        let head = self.columns.head.as_deref().unwrap_or_default();
        let columns = self.labels.len();
        for (frame, row) in markers.positions.chunks_exact_mut(3 * columns).enumerate() {
            if !played.contains(&frame) {
                for column in (0..columns).filter(|column| !head.contains(column)) {
                    row[3 * column..3 * column + 3].fill(f64::NAN);
                }
            }
        }
    }
}

/// Two tables of named columns as one, row by row.
fn beside(
    (mut names, left): (Vec<String>, Vec<f64>),
    (more, right): (Vec<String>, Vec<f64>),
    rows: usize,
) -> (Vec<String>, Vec<f64>) {
    let widths = [names.len(), more.len()];
    let row =
        |values: &[f64], width: usize, row: usize| values[row * width..(row + 1) * width].to_vec();
    let weights = (0..rows)
        .flat_map(|f| [row(&left, widths[0], f), row(&right, widths[1], f)].concat())
        .collect();
    names.extend(more);
    (names, weights)
}
