//! The plays of a page as they are drawn again: the wire between a log and what replays it (`static/researcher/replayed.js`).

use serde::Serialize;
use serde_json::Value;

use super::placed::PlacedClip;
use super::seen::{SeenPage, SeenPlay};
use super::view::View;
use crate::plan::Plan;

/// The plays of a page.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Plays {
    /// The version of the study in which the clips are.
    config_hash: String,
    /// Whether the second clip of a pair stood left.
    beside_left: bool,
    plays: Vec<Play>,
}

impl Plays {
    /// Of a page of that plan, with the frames that [`super::Seen`] has kept of it.
    pub fn of(plan: &Plan, page: &SeenPage) -> Self {
        let beside = match &page.view {
            View::Trial(trial) => trial.beside.as_ref(),
            _ => None,
        };
        Self {
            config_hash: plan.started.config_hash.clone(),
            beside_left: beside.is_some_and(|beside| beside.left),
            plays: page.plays.iter().map(|play| Play::of(plan, play)).collect(),
        }
    }

    /// How many plays there were, and how many of their frames came late.
    pub fn count(&self) -> (usize, u64) {
        (self.plays.len(), self.plays.iter().map(|play| u64::from(play.late)).sum())
    }
}

/// A play of one clip, or of several.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
struct Play {
    clips: Vec<PlayedClip>,
    in_turn: bool,
    /// When each frame was shown (milliseconds after the first), its clip time (milliseconds), 1 if late.
    frames: Vec<(f64, f64, f64)>,
    late: u32,
    longest_ms: f64,
    refresh_hz: f64,
    /// Size of the canvas in CSS pixels.
    size: [f64; 2],
    renderer: String,
    aborted: Option<String>,
}

/// A clip as it was played.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
struct PlayedClip {
    /// What the stage calls it.
    clip: String,
    /// What a face that was drawn for one trial is drawn from: the clip at rest, and its draw.
    #[serde(skip_serializing_if = "Option::is_none")]
    face: Option<(String, Value)>,
    /// SHA-256 of the weights that were shown; empty where the log has none.
    weights_hash: String,
    /// Of the clip as it was prepared; empty where the log has none.
    provenance: String,
}

impl Play {
    fn of(plan: &Plan, SeenPlay { clips, in_turn, log, .. }: &SeenPlay) -> Self {
        let panel = log.shown_in_panel();
        let clip = |(place, PlacedClip { clip, .. }): (usize, &PlacedClip)| {
            // The log has the weights of the first clip, and of a panel those of all.
            let (weights_hash, provenance) = match panel.iter().find(|shown| shown.clip == *clip) {
                Some(shown) => (shown.weights_hash.clone(), shown.provenance.clone()),
                None if place == 0 => (log.weights_hash.clone(), log.provenance.clone()),
                None => (String::new(), log.beside_provenance.clone()),
            };
            let face = plan.face(clip).map(|(at_rest, from)| (at_rest.to_owned(), from));
            PlayedClip { clip: clip.clone(), face, weights_hash, provenance }
        };
        Self {
            clips: clips.iter().enumerate().map(clip).collect(),
            in_turn: *in_turn,
            frames: log.frames.clone(),
            late: log.late,
            longest_ms: log.longest_ms,
            refresh_hz: log.refresh_hz,
            size: [log.width, log.height],
            renderer: log.renderer.clone(),
            aborted: log.aborted.clone(),
        }
    }
}
