//! From the address to a running session: fetch the study, begin or resume.

use std::rc::Rc;

use mimique_session::Client;
use mimique_session::flow::{Input, Plan, State};
use mimique_session::wire::{Event, Refusal, SessionStarted, StartSession};
use mimique_study::text::{Words, primary_language};
use mimique_study::{Multilingual as _, StudyProjection};

use crate::address::Address;
use crate::answer::{Failure, is_gone};
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

/// Everything before the first page; `fixed` becomes what is said if it fails, in the study's own words
/// as soon as it is there. `changed` is called when something changed that the screen shows.
pub async fn begin(fixed: &mut Words, changed: Rc<dyn Fn()>) -> Result<Rc<Engine>, Trouble> {
    let service = Service::of_document();
    let query = document::query();
    let address = match service.site() {
        Some(site) => Address::of_study(site.study(), &query),
        None => Address::parse(&document::path(), &query).ok_or(Trouble::NoStudy)?,
    };
    let bundle = bundle(&service, &address.study).await?;
    let Bundle { study, clips, .. } = bundle;
    let language = language(&address, &study);
    *fixed = study.words(&language);
    document::describe(&language, study.title.in_language(&language));

    if !host::hold_session(&address.study).await.is_ok_and(|held| held.as_bool() != Some(false)) {
        return Err(Trouble::OtherTab);
    }
    let (started, events) = match resume(&service, &address).await? {
        Some(known) => known,
        None => (begin_session(&service, &address, &study, &language).await?, Vec::new()),
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

    let plan = Plan::new(study, started).map_err(|error| Trouble::Unreadable(error.to_string()))?;
    let (state, input): (State, fn(Client) -> Input) = if all.is_empty() {
        (State::new(&plan, &language), Input::Opened)
    } else {
        (State::replay(&plan, &all), Input::Resumed)
    };
    let beginning = Beginning { plan, state, clips, service, store, stored, unsent };
    let engine = Engine::new(beginning, changed);
    engine.dispatch(input(client()));
    engine.open();
    Ok(engine)
}

/// The language of the pages: the address's first, then the browser's, of those that the study has.
fn language(address: &Address, study: &StudyProjection) -> String {
    let of_browser = document::languages();
    let mut wanted = address.language.iter().chain(&of_browser);
    wanted
        .find(|each| primary_language(study.language_for(each)) == primary_language(each))
        .map_or_else(|| study.default_language(), |each| study.language_for(each))
        .to_owned()
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
) -> Result<SessionStarted, Trouble> {
    let known = Identity::load(&address.study).filter(|identity| identity.started.is_none());
    let mut identity = match known {
        Some(known) => known,
        None => {
            let nonce =
                random::nonce(16).map_err(|error| Trouble::Unreadable(error.to_string()))?;
            Identity { nonce, started: None }
        }
    };
    // Kept before it is sent: a reload in between starts the same session again, not a second one.
    identity.save(&address.study);
    let body = StartSession {
        nonce: identity.nonce.clone(),
        recruitment: address.recruitment.clone(),
        condition: address.condition.clone(),
        language: language.to_owned(),
        client: about(),
    };
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
