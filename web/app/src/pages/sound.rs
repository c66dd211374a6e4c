//! The sound check. Its controls are a script's (`static/sound/check.js`), which only studies with sound load: it puts
//! its result into the hidden field that stands here for it.

use mimique_session::flow::{Input, SoundView};

use super::{heading, main, progress_line};
use crate::act::Act;
use crate::browser::host;
use crate::dom::{Element, FieldEvent, el};

/// Where the volume is set and tones are counted.
pub fn sound(shown: &SoundView) -> Element {
    let field = el("input", "")
        .set("type", "hidden")
        .set("data-pages", &shown.pages)
        .handles("change", |field| checked(&field))
        .mounted(host::attach_sound, || ());
    let card = el("div", "card").with(heading(&shown.heading)).paragraphs(&shown.text).with(field);
    main("page", "sound").with(progress_line(shown.progress)).with(card)
}

/// What the script found.
fn checked(field: &FieldEvent) -> Option<Act> {
    let answers = serde_json::from_str(&field.value).ok()?;
    Some(Act::Input(Input::SoundChecked(answers)))
}
