//! The last page: everything has arrived, and only now the code.

use leptos::prelude::*;
use mimique_study::flow::View;

use super::message::AnotherPerson;
use crate::session::Session;
use crate::{bridge, site};

/// Thanks, completion code, receipt, withdrawal code.
#[component]
pub fn EndPage() -> impl IntoView {
    let View::End(end) = Session::here().view.get_untracked() else {
        return ().into_any();
    };
    let end = *end;
    let words = untrack(|| Session::here().words());
    let (text, file) = match site::ending() {
        None => (end.text, None),
        // Without a server nothing has arrived unless it was posted.
        Some((posted, offered, email)) => {
            let text = match end.outcome {
                "completed" if !posted => vec![words.kept_here(&email)],
                _ => end.text,
            };
            (text, offered.then_some(words.download))
        }
    };
    let give = move |_| {
        if let Some((name, text, _)) = site::file() {
            bridge::download(&name, &text);
        }
    };
    view! {
        <main class="page" data-view="end" data-outcome=end.outcome>
            <div class="card">
                <h1 tabindex="-1">{end.heading}</h1>
                {text.into_iter().map(|text| view! { <p>{text}</p> }).collect_view()}
                {file.map(|label| view! {
                    <div class="actions">
                        <button type="button" class="primary" data-action="download" on:click=give>{label}</button>
                    </div>
                })}
                {end.completion_code.map(|(label, code)| view! {
                    <h2>{label}</h2>
                    <p><span class="code-block" data-code="completion">{code}</span></p>
                })}
                {end.redirect.map(|(label, address)| view! {
                    <p><a class="button primary" href=address>{label}</a></p>
                })}
                <h2>{end.receipt.0}</h2>
                <p><span class="code-block small" data-code="receipt">{end.receipt.1}</span></p>
                <h2>{end.withdrawal_code.0}</h2>
                <p><span class="code-block" data-code="withdrawal">{end.withdrawal_code.1}</span></p>
                <p class="soft">{end.withdrawal_code.2}</p>
                <AnotherPerson/>
            </div>
        </main>
    }
    .into_any()
}
