//! A page to read: instructions, a break, the debriefing.

use leptos::prelude::*;
use mimique_study::flow::{Input, View};

use super::ProgressLine;
use super::clock::Clock;
use crate::session::Session;

/// A page to read.
#[component]
pub fn ReadPage() -> impl IntoView {
    let session = Session::here();
    let View::Page { step, heading, text, progress, .. } = session.view.get_untracked() else {
        return ().into_any();
    };
    let button = Memo::new(move |_| {
        session.view.with(|view| match view {
            View::Page { button, .. } => Some(button.clone()),
            _ => None,
        })
    });
    let hint = move || button.get().and_then(|button| button.hint);
    let clock = Memo::new(move |_| {
        session.view.with(|view| match view {
            View::Page { clock, .. } => clock.clone(),
            _ => None,
        })
    });
    view! {
        <main class="page" data-view="page" data-step=step>
            <ProgressLine done=progress.done total=progress.total/>
            <Clock clock/>
            <div class="card">
                <h1 tabindex="-1">{heading}</h1>
                {text.into_iter().map(|text| view! { <p>{text}</p> }).collect_view()}
                <p class="soft" role="status">{hint}</p>
                <div class="actions">
                    <button type="button" class="primary" data-action="next"
                        aria-disabled=move || button.get().is_some_and(|b| !b.can_submit).then_some("true")
                        on:click=move |_| session.send(Input::Next)>
                        {move || button.get().map(|button| button.label)}
                    </button>
                </div>
            </div>
        </main>
    }
    .into_any()
}
