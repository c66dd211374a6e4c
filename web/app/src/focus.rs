//! Where the keyboard is: on the page's heading when a page is new, never nowhere.

use leptos::prelude::*;
use wasm_bindgen::JsCast as _;

/// Moves the focus to the page's heading, once the page stands there; not from somebody who was
/// quicker and is on the new page already.
pub fn heading() {
    request_animation_frame(|| {
        let active = document().active_element();
        let on_page = active.and_then(|element| element.closest("main").ok().flatten());
        if on_page.is_none() {
            window().scroll_to_with_x_and_y(0.0, 0.0);
            first(&["main h1"]);
        }
    });
}

/// Moves the focus to the first answer that has to be mended, if there is one.
pub fn problem() {
    later(&[
        "main [data-invalid] :is(input, textarea, button):checked",
        "main [data-invalid] :is(input, textarea, button):not(:disabled)",
    ]);
}

/// Moves the focus, after the next frame, to the first of these selectors that finds something.
pub fn later(selectors: &'static [&'static str]) {
    request_animation_frame(move || first(selectors));
}

/// Gives the focus a place if the element that had it has gone.
pub fn rescue(selectors: &'static [&'static str]) {
    request_animation_frame(move || {
        let active = document().active_element();
        if active.is_none_or(|element| element.tag_name().eq_ignore_ascii_case("body")) {
            first(selectors);
        }
    });
}

fn first(selectors: &[&str]) {
    let found = selectors.iter().find_map(|each| document().query_selector(each).ok().flatten());
    if let Some(element) = found.and_then(|found| found.dyn_into::<web_sys::HtmlElement>().ok()) {
        // What cannot take the focus leaves it where it is.
        let _ = element.focus();
    }
}
