//! Expressions in a long take: suggested from its weights, corrected by hand in a table or in ELAN,
//! cut with neutral before and after.
//!
//! ```text
//! weights or markers --Activity--> suggest --> TakeSegment... --cut--> clips of a study
//!                                                  |   ^
//!                                              CSV, ELAN (.eaf)
//! ```

mod activity;
mod borders;
mod csv;
mod eaf;
mod eaf_read;
mod eaf_times;
mod eaf_write;
mod literal;
mod peaks;
mod study;
mod suggest;

use std::ops::Range;

pub use activity::{Activity, ActivityOptions, Channels, bridge};
pub use borders::{BorderRule, stretches};
pub use csv::{
    SegmentFileError, read_labelled_segments, read_segments, write_segments, write_segments_with,
};
pub use eaf::{EafAnnotation, EafDocument, EafError, EafTier};
pub use eaf_write::{EafSegments, LeftOut};
pub use literal::Literal;
pub use study::{identifier, study_segments};
pub use suggest::{SuggestError, SuggestOptions, Suggestion, Timeline, TimelineSegment, suggest};

/// One expression of a take.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct TakeSegment {
    /// What it is called: `joy2`.
    pub label: String,
    /// Frames of the clip, counted from 0, with what comes before and after the expression.
    pub clip: Range<usize>,
    /// Frames of the expression itself, within the clip.
    pub expression: Range<usize>,
}

impl TakeSegment {
    /// A clip that is all expression.
    pub fn new(label: impl Into<String>, frames: Range<usize>) -> Self {
        Self { label: label.into(), clip: frames.clone(), expression: frames }
    }

    /// Whether it is called `N` or `neutral`: the face at rest, which is no expression.
    pub fn is_neutral(&self) -> bool {
        ["n", "neutral"].iter().any(|name| self.label.eq_ignore_ascii_case(name))
    }

    /// Share of frames that two expressions have in common: intersection over union.
    pub fn overlap(&self, other: &Self) -> f64 {
        let (a, b) = (&self.expression, &other.expression);
        let common = a.end.min(b.end).saturating_sub(a.start.max(b.start));
        let union = a.len() + b.len() - common;
        if union == 0 { 0.0 } else { common as f64 / union as f64 }
    }
}

/// Give every expression its lead-in and lead-out of neutral: as much of both as there is before
/// the expression's neighbours and within the take. Segments come out in order of time.
pub fn cut(
    segments: &[TakeSegment],
    frames: usize,
    rate_hz: f64,
    lead_in_s: f64,
    lead_out_s: f64,
) -> Vec<TakeSegment> {
    let mut sorted = segments.to_vec();
    sorted.sort_by_key(|s| (s.expression.start, s.expression.end));
    let length = |seconds: f64| (seconds * rate_hz).round().max(0.0) as usize;
    let (lead_in, lead_out) = (length(lead_in_s), length(lead_out_s));
    let expressions: Vec<Range<usize>> = sorted.iter().map(|s| s.expression.clone()).collect();
    for (i, segment) in sorted.iter_mut().enumerate() {
        let own = &expressions[i];
        let from = if i == 0 { 0 } else { expressions[i - 1].end.min(own.start) };
        let to = expressions.get(i + 1).map_or(frames, |next| next.start).max(own.end);
        let start = own.start.saturating_sub(lead_in).max(from);
        let end = own.end.saturating_add(lead_out).min(to).min(frames.max(own.end));
        segment.clip = start..end;
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leads_reach_the_neighbours_and_the_ends_and_no_further() {
        let segments = [
            TakeSegment::new("b", 200..300),
            TakeSegment::new("a", 30..150),
            TakeSegment::new("c", 310..390),
        ];
        let clips = cut(&segments, 400, 100.0, 0.6, 0.4);
        let got: Vec<_> = clips.iter().map(|s| (s.label.as_str(), s.clip.clone())).collect();
        assert_eq!(got, [("a", 0..190), ("b", 150..310), ("c", 300..400)]);
        assert!(clips.iter().zip([1, 0, 2]).all(|(c, i)| c.expression == segments[i].expression));
    }

    #[test]
    fn overlap_is_intersection_over_union() {
        let a = TakeSegment::new("a", 0..100);
        assert_eq!(a.overlap(&TakeSegment::new("b", 50..150)), 50.0 / 150.0);
        assert_eq!(a.overlap(&a), 1.0);
        assert_eq!(a.overlap(&TakeSegment::new("b", 100..150)), 0.0);
    }
}
