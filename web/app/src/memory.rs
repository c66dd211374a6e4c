//! What survives a reload: who we are (localStorage) and what is not acknowledged (IndexedDB).

use js_sys::Array;
use mimique_study::from_json::FromJson;
use mimique_study::wire::{Event, SessionStarted};
use serde::Serialize;
use wasm_bindgen::JsValue;

use crate::{json, page};

/// Who we are in a study.
#[derive(Debug, Clone, PartialEq, Serialize, FromJson)]
pub struct Identity {
    /// Made here; a repeated start with it gives the same session.
    pub nonce: String,
    /// The session, once the server has given one.
    pub started: Option<SessionStarted>,
}

impl Identity {
    fn key(study: &str) -> String {
        format!("mimique/{study}")
    }

    /// The identity kept for a study.
    pub fn load(study: &str) -> Option<Self> {
        json::read(&page::load(&Self::key(study))?).ok()
    }

    /// Keeps it; false where the browser keeps nothing.
    pub fn save(&self, study: &str) -> bool {
        let text = json::write(self);
        page::save(&Self::key(study), Some(text))
    }

    /// Forgets it.
    pub fn forget(study: &str) {
        page::save(&Self::key(study), None);
    }
}

/// The events that are not acknowledged, in IndexedDB. Where there is none (some private windows),
/// the page goes on with what it holds in memory, and `is_lasting` says so.
pub struct Keep {
    lasting: bool,
    store: &'static str,
    session: String,
}

/// What the server has not acknowledged.
const OUTBOX: &str = "outbox";
/// All answers, where there is no server.
pub const ANSWERS: &str = "answers";

impl Keep {
    /// Opens the keep of a session.
    pub async fn open(session: &str) -> Self {
        Self::open_store(OUTBOX, session).await
    }

    /// Opens one of the stores for a session.
    pub async fn open_store(store: &'static str, session: &str) -> Self {
        let lasting = page::open_database().await.is_ok();
        Self { lasting, store, session: session.to_owned() }
    }

    /// Whether what is put survives a reload.
    pub fn is_lasting(&self) -> bool {
        self.lasting
    }

    fn key(&self, sequence: u64) -> String {
        format!("{}/{sequence:012}", self.session)
    }

    fn ends(&self) -> (String, String) {
        (self.key(0), self.key(999_999_999_999))
    }

    /// Puts an event; done when IndexedDB says that it is written.
    pub async fn put(&self, event: &Event) -> Result<(), JsValue> {
        if self.lasting {
            let text = json::write(event);
            page::put(self.store, &self.key(event.sequence), &text).await?;
        }
        Ok(())
    }

    /// Forgets events that the server has.
    pub async fn forget(&self, sequences: &[u64]) -> Result<(), JsValue> {
        if self.lasting {
            let keys = Array::new();
            for sequence in sequences {
                keys.push(&JsValue::from_str(&self.key(*sequence)));
            }
            page::forget(self.store, keys).await?;
        }
        Ok(())
    }

    /// Everything kept of the session, by sequence.
    pub async fn all(&self) -> Result<Vec<Event>, JsValue> {
        if !self.lasting {
            return Ok(Vec::new());
        }
        let (first, last) = self.ends();
        let values = Array::from(&page::all(self.store, &first, &last).await?);
        Ok(values.iter().filter_map(|value| json::read(&value.as_string()?).ok()).collect())
    }

    /// Forgets everything of the session.
    pub async fn clear(&self) -> Result<(), JsValue> {
        if self.lasting {
            let (first, last) = self.ends();
            page::clear(self.store, &first, &last).await?;
        }
        Ok(())
    }
}
