//! A page of questions, and the list of questions that a trial has too.

use leptos::prelude::*;
use mimique_study::flow::{Input, QuestionView, View};

use super::ProgressLine;
use super::clock::Clock;
use crate::controls::QuestionField;
use crate::focus;
use crate::session::Session;

/// A page of questions.
#[component]
pub fn QuestionsPage() -> impl IntoView {
    let session = Session::here();
    let View::Questions { step, title, text, progress, .. } = session.view.get_untracked() else {
        return ().into_any();
    };
    let of_step = step.clone();
    let questions = Memo::new(move |_| {
        session.view.with(|view| match view {
            View::Questions { questions, .. } => questions.clone(),
            _ => Vec::new(),
        })
    });
    let label = move || {
        session.view.with(|view| match view {
            View::Questions { button, .. } => button.label.clone(),
            _ => String::new(),
        })
    };
    let clock = Memo::new(move |_| {
        session.view.with(|view| match view {
            View::Questions { clock, .. } => clock.clone(),
            _ => None,
        })
    });
    view! {
        <main class="page" data-view="questions" data-step=step>
            <ProgressLine done=progress.done total=progress.total/>
            <Clock clock/>
            <form class="card" novalidate
                on:submit=move |event| {
                    event.prevent_default();
                    session.send(Input::Next);
                    focus::problem();
                }>
                <h1 tabindex="-1">{title}</h1>
                {text.into_iter().map(|text| view! { <p>{text}</p> }).collect_view()}
                <QuestionList step=of_step questions/>
                <div class="actions">
                    <button type="submit" class="primary" data-action="next">{label}</button>
                </div>
            </form>
        </main>
    }
    .into_any()
}

/// Questions one below the other; each is built once and then changes in place.
#[component]
pub fn QuestionList(
    /// Distinguishes the fields of one page from those of the next.
    #[prop(into)]
    step: Signal<String>,
    /// What is asked now.
    questions: Memo<Vec<QuestionView>>,
) -> impl IntoView {
    let keys = move || {
        let step = step.get();
        let ids = questions.with(|all| all.iter().map(|q| q.id.clone()).collect::<Vec<_>>());
        ids.into_iter().map(|id| (step.clone(), id)).collect::<Vec<_>>()
    };
    view! {
        <For each=keys key=|key| key.clone() let((step, id))>
            {
                let now = {
                    let id = id.clone();
                    Memo::new(move |_| questions.with(|all| all.iter().find(|q| q.id == id).cloned()))
                };
                now.get_untracked().map(|first| view! {
                    <QuestionField name=format!("{step}/{id}") first now/>
                })
            }
        </For>
    }
}
