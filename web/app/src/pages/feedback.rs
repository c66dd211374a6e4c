//! After a practice clip: which answers were right.

use leptos::prelude::*;
use mimique_study::flow::{Input, View};

use super::ProgressLine;
use crate::session::Session;

/// Which answers were right.
#[component]
pub fn FeedbackPage() -> impl IntoView {
    let session = Session::here();
    let View::Feedback(feedback) = session.view.get_untracked() else {
        return ().into_any();
    };
    let feedback = *feedback;
    let progress = feedback.progress;
    view! {
        <main class="page" data-view="feedback" data-step=feedback.step data-correct=feedback.correct.to_string()>
            <ProgressLine done=progress.done total=progress.total/>
            <div class="card">
                <h1 tabindex="-1">{feedback.heading}</h1>
                {feedback.items.into_iter().map(|item| {
                    let wrong = item.right.is_some();
                    view! {
                        <div class="notice" class:good=!wrong class:warn=wrong>
                            <p><strong>{item.prompt}</strong></p>
                            <p>{if wrong { "✗ " } else { "✓ " }}{item.given}</p>
                            {item.right.map(|right| view! { <p>{right}</p> })}
                        </div>
                    }
                }).collect_view()}
                {feedback.text.map(|text| view! { <p>{text}</p> })}
                <div class="actions">
                    <button type="button" class="primary" data-action="next"
                        on:click=move |_| session.send(Input::Next)>{feedback.button.label}</button>
                </div>
            </div>
        </main>
    }
    .into_any()
}
