//! The last page: everything has arrived, and only now the code. Code and way back come first; what a
//! participant keeps stands below them.

use mimique_session::flow::{CodeView, EndView, Input, RecordsView};

use super::message::another_person;
use super::{button, heading, main, sends};
use crate::act::Act;
use crate::dom::{Element, el, words};
use crate::engine::Engine;
use crate::site::{Ending, Site};

/// Thanks, completion code and way back, then withdrawal code, number and receipt.
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
    // One button is the next thing to do.
    let offered = ending.as_ref().is_some_and(|ending| ending.offered);
    let file_first = offered && ending.is_some_and(|ending| !ending.posted);
    let is_primary = |first: bool| if first && !file_first { "primary" } else { "" };
    if offered {
        let class = if file_first { "primary" } else { "" };
        let download = button(class, "download", fixed.download());
        let download = download.on("click", |_| Act::Download);
        card = card.with(el("div", "actions").key("download").with(download));
    }
    let code = end
        .completion_code
        .as_ref()
        .map(|code| completion(code, is_primary(end.redirect.is_none())));
    let back = end.redirect.as_ref().map(|(label, address)| {
        let class = ["button", is_primary(true)].join(" ");
        let link = words("a", class.trim_end(), label).set("href", address);
        el("div", "actions").key("back").with(link)
    });
    let returning = end.returning.as_ref().map(|(text, stay)| {
        let stay = button("quiet", "stay", stay).on("click", sends(|| Input::Stay));
        el("div", "row").key("returning").with(words("span", "soft", text)).with(stay)
    });
    card = card.option(code).option(back).option(returning);
    // A site of plain files has nobody who deletes.
    let has_server = engine.service.site().is_none();
    let delete = has_server.then(|| {
        let address = format!("withdraw?lang={}", engine.language());
        let link = words("a", "", &end.records.delete).set("href", &address);
        el("p", "").key("delete").with(link)
    });
    let records = el("div", "card").key("records").all(records(&end.records)).option(delete);
    main("page", "end")
        .set("data-outcome", end.outcome)
        .with(card)
        .with(records.option(another_person(engine)))
}

/// The completion code, and the button that copies it.
fn completion(code: &CodeView, class: &str) -> Element {
    let text = code.code.clone();
    let copy = button(class, "copy", code.copied.as_deref().unwrap_or(&code.copy))
        .on("click", move |_| Act::Copy(text.clone()));
    let said = code.copied.as_deref().unwrap_or_default();
    el("div", "completion").key("completion").with(words("h2", "", &code.label)).with(
        el("div", "row")
            .with(words("span", "code-block", &code.code).set("data-code", "completion"))
            .with(copy)
            .with(words("span", "visually-hidden", said).set("role", "status")),
    )
}

/// What a participant keeps.
fn records(records: &RecordsView) -> Vec<Element> {
    let line = |what: &str, (label, value): &(String, String)| {
        let value = words("span", "kept", value).set("data-code", what);
        [words("dt", "", label), el("dd", "").with(value)]
    };
    let lines = [
        line("withdrawal", &records.withdrawal_code),
        line("participant", &records.participant),
        line("receipt", &records.receipt),
    ];
    vec![
        words("h2", "", &records.heading),
        el("dl", "records").all(lines.into_iter().flatten().collect()),
        words("p", "soft", &records.note),
    ]
}
