//! From the address to a running session: fetch the study, begin or resume, mount the pages.

use std::collections::BTreeMap;
use std::rc::Rc;

use gloo::timers::future::TimeoutFuture;
use leptos::prelude::*;
use mimique_study::flow::{Input, Plan, State};
use mimique_study::wire::{Event, SessionStarted, StartSession};
use mimique_study::{Client, Study};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::spawn_local;

use crate::address::Address;
use crate::engine::Engine;
use crate::memory::{Identity, Keep};
use crate::network::{self, Bundle, Failure};
use crate::outbox::back_off;
use crate::pages::Pages;
use crate::pages::failure::{Trouble, TroublePage};
use crate::session::Session;
use crate::{bridge, pages, site};

/// The module's entry.
#[wasm_bindgen(start)]
pub fn start() {
    console_error_panic_hook::set_once();
    let root = pages::element("app");
    root.set_inner_html("");
    mount_to(root, || view! { <Root/> }).forget();
}

/// Where the start is.
#[derive(Clone)]
enum Boot {
    Opening,
    Trouble(Trouble),
    Running(Session),
}

#[component]
fn Root() -> impl IntoView {
    let boot = RwSignal::new_local(Boot::Opening);
    let owner = Owner::current();
    let begin_again = move || {
        boot.set(Boot::Opening);
        let owner = owner.clone();
        spawn_local(async move {
            let next = match begin().await {
                Ok(engine) => {
                    let make = || Session::new(Rc::clone(&engine));
                    let session = owner.as_ref().map_or_else(make, |owner| owner.with(make));
                    listen(session);
                    Boot::Running(session)
                }
                Err(trouble) => Boot::Trouble(trouble),
            };
            boot.set(next);
        });
    };
    begin_again();
    let retry = StoredValue::new_local(begin_again);
    move || {
        match boot.get() {
        Boot::Opening => view! {
            <main class="page" data-view="opening"><div class="card"><p class="soft">"…"</p></div></main>
        }
        .into_any(),
        Boot::Trouble(trouble) => view! {
            <TroublePage trouble retry=move || retry.with_value(|again| again())/>
        }
        .into_any(),
        Boot::Running(session) => {
            provide_context(session);
            view! { <Pages/> }.into_any()
        }
    }
    }
}

/// Everything before the first page.
async fn begin() -> Result<Rc<Engine>, Trouble> {
    let location = window().location();
    let path = location.pathname().unwrap_or_default();
    let query = location.search().unwrap_or_default();
    let address = match site::study() {
        Some(study) => Address::of_study(&study, &query),
        None => Address::parse(&path, &query).ok_or(Trouble::NoStudy)?,
    };
    let wanted = wanted_languages(&address);

    let bundle = bundle(&address.study).await?;
    let study =
        Study::from_value(&bundle.study).map_err(|error| Trouble::Unreadable(error.to_string()))?;
    let language = wanted
        .iter()
        .find(|each| study.language_for(each).split('-').next() == each.split('-').next())
        .map_or_else(
            || study.default_language().to_owned(),
            |each| study.language_for(each).to_owned(),
        );
    pages::set_language(&language);
    document().set_title(study.study_metadata.title.in_language(&language));

    if !bridge::hold_session(&address.study).await.is_ok_and(|held| held.as_bool() != Some(false)) {
        return Err(Trouble::OtherTab(language));
    }
    let known = resume(&address).await?;
    let (started, events) = match known {
        Some(known) => known,
        None => (begin_session(&address, &language).await?, Vec::new()),
    };
    let keep = Keep::open(&started.session).await;
    let stored =
        (0_u64..).zip(&events).take_while(|(n, event)| event.sequence == *n).count() as u64;
    let mut all: BTreeMap<u64, Event> = BTreeMap::new();
    let unsent = keep.all().await.unwrap_or_default();
    for event in unsent.iter().cloned().chain(events) {
        all.insert(event.sequence, event);
    }
    let all: Vec<Event> = all.into_values().collect();
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
        Err(Trouble::Refused(_)) => {
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
        Err(Trouble::Refused(_)) => {
            Identity::forget(&address.study);
            Ok(None)
        }
        Err(trouble) => Err(trouble),
    }
}

async fn begin_session(address: &Address, language: &str) -> Result<SessionStarted, Trouble> {
    let mut identity = Identity::load(&address.study)
        .filter(|identity| identity.started.is_none())
        .unwrap_or_else(|| Identity { nonce: nonce(), started: None });
    // Kept before it is sent: a reload in between starts the same session again, not a second one.
    identity.save(&address.study);
    let body = StartSession {
        nonce: identity.nonce.clone(),
        recruitment: address.recruitment.clone(),
        language: language.to_owned(),
        client: about(),
    };
    let started = persist(|| network::start(&address.study, &body)).await?;
    identity.started = Some(started.clone());
    identity.save(&address.study);
    Ok(started)
}

/// A request tried for about a quarter of a minute before the page says that it cannot begin.
async fn persist<T, F>(request: impl Fn() -> F) -> Result<T, Trouble>
where
    F: Future<Output = Result<T, Failure>>,
{
    const TRIES: u32 = 6;
    let mut failures = 0;
    loop {
        match request().await {
            Ok(answer) => return Ok(answer),
            Err(Failure::Refused(refusal)) => return Err(Trouble::Refused(refusal)),
            Err(Failure::Unreachable(reason)) => {
                failures += 1;
                if failures >= TRIES {
                    return Err(Trouble::Unreachable(reason));
                }
                let wait = back_off(failures, js_sys::Math::random()).as_millis();
                TimeoutFuture::new(u32::try_from(wait).unwrap_or(1_000)).await;
            }
        }
    }
}

/// 128 random bits, hexadecimal.
fn nonce() -> String {
    let mut bytes = [0_u8; 16];
    if getrandom::fill(&mut bytes).is_err() {
        // Without a random source the clock still tells two participants apart.
        bytes[..8].copy_from_slice(&js_sys::Date::now().to_le_bytes());
        bytes[8..].copy_from_slice(&js_sys::Math::random().to_le_bytes());
    }
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The address's language first, then the browser's.
fn wanted_languages(address: &Address) -> Vec<String> {
    let browser = js_sys::Reflect::get(&window().navigator(), &JsValue::from_str("languages"))
        .map(|list| js_sys::Array::from(&list))
        .unwrap_or_default();
    address
        .language
        .iter()
        .cloned()
        .chain(browser.iter().filter_map(|each| each.as_string()))
        .collect()
}

fn about() -> BTreeMap<String, String> {
    crate::json::read(&bridge::about()).unwrap_or_default()
}

/// The display and the page, as events record them.
pub fn client() -> Client {
    let window = window();
    let size = |value: Result<JsValue, JsValue>| {
        value.ok().and_then(|value| value.as_f64()).unwrap_or(0.0) as u32
    };
    Client {
        viewport: [size(window.inner_width()), size(window.inner_height())],
        device_pixel_ratio: window.device_pixel_ratio(),
        about: about(),
    }
}

/// What the window reports: focus, visibility, connection, time.
fn listen(session: Session) {
    use leptos::ev;
    let on = move |input: fn() -> Input| move || session.send(input());
    let (lost, gained) = (on(|| Input::FocusLost), on(|| Input::FocusGained));
    window_event_listener(ev::blur, move |_| lost());
    window_event_listener(ev::focus, move |_| gained());
    window_event_listener(ev::resize, move |_| session.engine().resized());
    let root = document();
    let filled =
        Closure::<dyn Fn()>::new(move || session.send(Input::Fullscreen(bridge::is_fullscreen())));
    let _ =
        root.add_event_listener_with_callback("fullscreenchange", filled.as_ref().unchecked_ref());
    // It lives as long as the page.
    filled.forget();
    window_event_listener(ev::online, move |_| session.engine().flush());
    // A hidden page may never come back: what waits goes out now.
    window_event_listener(ev::pagehide, move |_| session.engine().flush());
    gloo::timers::callback::Interval::new(1_000, move || session.send(Input::Tick)).forget();
}
