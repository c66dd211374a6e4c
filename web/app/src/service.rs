//! Who answers the page: the server it came from, or its own site's files where there is none.

use mimique_session::wire::{
    Acknowledged, Event, Receipt, Resume, SessionStarted, StartSession, Withdrawn,
};
use mimique_study::StudyProjection;
use serde_json::Value;

use crate::answer::Failure;
use crate::browser::document;
use crate::server::{Bundle, Server};
use crate::site::Site;

/// Who answers the page.
pub enum Service {
    /// The server.
    Server(Server),
    /// The files of a static host.
    Site(Box<Site>),
}

impl Service {
    /// The one that the document names.
    pub fn of_document() -> Self {
        match document::site() {
            Some((file, study)) => Self::Site(Box::new(Site::new(file, study))),
            None => Self::Server(Server::default()),
        }
    }

    /// The site, where there is no server.
    pub fn site(&self) -> Option<&Site> {
        match self {
            Self::Server(_) => None,
            Self::Site(site) => Some(site),
        }
    }

    /// The study: the version of today, or the one of that configuration hash.
    pub async fn bundle(&self, study: &str, config_hash: Option<&str>) -> Result<Bundle, Failure> {
        match self {
            Self::Server(server) => server.bundle(study, config_hash).await,
            Self::Site(site) => site.bundle().await,
        }
    }

    /// Asks whether this participant could begin; nothing is kept of it.
    pub async fn ask(&self, study: &StudyProjection, body: &StartSession) -> Result<(), Failure> {
        match self {
            Self::Server(server) => server.ask(&study.id, body).await,
            Self::Site(site) => site.start(study, body).map(drop),
        }
    }

    /// Begins a session; repeated with the same nonce it is the same session.
    pub async fn start(
        &self,
        study: &StudyProjection,
        body: &StartSession,
    ) -> Result<SessionStarted, Failure> {
        match self {
            Self::Server(server) => server.start(&study.id, body).await,
            Self::Site(site) => site.start(study, body),
        }
    }

    /// The session as it was started, and its events.
    pub async fn resume(&self, session: &str) -> Result<Resume, Failure> {
        match self {
            Self::Server(server) => server.resume(session).await,
            Self::Site(site) => site.resume(session).await,
        }
    }

    /// Stores events.
    pub async fn append(&self, session: &str, events: Vec<Event>) -> Result<Acknowledged, Failure> {
        match self {
            Self::Server(server) => server.append(session, events).await,
            Self::Site(site) => site.append(events).await,
        }
    }

    /// What all others answered to the pairs of a block; a static host knows nobody else.
    pub async fn pair_counts(&self, session: &str, component: &str) -> Result<Value, Failure> {
        match self {
            Self::Server(server) => server.pair_counts(session, component).await,
            Self::Site(_) => Ok(Value::Array(Vec::new())),
        }
    }

    /// Closes a session of so many events.
    pub async fn complete(&self, session: &str, events: u64) -> Result<Receipt, Failure> {
        match self {
            Self::Server(server) => server.complete(session, events).await,
            Self::Site(site) => site.complete(events).await,
        }
    }

    /// Deletes a session.
    pub async fn withdraw(&self, session: &str, code: &str) -> Result<Withdrawn, Failure> {
        match self {
            Self::Server(server) => server.withdraw(session, code).await,
            Self::Site(site) => site.withdraw().await,
        }
    }
}
