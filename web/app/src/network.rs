//! Talking to the server: `mimique_study::wire`, as JSON.

use gloo::net::http::{Request, RequestBuilder, Response};
use mimique_study::wire::{
    Acknowledged, AppendEvents, Bundle, Complete, Event, Receipt, Refusal, Resume, SessionStarted,
    StartSession, Withdraw, Withdrawn,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Why a request brought nothing.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// No answer, or one that says to come back later: worth another try.
    Unreachable(String),
    /// The server understood and refuses: trying again changes nothing.
    Refused(Refusal),
}

/// `GET /api/studies/{study}`
pub async fn bundle(study: &str) -> Result<Bundle, Failure> {
    read(Request::get(&format!("/api/studies/{study}")).send().await).await
}

/// `POST /api/studies/{study}/sessions`
pub async fn start(study: &str, body: &StartSession) -> Result<SessionStarted, Failure> {
    post(&format!("/api/studies/{study}/sessions"), body).await
}

/// `GET /api/sessions/{session}`
pub async fn resume(session: &str) -> Result<Resume, Failure> {
    read(Request::get(&format!("/api/sessions/{session}")).send().await).await
}

/// `POST /api/sessions/{session}/events`
pub async fn append(session: &str, events: Vec<Event>) -> Result<Acknowledged, Failure> {
    post(&format!("/api/sessions/{session}/events"), &AppendEvents { events }).await
}

/// `POST /api/sessions/{session}/complete`
pub async fn complete(session: &str, events: u64) -> Result<Receipt, Failure> {
    post(&format!("/api/sessions/{session}/complete"), &Complete { events }).await
}

/// `POST /api/sessions/{session}/withdraw`
pub async fn withdraw(session: &str, withdrawal_code: String) -> Result<Withdrawn, Failure> {
    post(&format!("/api/sessions/{session}/withdraw"), &Withdraw { withdrawal_code }).await
}

async fn post<T: DeserializeOwned>(address: &str, body: &impl Serialize) -> Result<T, Failure> {
    let request: RequestBuilder = Request::post(address);
    match request.json(body) {
        Ok(request) => read(request.send().await).await,
        Err(error) => Err(Failure::Unreachable(error.to_string())),
    }
}

async fn read<T: DeserializeOwned>(
    answer: Result<Response, gloo::net::Error>,
) -> Result<T, Failure> {
    let answer = answer.map_err(|error| Failure::Unreachable(error.to_string()))?;
    if answer.ok() {
        return answer.json().await.map_err(|error| Failure::Unreachable(error.to_string()));
    }
    let status = answer.status();
    // Too early, too many, too late: the server wants us to come back.
    let later = status >= 500 || matches!(status, 408 | 425 | 429);
    match answer.json::<Refusal>().await {
        Ok(refusal) if !later => Err(Failure::Refused(refusal)),
        _ if later => Err(Failure::Unreachable(format!("HTTP {status}"))),
        _ => Err(Failure::Refused(Refusal {
            code: format!("http-{status}"),
            message: format!("HTTP {status}"),
            remedy: String::new(),
            sequences: Vec::new(),
        })),
    }
}
