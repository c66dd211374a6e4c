//! Pages of those who are not logged in: log in, use a link, what was refused.

use axum::response::Response;
use maud::{Markup, html};
use mimique_study::wire::Refusal;

use super::frame::{escaped, field, open_page, role_line, role_word};
use super::refusals::in_french;
use crate::accounts::{SHORTEST_PASSWORD, Tongue};
use crate::storage::{AccountLink, LinkPurpose};

/// The form to log in with; `problem` is what was wrong with the last attempt.
pub(crate) fn login_page(
    assets: &str,
    tongue: Tongue,
    csrf: &str,
    next: &str,
    problem: Option<&str>,
) -> Response {
    let title = tongue.pick("Log in", "Se connecter");
    let body = html! {
        div.card.narrow {
            h1 { (title) }
            (problem_line(problem))
            form.stack method="post" action="/researcher/login" {
                input type="hidden" name="csrf" value=(csrf);
                input type="hidden" name="next" value=(next);
                (field(tongue.pick("E-mail", "Courriel"), "email", "email", "username", ""))
                (field(tongue.pick("Password", "Mot de passe"), "password", "password", "current-password", ""))
                div.actions { button.primary type="submit" { (title) } }
            }
            p.soft {
                (tongue.pick(
                    "No account, or a forgotten password? An owner of this server can give you a link.",
                    "Pas de compte, ou mot de passe oublié ? Une personne responsable de ce serveur peut vous donner un lien.",
                ))
            }
        }
    };
    let address = format!("/researcher/login?next={}", escaped(next));
    open_page(assets, tongue, title, &address, &body)
}

/// The form behind a one-time link.
pub(crate) fn link_page(
    assets: &str,
    tongue: Tongue,
    csrf: &str,
    secret: &str,
    link: &AccountLink,
    problem: Option<&str>,
) -> Response {
    let title = match link.purpose {
        LinkPurpose::FirstOwner => tongue.pick("Make the first account", "Créer le premier compte"),
        LinkPurpose::Invitation => tongue.pick("Make your account", "Créer votre compte"),
        LinkPurpose::Reset => {
            tongue.pick("Choose a new password", "Choisir un nouveau mot de passe")
        }
    };
    let hint = format!(
        "{} {SHORTEST_PASSWORD} {}",
        tongue.pick("At least", "Au moins"),
        tongue.pick("characters; four words are good.", "caractères ; quatre mots conviennent."),
    );
    let body = html! {
        div.card.narrow {
            h1 { (title) }
            @if link.purpose != LinkPurpose::Reset {
                p {
                    (tongue.pick("Role: ", "Rôle : ")) strong { (role_word(tongue, link.role)) } ", "
                    (role_line(tongue, link.role)) "."
                }
            }
            (problem_line(problem))
            form.stack method="post" action={ "/researcher/link/" (secret) } {
                input type="hidden" name="csrf" value=(csrf);
                @if link.email.is_empty() {
                    (field(tongue.pick("E-mail", "Courriel"), "email", "email", "username", ""))
                } @else {
                    p { (tongue.pick("E-mail: ", "Courriel : ")) strong { (link.email) } }
                    input type="hidden" name="email" value=(link.email);
                }
                (field(tongue.pick("Password", "Mot de passe"), "password", "password", "new-password", &hint))
                div.actions { button.primary type="submit" { (title) } }
            }
        }
    };
    open_page(assets, tongue, title, &format!("/researcher/link/{secret}"), &body)
}

/// What was refused, for people.
pub(crate) fn refusal_page(assets: &str, tongue: Tongue, refusal: &Refusal) -> Response {
    let title = tongue.pick("This cannot be done", "Impossible");
    let body = html! {
        div.card.narrow {
            h1 { (title) }
            p { (in_french(tongue, refusal)) }
            p { a href="/researcher" { (tongue.pick("To the studies", "Vers les études")) } }
        }
    };
    open_page(assets, tongue, title, "/researcher", &body)
}

fn problem_line(problem: Option<&str>) -> Markup {
    html! {
        @if let Some(problem) = problem {
            div.notice.bad role="alert" { p { (problem) } }
        }
    }
}
