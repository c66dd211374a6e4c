//! The interpreter: inputs go into `flow::update`, the effects that come out are carried out.
//!
//! One writer puts events into IndexedDB, one sender sends them; both go on in order, one thing at
//! a time, whatever the pages do meanwhile.

use std::cell::{Cell, Ref, RefCell};
use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;
use std::time::Duration;

use mimique_session::flow::{Effect, Input, Plan, State, StepKind, update};
use mimique_session::wire::{Event, Refusal};
use mimique_session::{PlayLog, StageFailure, Standing};
use mimique_study::text::Words;
use mimique_study::{DeviceRules, Display, MEDIA_PREFIX};
use serde_json::{Value, json};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::spawn_local;

use crate::answer::{Failure, is_gone};
use crate::browser::{clock, document, focus, host, random, stage_failure};
use crate::client::client;
use crate::event_store::{EventStore, Identity};
use crate::outbox::{Outbox, back_off};
use crate::service::Service;

/// What the header has to say about the connection.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Connection {
    /// Answers wait here because the server is not reached.
    pub offline: bool,
    /// The browser keeps nothing: a reload would lose what waits.
    pub fleeting: bool,
    /// The server refuses what is sent.
    pub refused: Option<Refusal>,
}

/// Everything that a session runs on.
pub struct Engine {
    /// What this participant goes through.
    pub plan: Plan,
    /// Where the session is; pages read it through `flow::view`.
    state: RefCell<State>,
    /// What the header says.
    connection: RefCell<Connection>,
    /// `wire::ClipSource` of every clip.
    pub clips: BTreeMap<String, Value>,
    /// Path of a picture or a sign-language video -> address of what has been fetched.
    media: RefCell<BTreeMap<String, String>>,
    /// Who answers.
    pub service: Rc<Service>,
    /// Where events are kept; nowhere before the session.
    store: Option<EventStore>,
    /// What happened before the session, in memory alone.
    before: RefCell<Vec<Event>>,
    to_store: RefCell<VecDeque<Event>>,
    writing: Cell<bool>,
    outbox: RefCell<Outbox>,
    sending: Cell<bool>,
    /// Set to end a wait before the next try.
    wake: Cell<bool>,
    to_prepare: RefCell<VecDeque<String>>,
    /// What is being prepared right now.
    preparing: RefCell<Option<String>>,
    prepared: RefCell<BTreeMap<String, ()>>,
    /// False until the first page stands: a page that was just loaded is read from its top.
    open: Cell<bool>,
    /// Called when something changed that the screen shows.
    changed: Rc<dyn Fn()>,
}

/// What a session starts from.
pub struct Beginning {
    /// What this participant goes through.
    pub plan: Plan,
    /// Where the session is.
    pub state: State,
    /// `wire::ClipSource` of every clip.
    pub clips: BTreeMap<String, Value>,
    /// Who answers.
    pub service: Rc<Service>,
    /// Where events are kept until they are acknowledged; none before the session.
    pub store: Option<EventStore>,
    /// Number of events that the server has without a gap.
    pub stored: u64,
    /// What the server has not acknowledged yet.
    pub unsent: Vec<Event>,
}

impl Engine {
    /// An engine; `changed` is called whenever something changed that the screen shows.
    pub fn new(beginning: Beginning, changed: Rc<dyn Fn()>) -> Rc<Self> {
        let Beginning { plan, state, clips, service, store, stored, unsent } = beginning;
        let mut outbox = Outbox::new(stored);
        unsent.into_iter().for_each(|event| outbox.push(event));
        let fleeting = store.as_ref().is_some_and(|store| !store.is_lasting());
        let connection = Connection { fleeting, ..Connection::default() };
        Rc::new(Self {
            plan,
            state: RefCell::new(state),
            connection: RefCell::new(connection),
            clips,
            media: RefCell::default(),
            service,
            store,
            before: RefCell::default(),
            to_store: RefCell::default(),
            writing: Cell::new(false),
            outbox: RefCell::new(outbox),
            sending: Cell::new(false),
            wake: Cell::new(false),
            to_prepare: RefCell::default(),
            preparing: RefCell::default(),
            prepared: RefCell::default(),
            open: Cell::new(false),
            changed,
        })
    }

    /// One input: the state moves on, the effects are carried out.
    pub fn dispatch(self: &Rc<Self>, input: Input) {
        let before = self.state.take();
        let (after, effects) = update(&self.plan, before, input, clock::now());
        self.state.replace(after);
        (self.changed)();
        for effect in effects {
            self.carry_out(effect);
        }
    }

    /// Reads where the session is.
    pub fn state(&self) -> Ref<'_, State> {
        self.state.borrow()
    }

    /// What the header says.
    pub fn connection(&self) -> Ref<'_, Connection> {
        self.connection.borrow()
    }

    /// The language of the moment.
    pub fn language(&self) -> String {
        self.state.borrow().record.language.clone()
    }

    /// The fixed texts in the language of the moment.
    pub fn words(&self) -> &Words {
        self.plan.words(&self.state.borrow().record.language)
    }

    /// The address of a picture or a sign-language video of the study, once it has been fetched.
    pub fn media(&self, path: &str) -> Option<String> {
        self.media.borrow().get(path).cloned()
    }

    /// The header says something else.
    fn connection_is(&self, change: impl FnOnce(&mut Connection)) {
        change(&mut self.connection.borrow_mut());
        (self.changed)();
    }

    fn carry_out(self: &Rc<Self>, effect: Effect) {
        match effect {
            Effect::Store(event) if self.store.is_none() => self.before.borrow_mut().push(event),
            Effect::Store(event) => self.keep(vec![event]),
            Effect::Flush => self.flush(),
            Effect::PrepareClips(clips) => {
                let mut queue = self.to_prepare.borrow_mut();
                // The first named is the most urgent; one that is under way already answers soon.
                queue.retain(|waiting| !clips.contains(waiting));
                let under_way = self.preparing.borrow();
                let others =
                    clips.into_iter().rev().filter(|clip| under_way.as_ref() != Some(clip));
                others.for_each(|clip| queue.push_front(clip));
                drop(under_way);
                drop(queue);
                self.prepare();
            }
            Effect::PlayClip { clip, beside } => self.play(clip, beside),
            Effect::StopClip => host::stop_clip(),
            Effect::MeasureDevice => self.measure(),
            Effect::RequestFullscreen => host::request_fullscreen(),
            Effect::LeaveFullscreen => host::leave_fullscreen(),
            Effect::Complete { events } => self.complete(events),
            Effect::GoBack(address) => document::go(&address),
            Effect::Withdraw => self.withdraw(),
            Effect::FocusHeading if self.open.get() => focus::focus_heading(),
            Effect::FocusHeading => {}
            // An effect of a later version of the flow: the page is older than the study.
            _ => {}
        }
    }

    /// Keeps events, then sends them.
    pub fn keep(self: &Rc<Self>, events: Vec<Event>) {
        self.to_store.borrow_mut().extend(events);
        self.write();
    }

    /// What happened before the session.
    pub fn unkept(&self) -> Vec<Event> {
        self.before.borrow().clone()
    }

    /// Whether agreement and device were passed, or the device cannot take part: the session begins.
    pub fn leaves_lobby(&self) -> bool {
        let state = self.state();
        let is_over = match state.record.standing {
            Standing::InProgress => !self.plan.is_before_session(state.record.step),
            standing => standing.is_screened_out(),
        };
        self.store.is_none() && is_over
    }

    /// Whether somebody has declined before the session.
    pub fn is_declined_lobby(&self) -> bool {
        self.store.is_none() && self.state().record.standing == Standing::Declined
    }

    /// What browser and display can do.
    fn measure(self: &Rc<Self>) {
        let engine = Rc::clone(self);
        let rules = self.plan.study.device.as_ref();
        let trials = self.plan.steps.iter().filter_map(|step| step.trial());
        let mut clips = trials.map(|trial| trial.clip.as_str());
        let loads = rules.is_some_and(DeviceRules::measures_load);
        let clip = clips.next().filter(|_| loads).map(str::to_owned);
        let source = clip.as_ref().and_then(|clip| self.clips.get(clip)).map(Value::to_string);
        let look = json!(self.plan.study.look).to_string();
        spawn_local(async move {
            let source = source.unwrap_or_default();
            let measured = host::measure(clip, &source, &look).await;
            let measured = measured.ok().and_then(|text| text.as_string());
            let display = measured.and_then(|text| serde_json::from_str(&text).ok());
            engine.dispatch(Input::Measured(display.unwrap_or_default()));
        });
    }

    /// The window has another size: the device gate looks again.
    pub fn resized(self: &Rc<Self>) {
        let known = {
            let state = self.state();
            let step = self.plan.step(state.record.step);
            let gate = step.is_some_and(|step| matches!(step.kind, StepKind::Device));
            state.record.display.clone().filter(|_| gate)
        };
        if let Some(display) = known {
            let now = client();
            let (viewport, device_pixel_ratio) = (now.viewport, now.device_pixel_ratio);
            self.dispatch(Input::Measured(Display { viewport, device_pixel_ratio, ..display }));
        }
    }

    /// The first page stands; what an earlier load of the page left is sent.
    pub fn open(self: &Rc<Self>) {
        self.open.set(true);
        self.flush();
    }

    /// Sends now what waits, without the rest of a back-off.
    pub fn flush(self: &Rc<Self>) {
        self.wake.set(true);
        self.send();
    }

    fn write(self: &Rc<Self>) {
        if self.writing.replace(true) {
            return;
        }
        let engine = Rc::clone(self);
        spawn_local(async move {
            loop {
                let next = engine.to_store.borrow_mut().pop_front();
                let Some(event) = next else { break };
                if let Some(store) = &engine.store
                    && store.put(&event).await.is_err()
                {
                    engine.connection_is(|connection| connection.fleeting = true);
                }
                engine.outbox.borrow_mut().push(event);
                engine.send();
            }
            engine.writing.set(false);
        });
    }

    fn send(self: &Rc<Self>) {
        if self.sending.replace(true) {
            return;
        }
        let engine = Rc::clone(self);
        spawn_local(async move {
            let mut failures = 0;
            loop {
                let batch = engine.outbox.borrow().batch();
                if batch.is_empty() {
                    break;
                }
                let session = &engine.plan.started.session;
                match engine.service.append(session, batch.clone()).await {
                    Ok(answer) => {
                        failures = 0;
                        let gone = engine.outbox.borrow_mut().acknowledge(&batch, &answer);
                        // What cannot be forgotten here is sent again after a reload, and refused
                        // as known: no harm.
                        if let Some(store) = &engine.store {
                            let _ = store.forget(&gone).await;
                        }
                        engine.connected();
                        let stored = engine.outbox.borrow().stored();
                        engine.dispatch(Input::Acknowledged { stored });
                        if gone.is_empty() {
                            // The server took nothing of what was sent: do not run in circles.
                            clock::sleep(Duration::from_secs(1)).await;
                        }
                    }
                    Err(Failure::Unreachable(_)) => {
                        failures += 1;
                        if failures > 1 {
                            engine.connection_is(|connection| connection.offline = true);
                        }
                        engine.wait(failures).await;
                    }
                    // Whoever withdraws has nothing left to send.
                    Err(Failure::Refused(_)) if engine.is_withdrawing() => break,
                    Err(Failure::Refused(refusal)) => {
                        // The events stay in IndexedDB; a reload or a retry sends them again.
                        engine.troubled(Failure::Refused(refusal));
                        break;
                    }
                }
            }
            engine.sending.set(false);
        });
    }

    fn is_withdrawing(&self) -> bool {
        self.state.borrow().live.withdrawing
    }

    /// The header says what is wrong.
    fn troubled(&self, failure: Failure) {
        self.connection_is(|connection| match failure {
            Failure::Unreachable(_) => connection.offline = true,
            Failure::Refused(refusal) => connection.refused = Some(refusal),
        });
    }

    fn connected(self: &Rc<Self>) {
        let (offline, troubled) = {
            let connection = self.connection();
            (connection.offline, connection.offline || connection.refused.is_some())
        };
        if offline {
            self.dispatch(Input::Online);
        }
        if troubled {
            self.connection_is(|connection| {
                connection.offline = false;
                connection.refused = None;
            });
        }
    }

    /// Waits before the next try; `flush` ends the wait.
    async fn wait(&self, failures: u32) {
        self.wake.set(false);
        let mut left = back_off(failures, random::fraction());
        while !left.is_zero() && !self.wake.get() {
            let slice = left.min(Duration::from_millis(200));
            clock::sleep(slice).await;
            left -= slice;
        }
    }

    fn prepare(self: &Rc<Self>) {
        if self.preparing.borrow().is_none() && self.next_to_prepare() {
            let engine = Rc::clone(self);
            spawn_local(async move {
                loop {
                    let Some(clip) = engine.preparing.borrow().clone() else { break };
                    engine.prepare_one(clip).await;
                    engine.next_to_prepare();
                }
            });
        }
    }

    fn next_to_prepare(&self) -> bool {
        let next = self.to_prepare.borrow_mut().pop_front();
        let found = next.is_some();
        self.preparing.replace(next);
        found
    }

    async fn prepare_one(self: &Rc<Self>, clip: String) {
        if self.prepared.borrow().contains_key(&clip) {
            return self.dispatch(Input::ClipPrepared { clip });
        }
        let Some(source) = self.clips.get(&clip) else {
            let message = ["the server has no ", &clip].concat();
            let failure =
                StageFailure { code: "missing".to_owned(), message, ..Default::default() };
            return self.dispatch(Input::ClipFailed { clip, failure });
        };
        let loaded = match clip.strip_prefix(MEDIA_PREFIX) {
            Some(path) => self.load_media(path, source).await,
            None => self.load_clip(&clip, source).await,
        };
        match loaded {
            Ok(()) => {
                self.prepared.borrow_mut().insert(clip.clone(), ());
                self.dispatch(Input::ClipPrepared { clip });
            }
            Err(thrown) => {
                let failure = stage_failure(&thrown);
                self.dispatch(Input::ClipFailed { clip, failure });
            }
        }
    }

    /// Fetches a picture or a sign-language video, from the bundle's `source`.
    async fn load_media(&self, path: &str, source: &Value) -> Result<(), JsValue> {
        let text = |key: &str| source.get(key).and_then(Value::as_str).unwrap_or_default();
        let address = host::media_address(text("avatar"), text("video")).await?;
        let address = address.as_string().unwrap_or_default();
        self.media.borrow_mut().insert(path.to_owned(), address);
        Ok(())
    }

    async fn load_clip(self: &Rc<Self>, clip: &str, source: &Value) -> Result<(), JsValue> {
        let progress = Closure::<dyn Fn(f64)>::new({
            let (engine, clip) = (Rc::clone(self), clip.to_owned());
            move |fraction| engine.dispatch(Input::ClipProgress { clip: clip.clone(), fraction })
        });
        let source = source.to_string();
        host::prepare_clip(clip, &source, progress.as_ref().unchecked_ref()).await?;
        Ok(())
    }

    /// Shows the first frame of a clip that is prepared, and of the one beside it.
    pub fn show(self: &Rc<Self>, clip: String, beside: Option<String>) {
        let engine = Rc::clone(self);
        spawn_local(async move {
            if let Err(thrown) = host::show_clip(&clip, beside).await {
                engine.prepared.borrow_mut().remove(&clip);
                let failure = stage_failure(&thrown);
                engine.dispatch(Input::ClipFailed { clip, failure });
            }
        });
    }

    fn play(self: &Rc<Self>, clip: String, beside: Option<String>) {
        let engine = Rc::clone(self);
        spawn_local(async move {
            let input = match host::play_clip(&clip, beside).await.map(|log| play_log(&log)) {
                Ok(Ok(log)) => Input::Played(log),
                Ok(Err(failure)) => Input::ClipFailed { clip, failure },
                Err(thrown) => Input::ClipFailed { clip, failure: stage_failure(&thrown) },
            };
            engine.dispatch(input);
        });
    }

    fn complete(self: &Rc<Self>, events: u64) {
        if self.store.is_none() {
            return;
        }
        let engine = Rc::clone(self);
        spawn_local(async move {
            let mut failures = 0;
            loop {
                // After a reload at the end something may still be on its way.
                while engine.sending.get() {
                    clock::sleep(Duration::from_millis(100)).await;
                }
                // Whoever takes everything back needs no receipt.
                if engine.is_withdrawing() {
                    break;
                }
                match engine.service.complete(&engine.plan.started.session, events).await {
                    Ok(receipt) => {
                        engine.connected();
                        engine.dispatch(Input::ReceiptArrived(receipt));
                        break;
                    }
                    Err(failure) => {
                        failures += 1;
                        engine.troubled(failure);
                        engine.wait(failures).await;
                    }
                }
            }
        });
    }

    fn withdraw(self: &Rc<Self>) {
        if self.store.is_none() {
            // Nothing was kept.
            return self.dispatch(Input::WithdrawalConfirmed);
        }
        let engine = Rc::clone(self);
        spawn_local(async move {
            let started = &engine.plan.started;
            let mut failures = 0;
            loop {
                let (session, code) = (&started.session, &started.withdrawal_code);
                match engine.service.withdraw(session, code).await {
                    Ok(_) => break,
                    // It is gone already: the answer that said so was never heard here.
                    Err(Failure::Refused(refusal)) if is_gone(&refusal) => break,
                    Err(failure) => {
                        failures += 1;
                        engine.troubled(failure);
                        engine.wait(failures).await;
                    }
                }
            }
            *engine.outbox.borrow_mut() = Outbox::new(u64::MAX);
            if let Some(store) = &engine.store {
                let _ = store.clear().await;
            }
            Identity::forget(&engine.plan.study.id);
            engine.connected();
            engine.dispatch(Input::WithdrawalConfirmed);
        });
    }
}

fn play_log(log: &JsValue) -> Result<PlayLog, StageFailure> {
    let failure = |message: String| StageFailure { message, ..StageFailure::default() };
    let text = log.as_string().ok_or_else(|| failure("the stage gave no log".to_owned()))?;
    serde_json::from_str(&text).map_err(|error| failure(format!("the stage's log: {error}")))
}
