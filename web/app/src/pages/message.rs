//! Pages that only tell something.

use leptos::prelude::*;
use mimique_study::RepeatPrevention;
use mimique_study::flow::View;

use crate::memory::Identity;
use crate::session::Session;

/// The last answers are on their way.
#[component]
pub fn ReceiptPendingPage() -> impl IntoView {
    let session = Session::here();
    let parts = Memo::new(move |_| {
        session.view.with(|view| match view {
            View::ReceiptPending { heading, text, stored, total } => {
                (heading.clone(), text.clone(), *stored, *total)
            }
            _ => Default::default(),
        })
    });
    view! {
        <main class="page" data-view="receipt">
            <div class="card" aria-live="polite">
                <h1 tabindex="-1">{move || parts.get().0}</h1>
                <p>{move || parts.get().1}</p>
                <progress max=move || parts.get().3.to_string() value=move || parts.get().2.to_string()
                    aria-label=move || parts.get().0></progress>
            </div>
        </main>
    }
}

/// The participant did not agree.
#[component]
pub fn DeclinedPage() -> impl IntoView {
    let session = Session::here();
    let View::Declined { heading, text } = session.view.get_untracked() else {
        return ().into_any();
    };
    view! {
        <main class="page" data-view="declined">
            <div class="card">
                <h1 tabindex="-1">{heading}</h1>
                <p>{text}</p>
                <AnotherPerson/>
            </div>
        </main>
    }
    .into_any()
}

/// Where the study lets one browser take part again: a session of its own for the next person.
#[component]
pub fn AnotherPerson() -> impl IntoView {
    let session = Session::here();
    let engine = session.engine();
    let recruitment = &engine.plan.study.recruitment;
    // Whoever was sent here by a recruiting site goes back there.
    let offered =
        recruitment.repeat_prevention == RepeatPrevention::None && recruitment.redirect.is_none();
    let label = untrack(|| session.words().another_person);
    let again = move |_| {
        Identity::forget(&session.engine().plan.study.id);
        // Where the browser does not reload, the person does.
        let _ = window().location().reload();
    };
    offered.then(|| {
        view! {
            <div class="actions">
                <button type="button" data-action="another-person" on:click=again>{label}</button>
            </div>
        }
    })
}

/// The participant took everything back.
#[component]
pub fn WithdrawnPage() -> impl IntoView {
    let session = Session::here();
    let parts = Memo::new(move |_| {
        session.view.with(|view| match view {
            View::Withdrawn { heading, text, confirmed } => {
                (heading.clone(), text.clone(), *confirmed)
            }
            _ => Default::default(),
        })
    });
    view! {
        <main class="page" data-view="withdrawn" data-confirmed=move || parts.get().2.to_string()>
            <div class="card" aria-live="polite">
                <h1 tabindex="-1">{move || parts.get().0}</h1>
                <p>{move || parts.get().1}</p>
            </div>
        </main>
    }
}
