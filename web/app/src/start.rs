//! From the address to a running session: fetch the study, begin or resume, mount the pages.

use std::rc::Rc;

use mimique_study::flow::{Input, Plan, State};
use mimique_study::text::{Words, primary_language, words};
use mimique_study::wire::{Event, SessionStarted, StartSession};
use mimique_study::{Client, SortedMap, Study};
use wasm_bindgen::JsCast as _;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen_futures::spawn_local;

use crate::address::Address;
use crate::answer::is_gone;
use crate::engine::Engine;
use crate::memory::{Identity, Keep};
use crate::network::{self, Bundle, Failure};
use crate::outbox::{back_off, put};
use crate::pages::failure::Trouble;
use crate::screen::{self, Boot};
use crate::{bridge, page, site};

/// The module's entry.
#[wasm_bindgen(start)]
pub fn start() {
    // Words that builds for the public leave out (`cargo xtask web --no-opt` keeps them).
    std::panic::set_hook(Box::new(|panic| page::report(&panic.to_string())));
    screen::open();
    screen::boot(Boot::Opening);
    begin_again();
}

/// Fetches the study and goes on where the session is.
pub fn begin_again() {
    spawn_local(async move {
        let mut fixed = words(&page::language()).clone();
        match begin(&mut fixed).await {
            Ok(engine) => {
                screen::boot(Boot::Running(engine));
                listen();
            }
            Err(trouble) => screen::boot(Boot::Trouble(trouble, fixed)),
        }
    });
}

/// Everything before the first page; what is said if it fails, in the study's own words as soon as it
/// is there.
async fn begin(fixed: &mut Words) -> Result<Rc<Engine>, Trouble> {
    let place = page::place();
    let place = |part: u32| place.get(part).as_string().unwrap_or_default();
    let (path, query) = (place(0), place(1));
    let address = match site::study() {
        Some(study) => Address::of_study(&study, &query),
        None => Address::parse(&path, &query).ok_or(Trouble::NoStudy)?,
    };
    // The address's language first, then the browser's.
    let languages = place(2);
    let wanted: Vec<&str> =
        address.language.as_deref().into_iter().chain(languages.split(' ')).collect();

    let bundle = bundle(&address.study).await?;
    let study =
        Study::from_value(&bundle.study).map_err(|error| Trouble::Unreadable(error.to_string()))?;
    let language = wanted
        .iter()
        .find(|each| primary_language(study.language_for(each)) == primary_language(each))
        .map_or_else(
            || study.default_language().to_owned(),
            |each| study.language_for(each).to_owned(),
        );
    *fixed = study.words(&language);
    page::describe(&language, study.study_metadata.title.in_language(&language));

    if !bridge::hold_session(&address.study).await.is_ok_and(|held| held.as_bool() != Some(false)) {
        return Err(Trouble::OtherTab);
    }
    let known = resume(&address).await?;
    let (started, events) = match known {
        Some(known) => known,
        None => (begin_session(&address, &study, &language).await?, Vec::new()),
    };
    let keep = Keep::open(&started.session).await;
    let stored =
        (0_u64..).zip(&events).take_while(|(n, event)| event.sequence == *n).count() as u64;
    let mut all: Vec<Event> = Vec::new();
    let unsent = keep.all().await.unwrap_or_default();
    for event in unsent.iter().cloned().chain(events) {
        put(&mut all, event);
    }
    // What the server has need not be kept: the answer that said so was never heard here.
    let known: Vec<u64> =
        unsent.iter().map(|event| event.sequence).filter(|number| *number < stored).collect();
    let _ = keep.forget(&known).await;

    let plan = Plan::new(study, started).map_err(|error| Trouble::Unreadable(error.to_string()))?;
    let (state, input): (State, fn(Client) -> Input) = if all.is_empty() {
        (State::new(&plan, &language), Input::Opened)
    } else {
        (State::replay(&plan, &all), Input::Resumed)
    };
    let engine = Engine::new(plan, state, bundle.clips, keep, stored, unsent);
    engine.dispatch(input(client()));
    engine.open();
    Ok(engine)
}

/// The study as it is today; or, in the middle of a session that began before the study was
/// changed, the version that it began with.
async fn bundle(study: &str) -> Result<Bundle, Trouble> {
    let today = persist(|| network::bundle(study, None)).await?;
    let begun = Identity::load(study).and_then(|identity| identity.started);
    let Some(begun) = begun.filter(|begun| begun.config_hash != today.config_hash) else {
        return Ok(today);
    };
    match persist(|| network::bundle(study, Some(&begun.config_hash))).await {
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
async fn resume(address: &Address) -> Result<Option<(SessionStarted, Vec<Event>)>, Trouble> {
    let Some(started) = Identity::load(&address.study).and_then(|identity| identity.started) else {
        return Ok(None);
    };
    match persist(|| network::resume(&started.session)).await {
        Ok(resume) => Ok(Some((resume.started, resume.events))),
        Err(Trouble::Refused(refusal)) if is_gone(&refusal) => {
            Identity::forget(&address.study);
            Ok(None)
        }
        Err(trouble) => Err(trouble),
    }
}

async fn begin_session(
    address: &Address,
    study: &Study,
    language: &str,
) -> Result<SessionStarted, Trouble> {
    let mut identity = Identity::load(&address.study)
        .filter(|identity| identity.started.is_none())
        .unwrap_or_else(|| Identity { nonce: page::nonce(16), started: None });
    // Kept before it is sent: a reload in between starts the same session again, not a second one.
    identity.save(&address.study);
    let body = StartSession {
        nonce: identity.nonce.clone(),
        recruitment: address.recruitment.clone(),
        condition: address.condition.clone(),
        language: language.to_owned(),
        client: about(),
    };
    let started = persist(|| network::start(study, &body)).await?;
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
    let begun = page::now();
    let mut failures = 0;
    loop {
        match request().await {
            Ok(answer) => return Ok(answer),
            Err(Failure::Refused(refusal)) => return Err(Trouble::Refused(refusal)),
            Err(Failure::Unreachable(reason)) => {
                failures += 1;
                if failures >= TRIES || page::now() - begun > LONGEST_MS {
                    return Err(Trouble::Unreachable(reason));
                }
                page::sleep(back_off(failures, page::random()).as_millis() as f64).await;
            }
        }
    }
}

fn about() -> SortedMap<String, String> {
    crate::json::read(&bridge::about()).unwrap_or_default()
}

/// The display and the page, as events record them.
pub fn client() -> Client {
    let viewport = page::viewport();
    let number = |part: u32| viewport.get(part).as_f64().unwrap_or(0.0);
    Client {
        viewport: [number(0) as u32, number(1) as u32],
        device_pixel_ratio: number(2),
        about: about(),
    }
}

/// What the window reports: focus, visibility, connection, time.
fn listen() {
    let happens = Closure::<dyn Fn(String)>::new(|what: String| match what.as_str() {
        "blur" => screen::send(Input::FocusLost),
        "focus" => screen::send(Input::FocusGained),
        "fullscreenchange" => screen::send(Input::Fullscreen(bridge::is_fullscreen())),
        "tick" => screen::send(Input::Tick),
        other => {
            let Some(engine) = screen::engine() else { return };
            match other {
                "resize" => engine.resized(),
                // Online again; or hidden, and a hidden page may never come back: what waits goes
                // out now.
                _ => engine.flush(),
            }
        }
    });
    page::watch(happens.as_ref().unchecked_ref());
    // It lives as long as the page.
    happens.forget();
}
