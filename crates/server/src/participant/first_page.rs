//! The first page as HTML: title and agreement stand there to be read while the page's module and what it
//! needs are still on their way. The module then draws the same page with its buttons in its place.

use maud::{Markup, html};
use mimique_session::flow::{AgreementView, SectionView};
use mimique_study::{Multilingual as _, Study};

/// Title and agreement of a study in one of its languages.
pub fn first_page(study: &Study, language: &str) -> Markup {
    let agreement = AgreementView::new(&study.projection(), language, &study.words(language));
    html! {
        header.site-header.narrow { span.title { (agreement.title) } }
        div.site-notices {}
        main.page data-view="opening" {
            div.card {
                @if study.languages.len() > 1 { (languages(study, language)) }
                h1 { (agreement.title) }
                p { (agreement.description) }
                @for SectionView { heading, text } in &agreement.sections {
                    section { h2 { (heading) } @for paragraph in text { p { (paragraph) } } }
                }
                section {
                    h2 { (agreement.contact) }
                    @for contact in &agreement.contacts {
                        p {
                            strong { (contact.role) } br; (contact.name) ", "
                            a href={ "mailto:" (contact.email) } { (contact.email) }
                            @if let Some(reference) = &contact.reference { " (" (reference) ")" }
                        }
                    }
                }
                div.actions { p.soft role="status" { "…" } }
            }
        }
    }
}

/// Where the choice of language will stand, so that nothing moves when it does.
fn languages(study: &Study, language: &str) -> Markup {
    html! {
        nav.row.end.languages aria-hidden="true" {
            @for code in &study.languages {
                button.quiet type="button" disabled lang=(code)
                    aria-pressed=(if code == language { "true" } else { "false" }) {
                    (study.words(code).language_name())
                }
            }
        }
    }
}
