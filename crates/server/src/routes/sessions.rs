//! `/api/sessions`: a participant's session from start to receipt or withdrawal.
//!
//! The token of a session is derived from the nonce that the page made, by a key that never leaves
//! the server, so that a repeated start finds the same session although only the token's hash is
//! kept. The withdrawal code is derived from the token in the same way.

use axum::Json;
use axum::extract::{Path, State};
use mimique_study::wire::{
    Acknowledged, AppendEvents, Complete, Event, Receipt, Resume, SessionStarted, StartSession,
    Withdraw, Withdrawn,
};

use super::Body;
use crate::app::App;
use crate::clock::now_ms;
use crate::error::Error;
use crate::secret;
use crate::storage::{NewSession, SessionRecord, Status, StorageError};

/// Events in one session at most; a long study has some thousands.
const MOST_EVENTS: u64 = 100_000;
/// One event's body in bytes at most: the frame log of several minutes at 240 Hz.
const LARGEST_EVENT: usize = 1024 * 1024;
/// Hexadecimal digits of 128 bits.
const TOKEN_DIGITS: usize = 32;

pub(super) async fn start(
    State(app): State<App>,
    Path(study): Path<String>,
    Body(request): Body<StartSession>,
) -> Result<Json<SessionStarted>, Error> {
    let study = app.study(&study)?;
    if !secret::is_hex(&request.nonce, TOKEN_DIGITS) {
        return Err(Error::bad_request(
            "the nonce is not 32 lower-case hexadecimal digits",
            "make it of 128 random bits",
        ));
    }
    let token = token(&app, study.id(), &request.nonce);
    let code = withdrawal_code(&app, &token);
    let client =
        request.client.into_iter().take(8).map(|(name, value)| (clip(&name), clip(&value)));
    let client: std::collections::BTreeMap<_, _> = client.collect();
    let session = NewSession {
        token_hash: secret::hash(&token),
        withdrawal_hash: withdrawal_hash(&code),
        study_id: study.id().to_owned(),
        config_hash: study.config_hash().to_owned(),
        seed: study.study().seed,
        stage: study.stage().word().to_owned(),
        language: study.study().language_for(&request.language).to_owned(),
        client: serde_json::to_string(&client).unwrap_or_default(),
        recruitment: study.kept_parameters(request.recruitment),
        now_ms: now_ms(),
    };
    let record = app.storage.start(session).await?;
    if record.status == Status::Withdrawn {
        return Err(StorageError::Withdrawn.into());
    }
    Ok(Json(started(&app, token, &record)))
}

pub(super) async fn resume(
    State(app): State<App>,
    Path(token): Path<String>,
) -> Result<Json<Resume>, Error> {
    let record = app.storage.session(&token_hash(&token)?).await?;
    if record.status == Status::Withdrawn {
        return Err(StorageError::Withdrawn.into());
    }
    let events = app.storage.events(record.key).await?;
    Ok(Json(Resume { started: started(&app, token, &record), events }))
}

/// The events that can be stored are stored, whatever becomes of the others; an event that differs
/// from the one stored under its sequence is kept apart and named in a 409.
pub(super) async fn append(
    State(app): State<App>,
    Path(token): Path<String>,
    Body(request): Body<AppendEvents>,
) -> Result<Json<Acknowledged>, Error> {
    let token_hash = token_hash(&token)?;
    for event in &request.events {
        check_event(event)?;
    }
    let appended = app.storage.append(&token_hash, request.events, now_ms()).await?;
    if appended.conflicts.is_empty() {
        Ok(Json(appended.acknowledged))
    } else {
        Err(Error::EventConflict(appended.conflicts))
    }
}

pub(super) async fn complete(
    State(app): State<App>,
    Path(token): Path<String>,
    Body(request): Body<Complete>,
) -> Result<Json<Receipt>, Error> {
    let token_hash = token_hash(&token)?;
    if request.events == 0 || request.events > MOST_EVENTS {
        return Err(Error::bad_request(
            format!("a session cannot be complete with {} events", request.events),
            "send how many events the session has",
        ));
    }
    let completed =
        app.storage.complete(&token_hash, request.events, &app.receipt_key, now_ms()).await?;
    let mut receipt = Receipt {
        receipt: completed.receipt,
        stored: completed.stored,
        completion_code: None,
        redirect: None,
    };
    // A session may outlive its study's place on this server; its receipt stays good.
    if let Ok(study) = app.study(&completed.study_id) {
        let events = app.storage.events(completed.key).await?;
        let status = mimique_study::responses::session_status(&events);
        let code = study.study().recruitment.code_for(status);
        if code.is_some() || status == "completed" {
            let parameters = app.storage.session_recruitment(completed.key).await?;
            receipt.redirect = study.redirect(&parameters, code);
            receipt.completion_code = code.map(str::to_owned);
        }
    }
    Ok(Json(receipt))
}

pub(super) async fn withdraw(
    State(app): State<App>,
    Path(token): Path<String>,
    Body(request): Body<Withdraw>,
) -> Result<Json<Withdrawn>, Error> {
    let token_hash = token_hash(&token)?;
    let code_hash = withdrawal_hash(&request.withdrawal_code);
    let deleted = app.storage.withdraw(&token_hash, &code_hash, now_ms()).await?;
    Ok(Json(Withdrawn { deleted }))
}

fn check_event(event: &Event) -> Result<(), Error> {
    let sequence = event.sequence;
    if sequence >= MOST_EVENTS {
        return Err(Error::bad_request(
            format!("event {sequence}: a session has at most {MOST_EVENTS} events"),
            "number the events of a session from 0 without gaps",
        ));
    }
    if !event.body.is_object() {
        return Err(Error::bad_request(
            format!("event {sequence}: the body is no object"),
            "send an object with its `type`",
        ));
    }
    if event.body.to_string().len() > LARGEST_EVENT {
        return Err(Error::bad_request(
            format!("event {sequence}: the body is larger than {LARGEST_EVENT} bytes"),
            "shorten its frame log",
        ));
    }
    Ok(())
}

fn token(app: &App, study: &str, nonce: &str) -> String {
    secret::hex(&secret::derive(&app.token_key, &["session", study, nonce])[..16])
}

/// What is no token is no session's either.
fn token_hash(token: &str) -> Result<String, Error> {
    if secret::is_hex(token, TOKEN_DIGITS) {
        Ok(secret::hash(token))
    } else {
        Err(StorageError::UnknownSession.into())
    }
}

fn withdrawal_code(app: &App, token: &str) -> String {
    let derived = secret::derive(&app.token_key, &["withdrawal", token]);
    let mut bytes = [0; 10];
    bytes.copy_from_slice(&derived[..10]);
    secret::spoken(&bytes)
}

fn withdrawal_hash(code: &str) -> String {
    secret::hash(&secret::heard(code))
}

fn started(app: &App, token: String, record: &SessionRecord) -> SessionStarted {
    SessionStarted {
        withdrawal_code: withdrawal_code(app, &token),
        session: token,
        participant_id: crate::participant_id(record.participant),
        participant: record.participant,
        seed: record.seed,
        stage: record.stage.clone(),
        config_hash: record.config_hash.clone(),
    }
}

/// What a browser says of itself, without control characters and no longer than it should be.
fn clip(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(40).collect()
}
