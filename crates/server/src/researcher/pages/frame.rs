//! What every researcher's page stands in: head, navigation, forms, messages. Nothing is inline.

use axum::http::header;
use axum::response::{Html, IntoResponse, Response};
use maud::{DOCTYPE, Markup, html};
use mimique_locale::Language;
use mimique_storage::Role;
use mimique_study::iso_time;

use crate::accounts::csrf::FormToken;
use crate::accounts::identity::Researcher;
use crate::state::App;

/// A page of one who is logged in.
pub(crate) struct Frame {
    pub assets: String,
    pub language: Language,
    /// What the reader may do with what the page is about: a study, or the server.
    pub role: Role,
    /// What the reader may do with the server.
    in_all: Role,
    pub email: String,
    pub csrf: String,
}

impl Frame {
    pub fn new(app: &App, who: &Researcher) -> Self {
        Self {
            assets: app.assets.prefix(),
            language: who.language,
            role: who.role,
            in_all: who.role,
            email: who.account.email.clone(),
            csrf: FormToken::of(app, who).value,
        }
    }

    /// A page about a study.
    pub fn in_study(app: &App, who: &Researcher, study: &str) -> Self {
        Self { role: who.role_in(study), ..Self::new(app, who) }
    }

    /// The text in the reader's language.
    pub fn say<T>(&self, english: T, french: T) -> T {
        self.language.pick(english, french)
    }

    /// Whether the reader may do what this role may.
    pub fn may(&self, role: Role) -> bool {
        self.role >= role
    }

    /// The field that makes a form the page's own.
    pub fn token(&self) -> Markup {
        html! { input type="hidden" name="csrf" value=(self.csrf); }
    }

    /// The whole page. `address` is the page's own, for the change of language.
    pub fn page(&self, title: &str, address: &str, body: &Markup) -> Response {
        self.page_with(title, address, &html! {}, body)
    }

    /// The same with more in its head: scripts and styles of its own.
    pub fn page_with(&self, title: &str, address: &str, head: &Markup, body: &Markup) -> Response {
        let nav = html! {
            a href="/researcher" { (self.say("Studies", "Études")) }
            @if self.in_all >= Role::Owner {
                a href="/researcher/people" { (self.say("People", "Personnes")) }
                a href="/researcher/log" { (self.say("Log", "Journal")) }
            }
            a href="/researcher/account" { (self.email) }
            form method="post" action="/researcher/logout" {
                (self.token())
                button.quiet type="submit" { (self.say("Log out", "Se déconnecter")) }
            }
        };
        let parts = Parts { head, nav: &nav, body };
        answer(document(&self.assets, self.language, title, address, &parts))
    }
}

/// A page of one who is not logged in.
pub(crate) fn open_page(
    assets: &str,
    language: Language,
    title: &str,
    address: &str,
    body: &Markup,
) -> Response {
    let parts = Parts { head: &html! {}, nav: &html! {}, body };
    answer(document(assets, language, title, address, &parts))
}

/// HTML whose forms tell where they come from: without that no form could be told from a forged one.
fn answer(page: Markup) -> Response {
    ([(header::REFERRER_POLICY, "same-origin")], Html(page.into_string())).into_response()
}

/// What differs from page to page.
struct Parts<'p> {
    head: &'p Markup,
    nav: &'p Markup,
    body: &'p Markup,
}

fn document(
    assets: &str,
    language: Language,
    title: &str,
    address: &str,
    Parts { head, nav, body }: &Parts<'_>,
) -> Markup {
    let (other, name) = language.pick(("fr", "Français"), ("en", "English"));
    html! {
        (DOCTYPE)
        html lang=(language.code()) {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="robots" content="noindex";
                meta name="color-scheme" content="light dark";
                title { (title) " · Mimique" }
                link rel="icon" href={ (assets) "/style/icon.svg" } type="image/svg+xml";
                link rel="stylesheet" href={ (assets) "/style/style.css" };
                link rel="stylesheet" href={ (assets) "/researcher/researcher.css" };
                script type="module" src={ (assets) "/researcher/researcher.js" } {}
                (head)
            }
            body {
                a.skip-link href="#main" { (language.pick("To the content", "Au contenu")) }
                header.site-header.wide {
                    span.title { "Mimique" }
                    nav.site-nav aria-label=(language.pick("Pages", "Pages")) {
                        (nav)
                        a lang=(other) hreflang=(other)
                            href={ "/researcher/language/" (other) "?next=" (escaped(address)) } {
                            (name)
                        }
                    }
                }
                main.page.wide #main { (body) }
            }
        }
    }
}

/// A labelled field of a form.
pub(crate) fn field(label: &str, name: &str, kind: &str, complete: &str, hint: &str) -> Markup {
    html! {
        div.field {
            label for=(name) { (label) }
            @if !hint.is_empty() { p.hint id={ (name) "-hint" } { (hint) } }
            @if hint.is_empty() {
                input id=(name) name=(name) type=(kind) autocomplete=(complete) required;
            } @else {
                input id=(name) name=(name) type=(kind) autocomplete=(complete) required
                    aria-describedby={ (name) "-hint" };
            }
        }
    }
}

/// The word for a role.
pub(crate) fn role_word(language: Language, role: Role) -> &'static str {
    match role {
        Role::Nothing => language.pick("single studies", "certaines études"),
        Role::Viewer => language.pick("viewer", "lecture"),
        Role::Analyst => language.pick("analyst", "analyse"),
        Role::Owner => language.pick("owner", "responsable"),
    }
}

/// What a role may do, in a line.
pub(crate) fn role_line(language: Language, role: Role) -> &'static str {
    match role {
        Role::Nothing => language
            .pick("has roles in single studies alone", "n’a de rôle que dans certaines études"),
        Role::Viewer => language.pick(
            "sees the dashboard, without free text and without export",
            "voit le tableau de bord, sans les textes libres et sans l’export",
        ),
        Role::Analyst => language.pick(
            "reads every answer, exports, excludes participants",
            "lit toutes les réponses, exporte, exclut des participants",
        ),
        Role::Owner => language
            .pick("accounts, studies, deletion, the log", "comptes, études, suppression, journal"),
    }
}

/// `2026-11-21 08:30` in a `time` element that scripts turn into the reader's own time.
pub(crate) fn time(at_ms: Option<i64>) -> Markup {
    let Some(at_ms) = at_ms else { return html! {} };
    let text = iso_time(at_ms as f64);
    let short = text.get(..16).map(|text| text.replace('T', " ")).unwrap_or_default();
    html! { time datetime=(text) { (short) " UTC" } }
}

/// The day of a time; the page's script writes it as the reader does.
pub(crate) fn day(at_ms: i64) -> Markup {
    let text = iso_time(at_ms as f64);
    html! { time datetime=(text) data-day="" { (text.get(..10).unwrap_or_default()) } }
}

/// A text as part of an address's query.
pub(crate) fn escaped(text: &str) -> String {
    mimique_study::percent_encoded(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_in_the_page_for_people_and_for_scripts() {
        let markup = time(Some(1_795_251_845_678)).into_string();
        let expected = "<time datetime=\"2026-11-21T09:04:05.678Z\">2026-11-21 09:04 UTC</time>";
        assert_eq!(markup, expected);
    }
}
