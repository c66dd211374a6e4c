//! Pages of those who are not logged in: log in, use a link, what was refused.

use axum::response::Response;
use maud::{Markup, html};
use mimique_locale::Language;
use mimique_storage::{AccountLink, LinkPurpose};

use super::frame::{escaped, field, open_page, role_line, role_word};
use crate::accounts::password::SHORTEST_PASSWORD;
use crate::error::Error;

/// The form to log in with; `problem` is what was wrong with the last attempt.
pub(crate) fn login_page(
    assets: &str,
    language: Language,
    csrf: &str,
    next: &str,
    problem: Option<&str>,
) -> Response {
    let title = language.pick("Log in", "Se connecter");
    let body = html! {
        div.card.narrow {
            h1 { (title) }
            (problem_line(problem))
            form.stack method="post" action="/researcher/login" {
                input type="hidden" name="csrf" value=(csrf);
                input type="hidden" name="next" value=(next);
                (field(language.pick("E-mail", "Courriel"), "email", "email", "username", ""))
                (field(language.pick("Password", "Mot de passe"), "password", "password", "current-password", ""))
                div.actions { button.primary type="submit" { (title) } }
            }
            p.soft {
                (language.pick(
                    "No account, or a forgotten password? An owner of this server can give you a link.",
                    "Pas de compte, ou mot de passe oublié ? Une personne responsable de ce serveur peut vous donner un lien.",
                ))
            }
        }
    };
    let address = format!("/researcher/login?next={}", escaped(next));
    open_page(assets, language, title, &address, &body)
}

/// The form behind a one-time link.
pub(crate) fn link_page(
    assets: &str,
    language: Language,
    csrf: &str,
    secret: &str,
    link: &AccountLink,
    problem: Option<&str>,
) -> Response {
    let title = match link.purpose {
        LinkPurpose::FirstOwner => {
            language.pick("Make the first account", "Créer le premier compte")
        }
        LinkPurpose::Invitation => language.pick("Make your account", "Créer votre compte"),
        LinkPurpose::Reset | LinkPurpose::Recovery => {
            language.pick("Choose a new password", "Choisir un nouveau mot de passe")
        }
    };
    let hint = format!(
        "{} {SHORTEST_PASSWORD} {}",
        language.pick("At least", "Au moins"),
        language.pick("characters; four words are good.", "caractères ; quatre mots conviennent."),
    );
    let body = html! {
        div.card.narrow {
            h1 { (title) }
            @if !matches!(link.purpose, LinkPurpose::Reset | LinkPurpose::Recovery) {
                p {
                    (language.pick("Role: ", "Rôle : ")) strong { (role_word(language, link.role)) } ", "
                    (role_line(language, link.role)) "."
                    @if let Some(study) = &link.study_id {
                        " " (language.pick("In the study ", "Dans l’étude ")) code { (study) } "."
                    }
                }
            }
            (problem_line(problem))
            form.stack method="post" action={ "/researcher/link/" (secret) } {
                input type="hidden" name="csrf" value=(csrf);
                @if link.email.is_empty() {
                    (field(language.pick("E-mail", "Courriel"), "email", "email", "username", ""))
                } @else {
                    p { (language.pick("E-mail: ", "Courriel : ")) strong { (link.email) } }
                    input type="hidden" name="email" value=(link.email);
                }
                (field(language.pick("Password", "Mot de passe"), "password", "password", "new-password", &hint))
                div.actions { button.primary type="submit" { (title) } }
            }
        }
    };
    open_page(assets, language, title, &format!("/researcher/link/{secret}"), &body)
}

/// What was refused, for people.
pub(crate) fn refusal_page(assets: &str, language: Language, error: &Error) -> Response {
    let title = language.pick("This cannot be done", "Impossible");
    let body = html! {
        div.card.narrow {
            h1 { (title) }
            p { (error.sentence(language)) }
            p { a href="/researcher" { (language.pick("To the studies", "Vers les études")) } }
        }
    };
    open_page(assets, language, title, "/researcher", &body)
}

fn problem_line(problem: Option<&str>) -> Markup {
    html! {
        @if let Some(problem) = problem {
            div.notice.bad role="alert" { p { (problem) } }
        }
    }
}
