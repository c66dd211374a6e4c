//! What stands on the screen: after every change the pages are described anew ([`crate::pages`]) and
//! mended on the page ([`crate::dom`]), once for all changes of one turn.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use mimique_study::SortedMap;
use mimique_study::flow::{Input, Phase, View, view};
use mimique_study::text::Words;
use serde_json::Value;
use wasm_bindgen::JsValue;
use wasm_bindgen_futures::spawn_local;

use crate::dom::Place;
use crate::engine::Engine;
use crate::pages::failure::{self, Trouble};
use crate::pages::{self, Seen};
use crate::{bridge, page, start};

/// Where the page is.
pub enum Boot {
    /// The study is being fetched.
    Opening,
    /// It cannot begin.
    Trouble(Trouble, Words),
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
    phase: Option<(&'static str, String, Option<String>)>,
}

thread_local! {
    static BOOT: RefCell<Boot> = const { RefCell::new(Boot::Opening) };
    static PLACE: RefCell<Option<Place>> = const { RefCell::new(None) };
    static SHOWN: RefCell<Shown> = RefCell::default();
    static SEEN: RefCell<Seen> = RefCell::default();
    /// Path -> address of what has been fetched.
    static MEDIA: RefCell<SortedMap<String, String>> = const { RefCell::new(SortedMap::new()) };
    static DUE: Cell<bool> = const { Cell::new(false) };
}

/// Takes the place of the pages.
pub fn open() {
    PLACE.with(|place| *place.borrow_mut() = Some(Place::root()));
}

/// Another start, trouble, or session.
pub fn boot(boot: Boot) {
    BOOT.with(|now| *now.borrow_mut() = boot);
    changed();
}

/// The session that runs.
pub fn engine() -> Option<Rc<Engine>> {
    BOOT.with(|boot| match &*boot.borrow() {
        Boot::Running(engine) => Some(Rc::clone(engine)),
        _ => None,
    })
}

/// Hands an input to the session that runs.
pub fn send(input: Input) {
    if let Some(engine) = engine() {
        engine.dispatch(input);
    }
}

/// Something changed that the screen shows: it is drawn again at the end of this turn.
pub fn changed() {
    if !DUE.replace(true) {
        spawn_local(async { draw() });
    }
}

/// The address of a picture or a signed video of the study, once it has been fetched.
pub fn media(path: &str) -> Option<String> {
    MEDIA.with(|media| media.borrow().get(path).cloned())
}

/// Fetches a picture or a signed video, from the bundle's `source`.
pub async fn load_media(path: &str, source: &Value) -> Result<(), JsValue> {
    let text = |key: &str| source.get(key).and_then(Value::as_str).unwrap_or_default();
    let address = bridge::media_address(text("avatar"), text("film")).await?;
    let address = address.as_string().unwrap_or_default();
    MEDIA.with(|media| media.borrow_mut().insert(path.to_owned(), address));
    Ok(())
}

fn draw() {
    DUE.set(false);
    let Some(engine) = engine() else {
        let element = BOOT.with(|boot| match &*boot.borrow() {
            Boot::Trouble(trouble, words) => failure::trouble(trouble, words),
            _ => pages::opening(),
        });
        return show(vec![element]);
    };
    let view = view(&engine.plan, &engine.state());
    let language = engine.language();
    let shape = pages::shape(&view, &language);
    let elements = SEEN.with(|seen| {
        let mut seen = seen.borrow_mut();
        seen.look(&view);
        pages::pages(&engine, &view, &shape, &seen)
    });
    show(elements);
    SHOWN.with(|shown| after(&engine, &mut shown.borrow_mut(), view, shape, language));
}

fn show(elements: Vec<crate::dom::Element>) {
    PLACE.with(|place| {
        if let Some(place) = &mut *place.borrow_mut() {
            place.show(elements);
        }
    });
}

/// What a change of the screen brings with it.
fn after(engine: &Rc<Engine>, shown: &mut Shown, view: View, shape: String, language: String) {
    if shown.language != language {
        let title = engine.plan.study.study_metadata.title.in_language(&language);
        page::describe(&language, title);
        shown.language = language;
    }
    let step = pages::step_of(&view).map(str::to_owned);
    if shown.step != step {
        if let Some(step) = step.clone() {
            spawn_local(async move {
                page::painted().await;
                if SHOWN.with(|shown| shown.borrow().step.as_ref() == Some(&step)) {
                    send(Input::Shown { step });
                }
            });
        }
        shown.step = step;
    }
    let anew = shown.shape != shape;
    if anew {
        if !shown.shape.is_empty() {
            page::focus_rescue("main h1");
        }
        shown.shape = shape;
        shown.phase = None;
    }
    let View::Trial(trial) = view else { return };
    let companion = trial.beside.map(|beside| beside.clip);
    let phase = Some((pages::phase_word(&trial.phase), trial.clip, companion));
    if shown.phase == phase {
        return;
    }
    let before = std::mem::replace(&mut shown.phase, phase);
    let Some((word, clip, companion)) = &shown.phase else { return };
    if before.is_some_and(|before| before.0 != *word) {
        page::focus_rescue(
            "main [data-action=play], main [data-action=retry]|main fieldset[data-question] input|main h1",
        );
    }
    if matches!(trial.phase, Phase::Ready) {
        engine.show(clip.clone(), companion.clone());
    }
}

/// Begins again after trouble.
pub fn retry() {
    boot(Boot::Opening);
    start::begin_again();
}
