//! The page cannot begin, and why.

use mimique_study::text::Words;
use mimique_study::wire::Refusal;

use super::{heading, main};
use crate::dom::{Element, el, words};
use crate::screen;

/// What keeps the page from beginning.
#[derive(Debug)]
pub enum Trouble {
    /// The address names no study.
    NoStudy,
    /// The server cannot be reached.
    Unreachable(String),
    /// The server refuses.
    Refused(Refusal),
    /// The study cannot be read by this page.
    Unreadable(String),
    /// The session is open in another tab.
    OtherTab,
}

/// What is wrong, and a button to try again.
pub fn trouble(trouble: &Trouble, fixed: &Words) -> Element {
    let (title, detail) = match trouble {
        Trouble::NoStudy => (fixed.no_study(), String::new()),
        Trouble::Unreachable(reason) => (fixed.unreachable(), reason.clone()),
        Trouble::Refused(refusal) => (fixed.cannot_begin(), fixed.refused(refusal)),
        Trouble::Unreadable(reason) => (fixed.cannot_run(), reason.clone()),
        Trouble::OtherTab => (fixed.other_tab(), fixed.other_tab_text().to_owned()),
    };
    let retry = words("button", "primary", fixed.retry())
        .set("type", "button")
        .on("click", |_| screen::retry());
    let card = el("div", "card")
        .with(heading(title))
        .with(words("p", "", &detail))
        .with(el("div", "actions").with(retry));
    main("page", "failure").key("failure").with(card)
}
