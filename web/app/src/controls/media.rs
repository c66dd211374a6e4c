//! Pictures and sign-language videos: fetched by their hash like every stimulus, before the page that shows
//! them.

use crate::dom::{Element, el};
use crate::engine::Engine;

/// A sign-language video, with the browser's own controls; it has no sound that matters. `path` is that of
/// the study file, `label` what it says, `class` whose it is: of the prompt, or of an option.
pub fn sign_language_video(engine: &Engine, path: &str, label: &str, class: &str) -> Element {
    el("video", class)
        .key(path)
        .maybe("src", engine.media(path).as_deref())
        .set("aria-label", label)
        .set("controls", "")
        .set("playsinline", "")
        .set("preload", "metadata")
}

/// A picture beside its words, by its path in the study file.
pub fn picture(engine: &Engine, path: &str) -> Element {
    el("img", "").key(path).maybe("src", engine.media(path).as_deref()).set("alt", "")
}
