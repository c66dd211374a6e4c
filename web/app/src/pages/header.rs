//! Title, state of the connection, and the way out.

use leptos::html::Dialog;
use leptos::prelude::*;
use mimique_study::flow::{Input, View};

use crate::session::Session;

/// The header of every page.
#[component]
pub fn Header() -> impl IntoView {
    let session = Session::here();
    let title = move || {
        let engine = session.engine();
        let title = &engine.plan.study.study_metadata.title;
        title.in_language(&session.language()).to_string()
    };
    // Before the agreement there is nothing to withdraw, and at the end the code serves.
    let can_withdraw = Memo::new(move |_| {
        session.view.with(|view| {
            matches!(
                view,
                View::Questions { .. }
                    | View::Page { .. }
                    | View::Device(_)
                    | View::Calibration(_)
                    | View::Feedback(_)
                    | View::Trial(_)
                    | View::ReceiptPending { .. }
            )
        })
    });
    let dialog = NodeRef::<Dialog>::new();
    let open = move |_| {
        if let Some(dialog) = dialog.get() {
            // It fails only if it is open already.
            let _ = dialog.show_modal();
        }
    };
    let close = move || {
        if let Some(dialog) = dialog.get() {
            dialog.close();
        }
    };
    let connection = session.connection;
    let state = session.engine().state;
    let timed_out = Memo::new(move |_| state.with(|state| state.live.timed_out));
    view! {
        <header class="site-header narrow">
            <span class="title">{title}</span>
            <Show when=move || can_withdraw.get()>
                <button type="button" class="quiet" data-action="withdraw" on:click=open>
                    {move || session.words().withdraw}
                </button>
            </Show>
        </header>
        <div class="site-notices" role="status">
            <Show when=move || timed_out.get()>
                <p class="notice">{move || session.words().time_over()}</p>
            </Show>
            <Show when=move || connection.with(|connection| connection.offline)>
                <p class="notice warn">{move || session.words().offline}</p>
            </Show>
            <Show when=move || connection.with(|connection| connection.fleeting)>
                <p class="notice warn">{move || session.words().not_kept}</p>
            </Show>
            {move || connection.with(|connection| connection.refused.clone()).map(|refusal| view! {
                <p class="notice bad">{session.words().refused(&refusal)}</p>
            })}
        </div>
        <dialog node_ref=dialog class="card" aria-labelledby="withdraw-question">
            <p id="withdraw-question">{move || session.words().withdraw_question}</p>
            <div class="actions">
                <button type="button" on:click=move |_| close()>
                    {move || session.words().withdraw_no}
                </button>
                <button type="button" class="danger" data-action="withdraw-confirm"
                    on:click=move |_| { close(); session.send(Input::Withdraw); }>
                    {move || session.words().withdraw_yes}
                </button>
            </div>
        </dialog>
    }
}
