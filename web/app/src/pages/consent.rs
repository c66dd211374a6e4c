//! The agreement.

use mimique_session::flow::{ContactView, Input, View};

use super::{button, heading, main, sends};
use crate::browser::focus;
use crate::dom::{Element, el, words};
use crate::engine::Engine;

/// The agreement, with the choice of language.
pub fn consent(engine: &Engine, view: &View) -> Element {
    let View::Consent { agreement, languages, agree, decline, .. } = view else {
        return super::opening();
    };
    let fixed = engine.words();
    let mut card = el("div", "card");
    if !languages.is_empty() {
        let current = engine.language();
        let buttons = languages.iter().map(|(code, name)| language(code, name, *code == current));
        card = card.with(
            el("nav", "row end languages")
                .set("aria-label", fixed.choose_language())
                .all(buttons.collect()),
        );
    }
    card = card.with(heading(&agreement.title)).with(words("p", "", &agreement.description));
    for section in &agreement.sections {
        let section =
            el("section", "").with(words("h2", "", &section.heading)).paragraphs(&section.text);
        card = card.with(section);
    }
    let people = el("section", "")
        .with(words("h2", "", &agreement.contact))
        .all(agreement.contacts.iter().map(contact).collect());
    let actions = el("div", "actions")
        .with(button("primary", "agree", agree).on("click", sends(|| Input::Consent)))
        .with(button("", "decline", decline).on("click", sends(|| Input::Decline)));
    main("page", "consent").with(card.with(people).with(actions))
}

fn language(code: &str, name: &str, chosen: bool) -> Element {
    let wanted = code.to_owned();
    words("button", "quiet", name)
        .set("type", "button")
        .set("lang", code)
        .set("aria-pressed", if chosen { "true" } else { "false" })
        .on("click", move |_| {
            focus::focus_later(&[".languages [aria-pressed=true]"]);
            Input::ChooseLanguage(wanted.clone())
        })
}

fn contact(contact: &ContactView) -> Element {
    let address = ["mailto:", contact.email.as_str()].concat();
    let line = el("p", "")
        .with(words("strong", "", &contact.role))
        .with(el("br", ""))
        .text(&contact.name)
        .text(", ")
        .with(words("a", "", &contact.email).set("href", &address));
    match &contact.reference {
        Some(reference) => line.text(" (").text(reference).text(")"),
        None => line,
    }
}
