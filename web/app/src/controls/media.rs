//! Pictures and signed videos: fetched by their hash like every stimulus, shown when they are there.

use leptos::prelude::*;
use mimique_study::MEDIA_PREFIX;
use wasm_bindgen_futures::spawn_local;

use crate::bridge;
use crate::session::Session;

/// The address of a file that the study names, once it has been fetched.
fn address(path: String) -> ReadSignal<Option<String>> {
    let (address, set_address) = signal(None);
    let source = Session::here().engine().source(&format!("{MEDIA_PREFIX}{path}"));
    spawn_local(async move {
        let text = |key: &str| {
            let value = source.as_ref().and_then(|source| source.get(key));
            value.and_then(|value| value.as_str()).unwrap_or_default().to_owned()
        };
        let fetched = bridge::media_address(&text("avatar"), &text("film")).await;
        if let Some(found) = fetched.ok().and_then(|found| found.as_string()) {
            // The page may have gone on meanwhile.
            let _ = set_address.try_set(Some(found));
        }
    });
    address
}

/// A signed video, with the browser's own controls; it has no sound that matters.
#[component]
pub fn SignedVideo(
    /// Its path in the study file.
    path: String,
    /// What it says.
    label: String,
    /// Of the prompt, or of an option.
    class: &'static str,
) -> impl IntoView {
    let address = address(path);
    view! {
        <video class=class src=move || address.get() aria-label=label controls playsinline
            preload="metadata"></video>
    }
}

/// A picture beside its words.
#[component]
pub fn Picture(
    /// Its path in the study file.
    path: String,
) -> impl IntoView {
    let address = address(path);
    view! { <img src=move || address.get() alt=""/> }
}
