//! The built-in head and its actors as a study and the studio use them: marker map, capture, and the
//! range of motion that a regression learns from.

use mimique_actor::{
    HeadSpec, MarkerSites, Phases, SyntheticTake, build_head, marker_sites, range_of_motion_take,
};
use mimique_mocap::{Capture, LengthUnit, WeightsTable};

use crate::{MappedMarker, MarkerMap, MarkerPlace, TakeSegment, Training};

/// A range of motion has sensor noise of its own.
const TRAINING: u64 = 0x726f_6d00_0000_0000;

/// Where the built-in markers belong on a built-in head: a vertex each.
pub fn built_in_map(sites: &MarkerSites) -> MarkerMap {
    let face = sites.face_labels().iter().zip(&sites.vertices).map(|(label, &vertex)| {
        MappedMarker { label: label.clone(), place: MarkerPlace::Vertex(vertex) }
    });
    MarkerMap { face: face.collect(), ..MarkerMap::default() }
}

/// What the markers of a built-in actor did, in millimetres.
pub fn built_in_capture(take: &SyntheticTake) -> Capture {
    let (labels, positions) = (take.labels.clone(), take.positions.clone());
    Capture::new(labels, take.rate_hz, LengthUnit::Millimetre, positions)
}

/// The weights that a built-in actor played, without unit.
pub fn built_in_weights(take: &SyntheticTake) -> WeightsTable {
    WeightsTable::at_rate(take.shape_names.clone(), take.truth.clone(), 0, take.rate_hz)
}

/// What a built-in actor shows, as an annotator would write it: `neutral`, the way to an emotion as
/// `neutral>joy`, the emotion while it is held, and the way back.
pub fn built_in_labels(take: &SyntheticTake) -> Vec<TakeSegment> {
    let mut labels = Vec::new();
    let mut rest = 0;
    for segment in &take.segments {
        let Some(Phases { attack, apex, release, rest: end }) = segment.phases else { continue };
        let emotion = &segment.emotion;
        labels.push(TakeSegment::new("neutral", rest..attack));
        labels.push(TakeSegment::new(format!("neutral>{emotion}"), attack..apex));
        labels.push(TakeSegment::new(emotion, apex..release));
        labels.push(TakeSegment::new(format!("{emotion}>neutral"), release..end));
        rest = end;
    }
    labels.push(TakeSegment::new("neutral", rest..take.frames()));
    labels.retain(|label| !label.clip.is_empty());
    labels
}

/// The range of motion of the built-in actor of that number with its weights: what a regression learns
/// from. `noise_mm` is the sensors' standard deviation in millimetres.
pub fn built_in_training(actor: u64, noise_mm: f64) -> Training {
    let spec = HeadSpec::actor(actor);
    let (head, sites) = (build_head(&spec), marker_sites(&spec));
    let take = range_of_motion_take(&head, &sites, actor ^ TRAINING, noise_mm);
    let [first, end] = take.neutral;
    Training {
        weights: built_in_weights(&take),
        capture: built_in_capture(&take),
        neutral: Some(first..end),
        head: Some(take.head_labels),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_actor::{Clip, Density, Emotion, synthetic_take};

    #[test]
    fn labels_follow_what_was_played() {
        let spec = HeadSpec { density: Density::COARSE, ..HeadSpec::actor(3) };
        let clip = |emotion, seed| Clip { emotion, intensity: 3, seed };
        let clips = [clip(Emotion::Joy, 1), clip(Emotion::Fear, 2)];
        let take = synthetic_take(&build_head(&spec), &marker_sites(&spec), &clips, 5, 0.0);
        let labels = built_in_labels(&take);
        let names: Vec<&str> = labels.iter().map(|label| label.label.as_str()).collect();
        let expected = ["neutral", "neutral>joy", "joy", "joy>neutral"];
        assert_eq!(names[..4], expected);
        assert_eq!((names.len(), names[8]), (9, "neutral"));
        assert!(labels.windows(2).all(|pair| pair[0].clip.end == pair[1].clip.start));
        assert_eq!(labels[8].clip.end, take.frames());
        // Held at the apex, at rest outside: gaze and blinks left out.
        let n = take.shape_names.len();
        let moves = |k: usize| !take.shape_names[k].starts_with("eye");
        let level =
            |f: usize| -> f64 { (0..n).filter(|k| moves(*k)).map(|k| take.truth[f * n + k]).sum() };
        let most = (0..take.frames()).map(level).fold(0.0, f64::max);
        for label in &labels {
            let middle = level((label.clip.start + label.clip.end) / 2);
            match label.label.as_str() {
                "neutral" => assert!(middle < 0.01, "{label:?}: {middle}"),
                "joy" | "fear" => assert!(middle > 0.3 * most, "{label:?}: {middle}"),
                _ => assert!(middle > 0.01 && middle < most, "{label:?}: {middle}"),
            }
        }
    }
}
