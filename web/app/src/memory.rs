//! What survives a reload: who we are (localStorage) and what is not acknowledged (IndexedDB).

use idb::{
    Database, DatabaseEvent as _, Factory, KeyRange, ObjectStoreParams, Query, TransactionMode,
};
use mimique_study::wire::{Event, SessionStarted};
use serde::{Deserialize, Serialize};
use wasm_bindgen::JsValue;

use crate::json;

/// Who we are in a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
        json::read(&storage()?.get_item(&Self::key(study)).ok()??).ok()
    }

    /// Keeps it; false where the browser keeps nothing.
    pub fn save(&self, study: &str) -> bool {
        let text = serde_json::to_string(self).unwrap_or_default();
        storage().is_some_and(|storage| storage.set_item(&Self::key(study), &text).is_ok())
    }

    /// Forgets it.
    pub fn forget(study: &str) {
        if let Some(storage) = storage() {
            // What was never kept is forgotten already.
            let _ = storage.remove_item(&Self::key(study));
        }
    }
}

/// The browser's storage; none where it is forbidden.
fn storage() -> Option<web_sys::Storage> {
    web_sys::window()?.local_storage().ok()?
}

/// The events that are not acknowledged, in IndexedDB. Where there is none (some private windows),
/// the page goes on with what it holds in memory, and `is_lasting` says so.
pub struct Keep {
    database: Option<Database>,
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
        Self { database: open().await.ok(), store, session: session.to_owned() }
    }

    /// Whether what is put survives a reload.
    pub fn is_lasting(&self) -> bool {
        self.database.is_some()
    }

    fn key(&self, sequence: u64) -> JsValue {
        JsValue::from_str(&format!("{}/{sequence:012}", self.session))
    }

    fn range(&self) -> Result<Query, idb::Error> {
        let (first, last) = (self.key(0), self.key(999_999_999_999));
        Ok(Query::KeyRange(KeyRange::bound(&first, &last, None, None)?))
    }

    /// Puts an event; done when IndexedDB says that it is written.
    pub async fn put(&self, event: &Event) -> Result<(), idb::Error> {
        let Some(database) = &self.database else { return Ok(()) };
        let text = serde_json::to_string(event).unwrap_or_default();
        let transaction = database.transaction(&[self.store], TransactionMode::ReadWrite)?;
        let store = transaction.object_store(self.store)?;
        store.put(&JsValue::from_str(&text), Some(&self.key(event.sequence)))?.await?;
        transaction.commit()?.await?;
        Ok(())
    }

    /// Forgets events that the server has.
    pub async fn forget(&self, sequences: &[u64]) -> Result<(), idb::Error> {
        let Some(database) = &self.database else { return Ok(()) };
        let transaction = database.transaction(&[self.store], TransactionMode::ReadWrite)?;
        let store = transaction.object_store(self.store)?;
        for sequence in sequences {
            store.delete(self.key(*sequence))?.await?;
        }
        transaction.commit()?.await?;
        Ok(())
    }

    /// Everything kept of the session, by sequence.
    pub async fn all(&self) -> Result<Vec<Event>, idb::Error> {
        let Some(database) = &self.database else { return Ok(Vec::new()) };
        let transaction = database.transaction(&[self.store], TransactionMode::ReadOnly)?;
        let values =
            transaction.object_store(self.store)?.get_all(Some(self.range()?), None)?.await?;
        Ok(values.iter().filter_map(|value| json::read(&value.as_string()?).ok()).collect())
    }

    /// Forgets everything of the session.
    pub async fn clear(&self) -> Result<(), idb::Error> {
        let Some(database) = &self.database else { return Ok(()) };
        let transaction = database.transaction(&[self.store], TransactionMode::ReadWrite)?;
        transaction.object_store(self.store)?.delete(self.range()?)?.await?;
        transaction.commit()?.await?;
        Ok(())
    }
}

async fn open() -> Result<Database, idb::Error> {
    let mut request = Factory::new()?.open("mimique", Some(2))?;
    request.on_upgrade_needed(|event| {
        if let Ok(database) = event.database() {
            for store in [OUTBOX, ANSWERS] {
                // It fails only if the store is there already.
                let _ = database.create_object_store(store, ObjectStoreParams::new());
            }
        }
    });
    request.await
}
