//! What a study file names of the built-in head and its actors: avatars, performances, training takes
//! (`built_in.rs` has what they are made of).

use std::ops::Range;

use mimique_actor::{
    Density, Emotion, HeadPose, HeadSpec, NOISE_MM, SyntheticTake, build_head, marker_sites,
    synthetic_take,
};
use mimique_avatar::{Avatar, HEAD_POSE_SHAPES, HeadAngles};
use mimique_geometry::coordinates;
use mimique_mocap::{Capture, WeightsTable};
use mimique_study::{BuiltinAvatar, BuiltinCapture, BuiltinExpression};

use crate::provenance::Provenance;
use crate::{
    MarkerMap, Training, built_in_capture, built_in_map, built_in_training, built_in_weights,
};

/// A take of one performance.
pub(super) struct BuiltinTake {
    pub capture: Capture,
    /// Labels of the markers on the skull.
    pub head: Vec<String>,
    /// Frames of the neutral face.
    pub neutral: Range<usize>,
    /// Frames of the performance.
    pub played: Range<usize>,
}

/// A person of the built-in head, and where markers sit on it.
pub(super) fn avatar(who: &BuiltinAvatar) -> (Avatar, MarkerMap) {
    let person = who.actor.map_or_else(|| HeadSpec::person(who.seed), HeadSpec::actor);
    let density = who.vertices.map_or_else(Density::default, |v| Density::nearest(v as usize));
    let spec = HeadSpec { density, ..person };
    (build_head(&spec), built_in_map(&marker_sites(&spec)))
}

/// An actor's take of one performance: always the same for the same actor and performance.
pub(super) fn take(actor: &BuiltinCapture, what: mimique_study::Performance) -> BuiltinTake {
    let take = synthetic(actor, what);
    let [first, end] = take.neutral;
    BuiltinTake {
        played: played(&take),
        neutral: first..end,
        capture: built_in_capture(&take),
        head: take.head_labels,
    }
}

/// The weights of an actor's performance as the actor made them, with a share of the head's motion beside them (none
/// where it is 0), and the frames played.
pub(super) fn performed(
    actor: &BuiltinCapture,
    what: mimique_study::Performance,
    head_motion: f64,
) -> (WeightsTable, Range<usize>) {
    let take = synthetic(actor, what);
    let played = played(&take);
    let weights = built_in_weights(&take);
    if head_motion == 0.0 {
        return (weights, played);
    }
    let rows = weights.weights.chunks_exact(weights.shape_names.len());
    let beside = |(row, pose): (&[f64], &HeadPose)| {
        let [nod, turn, tilt] = pose.rotation.map(f64::to_degrees);
        let angles = HeadAngles { nod, turn, tilt: -tilt };
        let head = angles.weights().map(|weight| head_motion * weight);
        row.iter().copied().chain(head).collect::<Vec<f64>>()
    };
    let names = weights.shape_names.iter().cloned().chain(HEAD_POSE_SHAPES.map(str::to_owned));
    let with_head = WeightsTable {
        shape_names: names.collect(),
        weights: rows.zip(&take.head).flat_map(beside).collect(),
        ..weights.clone()
    };
    (with_head, played)
}

fn played(take: &SyntheticTake) -> Range<usize> {
    take.segments.first().map_or(0..take.frames(), |s| s.first..s.end)
}

fn synthetic(actor: &BuiltinCapture, what: mimique_study::Performance) -> SyntheticTake {
    let spec = HeadSpec::actor(actor.actor);
    let emotion = match what.expression {
        BuiltinExpression::Anger => Emotion::Anger,
        BuiltinExpression::Disgust => Emotion::Disgust,
        BuiltinExpression::Fear => Emotion::Fear,
        BuiltinExpression::Joy => Emotion::Joy,
        BuiltinExpression::Sadness => Emotion::Sadness,
        BuiltinExpression::Surprise => Emotion::Surprise,
    };
    let clip = mimique_actor::Clip { emotion, intensity: what.intensity, seed: actor.actor };
    let noise_mm = actor.noise_mm.unwrap_or(NOISE_MM);
    // Every performance has noise of its own.
    let seed = actor.actor ^ ((emotion as u64 + 1) << 40) ^ (u64::from(what.intensity) << 48);
    synthetic_take(&build_head(&spec), &marker_sites(&spec), &[clip], seed, noise_mm)
}

/// An actor's range of motion with its weights: what a regression learns from.
pub(super) fn training(actor: &BuiltinCapture) -> Training {
    built_in_training(actor.actor, actor.noise_mm.unwrap_or(NOISE_MM))
}

/// What a take made by code is known by: its numbers.
pub(super) fn take_key(capture: &Capture) -> String {
    Provenance::default()
        .numbers("positions", coordinates(&capture.positions))
        .json("rateHz", capture.rate_hz)
        .json("labels", capture.labels.clone())
        .hash()
}
