//! Pictures and signed videos: fetched by their hash like every stimulus, before the page that shows
//! them.

use crate::dom::{Element, el};
use crate::screen;

/// A signed video, with the browser's own controls; it has no sound that matters. `path` is that of
/// the study file, `label` what it says, `class` whose it is: of the prompt, or of an option.
pub fn signed_video(path: &str, label: &str, class: &str) -> Element {
    el("video", class)
        .key(path)
        .maybe("src", screen::media(path).as_deref())
        .set("aria-label", label)
        .set("controls", "")
        .set("playsinline", "")
        .set("preload", "metadata")
}

/// A picture beside its words, by its path in the study file.
pub fn picture(path: &str) -> Element {
    el("img", "").key(path).maybe("src", screen::media(path).as_deref()).set("alt", "")
}
