//! The agreement.

use leptos::prelude::*;
use mimique_study::flow::{Input, View};

use crate::focus;
use crate::session::Session;

/// The agreement, with the choice of language.
#[component]
pub fn ConsentPage() -> impl IntoView {
    let session = Session::here();
    let View::Consent { step, title, description, sections, contacts, languages, agree, decline } =
        session.view.get_untracked()
    else {
        return ().into_any();
    };
    let words = untrack(|| session.words());
    let current = untrack(|| session.language());
    let several = !languages.is_empty();
    view! {
        <main class="page" data-view="consent" data-step=step>
            <div class="card">
                <Show when=move || several>
                    <nav class="row end languages" aria-label=words.choose_language>
                        {languages.clone().into_iter().map(|(code, name)| {
                            let chosen = code == current;
                            let wanted = code.clone();
                            view! {
                                <button type="button" class="quiet" lang=code
                                    aria-pressed=if chosen { "true" } else { "false" }
                                    on:click=move |_| {
                                        session.send(Input::ChooseLanguage(wanted.clone()));
                                        focus::later(&[".languages [aria-pressed=true]"]);
                                    }>
                                    {name}
                                </button>
                            }
                        }).collect_view()}
                    </nav>
                </Show>
                <h1 tabindex="-1">{title}</h1>
                <p>{description}</p>
                {sections.into_iter().map(|section| view! {
                    <section>
                        <h2>{section.heading}</h2>
                        {section.text.into_iter().map(|text| view! { <p>{text}</p> }).collect_view()}
                    </section>
                }).collect_view()}
                <section>
                    <h2>{words.contact}</h2>
                    {contacts.into_iter().map(|contact| view! {
                        <p>
                            <strong>{contact.role}</strong>
                            <br/>
                            {contact.name}", "
                            <a href=format!("mailto:{}", contact.email)>{contact.email.clone()}</a>
                            {contact.reference.map(|reference| format!(" ({reference})"))}
                        </p>
                    }).collect_view()}
                </section>
                <div class="actions">
                    <button type="button" class="primary" data-action="agree"
                        on:click=move |_| session.send(Input::Consent)>{agree}</button>
                    <button type="button" data-action="decline"
                        on:click=move |_| session.send(Input::Decline)>{decline}</button>
                </div>
            </div>
        </main>
    }
    .into_any()
}
