//! How much time is left: seen every second, heard once when the end is near.

use mimique_session::flow::{ClockView, Input};

use super::{button, sends};
use crate::dom::{Element, el, words};

/// The clock of a page or a trial, with the button that gives more time.
pub fn clock(clock: &ClockView) -> Element {
    let warning = clock.warning.as_deref();
    let extend = clock
        .extend
        .as_ref()
        .map(|label| button("", "more-time", label).on("click", sends(|| Input::ExtendTime)));
    el("div", if warning.is_some() { "clock near" } else { "clock" })
        .key("clock")
        // A timer is announced only when its reader asks for it.
        .with(words("span", "number", &clock.text).key("timer").set("role", "timer"))
        .option(extend)
        // Changed only when the words change: not heard with every second.
        .with(words("span", "visually-hidden", warning.unwrap_or_default()).set("role", "status"))
}
