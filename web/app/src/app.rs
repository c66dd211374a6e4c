//! The page itself: what state it is in, and what stands on the screen. After every change the pages are
//! described anew ([`crate::pages`]) and the document is made to follow ([`crate::dom`]), once for all
//! changes of one turn of the browser's loop.

use std::cell::{Cell, RefCell};
use std::rc::{Rc, Weak};

use mimique_session::flow::{Input, Phase, PlacedClip, QuestionKindView, View, view};
use mimique_study::SPACE_KEY;
use mimique_study::text::{Words, words};
use mimique_web_panics::report_panics;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen_futures::spawn_local;

use crate::act::Act;
use crate::browser::window::{WindowEvent, watch, watch_keys};
use crate::browser::{clock, document, focus, host};
use crate::dom::{Element, Mount};
use crate::engine::Engine;
use crate::event_store::Identity;
use crate::pages::{self, WatchedClip, failure};
use crate::start::{self, Trouble};

/// Where the page is.
enum Status {
    /// The study is being fetched.
    Opening,
    /// It cannot begin.
    Failed(Trouble, Words),
    /// Agreement and device are passed: the session is being begun.
    Entering(Words),
    /// A session runs.
    Running(Rc<Engine>),
}

/// What was last shown, to see what has changed.
#[derive(Default)]
struct Shown {
    /// What was built anew when it changed.
    shape: String,
    step: Option<String>,
    language: String,
    /// Phase of the trial, its clip and the one beside it.
    phase: Option<(&'static str, Vec<PlacedClip>)>,
}

/// The page. It lives as long as the document.
struct App {
    here: Weak<Self>,
    status: RefCell<Status>,
    mount: RefCell<Mount>,
    shown: RefCell<Shown>,
    watched: RefCell<WatchedClip>,
    /// Who has passed agreement and device, and could not begin yet.
    lobby: RefCell<Option<Rc<Engine>>>,
    /// Whether a declining was counted.
    declined: Cell<bool>,
    /// Whether the pages are drawn: before, title and agreement stand there as the HTML has them.
    drawn: Cell<bool>,
    /// Whether it is drawn at the end of this turn.
    due: Cell<bool>,
    /// Whether something is pressed: what stands under the pointer stays there until it is let go.
    pressed: Cell<bool>,
}

/// The module's entry.
#[wasm_bindgen(start)]
pub fn start() {
    report_panics("app", "");
    let app = Rc::new_cyclic(|here: &Weak<App>| {
        let dispatch = here.clone();
        let dispatch = Rc::new(move |act| {
            if let Some(app) = dispatch.upgrade() {
                app.act(act);
            }
        });
        App {
            here: here.clone(),
            status: RefCell::new(Status::Opening),
            mount: RefCell::new(Mount::new(document::root(), dispatch)),
            shown: RefCell::default(),
            watched: RefCell::default(),
            lobby: RefCell::default(),
            declined: Cell::new(false),
            drawn: Cell::new(false),
            due: Cell::new(false),
            pressed: Cell::new(false),
        }
    });
    app.begin();
    // What holds the page from now on.
    let keys = Rc::clone(&app);
    watch(move |event| app.window(event));
    watch_keys(move |key, at_ms| keys.key(key, at_ms));
}

impl App {
    /// Fetches the study and goes on where the session is.
    fn begin(&self) {
        self.is_now(Status::Opening);
        let Some(app) = self.here.upgrade() else { return };
        spawn_local(async move {
            let mut fixed = words(&document::language()).clone();
            let here = Rc::clone(&app);
            let status = match start::begin(&mut fixed, Rc::new(move || here.changed())).await {
                Ok(engine) => Status::Running(engine),
                Err(trouble) => Status::Failed(trouble, fixed),
            };
            app.is_now(status);
        });
    }

    /// Begins the session of somebody who has passed agreement and device.
    fn enter(&self, lobby: Rc<Engine>) {
        let fixed = lobby.words().clone();
        self.is_now(Status::Entering(fixed.clone()));
        let Some(app) = self.here.upgrade() else { return };
        spawn_local(async move {
            let here = Rc::clone(&app);
            let status = match start::enter(&lobby, Rc::new(move || here.changed())).await {
                Ok(engine) => Status::Running(engine),
                Err(trouble) => {
                    *app.lobby.borrow_mut() = Some(lobby);
                    Status::Failed(trouble, fixed)
                }
            };
            app.is_now(status);
        });
    }

    /// Counts a declining, once.
    fn count_declined(&self, lobby: Rc<Engine>) {
        if !self.declined.replace(true) {
            spawn_local(async move { start::count_declined(&lobby).await });
        }
    }

    fn is_now(&self, status: Status) {
        *self.status.borrow_mut() = status;
        self.changed();
    }

    /// The session that runs.
    fn engine(&self) -> Option<Rc<Engine>> {
        match &*self.status.borrow() {
            Status::Running(engine) => Some(Rc::clone(engine)),
            _ => None,
        }
    }

    /// Hands an input to the session that runs.
    fn send(&self, input: Input) {
        if let Some(engine) = self.engine() {
            engine.dispatch(input);
        }
    }

    /// Does what a page asks for.
    fn act(&self, act: Act) {
        match (act, self.engine()) {
            (Act::BeginAgain, _) => {
                let lobby = self.lobby.take();
                match lobby {
                    Some(lobby) => self.enter(lobby),
                    None => self.begin(),
                }
            }
            (Act::Input(input), Some(engine)) => engine.dispatch(input),
            (Act::Change { question, change }, Some(engine)) => {
                let value = change(engine.state().record.draft(&question));
                engine.dispatch(Input::Answer { question, value });
            }
            (Act::AnotherPerson, Some(engine)) => {
                Identity::forget(&engine.plan.study.id);
                document::reload();
            }
            (Act::Copy(text), Some(engine)) => spawn_local(async move {
                if host::copy(&text).await.is_ok_and(|copied| copied.as_bool() == Some(true)) {
                    engine.dispatch(Input::Copied);
                }
            }),
            (Act::Download, Some(engine)) => {
                let file = engine.service.site().and_then(|site| site.session_file());
                if let Some((name, text, _)) = file {
                    host::download(&name, &text);
                }
            }
            // Nothing else is asked for where no session runs.
            (_, None) => {}
        }
    }

    /// What the window reports: focus, visibility, connection, time.
    fn window(&self, event: WindowEvent) {
        match event {
            WindowEvent::Pressed => return self.pressed.set(true),
            WindowEvent::LetGo => return self.let_go(),
            _ => {}
        }
        let Some(engine) = self.engine() else { return };
        match event {
            WindowEvent::Blurred => engine.dispatch(Input::FocusLost),
            WindowEvent::Focused => engine.dispatch(Input::FocusGained),
            WindowEvent::Resized => engine.resized(),
            WindowEvent::FullscreenChanged => {
                engine.dispatch(Input::Fullscreen(host::is_fullscreen()));
            }
            WindowEvent::Online => {
                engine.flush();
                engine.dispatch(Input::Online);
            }
            WindowEvent::SendNow => engine.flush(),
            WindowEvent::Second => engine.dispatch(Input::Tick),
            WindowEvent::Pressed | WindowEvent::LetGo => {}
        }
    }

    /// A key: an answer, where a question of the trial has it.
    fn key(&self, key: &str, at_ms: f64) -> bool {
        let Some(engine) = self.engine() else { return false };
        let View::Trial(trial) = view(&engine.plan, &engine.state()) else { return false };
        let is_it = |own: &str| match own {
            SPACE_KEY => key == " ",
            own => own.to_lowercase() == key.to_lowercase(),
        };
        for asked in trial.keys.iter().filter(|_| trial.can_press) {
            let QuestionKindView::Keys { options, keys } = &asked.kind else { continue };
            let found = keys.iter().position(|own| own.as_deref().is_some_and(is_it));
            if let Some(option) = found.and_then(|place| options.get(place)) {
                let (question, value) = (asked.id.clone(), option.value.clone());
                engine.dispatch(Input::Press { question, value, at_ms });
                return true;
            }
        }
        false
    }

    /// Something changed that the screen shows: it is drawn again at the end of this turn, or once what is
    /// pressed is let go. A page that moved in between would take the button from under the pointer.
    fn changed(&self) {
        if !self.due.replace(true) && !self.pressed.get() {
            self.draw_soon();
        }
    }

    fn draw_soon(&self) {
        if let Some(app) = self.here.upgrade() {
            spawn_local(async move { app.draw() });
        }
    }

    fn let_go(&self) {
        if self.pressed.replace(false) && self.due.get() {
            self.draw_soon();
        }
    }

    fn draw(&self) {
        self.due.set(false);
        let Some(engine) = self.engine() else {
            let element = match &*self.status.borrow() {
                Status::Failed(trouble, words) => failure::trouble(trouble, words),
                Status::Entering(words) => pages::entering(words),
                // Who is only beginning can read the agreement meanwhile.
                _ if !self.drawn.get() && !start::is_under_way() => return,
                _ => pages::opening(),
            };
            return self.show(vec![element]);
        };
        if engine.leaves_lobby() {
            return self.enter(engine);
        }
        if engine.is_declined_lobby() {
            self.count_declined(Rc::clone(&engine));
        }
        let view = view(&engine.plan, &engine.state());
        let language = engine.language();
        let shape = pages::shape(&view, &language);
        self.watched.borrow_mut().look(&view);
        self.show(pages::pages(&engine, &view, &shape, &self.watched.borrow()));
        self.after(&engine, view, shape, language);
    }

    fn show(&self, elements: Vec<Element>) {
        if !self.drawn.replace(true) {
            document::clear();
        }
        self.mount.borrow_mut().show(elements);
    }

    /// What a change of the screen brings with it.
    fn after(&self, engine: &Rc<Engine>, view: View, shape: String, language: String) {
        let mut shown = self.shown.borrow_mut();
        if shown.language != language {
            let title = engine.plan.study.title.in_language(&language);
            document::describe(&language, title);
            shown.language = language;
        }
        let step = pages::step_of(&view).map(str::to_owned);
        if shown.step != step {
            shown.step.clone_from(&step);
            if let (Some(step), Some(app)) = (step, self.here.upgrade()) {
                spawn_local(async move {
                    clock::painted().await;
                    let is_there = app.shown.borrow().step.as_ref() == Some(&step);
                    if is_there {
                        app.send(Input::Shown { step });
                    }
                });
            }
        }
        if shown.shape != shape {
            if !shown.shape.is_empty() {
                focus::focus_if_lost(&["main h1"]);
            }
            shown.shape = shape;
            shown.phase = None;
        }
        let View::Trial(trial) = view else { return };
        let placed = trial.placed().to_vec();
        let word = pages::phase_word(&trial.phase);
        let phase = Some((word, placed.clone()));
        if shown.phase == phase {
            return;
        }
        let before = std::mem::replace(&mut shown.phase, phase);
        if before.is_some_and(|before| before.0 != word) {
            focus::focus_if_lost(&[
                "main [data-action=play], main [data-action=retry]",
                "main fieldset[data-question] input",
                "main h1",
            ]);
        }
        match trial.phase {
            // To the stage when its trial begins, to the questions when they are asked.
            Phase::Loading { .. } | Phase::Ready => focus::bring_into_view(".clip-card"),
            Phase::Answering => focus::bring_into_view(".answers > form"),
            _ => {}
        }
        if matches!(trial.phase, Phase::Ready) {
            engine.show(&placed);
        }
    }
}
