//! The page cannot begin, and why.

use leptos::prelude::*;
use mimique_study::text::words;
use mimique_study::wire::Refusal;

/// What keeps the page from beginning.
#[derive(Debug, Clone, PartialEq)]
pub enum Trouble {
    /// The address names no study.
    NoStudy,
    /// The server cannot be reached.
    Unreachable(String),
    /// The server refuses.
    Refused(Refusal),
    /// The study cannot be read by this page.
    Unreadable(String),
    /// The session is open in another tab; the language of the study.
    OtherTab(String),
}

/// What is wrong, and a button to try again.
#[component]
pub fn TroublePage(trouble: Trouble, retry: impl Fn() + 'static) -> impl IntoView {
    let language = document()
        .document_element()
        .and_then(|root| root.get_attribute("lang"))
        .unwrap_or_default();
    let words = words(match &trouble {
        Trouble::OtherTab(language) => language,
        _ => &language,
    });
    let (heading, detail) = match trouble {
        Trouble::NoStudy => (words.no_study, String::new()),
        Trouble::Unreachable(reason) => (words.unreachable, reason),
        Trouble::Refused(refusal) => (words.cannot_begin, words.refused(&refusal)),
        Trouble::Unreadable(reason) => (words.cannot_run, reason),
        Trouble::OtherTab(_) => (words.other_tab, words.other_tab_text.to_owned()),
    };
    view! {
        <main class="page" data-view="failure">
            <div class="card">
                <h1 tabindex="-1">{heading}</h1>
                <p>{detail}</p>
                <div class="actions">
                    <button type="button" class="primary" on:click=move |_| retry()>{words.retry}</button>
                </div>
            </div>
        </main>
    }
}
