//! Talking to the server: `mimique_session::wire`, as JSON.

use mimique_session::wire::{
    Acknowledged, AppendEvents, Complete, Event, Receipt, Resume, SessionStarted, StartSession,
    Withdraw, Withdrawn,
};
use serde_json::Value;

use crate::answer::Failure;
use crate::requests::Requests;

/// What the server sends of a study; the clips go through to the stage as they came.
pub type Bundle = mimique_session::wire::Bundle<Value>;

/// The server that the page came from.
#[derive(Default)]
pub struct Server {
    requests: Requests,
}

impl Server {
    /// `GET /api/studies/{study}`: the version of today, or the one of that configuration hash.
    pub async fn bundle(&self, study: &str, config_hash: Option<&str>) -> Result<Bundle, Failure> {
        let version = config_hash.map(|hash| format!("?config_hash={hash}")).unwrap_or_default();
        self.requests.get(&format!("/api/studies/{study}{version}")).await
    }

    /// `POST /api/studies/{study}/arrivals`
    pub async fn ask(&self, study: &str, body: &StartSession) -> Result<(), Failure> {
        self.requests.post(&format!("/api/studies/{study}/arrivals"), body).await
    }

    /// `POST /api/studies/{study}/sessions`
    pub async fn start(&self, study: &str, body: &StartSession) -> Result<SessionStarted, Failure> {
        self.requests.post(&format!("/api/studies/{study}/sessions"), body).await
    }

    /// `GET /api/sessions/{session}`
    pub async fn resume(&self, session: &str) -> Result<Resume, Failure> {
        self.requests.get(&format!("/api/sessions/{session}")).await
    }

    /// `POST /api/sessions/{session}/events`
    pub async fn append(&self, session: &str, events: Vec<Event>) -> Result<Acknowledged, Failure> {
        let body = AppendEvents { events };
        self.requests.post(&format!("/api/sessions/{session}/events"), &body).await
    }

    /// `GET /api/sessions/{session}/pairs/{component}`
    pub async fn pair_counts(&self, session: &str, component: &str) -> Result<Value, Failure> {
        self.requests.get(&format!("/api/sessions/{session}/pairs/{component}")).await
    }

    /// `POST /api/sessions/{session}/complete`
    pub async fn complete(&self, session: &str, events: u64) -> Result<Receipt, Failure> {
        let body = Complete { events };
        self.requests.post(&format!("/api/sessions/{session}/complete"), &body).await
    }

    /// `POST /api/sessions/{session}/withdraw`
    pub async fn withdraw(&self, session: &str, code: &str) -> Result<Withdrawn, Failure> {
        let body = Withdraw { withdrawal_code: code.to_owned() };
        self.requests.post(&format!("/api/sessions/{session}/withdraw"), &body).await
    }
}
