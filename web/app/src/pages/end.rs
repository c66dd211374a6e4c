//! The last page: everything has arrived, and only now the code.

use leptos::prelude::*;
use mimique_study::flow::View;

use super::message::AnotherPerson;
use crate::session::Session;

/// Thanks, completion code, receipt, withdrawal code.
#[component]
pub fn EndPage() -> impl IntoView {
    let View::End(end) = Session::here().view.get_untracked() else {
        return ().into_any();
    };
    let end = *end;
    view! {
        <main class="page" data-view="end">
            <div class="card">
                <h1 tabindex="-1">{end.heading}</h1>
                <p>{end.text}</p>
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
