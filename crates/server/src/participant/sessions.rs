//! `/api/sessions`: a participant's session from start to receipt or withdrawal.
//!
//! The token of a session is derived from the nonce that the page made, by a key that never leaves
//! the server, so that a repeated start finds the same session although only the token's hash is
//! kept. The withdrawal code is derived from the token in the same way.

use std::time::Instant;

use axum::Json;
use axum::extract::{Extension, Path, State};
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use mimique_session::wire::{
    Acknowledged, AppendEvents, Complete, Event, Receipt, SessionStarted, StartSession, Withdraw,
    Withdrawn,
};
use mimique_session::{Admission, Standing};
use mimique_storage::{NewSession, SessionRecord, StorageError, WrittenEvent};
use mimique_study::{Multilingual as _, Study};

use super::marks::{browser_mark, cookie_name, marks};
use super::resumed::resumed;
use crate::clock::now_ms;
use crate::error::Error;
use crate::http::cookies::{self, Pages};
use crate::http::extract::Body;
use crate::http::rate_limit::caller_of;
use crate::participant::withdrawal::withdrawal_hash;
use crate::secret;
use crate::state::App;
use crate::state::hosted_study::HostedStudy;
use crate::state::rate_limit::Peer;

/// Events in one session at most; a long study has some thousands.
const MOST_EVENTS: u64 = 100_000;
/// One event's body in bytes at most: the frame log of several minutes at 240 Hz.
const LARGEST_EVENT: usize = 1024 * 1024;
/// What is kept of a browser: its name, its major version, the kind of system it runs on.
const CLIENT_KEYS: [&str; 3] = ["browser", "version", "platform"];
/// Hexadecimal digits of 128 bits.
pub(super) const TOKEN_DIGITS: usize = 32;

/// Somebody who asks to begin.
struct Arrival {
    session: NewSession,
    token: String,
    browser_mark: Option<String>,
}

/// Whether somebody could begin; nothing is written.
pub(crate) async fn arrive(
    State(app): State<App>,
    Path(study): Path<String>,
    headers: HeaderMap,
    Body(request): Body<StartSession>,
) -> Result<Json<()>, Error> {
    let study = app.study(&study)?;
    let Arrival { session, .. } = arrival(&app, &study, &headers, request).await?;
    let language = session.language.clone();
    app.storage.may_start(&session).await.map_err(|error| refused(&study, error, &language))?;
    Ok(Json(()))
}

pub(crate) async fn start(
    State(app): State<App>,
    Path(study): Path<String>,
    peer: Option<Extension<Peer>>,
    headers: HeaderMap,
    Body(request): Body<StartSession>,
) -> Result<Response, Error> {
    let study = app.study(&study)?;
    let study = study.as_ref();
    let takes_part = !request.turned_away;
    let Arrival { session, token, browser_mark } = arrival(&app, study, &headers, request).await?;
    let (language, token_hash) = (session.language.clone(), session.token_hash.clone());
    let address = caller_of(&app, &headers, peer.map(|Extension(peer)| peer));
    let address = address.filter(|address| takes_part && !app.settings.is_own(*address));
    if let Some(address) = address
        && !has_begun(&app, &token).await?
    {
        if !app.starts.allow(address, app.settings.starts_per_minute, Instant::now()) {
            return Err(Error::TooManyStarts);
        }
        app.starts.begun(&token_hash, address, Instant::now());
    }
    let record = app.storage.start(session).await;
    let record = record.map_err(|error| {
        app.starts.heard(&token_hash);
        refused(study, error, &language)
    })?;
    if record.is_deleted() {
        return Err(StorageError::Withdrawn.into());
    }
    let mut response = Json(started(&app, token, &record)).into_response();
    if let Some(mark) = browser_mark {
        let path = format!("/api/studies/{}/", study.id());
        let pages = match app.settings.embedding.is_empty() {
            true => Pages::OwnSite,
            false => Pages::Frames,
        };
        let name = cookie_name(study);
        let cookie = cookies::set_below(&path, &name, &mark, app.is_encrypted(), pages)?;
        response.headers_mut().insert(header::SET_COOKIE, cookie);
    }
    Ok(response)
}

fn refused(study: &HostedStudy, error: StorageError, language: &str) -> Error {
    match error {
        StorageError::AlreadyTookPart => cannot_begin(study.study(), "already-took-part", language),
        StorageError::StudyFull => cannot_begin(study.study(), "study-full", language),
        error => error.into(),
    }
}

/// What somebody who asks to begin would be given. Whoever is turned away holds no place and uses no
/// identifier, and is told nothing of hours.
async fn arrival(
    app: &App,
    study: &HostedStudy,
    headers: &HeaderMap,
    request: StartSession,
) -> Result<Arrival, Error> {
    if !secret::is_hex(&request.nonce, TOKEN_DIGITS) {
        return Err(Error::BadNonce);
    }
    let takes_part = !request.turned_away;
    let token = token(app, study.id(), &request.nonce);
    let code = withdrawal_code(app, &token);
    let client: std::collections::BTreeMap<_, _> = request
        .client
        .iter()
        .filter(|(name, _)| CLIENT_KEYS.contains(&name.as_str()))
        .map(|(name, value)| (name.as_str(), one_word(value)))
        .collect();
    let language = study.study().language_for(&request.language).to_owned();
    let recruitment = study.kept_parameters(request.recruitment);
    let browser_mark = takes_part.then(|| browser_mark(app, study, &token)).flatten();
    let marks = match takes_part {
        true => marks(app, study, &recruitment, browser_mark.as_deref(), headers)
            .ok_or_else(|| cannot_begin(study.study(), "no-identifier", &language))?,
        false => Vec::new(),
    };
    if takes_part {
        refuse_outside_hours(app, study, &token, &language).await?;
    }
    let conditions = conditions(app, study, request.condition, &token, &language).await?;
    let rules = &study.study().recruitment;
    let session = NewSession {
        token_hash: secret::hash(&token),
        withdrawal_hash: withdrawal_hash(&code),
        study_id: study.id().to_owned(),
        config_hash: study.config_hash().to_owned(),
        seed: study.study().seed,
        stage: study.stage().word().to_owned(),
        language: language.clone(),
        client: serde_json::to_string(&client).unwrap_or_default(),
        recruitment,
        marks,
        conditions,
        places: rules.participants.filter(|_| takes_part),
        reservation_ms: if takes_part { rules.reservation_ms() } else { 0 },
        now_ms: now_ms(),
    };
    Ok(Arrival { session, token, browser_mark })
}

/// Before the study opens and after it closes nobody begins; who has begun goes on.
async fn refuse_outside_hours(
    app: &App,
    study: &HostedStudy,
    token: &str,
    language: &str,
) -> Result<(), Error> {
    let recruitment = &study.study().recruitment;
    let now = now_ms();
    let code = if recruitment.opens_ms().is_some_and(|opens| now < opens) {
        "study-not-open"
    } else if recruitment.closes_ms().is_some_and(|closes| now >= closes) {
        "study-closed"
    } else {
        return Ok(());
    };
    match has_begun(app, token).await? {
        true => Ok(()),
        false => Err(cannot_begin(study.study(), code, language)),
    }
}

async fn has_begun(app: &App, token: &str) -> Result<bool, Error> {
    match app.storage.session(&secret::hash(token)).await {
        Ok(_) => Ok(true),
        Err(StorageError::UnknownSession) => Ok(false),
        Err(error) => Err(error.into()),
    }
}

/// The conditions between which the participant is put: the one that the address names, or all. A
/// session that has begun keeps its own, whatever the address says now.
async fn conditions(
    app: &App,
    study: &HostedStudy,
    asked: Option<String>,
    token: &str,
    language: &str,
) -> Result<Vec<String>, Error> {
    match study.study().sequence.conditions_for(asked.as_deref()) {
        Ok(names) => Ok(names.into_iter().map(str::to_owned).collect()),
        Err(_) if has_begun(app, token).await? => Ok(Vec::new()),
        Err(unknown) => {
            let (message, remedy) = study.study().words(language).unknown_condition(&unknown);
            Err(Error::CannotBegin { code: "unknown-condition", message, remedy })
        }
    }
}

fn cannot_begin(study: &Study, code: &'static str, language: &str) -> Error {
    let words = study.words(language);
    let (message, remedy) = words.refusal(code).unwrap_or(("", ""));
    Error::CannotBegin { code, message: message.to_owned(), remedy: remedy.to_owned() }
}

pub(crate) async fn resume(
    State(app): State<App>,
    Path(token): Path<String>,
) -> Result<Response, Error> {
    let record = app.storage.session(&token_hash(&token)?).await?;
    if record.is_deleted() {
        return Err(StorageError::Withdrawn.into());
    }
    let key = record.key;
    resumed(app.storage.clone(), key, &started(&app, token, &record))
}

/// The events that can be stored are stored, whatever becomes of the others; an event that differs
/// from the one stored under its sequence is kept apart and named in a 409.
pub(crate) async fn append(
    State(app): State<App>,
    Path(token): Path<String>,
    Body(request): Body<AppendEvents>,
) -> Result<Json<Acknowledged>, Error> {
    let token_hash = token_hash(&token)?;
    for event in &request.events {
        check_event(event)?;
    }
    let admission = app.admissions.of(&app.storage, &token_hash).await?;
    let events: Vec<WrittenEvent> = request
        .events
        .into_iter()
        .map(|event| written(event, admission.as_deref()))
        .collect::<Result<_, _>>()?;
    let sent = events.len() as u64;
    let is_heard = events.iter().any(|event| event.misfit.is_none());
    let limits = admission.map(|admission| admission.limits());
    let appended = app.storage.append_written(&token_hash, events, limits, now_ms()).await?;
    if is_heard {
        app.starts.heard(&token_hash);
    }
    let kept = sent - appended.conflicts.len() as u64;
    app.metrics.events.inc_by(kept);
    if appended.conflicts.is_empty() {
        Ok(Json(appended.acknowledged))
    } else {
        Err(Error::EventConflict { count: appended.conflicts.len(), sequences: appended.conflicts })
    }
}

pub(crate) async fn complete(
    State(app): State<App>,
    Path(token): Path<String>,
    Body(request): Body<Complete>,
) -> Result<Json<Receipt>, Error> {
    let token_hash = token_hash(&token)?;
    if request.events == 0 || request.events > MOST_EVENTS {
        return Err(Error::BadEventCount { events: request.events });
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
        let record = app.storage.record_without_plays(completed.key, completed.stored).await?;
        let standing = record.standing;
        let admission = app.admissions.of(&app.storage, &token_hash).await?;
        // Who says to have finished has to have held a place, and to have been through what lies before.
        let held_place = app.storage.session(&token_hash).await?.slot_lasts_ms > 0;
        let is_earned = standing != Standing::Completed
            || (held_place && admission.is_none_or(|admission| admission.is_done(&record)));
        let code = standing.completion_code(&study.study().recruitment);
        if is_earned && (code.is_some() || standing == Standing::Completed) {
            let parameters = app.storage.session_recruitment(completed.key).await?;
            receipt.redirect = study.redirect(&parameters, code);
            receipt.completion_code = code.map(str::to_owned);
        }
    }
    Ok(Json(receipt))
}

pub(crate) async fn withdraw(
    State(app): State<App>,
    Path(token): Path<String>,
    Body(request): Body<Withdraw>,
) -> Result<Json<Withdrawn>, Error> {
    let token_hash = token_hash(&token)?;
    let code_hash = withdrawal_hash(&request.withdrawal_code);
    let done = app.storage.withdraw(&token_hash, &code_hash, now_ms()).await?;
    Ok(Json(Withdrawn { deleted: done.deleted }))
}

fn check_event(event: &Event) -> Result<(), Error> {
    let sequence = event.sequence;
    if sequence >= MOST_EVENTS {
        return Err(Error::EventBeyondEnd { sequence, most: MOST_EVENTS });
    }
    if !event.body.is_object() {
        return Err(Error::EventNotAnObject { sequence });
    }
    Ok(())
}

/// The event as it is stored: what the session's plan cannot hold is kept and marked.
fn written(event: Event, admission: Option<&Admission>) -> Result<WrittenEvent, Error> {
    let sequence = event.sequence;
    let misfit = admission.and_then(|admission| admission.misfit(&event.body));
    let event = WrittenEvent::from(event).found(misfit);
    if event.body.len() > LARGEST_EVENT {
        return Err(Error::EventTooLarge { sequence, most_bytes: LARGEST_EVENT });
    }
    Ok(event)
}

fn token(app: &App, study: &str, nonce: &str) -> String {
    hex::encode(&secret::derive(&app.token_key, &["session", study, nonce])[..16])
}

/// Text that is not a token belongs to no session.
pub(super) fn token_hash(token: &str) -> Result<String, Error> {
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

fn started(app: &App, token: String, record: &SessionRecord) -> SessionStarted {
    SessionStarted {
        withdrawal_code: withdrawal_code(app, &token),
        session: token,
        participant_id: mimique_storage::participant_id(record.participant),
        participant: record.participant,
        slot: record.slot,
        condition: record.condition.clone(),
        seed: record.seed,
        stage: record.stage.clone(),
        config_hash: record.config_hash.clone(),
    }
}

/// What a browser reports about itself: one short word or number, so that no user agent string fits.
fn one_word(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || matches!(c, '-' | '_')).take(24).collect()
}
