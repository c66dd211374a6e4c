//! The server's part where there is none: pages hosted as files (`mimique export-site`).
//!
//! Answers stay in this browser's IndexedDB; at the end they are posted to the study's address, where
//! it names one, and offered as a file. Everything else of the page goes on as if a server answered.

use std::cell::RefCell;

use mimique_session::wire::{
    Acknowledged, Event, Receipt, Resume, SessionStarted, StartSession, Withdrawn,
};
use mimique_session::{Record, SessionFile, SiteFile, Standing};
use mimique_study::{Draw, Multilingual as _, StudyProjection, drawn_condition};
use serde_json::Value;

use crate::answer::{Failure, refusal};
use crate::browser::document;
use crate::browser::http::Body;
use crate::event_store::{EventStore, Identity, Store};
use crate::outbox::put;
use crate::requests::Requests;
use crate::server::Bundle;

/// The answers of this page, and where they are kept.
struct Answers {
    store: EventStore,
    started: SessionStarted,
    /// In ascending order of sequence.
    events: Vec<Event>,
    /// How many of them, from the first on, the study's address has taken already.
    posted: usize,
}

/// What the last page says where no server has the answers.
pub struct Ending {
    /// Whether they were posted to the study's address.
    pub posted: bool,
    /// Whether they are offered as a file.
    pub offered: bool,
    /// Whom to send the file to.
    pub email: String,
}

/// The pages of one study, hosted as files.
pub struct Site {
    /// Address of the site's file.
    address: String,
    /// The study's name.
    study: String,
    file: RefCell<Option<SiteFile<Value>>>,
    answers: RefCell<Option<Answers>>,
    requests: Requests,
}

impl Site {
    /// The site whose file is at `address`, of the study of that name.
    pub fn new(address: String, study: String) -> Self {
        Self {
            address,
            study,
            file: RefCell::default(),
            answers: RefCell::default(),
            requests: Requests::default(),
        }
    }

    /// The study's name.
    pub fn study(&self) -> &str {
        &self.study
    }

    /// The study, from the site's file.
    pub async fn bundle(&self) -> Result<Bundle, Failure> {
        let site: SiteFile<Value> = self.requests.get(&self.address).await?;
        let bundle = site.bundle.clone();
        *self.file.borrow_mut() = Some(site);
        Ok(bundle)
    }

    /// Begins a session: everything comes of nonce and address, so that a repeated start is the same
    /// session. Where the address names no condition, one is drawn: nobody counts here.
    pub fn start(
        &self,
        study: &StudyProjection,
        body: &StartSession,
    ) -> Result<SessionStarted, Failure> {
        let conditions =
            study.sequence.conditions_for(body.condition.as_deref()).map_err(|unknown| {
                let (message, remedy) = study.words(&body.language).unknown_condition(&unknown);
                Failure::Refused(refusal("unknown-condition", &message, &remedy))
            })?;
        let nonce = &body.nonce;
        let number = nonce.get(..12).and_then(|digits| u64::from_str_radix(digits, 16).ok());
        let (Some(number), Some(name), Some(code)) = (number, nonce.get(12..20), nonce.get(20..))
        else {
            return Err(Failure::Unreachable("no nonce".to_owned()));
        };
        let started = self.file.borrow().as_ref().map(|site| {
            let draw = Draw {
                seed: site.seed,
                config_hash: &site.bundle.config_hash,
                participant: number,
                condition: None,
            };
            SessionStarted {
                session: nonce.clone(),
                participant_id: format!("s{name}"),
                participant: number,
                // Nobody counts here: the place in squares and subsets is drawn.
                slot: 0,
                condition: drawn_condition(draw, &conditions).map(str::to_owned),
                seed: site.seed,
                stage: site.stage.clone(),
                config_hash: site.bundle.config_hash.clone(),
                withdrawal_code: code.to_owned(),
            }
        });
        started.ok_or_else(|| Failure::Unreachable("no site".to_owned()))
    }

    /// The session that this browser is in the middle of.
    pub async fn resume(&self, session: &str) -> Result<Resume, Failure> {
        let started = Identity::load(&self.study)
            .and_then(|identity| identity.started)
            .filter(|started| started.session == session)
            .ok_or_else(|| refused("unknown-session"))?;
        let answers = self.open(started.clone()).await;
        Ok(Resume { started, events: answers })
    }

    /// Opens the answers of a session; returns its events.
    async fn open(&self, started: SessionStarted) -> Vec<Event> {
        let store = EventStore::open(Store::Answers, &started.session).await;
        let events = store.all().await.unwrap_or_default();
        let kept = events.clone();
        *self.answers.borrow_mut() = Some(Answers { store, started, events: kept, posted: 0 });
        events
    }

    /// Keeps events; an event that is there already stays as it is.
    pub async fn append(&self, events: Vec<Event>) -> Result<Acknowledged, Failure> {
        if self.answers.borrow().is_none() {
            let started = Identity::load(&self.study).and_then(|identity| identity.started);
            self.open(started.ok_or_else(|| refused("unknown-session"))?).await;
        }
        // Taken out while it is awaited: there is one sender only.
        let Some(mut answers) = self.answers.borrow_mut().take() else {
            return Err(Failure::Unreachable("busy".to_owned()));
        };
        let mut failed = None;
        for event in events {
            if answers.events.iter().any(|each| each.sequence == event.sequence) {
                continue;
            }
            if let Err(error) = answers.store.put(&event).await {
                failed = Some(error);
                break;
            }
            put(&mut answers.events, event);
        }
        let whole = (0..).zip(&answers.events).take_while(|(n, each)| each.sequence == *n);
        let stored = whole.count() as u64;
        *self.answers.borrow_mut() = Some(answers);
        let hosting = self.file.borrow().as_ref().map(|site| site.hosting.clone());
        if hosting.is_some_and(|hosting| hosting.post_progress) {
            // What does not arrive goes with what is posted next.
            let _ = self.post().await;
        }
        match failed {
            Some(error) => Err(Failure::Unreachable(error.to_string())),
            None => Ok(Acknowledged { stored, gaps: Vec::new() }),
        }
    }

    /// The whole session as a file: its name, its text and its hash.
    pub fn session_file(&self) -> Option<(String, String, String)> {
        let answers = self.answers.borrow();
        let answers = answers.as_ref()?;
        let name = format!("{}_{}.jsonl", self.study, answers.started.participant_id);
        let (text, hash) = self.written(answers, 0);
        Some((name, text, hash))
    }

    /// The events from `first` on as a file: its text and its hash.
    fn written(&self, answers: &Answers, first: usize) -> (String, String) {
        let (started, events) = (answers.started.clone(), answers.events[first..].to_vec());
        SessionFile { study: self.study.clone(), started, events }.write()
    }

    /// Posts what the study's address has not taken yet.
    async fn post(&self) -> Result<(), Failure> {
        let address = self.file.borrow().as_ref().and_then(|site| site.hosting.post.clone());
        let due = self.answers.borrow().as_ref().map(|answers| {
            let (text, _) = self.written(answers, answers.posted);
            (answers.started.participant_id.clone(), answers.posted, answers.events.len(), text)
        });
        let (Some(address), Some((session, posted, all, text))) = (address, due) else {
            return Ok(());
        };
        if posted == all {
            return Ok(());
        }
        // Plain text asks the other site for nothing but to be taken.
        let body = Body { media_type: "text/plain;charset=UTF-8", text };
        let address = address.replace("{session}", &session);
        let answer = self.requests.send("POST", &address, Some(body)).await?;
        if !answer.ok() {
            return Err(Failure::Unreachable(format!("HTTP {}", answer.status)));
        }
        if let Some(answers) = &mut *self.answers.borrow_mut() {
            answers.posted = all;
        }
        Ok(())
    }

    /// Posts the session where the study says; then the code.
    pub async fn complete(&self, events: u64) -> Result<Receipt, Failure> {
        let (_, _, hash) = self.session_file().ok_or_else(|| refused("missing-events"))?;
        let (standing, stored) =
            self.answers.borrow().as_ref().map_or((Standing::InProgress, 0), |answers| {
                let all = &answers.events;
                (Record::of(None, all).standing, all.len() as u64)
            });
        if stored < events {
            return Err(refused("missing-events"));
        }
        let site = self.file.borrow().clone();
        let Some(site) = site else { return Err(Failure::Unreachable("no site".to_owned())) };
        self.post().await?;
        self.leave_nothing().await;
        let code = site.codes.get(standing.stored_word()).cloned();
        // As the server does: who has no code does not go back as somebody who has finished.
        let back = site.redirect.filter(|_| code.is_some() || standing == Standing::Completed);
        let redirect = back.map(|address| filled(&address, code.as_deref()));
        Ok(Receipt { receipt: hash, stored, completion_code: code, redirect })
    }

    /// Where a run of another program ends here, the next one in this browser is another person's: what was posted is
    /// not kept.
    async fn leave_nothing(&self) {
        if document::run().is_none() {
            return;
        }
        let answers = self.answers.borrow_mut().take();
        if let Some(answers) = answers {
            let _ = answers.store.clear().await;
            *self.answers.borrow_mut() = Some(answers);
        }
        Identity::forget(&self.study);
    }

    /// Forgets the answers.
    pub async fn withdraw(&self) -> Result<Withdrawn, Failure> {
        let answers = self.answers.borrow_mut().take();
        let Some(answers) = answers else { return Ok(Withdrawn { deleted: 0 }) };
        let deleted = answers.events.len() as u64;
        match answers.store.clear().await {
            Ok(()) => Ok(Withdrawn { deleted }),
            Err(error) => Err(Failure::Unreachable(error.to_string())),
        }
    }

    /// What the last page says, once the site's file is there.
    pub fn ending(&self) -> Option<Ending> {
        let file = self.file.borrow();
        let site = file.as_ref()?;
        let (posted, offered) = (site.hosting.post.is_some(), site.hosting.download);
        Some(Ending { posted, offered, email: site.email.clone() })
    }
}

/// The way back, with the code and the arrival's parameters.
fn filled(address: &str, code: Option<&str>) -> String {
    let encoded = document::encode;
    let mut filled = address.replace("{code}", &encoded(code.unwrap_or_default()));
    for (name, value) in &document::arrival().recruitment {
        filled = filled.replace(&format!("{{{name}}}"), &encoded(value));
    }
    filled
}

fn refused(code: &str) -> Failure {
    Failure::Refused(refusal(code, code, ""))
}
