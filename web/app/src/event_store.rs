//! What survives a reload: who we are (localStorage) and which events are not acknowledged (IndexedDB).

use idb::{
    Database, DatabaseEvent as _, Error, Factory, KeyRange, ObjectStoreParams, Query,
    TransactionMode,
};
use mimique_session::wire::{Event, SessionStarted};
use serde::{Deserialize, Serialize};
use serde_json::json;
use wasm_bindgen::JsValue;

use crate::browser::{document, storage};

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
        match document::run() {
            Some(run) => format!("mimique/{study}/{run}"),
            None => format!("mimique/{study}"),
        }
    }

    /// The identity kept for a study.
    pub fn load(study: &str) -> Option<Self> {
        serde_json::from_str(&storage::load(&Self::key(study))?).ok()
    }

    /// Keeps it; false where the browser keeps nothing.
    pub fn save(&self, study: &str) -> bool {
        storage::save(&Self::key(study), &json!(self).to_string())
    }

    /// Forgets it.
    pub fn forget(study: &str) {
        storage::forget(&Self::key(study));
    }
}

/// A store of events of one session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Store {
    /// Events that the server has not acknowledged.
    Outbox,
    /// All events, where there is no server.
    Answers,
}

impl Store {
    const ALL: [Self; 2] = [Self::Outbox, Self::Answers];

    /// Its name in the database.
    fn name(self) -> &'static str {
        match self {
            Self::Outbox => "outbox",
            Self::Answers => "answers",
        }
    }
}

/// The events of a session, in IndexedDB. Where there is none (some private windows), the page goes on
/// with what it holds in memory, and `is_lasting` says so.
pub struct EventStore {
    database: Option<Database>,
    store: Store,
    session: String,
}

/// Name and version of the database.
const DATABASE: (&str, u32) = ("mimique", 2);

async fn open_database() -> Result<Database, Error> {
    let mut request = Factory::new()?.open(DATABASE.0, Some(DATABASE.1))?;
    request.on_upgrade_needed(|event| {
        let Ok(database) = event.database() else { return };
        let there = database.store_names();
        for store in
            Store::ALL.iter().filter(|store| !there.iter().any(|name| name == store.name()))
        {
            // A store that cannot be made is missed by the first event that is put.
            let _ = database.create_object_store(store.name(), ObjectStoreParams::new());
        }
    });
    request.await
}

impl EventStore {
    /// Opens a store of a session.
    pub async fn open(store: Store, session: &str) -> Self {
        Self { database: open_database().await.ok(), store, session: session.to_owned() }
    }

    /// Whether what is put survives a reload.
    pub fn is_lasting(&self) -> bool {
        self.database.is_some()
    }

    fn key(&self, sequence: u64) -> JsValue {
        JsValue::from_str(&format!("{}/{sequence:012}", self.session))
    }

    /// The keys of every event of the session.
    fn range(&self) -> Result<Query, Error> {
        let range = KeyRange::bound(&self.key(0), &self.key(999_999_999_999), None, None)?;
        Ok(Query::KeyRange(range))
    }

    /// Changes the store; done when IndexedDB says that it is written.
    async fn write(
        &self,
        change: impl Fn(&idb::ObjectStore) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let Some(database) = &self.database else { return Ok(()) };
        let name = self.store.name();
        let transaction = database.transaction(&[name], TransactionMode::ReadWrite)?;
        change(&transaction.object_store(name)?)?;
        match transaction.await?.is_committed() {
            true => Ok(()),
            // The disk is full, or the browser throws the data away.
            false => Err(Error::TransactionAbortError(JsValue::from_str("nothing was written"))),
        }
    }

    /// Puts an event.
    pub async fn put(&self, event: &Event) -> Result<(), Error> {
        self.put_all(std::slice::from_ref(event)).await
    }

    /// Puts events, all or none.
    pub async fn put_all(&self, events: &[Event]) -> Result<(), Error> {
        self.write(|store| {
            events.iter().try_for_each(|event| {
                let text = JsValue::from_str(&json!(event).to_string());
                store.put(&text, Some(&self.key(event.sequence))).map(drop)
            })
        })
        .await
    }

    /// Forgets events that the server has.
    pub async fn forget(&self, sequences: &[u64]) -> Result<(), Error> {
        self.write(|store| {
            sequences.iter().try_for_each(|number| store.delete(self.key(*number)).map(drop))
        })
        .await
    }

    /// Everything of the session, by sequence.
    pub async fn all(&self) -> Result<Vec<Event>, Error> {
        let Some(database) = &self.database else { return Ok(Vec::new()) };
        let name = self.store.name();
        let transaction = database.transaction(&[name], TransactionMode::ReadOnly)?;
        let values = transaction.object_store(name)?.get_all(Some(self.range()?), None)?.await?;
        Ok(values
            .iter()
            .filter_map(|value| serde_json::from_str(&value.as_string()?).ok())
            .collect())
    }

    /// Forgets everything of the session.
    pub async fn clear(&self) -> Result<(), Error> {
        self.write(|store| store.delete(self.range()?).map(drop)).await
    }
}
