//! The keyboard's focus.

use gloo_utils::{document, window};
use wasm_bindgen::JsCast as _;
use wasm_bindgen_futures::spawn_local;
use web_sys::{HtmlElement, ScrollIntoViewOptions, ScrollLogicalPosition};

use super::clock::{next_frame, painted};

/// Focuses what the first of the selectors finds that finds something.
pub fn focus(selectors: &[&str]) {
    let found = |selector: &&str| document().query_selector(selector).ok().flatten();
    if let Some(element) = selectors.iter().find_map(found)
        && let Ok(element) = element.dyn_into::<HtmlElement>()
    {
        // What cannot take the focus leaves it where it is.
        let _ = element.focus();
    }
}

/// The same, after the next frame.
pub fn focus_later(selectors: &'static [&'static str]) {
    spawn_local(async move {
        next_frame().await;
        focus(selectors);
    });
}

/// The same, if the element that had the focus has gone by then.
pub fn focus_if_lost(selectors: &'static [&'static str]) {
    spawn_local(async move {
        next_frame().await;
        let body = document().body();
        if document().active_element().is_none_or(|active| Some(&active) == body.as_deref()) {
            focus(selectors);
        }
    });
}

/// Focuses the heading of a new page; not for somebody who was quicker and is on that page already.
pub fn focus_heading() {
    spawn_local(async move {
        next_frame().await;
        let active = document().active_element();
        let is_inside = active.and_then(|active| active.closest("main").ok().flatten()).is_some();
        if !is_inside {
            window().scroll_to_with_x_and_y(0.0, 0.0);
            focus(&["main h1"]);
        }
    });
}

/// Scrolls, once the page stands, as little as brings what the selector finds into view.
pub fn bring_into_view(selector: &'static str) {
    spawn_local(async move {
        painted().await;
        if let Some(element) = document().query_selector(selector).ok().flatten() {
            let options = ScrollIntoViewOptions::new();
            options.set_block(ScrollLogicalPosition::Nearest);
            element.scroll_into_view_with_scroll_into_view_options(&options);
        }
    });
}
