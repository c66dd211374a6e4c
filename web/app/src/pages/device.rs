//! The device gate: what is missing, and what to do about it.

use mimique_session::flow::{DeviceView, Input};

use super::{button, heading, main, next, progress_line, sends};
use crate::dom::{Element, el, words};

/// The device gate. It changes in place when the window changes its size.
pub fn device(gate: &DeviceView) -> Element {
    let mut status = el("div", "").set("role", "status").with(words("p", "", &gate.text));
    for (what, remedy) in &gate.problems {
        let what = el("p", "").with(words("strong", "", what));
        status = status.with(el("div", "notice warn").with(what).with(words("p", "", remedy)));
    }
    let offered = |class: &str, action: &str, label: &Option<String>, input: fn() -> Input| {
        label.as_ref().map(|label| button(class, action, label).on("click", sends(input)))
    };
    let actions = el("div", "actions")
        .option(gate.button.can_submit.then(|| next(&gate.button.label)))
        .option(offered("", "without-fullscreen", &gate.without, || Input::WithoutFullscreen))
        .option(offered("primary", "again", &gate.again, || Input::MeasureAgain))
        .option(offered("", "give-up", &gate.give_up, || Input::GiveUp));
    let card = el("div", "card").with(heading(&gate.heading)).with(status).with(actions);
    main("page", "device")
        .set("data-measuring", if gate.measuring { "true" } else { "false" })
        .set("data-fine", if gate.button.can_submit { "true" } else { "false" })
        .with(progress_line(gate.progress))
        .with(card)
}
