//! A session gone through again: what its participant saw, made of its events under its own version of the study.

use mimique_session::EventKind;
use mimique_session::flow::{KeptFrames, Plan, Plays, Seen, SeenPage};
use mimique_storage::{SessionRecord, Storage};
use tokio_stream::StreamExt as _;

use crate::error::Error;
use crate::export::sources::{Sources, as_started};

/// What a participant saw, and the plan that it followed.
pub(crate) struct Replay {
    pub plan: Plan,
    pub pages: Vec<SeenPage>,
}

impl Replay {
    /// Reads the events of a session one by one; frames are kept of the pages that are asked for.
    pub async fn load(
        storage: &Storage,
        study_id: &str,
        session: &SessionRecord,
        frames: KeptFrames,
    ) -> Result<Self, Error> {
        let sources = Sources::load(storage, study_id).await?;
        let study = sources.version(&session.config_hash)?.study.projection();
        let plan = Plan::new(study, as_started(session))
            .map_err(|error| Error::NoReplay { problem: error.to_string() })?;
        let mut seen = Seen::new(&plan, frames);
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
        self.pages.get(page).map(|page| Plays::of(&self.plan, page))
    }
}
