//! The participant's face, as it was measured while a clip was played once (`static/mimicry/tracker.js`), and the answers
//! of the page on which that is agreed to (`static/mimicry/check.js`).
//!
//! | answer | holds |
//! |---|---|
//! | `mimicry_consent` | `agreed`, `declined` |
//! | `mimicry_version` | version of the text that it is the answer to |
//! | `mimicry_camera` | `seen`, a face in its picture; `not_seen`; `refused`, `no_camera`, `failed`, `insecure`: why there is none; `off` of those who declined or went on without |

use mimique_study::{Answers, TRACKED_SHAPES};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// Identifier of the page's step.
pub(crate) const MIMICRY_STEP: &str = "mimicry";

/// What was measured of a face during one play, as [`crate::PlayLog::mimicry`] holds it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct TrackedFace {
    /// `tracked`, or why nothing was: `stopped` by the participant, `lost` (no camera any more), `failed`, `starting`.
    pub status: String,
    /// What the times are of: `capture`, when the camera took the picture; `presented`, when the browser had it.
    pub clock: String,
    /// SHA-256 of the model.
    pub model: String,
    /// A picture each: milliseconds after the clip's first frame, then the scores of [`TRACKED_SHAPES`] in thousandths; no
    /// scores where no face was found.
    pub frames: Vec<Vec<f64>>,
}

/// One picture of a [`TrackedFace`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackedPicture<'t> {
    /// When, milliseconds after the clip's first frame.
    pub at_ms: f64,
    /// The scores in thousandths; none where no face was found.
    pub scores: Option<&'t [f64]>,
}

impl TrackedFace {
    /// What a log of a play holds; none of plays in which nothing was to be measured.
    pub fn of(log: &Value) -> Option<Self> {
        Self::deserialize(log).ok()
    }

    /// The pictures in order. What no tracker gives (another number of scores, scores that are none, times that run
    /// backwards) is left out.
    pub fn pictures(&self) -> impl Iterator<Item = TrackedPicture<'_>> {
        let mut before = f64::NEG_INFINITY;
        self.frames.iter().filter_map(move |frame| {
            let (&at_ms, scores) = frame.split_first()?;
            let is_score = |score: &f64| (0.0..=1000.0).contains(score);
            let is_whole = scores.len() == TRACKED_SHAPES.len() && scores.iter().all(is_score);
            if !at_ms.is_finite() || at_ms <= before || !(scores.is_empty() || is_whole) {
                return None;
            }
            before = at_ms;
            Some(TrackedPicture { at_ms, scores: is_whole.then_some(scores) })
        })
    }
}

/// What a record keeps of a log: counts in the place of the pictures.
pub(crate) fn in_short(log: &mut Value) {
    if let Some(frames) = log["frames"].as_array() {
        let with_face = |frame: &&Value| frame.as_array().is_some_and(|own| own.len() > 1);
        let (all, faces) = (frames.len(), frames.iter().filter(with_face).count());
        log["frames"] = json!(all);
        log["faces"] = json!(faces);
    }
}

/// Whether these are answers that the page of the consent gives.
pub(crate) fn are_of_mimicry(answers: &Answers) -> bool {
    const CAMERA: [&str; 7] =
        ["seen", "not_seen", "refused", "no_camera", "failed", "insecure", "off"];
    let fits = |(name, value): (&String, &Value)| {
        let Some(word) = value.as_str() else { return false };
        match name.as_str() {
            "mimicry_consent" => ["agreed", "declined"].contains(&word),
            "mimicry_version" => word.len() <= 200,
            "mimicry_camera" => CAMERA.contains(&word),
            _ => false,
        }
    };
    answers.contains_key("mimicry_consent") && answers.iter().all(fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_the_page_gives_is_taken() {
        let answers = |text: Value| -> Answers { serde_json::from_value(text).unwrap() };
        let agreed = json!({ "mimicry_consent": "agreed", "mimicry_version": "2", "mimicry_camera": "seen" });
        assert!(are_of_mimicry(&answers(agreed)));
        for wrong in [
            json!({}),
            json!({ "mimicry_camera": "seen" }),
            json!({ "mimicry_consent": true }),
            json!({ "mimicry_consent": "perhaps" }),
            json!({ "mimicry_consent": "agreed", "mimicry_camera": "broken" }),
            json!({ "mimicry_consent": "agreed", "mimicry_version": "2".repeat(201) }),
            json!({ "mimicry_consent": "agreed", "picture": "data:image/png;base64," }),
        ] {
            assert!(!are_of_mimicry(&answers(wrong.clone())), "{wrong}");
        }
    }

    #[test]
    fn pictures_are_those_that_a_tracker_gives() {
        let scores = |first: f64| {
            let mut scores = vec![0.0; 52];
            scores[0] = first;
            scores
        };
        let frame = |at_ms: f64, first: f64| [vec![at_ms], scores(first)].concat();
        let frames = vec![
            frame(1.5, 250.0),
            vec![34.0],
            frame(20.0, 1.0),
            frame(60.0, 1001.0),
            vec![],
            vec![80.0, 1.0],
            frame(90.0, 1000.0),
        ];
        let log = json!({ "status": "tracked", "clock": "capture", "frames": frames, "more": 1 });
        let face = TrackedFace::of(&log).unwrap();
        let found: Vec<(f64, Option<f64>)> =
            face.pictures().map(|own| (own.at_ms, own.scores.map(|own| own[0]))).collect();
        assert_eq!(found, [(1.5, Some(250.0)), (34.0, None), (90.0, Some(1000.0))]);
        assert_eq!(TrackedFace::of(&Value::Null), None);
        let mut short = log;
        in_short(&mut short);
        assert_eq!(short["frames"], 7);
        assert_eq!(short["status"], "tracked");
    }
}
