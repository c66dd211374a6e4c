//! Pages whose controls are a script's, which only the studies load that have such a page: the sound check
//! (`static/sound/check.js`), the consent to measuring the face (`static/mimicry/check.js`). The script puts its result into
//! the hidden field that stands here for it.

use mimique_session::flow::{Input, ScriptedView};

use super::{heading, main, progress_line};
use crate::act::Act;
use crate::browser::host;
use crate::dom::{Element, FieldEvent, el};

/// The page of a script; its name is the step's.
pub fn scripted(shown: &ScriptedView) -> Element {
    let field = el("input", "")
        .set("type", "hidden")
        .set("data-script", &shown.step)
        .set("data-pages", &shown.pages)
        .handles("change", |field| checked(&field))
        .mounted(host::attach_sound, || ());
    let card = el("div", "card").with(heading(&shown.heading)).paragraphs(&shown.text).with(field);
    main("page", &shown.step).with(progress_line(shown.progress)).with(card)
}

/// What the script found.
fn checked(field: &FieldEvent) -> Option<Act> {
    let answers = serde_json::from_str(&field.value).ok()?;
    Some(Act::Input(Input::PageScripted(answers)))
}
