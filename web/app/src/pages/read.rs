//! A page to read: instructions, a break, the debriefing.

use mimique_session::flow::View;

use super::clock::clock;
use super::{heading, main, next, progress_line};
use crate::dom::{Element, el, words};

/// A page to read.
pub fn read(view: &View) -> Element {
    let View::Page { heading: title, text, progress, button, clock: left, .. } = view else {
        return super::opening();
    };
    let hint = button.hint.as_deref().unwrap_or_default();
    let next = next(&button.label).flag("aria-disabled", !button.can_submit);
    let card = el("div", "card")
        .with(heading(title))
        .paragraphs(text)
        .with(words("p", "soft", hint).key("hint").set("role", "status"))
        .with(el("div", "actions").with(next));
    main("page", "page").with(progress_line(*progress)).option(left.as_ref().map(clock)).with(card)
}
