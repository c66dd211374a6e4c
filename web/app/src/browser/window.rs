//! What happens to the window.

use std::rc::Rc;

use gloo_events::EventListener;
use gloo_timers::callback::Interval;
use gloo_utils::{document, window};
use web_sys::EventTarget;

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
    /// The connection is back, or the page is hidden and may never come back: what waits should go out.
    SendNow,
    /// A second has passed.
    Second,
}

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
    listen(&window(), "online", WindowEvent::SendNow);
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
    Interval::new(1_000, move || call(WindowEvent::Second)).forget();
}
