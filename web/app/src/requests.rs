//! Requests and their answers as JSON, with the patience that the network asks for.

use std::cell::Cell;

use mimique_session::wire::Refusal;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::json;

use crate::answer::{Failure, failure};
use crate::browser::http::{self, Body};
use crate::browser::{clock, reason};
use crate::outbox::patience;

/// The requests of a page.
#[derive(Default)]
pub struct Requests {
    /// Requests since the last answer that were given up.
    unanswered: Cell<u32>,
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

impl Requests {
    /// `GET`
    pub async fn get<T: DeserializeOwned>(&self, address: &str) -> Result<T, Failure> {
        read(&self.send("GET", address, None).await?)
    }

    /// `POST`
    pub async fn post<T: DeserializeOwned>(
        &self,
        address: &str,
        body: &impl Serialize,
    ) -> Result<T, Failure> {
        let body = Body { media_type: "application/json", text: json!(body).to_string() };
        read(&self.send("POST", address, Some(body)).await?)
    }

    /// A request; a failure where no answer comes, or none in time ([`patience`]).
    pub async fn send(
        &self,
        method: &str,
        address: &str,
        body: Option<Body>,
    ) -> Result<Answer, Failure> {
        let patience = patience(self.unanswered.get());
        let begun = clock::now();
        match http::request(method, address, body, patience).await {
            Ok((status, text)) => {
                self.unanswered.set(0);
                Ok(Answer { status, text })
            }
            Err(thrown) => {
                // A connection that breaks at once says nothing of how slow it is.
                let given_up = clock::now() - begun >= patience.as_millis() as f64;
                self.unanswered.set(self.unanswered.get() + u32::from(given_up));
                Err(Failure::Unreachable(reason(&thrown)))
            }
        }
    }
}

fn read<T: DeserializeOwned>(answer: &Answer) -> Result<T, Failure> {
    if answer.ok() {
        // A page where JSON should be: something on the way answered.
        let foreign = |error| Failure::Unreachable(format!("HTTP {}: {error}", answer.status));
        return serde_json::from_str(&answer.text).map_err(foreign);
    }
    Err(failure(answer.status, serde_json::from_str::<Refusal>(&answer.text).ok()))
}
