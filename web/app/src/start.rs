//! From the address to a running session: fetch the study, then resume the session that this browser is in
//! the middle of, or show agreement and device gate. Until both are passed nothing is kept, here or on the
//! server: the plan is a stand-in's, and its events are in memory alone. [`enter`] begins the session.

use std::collections::BTreeMap;
use std::rc::Rc;

use mimique_session::flow::{Input, Plan, State};
use mimique_session::wire::{Event, Refusal, SessionStarted, StartSession};
use mimique_session::{Client, EventKind};
use mimique_study::text::Words;
use mimique_study::{Multilingual as _, StudyProjection};
use serde_json::Value;

use crate::address::Address;
use crate::answer::{Failure, is_gone, refusal};
use crate::browser::{clock, document, host, random};
use crate::client::{about, client};
use crate::engine::{Beginning, Engine};
use crate::event_store::{EventStore, Identity, Store};
use crate::outbox::{back_off, put};
use crate::server::Bundle;
use crate::service::Service;

/// What keeps the page from beginning.
#[derive(Debug)]
pub enum Trouble {
    /// The address names no study.
    NoStudy,
    /// The server cannot be reached.
    Unreachable(String),
    /// The server refuses.
    Refused(Refusal),
    /// The study cannot be read by this page.
    Unreadable(String),
    /// The session is open in another tab.
    OtherTab,
}

/// Whether this browser is in the middle of a session of the study that the address names.
pub fn is_under_way() -> bool {
    let address = address(&Service::of_document());
    let identity = address.and_then(|address| Identity::load(&address.study));
    identity.is_some_and(|identity| identity.started.is_some())
}

/// The address of the study.
fn address(service: &Service) -> Option<Address> {
    let query = document::query();
    match service.site() {
        Some(site) => Some(Address::of_study(site.study(), &query)),
        None => Address::parse(&document::path(), &query),
    }
}

/// Everything before the first page; `fixed` becomes what is said if it fails, in the study's own words
/// as soon as it is there. `changed` is called when something changed that the screen shows.
pub async fn begin(fixed: &mut Words, changed: Rc<dyn Fn()>) -> Result<Rc<Engine>, Trouble> {
    let service = Service::of_document();
    let address = address(&service).ok_or(Trouble::NoStudy)?;
    let bundle = bundle(&service, &address.study).await?;
    let Bundle { study, clips, .. } = bundle;
    let language = language(&address, &study);
    *fixed = study.words(&language);
    document::describe(&language, study.title.in_language(&language));

    if !host::hold_session(&address.study).await.is_ok_and(|held| held.as_bool() != Some(false)) {
        return Err(Trouble::OtherTab);
    }
    let service = Rc::new(service);
    let Some((started, events)) = resume(&service, &address).await? else {
        return lobby(service, &address, study, clips, &language, changed).await;
    };
    let store = EventStore::open(Store::Outbox, &started.session).await;
    let stored =
        (0_u64..).zip(&events).take_while(|(n, event)| event.sequence == *n).count() as u64;
    let mut all: Vec<Event> = Vec::new();
    let unsent = store.all().await.unwrap_or_default();
    for event in unsent.iter().cloned().chain(events) {
        put(&mut all, event);
    }
    // What the server has need not be kept: the answer that said so was never heard here.
    let known: Vec<u64> =
        unsent.iter().map(|event| event.sequence).filter(|number| *number < stored).collect();
    let _ = store.forget(&known).await;

    let plan = planned(study, started)?;
    let (state, input): (State, fn(Client) -> Input) = if all.is_empty() {
        (State::new(&plan, &language), Input::Opened)
    } else {
        (State::replay(&plan, &all), Input::Resumed)
    };
    let store = Some(store);
    let beginning = Beginning { plan, state, clips, service, store, stored, unsent };
    let engine = Engine::new(beginning, changed);
    engine.dispatch(input(client()));
    engine.open();
    Ok(engine)
}

fn planned(study: StudyProjection, started: SessionStarted) -> Result<Plan, Trouble> {
    Plan::new(study, started).map_err(|error| Trouble::Unreadable(error.to_string()))
}

/// Agreement and device gate. Whoever could not begin is told before reading.
async fn lobby(
    service: Rc<Service>,
    address: &Address,
    study: StudyProjection,
    clips: BTreeMap<String, Value>,
    language: &str,
    changed: Rc<dyn Fn()>,
) -> Result<Rc<Engine>, Trouble> {
    let ask = arrival(address, &new_nonce()?, language);
    persist(|| service.ask(&study, &ask)).await?;
    let conditions = study.sequence.conditions_for(address.condition.as_deref());
    let condition = conditions.ok().and_then(|names| names.first().map(|name| (*name).to_owned()));
    let stand_in = SessionStarted {
        session: String::new(),
        participant_id: String::new(),
        participant: 1,
        slot: 1,
        condition,
        seed: 0,
        stage: String::new(),
        config_hash: String::new(),
        withdrawal_code: String::new(),
    };
    let plan = planned(study, stand_in)?;
    let state = State::new(&plan, language);
    let (store, stored, unsent) = (None, 0, Vec::new());
    let beginning = Beginning { plan, state, clips, service, store, stored, unsent };
    let engine = Engine::new(beginning, changed);
    engine.dispatch(Input::Opened(client()));
    engine.open();
    Ok(engine)
}

/// Begins the session of somebody who has passed the lobby, or whose device cannot take part: what
/// happened there is its beginning.
pub async fn enter(lobby: &Engine, changed: Rc<dyn Fn()>) -> Result<Rc<Engine>, Trouble> {
    let service = Rc::clone(&lobby.service);
    let study = lobby.plan.study.clone();
    let language = lobby.language();
    let turned_away = !lobby.state().record.standing.is_open();
    let query = document::query();
    let address = Address::of_study(&study.id, &query);
    let started = begin_session(&service, &address, &study, &language, turned_away).await?;
    let store = EventStore::open(Store::Outbox, &started.session).await;
    let plan = planned(study, started)?;
    let events = lobby.unkept();
    let state = State::replay(&plan, &events);
    // Kept before the next page is shown: a reload finds the agreement given.
    let kept = store.put_all(&events).await.is_ok();
    let (unsent, later) = if kept { (events, Vec::new()) } else { (Vec::new(), events) };
    let (clips, store, stored) = (lobby.clips.clone(), Some(store), 0);
    let beginning = Beginning { plan, state, clips, service, store, stored, unsent };
    let engine = Engine::new(beginning, changed);
    engine.keep(later);
    engine.open();
    engine.dispatch(Input::Begun);
    Ok(engine)
}

/// Counts somebody who has declined, and nothing of them. What is lost on the way is lost.
pub async fn count_declined(lobby: &Engine) {
    let study = &lobby.plan.study;
    let Ok(nonce) = new_nonce() else { return };
    let language = lobby.language();
    let condition = Address::of_study(&study.id, &document::query()).condition;
    let (turned_away, at_ms) = (true, clock::now());
    let body = StartSession {
        nonce,
        condition,
        language: language.clone(),
        turned_away,
        ..StartSession::default()
    };
    let Ok(started) = lobby.service.start(study, &body).await else { return };
    let kinds = [EventKind::Opened { client: Client::default(), language }, EventKind::Declined];
    let events =
        (0..).zip(kinds).map(|(sequence, kind)| Event { sequence, at_ms, body: kind.to_body() });
    let _ = lobby.service.append(&started.session, events.collect()).await;
}

fn new_nonce() -> Result<String, Trouble> {
    random::nonce(16).map_err(|error| Trouble::Unreadable(error.to_string()))
}

fn arrival(address: &Address, nonce: &str, language: &str) -> StartSession {
    StartSession {
        nonce: nonce.to_owned(),
        recruitment: address.recruitment.clone(),
        condition: address.condition.clone(),
        language: language.to_owned(),
        client: about(),
        turned_away: false,
    }
}

/// The language of the pages: the address's first, then the browser's, of those that the study has.
fn language(address: &Address, study: &StudyProjection) -> String {
    let of_browser = document::languages();
    let wanted = address.language.iter().chain(&of_browser).map(String::as_str);
    study.language_among(wanted).to_owned()
}

/// The study as it is today; or, in the middle of a session that began before the study was
/// changed, the version that it began with.
async fn bundle(service: &Service, study: &str) -> Result<Bundle, Trouble> {
    let today = persist(|| service.bundle(study, None)).await?;
    let begun = Identity::load(study).and_then(|identity| identity.started);
    let Some(begun) = begun.filter(|begun| begun.config_hash != today.config_hash) else {
        return Ok(today);
    };
    match persist(|| service.bundle(study, Some(&begun.config_hash))).await {
        Ok(earlier) => Ok(earlier),
        Err(Trouble::Refused(refusal)) if refusal.code == "unknown-study" => {
            // The server has never had that version: the session is not of this server.
            Identity::forget(study);
            Ok(today)
        }
        Err(trouble) => Err(trouble),
    }
}

/// The session that this browser is in the middle of, and its events on the server.
async fn resume(
    service: &Service,
    address: &Address,
) -> Result<Option<(SessionStarted, Vec<Event>)>, Trouble> {
    let Some(started) = Identity::load(&address.study).and_then(|identity| identity.started) else {
        return Ok(None);
    };
    match persist(|| service.resume(&started.session)).await {
        Ok(resume) => Ok(Some((resume.started, resume.events))),
        Err(Trouble::Refused(refusal)) if is_gone(&refusal) => {
            Identity::forget(&address.study);
            Ok(None)
        }
        Err(trouble) => Err(trouble),
    }
}

async fn begin_session(
    service: &Service,
    address: &Address,
    study: &StudyProjection,
    language: &str,
    turned_away: bool,
) -> Result<SessionStarted, Trouble> {
    let known = Identity::load(&address.study).filter(|identity| identity.started.is_none());
    let mut identity = match known {
        Some(known) => known,
        None => Identity { nonce: new_nonce()?, started: None },
    };
    // Kept before it is sent: a reload in between starts the same session again, not a second one.
    identity.save(&address.study);
    let body = StartSession { turned_away, ..arrival(address, &identity.nonce, language) };
    let started = persist(|| service.start(study, &body)).await?;
    identity.started = Some(started.clone());
    identity.save(&address.study);
    Ok(started)
}

/// A request tried six times in about a quarter of a minute, or for a minute where nobody answers,
/// before the page says that it cannot begin.
async fn persist<T, F>(request: impl Fn() -> F) -> Result<T, Trouble>
where
    F: Future<Output = Result<T, Failure>>,
{
    const TRIES: u32 = 6;
    const LONGEST_MS: f64 = 60_000.0;
    let begun = clock::now();
    let mut failures = 0;
    loop {
        match request().await {
            Ok(answer) => return Ok(answer),
            Err(Failure::Refused(refusal)) => return Err(Trouble::Refused(refusal)),
            Err(Failure::TooLarge) => return Err(Trouble::Refused(refusal("too-large", "", ""))),
            Err(Failure::Unreachable(reason)) => {
                failures += 1;
                if failures >= TRIES || clock::now() - begun > LONGEST_MS {
                    return Err(Trouble::Unreachable(reason));
                }
                clock::sleep(back_off(failures, random::fraction())).await;
            }
        }
    }
}
