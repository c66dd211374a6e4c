//! What happens to the window.

use std::cell::Cell;
use std::rc::Rc;

use gloo_events::{EventListener, EventListenerOptions, EventListenerPhase};
use gloo_timers::callback::{Interval, Timeout};
use gloo_utils::{document, window};
use wasm_bindgen::JsCast as _;
use web_sys::{Element, Event, EventTarget, KeyboardEvent};

use super::clock::time_of;

/// What happens to the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WindowEvent {
    /// It lost the focus, or was hidden.
    Blurred,
    /// It has the focus (again).
    Focused,
    /// It has another size.
    Resized,
    /// It entered or left the full screen.
    FullscreenChanged,
    /// The connection is back.
    Online,
    /// The page is hidden and may never come back: what waits should go out.
    SendNow,
    /// A second has passed.
    Second,
    /// Something that acts when it is let go is pressed.
    Pressed,
    /// It was let go, and what that does is done.
    LetGo,
}

/// What acts when it is let go, if it is still below the finger then. A line of a scale acts while it is held.
const ACTS_ON_RELEASE: &str = "button, a, label, summary, input:not([type=range])";

/// Calls back with everything that happens, for as long as the page lives.
pub fn watch(call: impl Fn(WindowEvent) + 'static) {
    let call = Rc::new(call);
    let listen = |target: &EventTarget, name: &'static str, event: WindowEvent| {
        let call = Rc::clone(&call);
        EventListener::new(target, name, move |_| call(event)).forget();
    };
    listen(&window(), "blur", WindowEvent::Blurred);
    listen(&window(), "focus", WindowEvent::Focused);
    listen(&window(), "resize", WindowEvent::Resized);
    listen(&window(), "online", WindowEvent::Online);
    listen(&window(), "pagehide", WindowEvent::SendNow);
    listen(&document(), "fullscreenchange", WindowEvent::FullscreenChanged);
    let seen = Rc::clone(&call);
    EventListener::new(&document(), "visibilitychange", move |_| {
        if document().hidden() {
            // A hidden page need not lose the focus.
            seen(WindowEvent::Blurred);
            seen(WindowEvent::SendNow);
        } else if document().has_focus().unwrap_or(false) {
            seen(WindowEvent::Focused);
        }
    })
    .forget();
    watch_presses(&call);
    Interval::new(1_000, move || call(WindowEvent::Second)).forget();
}

/// Says when something is pressed, and when its click is over.
fn watch_presses<F: Fn(WindowEvent) + 'static>(call: &Rc<F>) {
    // Presses so far: what is let go ends those before it, not one that comes while its timer waits.
    let presses = Rc::new(Cell::new(0_u64));
    // A finger's press comes as a mouse's again, right before the click.
    for name in ["pointerdown", "mousedown"] {
        let (call, presses) = (Rc::clone(call), Rc::clone(&presses));
        // Before the field that loses the focus says that it has changed.
        let options =
            EventListenerOptions { phase: EventListenerPhase::Capture, ..Default::default() };
        EventListener::new_with_options(&window(), name, options, move |event: &Event| {
            let target = event.target().and_then(|target| target.dyn_into::<Element>().ok());
            let acts = |target: Element| target.closest(ACTS_ON_RELEASE).ok().flatten();
            if target.and_then(acts).is_some() {
                presses.set(presses.get() + 1);
                call(WindowEvent::Pressed);
            }
        })
        .forget();
    }
    // The window's own loss of the focus; that of a field does not come up here.
    for name in ["pointerup", "pointercancel", "mouseup", "keydown", "blur"] {
        let (call, presses) = (Rc::clone(call), Rc::clone(&presses));
        EventListener::new(&window(), name, move |_| {
            let (call, presses) = (Rc::clone(&call), Rc::clone(&presses));
            let ended = presses.get();
            let let_go = move || {
                if presses.get() == ended {
                    call(WindowEvent::LetGo);
                }
            };
            // The click comes with the release, before anything that waits.
            Timeout::new(0, let_go).forget();
        })
        .forget();
    }
}

/// Calls back with every key that is pressed alone, and not into a field of text: its name, and when, page clock. The
/// browser does nothing of its own with a key that was taken.
pub fn watch_keys(call: impl Fn(&str, f64) -> bool + 'static) {
    const TYPED_INTO: &str = "textarea, input:not([type=range], [type=radio], [type=checkbox])";
    let options = EventListenerOptions::enable_prevent_default();
    EventListener::new_with_options(&window(), "keydown", options, move |event: &Event| {
        let Some(pressed) = event.dyn_ref::<KeyboardEvent>() else { return };
        let target = event.target().and_then(|target| target.dyn_into::<Element>().ok());
        let is_typed = target.is_some_and(|target| target.matches(TYPED_INTO).unwrap_or(false));
        let with_others = pressed.ctrl_key() || pressed.alt_key() || pressed.meta_key();
        if is_typed || with_others || pressed.repeat() {
            return;
        }
        if call(&pressed.key(), time_of(event)) {
            event.prevent_default();
        }
    })
    .forget();
}
