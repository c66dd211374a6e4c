//! The neutral where none is named: the stillest second of the face.

use std::ops::Range;

use mimique_mocap::{Capture, stabilise, stillest};

use super::joined::NEUTRAL_FRAMES;
use crate::TakeWarning;

/// The neutral where none is named: the stillest second of the face, its head held still; and what
/// is to be said of it. The first `face` labels are those of the face.
pub(crate) fn found_neutral(
    capture: &Capture,
    labels: &[String],
    face: usize,
    head: &[String],
) -> (Range<usize>, TakeWarning) {
    let columns: Vec<usize> = labels.iter().filter_map(|l| capture.marker_index(l)).collect();
    let mut part = Capture {
        labels: labels.to_vec(),
        positions: (0..capture.frames())
            .flat_map(|frame| columns.iter().map(move |&c| capture.frame(frame)[c]))
            .collect(),
        notes: Vec::new(),
        ..*capture
    };
    let head_held = head.is_empty() || stabilise(&mut part, head).is_ok();
    let width = part.labels.len();
    part.positions = part.positions.chunks(width).flat_map(|row| row[..face].to_vec()).collect();
    part.labels.truncate(face);
    match stillest(&part, 1.0) {
        Some(found) => {
            let mm = found.deviation * capture.unit.metres() * 1e3;
            let said = TakeWarning::neutral_found(&found.frames, mm, head_held);
            (found.frames, said)
        }
        None => (0..NEUTRAL_FRAMES.min(capture.frames()), TakeWarning::NeutralUnseen),
    }
}
