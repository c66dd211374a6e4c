//! The built-in head and its actors as avatar, capture and marker map.

use std::ops::Range;

use mimique_face::{
    Avatar, Density, Emotion, HeadSpec, Identity, SyntheticTake, build_head, marker_sites,
    range_of_motion_take, synthetic_take,
};
use mimique_mocap::{Capture, LengthUnit};
use mimique_study::{BuiltinAvatar, BuiltinCapture, BuiltinExpression};

use crate::provenance::Provenance;
use crate::{MappedMarker, MarkerMap, MarkerPlace, Training, WeightsTable};

/// Noise of the built-in actors' sensors where the study gives none, millimetres.
const NOISE_MM: f64 = 0.1;
/// Actors are other people than the avatars of the same seed.
const ACTORS: u64 = 0x6163_746f_7273_0000;

/// A range of motion has noise of its own.
const TRAINING: u64 = 0x726f_6d00_0000_0000;

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
    let seed = who.actor.map_or(who.seed, |actor| actor ^ ACTORS);
    let spec = HeadSpec {
        identity: Identity::from_seed(seed),
        density: who.vertices.map_or_else(Density::default, |v| Density::nearest(v as usize)),
    };
    let sites = marker_sites(&spec);
    let face = sites.face_labels().iter().zip(&sites.vertices).map(|(label, &vertex)| {
        MappedMarker { label: label.clone(), place: MarkerPlace::Vertex(vertex) }
    });
    let map = MarkerMap { face: face.collect(), ..MarkerMap::default() };
    (build_head(&spec), map)
}

/// What an avatar made by code is known by: all its numbers.
pub(super) fn avatar_key(avatar: &Avatar) -> String {
    // Debug text of a float is exact; the avatar's own pack would be rounded.
    Provenance::default().text("avatar", &format!("{avatar:?}")).hash()
}

/// An actor's take of one performance: always the same for the same actor and performance.
pub(super) fn take(actor: &BuiltinCapture, what: mimique_study::Performance) -> BuiltinTake {
    let take = synthetic(actor, what);
    let [first, end] = take.neutral;
    BuiltinTake {
        played: played(&take),
        head: take.head_labels,
        neutral: first..end,
        capture: Capture::new(take.labels, take.rate_hz, LengthUnit::Millimetre, take.positions),
    }
}

/// The weights of an actor's performance as the actor made them, and the frames played.
pub(super) fn performed(
    actor: &BuiltinCapture,
    what: mimique_study::Performance,
) -> (WeightsTable, Range<usize>) {
    let take = synthetic(actor, what);
    let played = played(&take);
    (WeightsTable::at_rate(take.shape_names, take.truth, 0, take.rate_hz), played)
}

fn played(take: &SyntheticTake) -> Range<usize> {
    take.segments.first().map_or(0..take.frames(), |s| s.first..s.end)
}

fn synthetic(actor: &BuiltinCapture, what: mimique_study::Performance) -> SyntheticTake {
    let spec = actor_head(actor);
    let emotion = match what.expression {
        BuiltinExpression::Anger => Emotion::Anger,
        BuiltinExpression::Disgust => Emotion::Disgust,
        BuiltinExpression::Fear => Emotion::Fear,
        BuiltinExpression::Joy => Emotion::Joy,
        BuiltinExpression::Sadness => Emotion::Sadness,
        BuiltinExpression::Surprise => Emotion::Surprise,
    };
    let clip = mimique_face::Clip { emotion, intensity: what.intensity, seed: actor.actor };
    let noise_mm = actor.noise_mm.unwrap_or(NOISE_MM);
    // Every performance has noise of its own.
    let seed = actor.actor ^ ((emotion as u64 + 1) << 40) ^ (u64::from(what.intensity) << 48);
    synthetic_take(&build_head(&spec), &marker_sites(&spec), &[clip], seed, noise_mm)
}

/// An actor's range of motion with its weights: what a regression learns from.
pub(super) fn training(actor: &BuiltinCapture) -> Training {
    let spec = actor_head(actor);
    let noise_mm = actor.noise_mm.unwrap_or(NOISE_MM);
    let seed = actor.actor ^ TRAINING;
    let take = range_of_motion_take(&build_head(&spec), &marker_sites(&spec), seed, noise_mm);
    let [first, end] = take.neutral;
    Training {
        weights: WeightsTable::at_rate(take.shape_names, take.truth, 0, take.rate_hz),
        capture: Capture::new(take.labels, take.rate_hz, LengthUnit::Millimetre, take.positions),
        neutral: Some(first..end),
        head: Some(take.head_labels),
    }
}

fn actor_head(actor: &BuiltinCapture) -> HeadSpec {
    HeadSpec { identity: Identity::from_seed(actor.actor ^ ACTORS), density: Density::default() }
}

/// What a take made by code is known by: its numbers.
pub(super) fn take_key(capture: &Capture) -> String {
    Provenance::default()
        .numbers("positions", capture.positions.as_flattened())
        .numbers("rate", &[capture.rate_hz])
        .text("labels", &capture.labels.join("\n"))
        .hash()
}
