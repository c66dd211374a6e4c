//! Pages that only tell something.

use mimique_session::Standing;
use mimique_study::RepeatPrevention;

use super::{button, heading, main};
use crate::act::Act;
use crate::browser::document;
use crate::dom::{Element, el, words};
use crate::engine::Engine;

/// The last answers are on their way.
pub fn receipt_pending(title: &str, text: &str, stored: u64, total: u64) -> Element {
    let bar = el("progress", "")
        .set("max", &total.to_string())
        .set("value", &stored.to_string())
        .set("aria-label", title);
    told("receipt", title, text, Some(bar))
}

/// The participant took everything back.
pub fn withdrawn(title: &str, text: &str, confirmed: bool) -> Element {
    let outcome = confirmed.then(|| Standing::Withdrawn.export_word());
    let confirmed = if confirmed { "true" } else { "false" };
    told("withdrawn", title, text, None)
        .set("data-confirmed", confirmed)
        .maybe("data-outcome", outcome)
}

fn told(view: &str, title: &str, text: &str, more: Option<Element>) -> Element {
    let card = el("div", "card").set("aria-live", "polite");
    main("page", view).with(card.with(heading(title)).with(words("p", "", text)).option(more))
}

/// The participant did not agree, and may have pressed the wrong button.
pub fn declined(engine: &Engine, title: &str, text: &str) -> Element {
    let back = button("", "back-to-consent", engine.words().back_to_consent());
    let card = el("div", "card")
        .with(heading(title))
        .with(words("p", "", text))
        .with(el("div", "actions").with(back.on("click", |_| Act::BeginAgain)));
    main("page", "declined").set("data-outcome", Standing::Declined.export_word()).with(card)
}

/// Where the study lets one browser take part again: a session of its own for the next person.
pub fn another_person(engine: &Engine) -> Option<Element> {
    let study = &engine.plan.study;
    // Whoever was sent here by a recruiting site goes back there.
    let sent = document::arrival().recruitment;
    let offered = matches!(study.repeat_prevention, RepeatPrevention::None)
        && !study.url_parameters.iter().any(|name| sent.contains_key(name));
    offered.then(|| {
        let again = button("", "another-person", engine.words().another_person());
        el("div", "actions").key("another-person").with(again.on("click", |_| Act::AnotherPerson))
    })
}
