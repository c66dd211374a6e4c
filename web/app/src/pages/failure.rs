//! The page cannot begin, and why.

use mimique_study::text::Words;

use super::{heading, main};
use crate::act::Act;
use crate::dom::{Element, el, words};
use crate::start::Trouble;

/// Refusals with which a participant's part has ended: a page around the study goes on. The others may pass.
const TURNED_AWAY: [&str; 5] =
    ["already-took-part", "no-identifier", "study-closed", "study-full", "study-not-open"];

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
    let outcome = match trouble {
        Trouble::Refused(refusal) if TURNED_AWAY.contains(&refusal.code.as_str()) => {
            Some(refusal.code.replace('-', "_"))
        }
        _ => None,
    };
    main("page", "failure").maybe("data-outcome", outcome.as_deref()).key("failure").with(card)
}
