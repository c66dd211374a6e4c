//! The page cannot begin, and why.

use mimique_study::text::Words;

use super::{heading, main};
use crate::act::Act;
use crate::dom::{Element, el, words};
use crate::start::Trouble;

/// What is wrong, and a button to try again.
pub fn trouble(trouble: &Trouble, fixed: &Words) -> Element {
    let (title, detail) = match trouble {
        Trouble::NoStudy => (fixed.no_study(), String::new()),
        Trouble::Unreachable(reason) => (fixed.unreachable(), reason.clone()),
        Trouble::Refused(refusal) => {
            (fixed.cannot_begin(), fixed.refused(&refusal.code, &refusal.message, &refusal.remedy))
        }
        Trouble::Unreadable(reason) => (fixed.cannot_run(), reason.clone()),
        Trouble::OtherTab => (fixed.other_tab(), fixed.other_tab_text().to_owned()),
    };
    let retry = words("button", "primary", fixed.retry())
        .set("type", "button")
        .on("click", |_| Act::BeginAgain);
    let card = el("div", "card")
        .with(heading(title))
        .with(words("p", "", &detail))
        .with(el("div", "actions").with(retry));
    main("page", "failure").key("failure").with(card)
}
