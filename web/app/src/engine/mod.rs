//! The interpreter: inputs go into `flow::update`, the effects that come out are carried out.
//!
//! `sending` keeps events and sends them, to the receipt or the withdrawal; `clips` prepares and plays clips.

mod clips;
mod sending;

use std::cell::{Cell, Ref, RefCell};
use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;

use mimique_session::Standing;
use mimique_session::flow::{Effect, Input, Plan, State, StepKind, update};
use mimique_session::wire::{Event, Refusal};
use mimique_study::text::Words;
use mimique_study::{DeviceRules, Display};
use serde_json::{Value, json};
use wasm_bindgen_futures::spawn_local;

use crate::browser::{clock, document, focus, host};
use crate::client::client;
use crate::event_store::EventStore;
use crate::outbox::Outbox;
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
        // A program beside the page is told of a session, not of who looks at the first pages.
        if store.is_some() && !plan.study.triggers.is_null() {
            host::open_triggers(&plan.study.triggers.to_string());
        }
        if store.is_some()
            && let Some(camera) = state.record.answers.get("mimicry_camera").and_then(Value::as_str)
        {
            host::open_mimicry(&plan.study.mimicry.to_string(), camera);
        }
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

    fn carry_out(self: &Rc<Self>, effect: Effect) {
        match effect {
            Effect::Store(event) if self.store.is_none() => self.before.borrow_mut().push(event),
            Effect::Store(event) => {
                if !self.plan.study.triggers.is_null() {
                    host::tell_triggers(&json!([event]).to_string());
                }
                self.keep(vec![event]);
            }
            Effect::Flush => self.flush(),
            Effect::PrepareClips(clips) => self.prepare_clips(clips),
            Effect::ChooseLevel(request) => self.choose_level(request),
            Effect::ReadyLevels(request) => clips::ready_levels(request),
            Effect::DrawPairs(request) => self.draw_pairs(request),
            Effect::PlayClips { clips, in_turn } => self.play(&clips, in_turn),
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
        let mut clips = trials.map(|trial| trial.clip.as_str()).filter(|clip| !clip.is_empty());
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
}
