//! The server's part where there is none: pages hosted as files (`mimique export-site`).
//!
//! Answers stay in this browser's IndexedDB; at the end they are posted to the study's address, where
//! it names one, and offered as a file. Everything else of the page goes on as if a server answered.

use std::cell::{OnceCell, RefCell};

use mimique_study::from_json::{self, FromJson};
use mimique_study::responses::session_status;
use mimique_study::wire::{
    Acknowledged, Event, Receipt, Refusal, Resume, SessionStarted, StartSession, Withdrawn,
};
use mimique_study::{
    Draw, SessionFile, SortedMap, StaticHosting, Study, drawn_condition, json_text,
};

use crate::memory::{ANSWERS, Identity, Keep};
use crate::network::{self, Bundle, Failure, unreachable};
use crate::outbox::put;
use crate::page;

/// What `mimique export-site` writes beside the pages.
#[derive(Debug, Clone, FromJson)]
struct SiteFile {
    bundle: Bundle,
    stage: String,
    seed: u64,
    /// Status of the export -> code.
    codes: SortedMap<String, String>,
    redirect: Option<String>,
    hosting: StaticHosting,
    email: String,
}

/// The answers of this page, and where they are kept.
struct Answers {
    keep: Keep,
    started: SessionStarted,
    /// In ascending order of sequence.
    events: Vec<Event>,
}

thread_local! {
    static ADDRESS: OnceCell<Option<(String, String)>> = const { OnceCell::new() };
    static FILE: RefCell<Option<SiteFile>> = const { RefCell::new(None) };
    static ANSWERS_HERE: RefCell<Option<Answers>> = const { RefCell::new(None) };
}

/// Where the site's file is, and the study's name; `None` where a server answers.
fn address() -> Option<(String, String)> {
    ADDRESS.with(|address| {
        let read = || {
            let place = page::place();
            Some((place.get(3).as_string()?, place.get(4).as_string()?))
        };
        address.get_or_init(read).clone()
    })
}

/// Whether the pages are hosted without the server.
pub fn is_site() -> bool {
    address().is_some()
}

/// The study's name.
pub fn study() -> Option<String> {
    address().map(|(_, study)| study)
}

/// The study, from the site's file.
pub async fn bundle() -> Result<Bundle, Failure> {
    let (file, _) = address().ok_or_else(|| Failure::Unreachable("no site".to_owned()))?;
    let site: SiteFile = network::get(&file).await?;
    let bundle = site.bundle.clone();
    FILE.with(|here| *here.borrow_mut() = Some(site));
    Ok(bundle)
}

/// Begins a session: everything comes of nonce and address, so that a repeated start is the same
/// session. Where the address names no condition, one is drawn: nobody counts here.
pub fn start(study: &Study, body: &StartSession) -> Result<SessionStarted, Failure> {
    let conditions = study.conditions_for(body.condition.as_deref()).map_err(|unknown| {
        let (message, remedy) = study.words(&body.language).unknown_condition(&unknown);
        refusal("unknown-condition", message, remedy)
    })?;
    let nonce = &body.nonce;
    let number = nonce.get(..12).and_then(|digits| u64::from_str_radix(digits, 16).ok());
    let (Some(number), Some(name), Some(code)) = (number, nonce.get(12..20), nonce.get(20..))
    else {
        return Err(Failure::Unreachable("no nonce".to_owned()));
    };
    let started = FILE.with(|file| {
        file.borrow().as_ref().map(|site| {
            let draw = Draw {
                seed: site.seed,
                config_hash: &site.bundle.config_hash,
                participant: number,
                condition: None,
            };
            json_text::object([
                ("condition", drawn_condition(draw, &conditions).into()),
                ("session", nonce.as_str().into()),
                ("participant_id", ["s", name].concat().into()),
                // Nobody counts here: the place in squares and subsets is drawn.
                ("participant", number.into()),
                ("seed", site.seed.into()),
                ("stage", site.stage.as_str().into()),
                ("config_hash", site.bundle.config_hash.as_str().into()),
                ("withdrawal_code", code.into()),
            ])
        })
    });
    let started = started.unwrap_or_default();
    from_json::read(&started).map_err(|error| Failure::Unreachable(error.to_string()))
}

/// The session that this browser is in the middle of.
pub async fn resume(session: &str) -> Result<Resume, Failure> {
    let started = study()
        .and_then(|study| Identity::load(&study)?.started)
        .filter(|started| started.session == session)
        .ok_or_else(|| refused("unknown-session"))?;
    let answers = open(started.clone()).await;
    Ok(Resume { started, events: answers })
}

/// Opens the answers of a session; returns its events.
async fn open(started: SessionStarted) -> Vec<Event> {
    let keep = Keep::open_store(ANSWERS, &started.session).await;
    let events = keep.all().await.unwrap_or_default();
    let kept = events.clone();
    ANSWERS_HERE.with(|here| *here.borrow_mut() = Some(Answers { keep, started, events: kept }));
    events
}

/// Keeps events; an event that is there already stays as it is.
pub async fn append(events: Vec<Event>) -> Result<Acknowledged, Failure> {
    if ANSWERS_HERE.with(|here| here.borrow().is_none()) {
        let started = study().and_then(|study| Identity::load(&study)?.started);
        open(started.ok_or_else(|| refused("unknown-session"))?).await;
    }
    // Taken out while it is awaited: there is one sender only.
    let Some(mut answers) = ANSWERS_HERE.with(|here| here.borrow_mut().take()) else {
        return Err(Failure::Unreachable("busy".to_owned()));
    };
    let mut failed = None;
    for event in events {
        if answers.events.iter().any(|each| each.sequence == event.sequence) {
            continue;
        }
        if let Err(error) = answers.keep.put(&event).await {
            failed = Some(error);
            break;
        }
        put(&mut answers.events, event);
    }
    let whole = (0..).zip(&answers.events).take_while(|(n, each)| each.sequence == *n);
    let stored = whole.count() as u64;
    ANSWERS_HERE.with(|here| *here.borrow_mut() = Some(answers));
    match failed {
        Some(thrown) => Err(unreachable(&thrown)),
        None => Ok(Acknowledged { stored, gaps: Vec::new() }),
    }
}

/// The whole session as a file: its name, its text and its hash.
pub fn file() -> Option<(String, String, String)> {
    let study = study()?;
    ANSWERS_HERE.with(|here| {
        let here = here.borrow();
        let answers = here.as_ref()?;
        let name = format!("{study}_{}.jsonl", answers.started.participant_id);
        let events = answers.events.clone();
        let file = SessionFile { study, started: answers.started.clone(), events };
        let (text, hash) = file.write();
        Some((name, text, hash))
    })
}

/// Posts the session where the study says; then the code.
pub async fn complete(events: u64) -> Result<Receipt, Failure> {
    let (_, text, hash) = file().ok_or_else(|| refused("missing-events"))?;
    let (status, stored, session) = ANSWERS_HERE.with(|here| {
        here.borrow().as_ref().map_or(("active", 0, String::new()), |answers| {
            let all = &answers.events;
            (session_status(all), all.len() as u64, answers.started.participant_id.clone())
        })
    });
    if stored < events {
        return Err(refused("missing-events"));
    }
    let site = FILE.with(|file| file.borrow().clone());
    let Some(site) = site else { return Err(Failure::Unreachable("no site".to_owned())) };
    if let Some(address) = &site.hosting.post {
        let address = address.replace("{session}", &session);
        // Plain text asks the other site for nothing but to be taken.
        let answer =
            network::send("POST", &address, "text/plain;charset=UTF-8", Some(text)).await?;
        if !answer.ok() {
            return Err(Failure::Unreachable(format!("HTTP {}", answer.status)));
        }
    }
    let code = site.codes.get(status).cloned();
    // As the server does: who has no code does not go back as somebody who has finished.
    let back = site.redirect.filter(|_| code.is_some() || status == "completed");
    let redirect = back.map(|address| filled(&address, code.as_deref()));
    Ok(Receipt { receipt: hash, stored, completion_code: code, redirect })
}

/// Forgets the answers.
pub async fn withdraw() -> Result<Withdrawn, Failure> {
    let answers = ANSWERS_HERE.with(|here| here.borrow_mut().take());
    let Some(answers) = answers else { return Ok(Withdrawn { deleted: 0 }) };
    let deleted = answers.events.len() as u64;
    match answers.keep.clear().await {
        Ok(()) => Ok(Withdrawn { deleted }),
        Err(thrown) => Err(unreachable(&thrown)),
    }
}

/// What the last page says: whether the answers were posted, whether they are offered as a file, and
/// whom to send it to. `None` where a server answers.
pub fn ending() -> Option<(bool, bool, String)> {
    FILE.with(|file| {
        let file = file.borrow();
        let site = file.as_ref()?;
        Some((site.hosting.post.is_some(), site.hosting.download, site.email.clone()))
    })
}

/// The way back, with the code and the arrival's parameters.
fn filled(address: &str, code: Option<&str>) -> String {
    let arrival = page::arrival();
    let encoded = page::encode;
    let mut filled = address.replace("{code}", &encoded(code.unwrap_or_default()));
    for (name, value) in &arrival.recruitment {
        filled = filled.replace(&format!("{{{name}}}"), &encoded(value));
    }
    filled
}

fn refused(code: &str) -> Failure {
    refusal(code, code.to_owned(), String::new())
}

fn refusal(code: &str, message: String, remedy: String) -> Failure {
    Failure::Refused(Refusal { code: code.to_owned(), message, remedy, sequences: Vec::new() })
}
