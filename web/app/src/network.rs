//! Talking to the server: `mimique_study::wire`, as JSON; or to [`site`] where there is none.

use std::cell::Cell;
use std::collections::BTreeMap;

use js_sys::Array;
use mimique_study::Study;
use mimique_study::from_json::FromJson;
use mimique_study::wire::{
    Acknowledged, AppendEvents, Complete, Event, Receipt, Refusal, Resume, SessionStarted,
    StartSession, Withdraw, Withdrawn,
};
use serde::Serialize;
use serde_json::Value;

use wasm_bindgen::JsValue;

pub use crate::answer::Failure;
use crate::answer::failure;
use crate::outbox::patience;
use crate::{bridge, json, page, site};

thread_local! {
    /// Requests since the last answer that were given up.
    static UNANSWERED: Cell<u32> = const { Cell::new(0) };
}

/// What the pages need of `wire::Bundle`: the clips go through to the stage as they came.
#[derive(Debug, Clone, FromJson)]
pub struct Bundle {
    /// SHA-256 of the canonical study file, hexadecimal.
    pub config_hash: String,
    /// The study file.
    pub study: Value,
    /// `wire::ClipSource` of every clip.
    pub clips: BTreeMap<String, Value>,
}

/// `GET /api/studies/{study}`: the version of today, or the one of that configuration hash.
pub async fn bundle(study: &str, config_hash: Option<&str>) -> Result<Bundle, Failure> {
    if site::is_site() {
        return site::bundle().await;
    }
    let version = config_hash.map(|hash| format!("?config_hash={hash}")).unwrap_or_default();
    get(&format!("/api/studies/{study}{version}")).await
}

/// `POST /api/studies/{study}/sessions`
pub async fn start(study: &Study, body: &StartSession) -> Result<SessionStarted, Failure> {
    if site::is_site() {
        return site::start(study, body);
    }
    post(&format!("/api/studies/{}/sessions", study.id), body).await
}

/// `GET /api/sessions/{session}`
pub async fn resume(session: &str) -> Result<Resume, Failure> {
    if site::is_site() {
        return site::resume(session).await;
    }
    get(&format!("/api/sessions/{session}")).await
}

/// `POST /api/sessions/{session}/events`
pub async fn append(session: &str, events: Vec<Event>) -> Result<Acknowledged, Failure> {
    if site::is_site() {
        return site::append(events).await;
    }
    post(&format!("/api/sessions/{session}/events"), &AppendEvents { events }).await
}

/// `POST /api/sessions/{session}/complete`
pub async fn complete(session: &str, events: u64) -> Result<Receipt, Failure> {
    if site::is_site() {
        return site::complete(events).await;
    }
    post(&format!("/api/sessions/{session}/complete"), &Complete { events }).await
}

/// `POST /api/sessions/{session}/withdraw`
pub async fn withdraw(session: &str, withdrawal_code: String) -> Result<Withdrawn, Failure> {
    if site::is_site() {
        return site::withdraw().await;
    }
    post(&format!("/api/sessions/{session}/withdraw"), &Withdraw { withdrawal_code }).await
}

async fn post<T: FromJson>(address: &str, body: &impl Serialize) -> Result<T, Failure> {
    read(&send("POST", address, "application/json", Some(json::write(body))).await?)
}

/// `GET`
pub async fn get<T: FromJson>(address: &str) -> Result<T, Failure> {
    read(&send("GET", address, "", None).await?)
}

/// An answer's status and text.
pub struct Answer {
    /// 200 and so on.
    pub status: u16,
    text: String,
}

impl Answer {
    /// Whether the request was carried out.
    pub fn ok(&self) -> bool {
        (200..300).contains(&self.status)
    }
}

/// A request; a failure where no answer comes, or none in time ([`patience`]).
pub async fn send(
    method: &str,
    address: &str,
    content_type: &str,
    body: Option<String>,
) -> Result<Answer, Failure> {
    let patience = patience(UNANSWERED.get()).as_millis() as f64;
    let begun = page::now();
    let answer = page::request(method, address, content_type, body, patience).await;
    let answer: Array = match answer {
        Ok(answer) => Array::from(&answer),
        Err(thrown) => {
            // A connection that breaks at once says nothing of how slow it is.
            let given_up = page::now() - begun >= patience;
            UNANSWERED.set(UNANSWERED.get() + u32::from(given_up));
            return Err(unreachable(&thrown));
        }
    };
    UNANSWERED.set(0);
    let status = answer.get(0).as_f64().unwrap_or(0.0) as u16;
    Ok(Answer { status, text: answer.get(1).as_string().unwrap_or_default() })
}

/// No answer came: what was thrown says why.
pub fn unreachable(thrown: &JsValue) -> Failure {
    Failure::Unreachable(bridge::reason(thrown))
}

fn read<T: FromJson>(answer: &Answer) -> Result<T, Failure> {
    if answer.ok() {
        // A page where JSON should be: something on the way answered.
        let foreign = |error| Failure::Unreachable(format!("HTTP {}: {error}", answer.status));
        return json::read(&answer.text).map_err(foreign);
    }
    Err(failure(answer.status, json::read::<Refusal>(&answer.text).ok()))
}
