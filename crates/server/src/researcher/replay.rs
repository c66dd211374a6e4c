//! A session gone through again: what its participant saw, made of its events under its own version of the study.

use mimique_session::EventKind;
use mimique_session::flow::{PlacedClip, Plan, Seen, SeenPage, SeenPlay, View};
use mimique_storage::{SessionRecord, Storage};
use serde::Serialize;
use serde_json::Value;
use tokio_stream::StreamExt as _;

use crate::error::Error;
use crate::export::sources::{Sources, as_started};

/// What a participant saw, and the plan that it followed.
pub(crate) struct Replay {
    pub plan: Plan,
    pub pages: Vec<SeenPage>,
}

impl Replay {
    /// Reads the events of a session one by one; frames are kept of one page, by its place from 0.
    pub async fn load(
        storage: &Storage,
        study_id: &str,
        session: &SessionRecord,
        frames_of: Option<usize>,
    ) -> Result<Self, Error> {
        let sources = Sources::load(storage, study_id).await?;
        let study = sources.version(&session.config_hash)?.study.projection();
        let plan = Plan::new(study, as_started(session))
            .map_err(|error| Error::NoReplay { problem: error.to_string() })?;
        let mut seen = Seen::new(&plan, frames_of);
        let mut events = storage.stored_events(session.key, 0..session.next_sequence);
        while let Some(event) = events.next().await {
            let event = event?;
            seen.add(event.sequence, event.at_ms, EventKind::from_text(&event.body));
        }
        let pages = seen.pages();
        Ok(Self { plan, pages })
    }

    /// The plays of a page, as the page's script draws them again.
    pub fn plays(&self, page: usize) -> Option<Plays> {
        let page = self.pages.get(page)?;
        let plays = page.plays.iter().map(|play| Play::of(&self.plan, play)).collect();
        let beside = match &page.view {
            View::Trial(trial) => trial.beside.as_ref(),
            _ => None,
        };
        Some(Plays {
            config_hash: self.plan.started.config_hash.clone(),
            beside_left: beside.is_some_and(|beside| beside.left),
            plays,
        })
    }
}

/// The plays of a page.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Plays {
    /// The version of the study in which the clips are.
    config_hash: String,
    /// Whether the second clip of a pair stood left.
    beside_left: bool,
    plays: Vec<Play>,
}

/// A play of one clip, or of several.
#[derive(Serialize)]
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
#[derive(Serialize)]
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
