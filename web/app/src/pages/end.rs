//! The last page: everything has arrived, and only now the code.

use mimique_session::flow::EndView;

use super::message::another_person;
use super::{button, heading, main};
use crate::act::Act;
use crate::dom::{Element, el, words};
use crate::engine::Engine;
use crate::site::{Ending, Site};

/// Thanks, completion code, receipt, withdrawal code.
pub fn end(engine: &Engine, end: &EndView) -> Element {
    let fixed = engine.words();
    let mut card = el("div", "card").with(heading(&end.heading));
    let ending = engine.service.site().and_then(Site::ending);
    card = match &ending {
        // Without a server nothing has arrived unless it was posted.
        Some(Ending { posted: false, email, .. }) if end.outcome == "completed" => {
            card.with(words("p", "", &fixed.kept_here(email)))
        }
        _ => card.paragraphs(&end.text),
    };
    if ending.is_some_and(|ending| ending.offered) {
        let download = button("primary", "download", fixed.download());
        let download = download.on("click", |_| Act::Download);
        card = card.with(el("div", "actions").key("download").with(download));
    }
    let code = |class: &str, what: &str, code: &str| {
        el("p", "").with(words("span", class, code).set("data-code", what))
    };
    if let Some((label, completion)) = &end.completion_code {
        card = card.with(words("h2", "", label)).with(code("code-block", "completion", completion));
    }
    if let Some((label, address)) = &end.redirect {
        let back = words("a", "button primary", label).set("href", address);
        card = card.with(el("p", "").with(back));
    }
    let (label, receipt) = &end.receipt;
    card = card.with(words("h2", "", label)).with(code("code-block small", "receipt", receipt));
    let (label, withdrawal, meaning) = &end.withdrawal_code;
    card = card
        .with(words("h2", "", label))
        .with(code("code-block", "withdrawal", withdrawal))
        .with(words("p", "soft", meaning))
        .option(another_person(engine));
    main("page", "end").set("data-outcome", end.outcome).with(card)
}
