//! Pages of accounts: one's own, everybody's, and the log.

use axum::response::Response;
use maud::{Markup, html};
use mimique_storage::{Account, ApiToken, AuditEntry, Role, StudyRole};

use super::frame::{Frame, field, role_line, role_word, time};
use super::study_roles::{own_roles, study_choice, study_roles};
use crate::accounts::identity::Researcher;
use crate::accounts::password::SHORTEST_PASSWORD;

/// What was just done, to be said on the page.
pub(crate) enum Done {
    /// A link to hand over; shown once.
    Link { whom: String, address: String },
    /// A token; shown once.
    Token(String),
    /// A new password.
    Password,
}

/// Everybody who has an account, and the studies that they may have roles in.
pub(crate) struct Everybody<'a> {
    pub accounts: &'a [Account],
    pub roles: &'a [StudyRole],
    pub studies: &'a [String],
}

/// One's own account: password, sessions, tokens.
pub(crate) fn account_page(
    frame: &Frame,
    who: &Researcher,
    tokens: &[&ApiToken],
    done: Option<&Done>,
) -> Response {
    let title = frame.say("Your account", "Votre compte");
    let hint = format!(
        "{} {SHORTEST_PASSWORD} {}",
        frame.say("At least", "Au moins"),
        frame.say("characters.", "caractères."),
    );
    let body = html! {
        h1 { (title) }
        (done_line(frame, done))
        div.card {
            p {
                strong { (frame.email) } ", " (role_word(frame.language, frame.role)) ": "
                (role_line(frame.language, frame.role)) "."
            }
            (own_roles(frame, who))
            form method="post" action="/researcher/logout-everywhere" {
                (frame.token())
                button type="submit" { (frame.say("Log out everywhere", "Se déconnecter partout")) }
            }
        }
        div.card {
            h2 { (frame.say("Password", "Mot de passe")) }
            form.stack method="post" action="/researcher/account/password" {
                (frame.token())
                (field(frame.say("Old password", "Ancien mot de passe"), "old", "password", "current-password", ""))
                (field(frame.say("New password", "Nouveau mot de passe"), "new", "password", "new-password", &hint))
                div.actions {
                    button type="submit" { (frame.say("Change the password", "Changer le mot de passe")) }
                }
            }
            p.soft {
                (frame.say(
                    "Every other browser is logged out by it, and every token below is ended: make new ones for your scripts.",
                    "Tous les autres navigateurs sont alors déconnectés et tous les jetons ci-dessous révoqués : créez-en d’autres pour vos scripts.",
                ))
            }
        }
        div.card {
            h2 { (frame.say("Tokens for scripts", "Jetons pour les scripts")) }
            p.soft {
                (frame.say("A script exports with ", "Un script exporte avec "))
                code { "Authorization: Bearer …" }
                (frame.say(". A token is shown once.", ". Un jeton n’est montré qu’une fois."))
            }
            (token_table(frame, tokens))
            form.stack method="post" action="/researcher/tokens" {
                (frame.token())
                (field(frame.say("Name", "Nom"), "name", "text", "off", ""))
                (roles(frame, "role", who.most()))
                div.actions { button type="submit" { (frame.say("Make a token", "Créer un jeton")) } }
            }
        }
    };
    frame.page(title, "/researcher/account", &body)
}

/// Everybody's accounts.
pub(crate) fn people_page(
    frame: &Frame,
    everybody: &Everybody<'_>,
    tokens: &[ApiToken],
    done: Option<&Done>,
) -> Response {
    let title = frame.say("People", "Personnes");
    let every: Vec<&ApiToken> = tokens.iter().collect();
    let body = html! {
        h1 { (title) }
        (done_line(frame, done))
        div.card {
            div.table-scroll tabindex="0" role="region" aria-label=(title) {
                table {
                    thead { tr {
                        th scope="col" { (frame.say("E-mail", "Courriel")) }
                        th scope="col" { (frame.say("Role in all studies", "Rôle dans toutes les études")) }
                        th scope="col" { (frame.say("Roles in single studies", "Rôles dans certaines études")) }
                        th scope="col" { (frame.say("Since", "Depuis")) }
                        th scope="col" { (frame.say("Actions", "Actions")) }
                    } }
                    tbody {
                        @for account in everybody.accounts { (person(frame, account, everybody)) }
                    }
                }
            }
        }
        div.card {
            h2 { (frame.say("Invite somebody", "Inviter quelqu’un")) }
            form.stack method="post" action="/researcher/people/invite" {
                (frame.token())
                (field(frame.say("E-mail", "Courriel"), "email", "email", "off", ""))
                (roles(frame, "role", Role::Owner))
                (study_choice(frame, everybody.studies))
                div.actions {
                    button type="submit" { (frame.say("Make a link", "Créer un lien")) }
                }
            }
            p.soft {
                (frame.say(
                    "The link works once, for two days. Hand it over yourself: the server sends no mail.",
                    "Le lien sert une fois, pendant deux jours. Transmettez-le vous-même : le serveur n’envoie pas de courriel.",
                ))
            }
        }
        div.card {
            h2 { (frame.say("Everybody’s tokens", "Jetons de chacun")) }
            (token_table(frame, &every))
        }
    };
    frame.page(title, "/researcher/people", &body)
}

fn person(frame: &Frame, account: &Account, everybody: &Everybody<'_>) -> Markup {
    let action = format!("/researcher/people/{}", account.key);
    let button = |what: &str, text: &str| {
        html! {
            form method="post" action=(action) {
                (frame.token())
                input type="hidden" name="action" value=(what);
                button type="submit" aria-label={ (text) ": " (account.email) } { (text) }
            }
        }
    };
    html! {
        tr {
            th scope="row" { (account.email) }
            td {
                @if account.disabled_ms.is_some() {
                    span.tag.warn { (frame.say("disabled", "désactivé")) }
                } @else {
                    form.row method="post" action=(action) {
                        (frame.token())
                        input type="hidden" name="action" value="role";
                        select name="role" aria-label={ (frame.say("Role of ", "Rôle de ")) (account.email) } {
                            @for role in [Role::Nothing].into_iter().chain(Role::ALL) {
                                option value=(role.word()) selected[role == account.role] {
                                    (role_word(frame.language, role))
                                }
                            }
                        }
                        button type="submit" aria-label={ (frame.say("Change the role of ", "Changer le rôle de ")) (account.email) } {
                            (frame.say("Change", "Changer"))
                        }
                    }
                }
            }
            td { (study_roles(frame, account, everybody)) }
            td { (time(Some(account.created_ms))) }
            td {
                div.row {
                    @if account.disabled_ms.is_some() {
                        (button("enable", frame.say("Enable", "Activer")))
                    } @else {
                        (button("reset", frame.say("New password", "Nouveau mot de passe")))
                        (button("disable", frame.say("Disable", "Désactiver")))
                    }
                }
            }
        }
    }
}

fn token_table(frame: &Frame, tokens: &[&ApiToken]) -> Markup {
    let title = frame.say("Tokens", "Jetons");
    html! {
        @if tokens.is_empty() {
            p.soft { (frame.say("None.", "Aucun.")) }
        } @else {
            div.table-scroll tabindex="0" role="region" aria-label=(title) {
                table {
                    thead { tr {
                        th scope="col" { (frame.say("Name", "Nom")) }
                        th scope="col" { (frame.say("Role", "Rôle")) }
                        th scope="col" { (frame.say("Of", "De")) }
                        th scope="col" { (frame.say("Last used", "Dernier usage")) }
                        th scope="col" { (frame.say("Actions", "Actions")) }
                    } }
                    tbody {
                        @for token in tokens {
                            tr {
                                th scope="row" { (token.name) }
                                td { (role_word(frame.language, token.role)) }
                                td { (token.email) }
                                td { (time(token.used_ms)) }
                                td {
                                    @if token.revoked_ms.is_some() {
                                        span.tag.warn { (frame.say("revoked", "révoqué")) }
                                    } @else {
                                        form method="post" action={ "/researcher/tokens/" (token.key) "/revoke" } {
                                            (frame.token())
                                            button type="submit" aria-label={ (frame.say("Revoke ", "Révoquer ")) (token.name) } {
                                                (frame.say("Revoke", "Révoquer"))
                                            }
                                        }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A choice of roles up to one's own.
fn roles(frame: &Frame, name: &str, most: Role) -> Markup {
    html! {
        fieldset.question {
            legend { (frame.say("Role", "Rôle")) }
            div.choices.one-column {
                @for role in Role::ALL.into_iter().filter(|role| *role <= most) {
                    label.choice {
                        input type="radio" name=(name) value=(role.word()) required;
                        span { strong { (role_word(frame.language, role)) } ": " (role_line(frame.language, role)) }
                    }
                }
            }
        }
    }
}

fn done_line(frame: &Frame, done: Option<&Done>) -> Markup {
    html! {
        @match done {
            Some(Done::Link { whom, address }) => {
                div.notice.good role="status" {
                    p {
                        (frame.say("The link for ", "Le lien pour ")) strong { (whom) }
                        (frame.say(". It is not shown again.", ". Il ne sera plus montré."))
                    }
                    code.code-block data-secret="" { (address) }
                }
            }
            Some(Done::Token(token)) => {
                div.notice.good role="status" {
                    p { (frame.say("The token. It is not shown again.", "Le jeton. Il ne sera plus montré.")) }
                    code.code-block data-secret="" { (token) }
                }
            }
            Some(Done::Password) => {
                div.notice.good role="status" {
                    p { (frame.say("The password is changed.", "Le mot de passe est changé.")) }
                }
            }
            None => {}
        }
    }
}

/// The log, the newest first.
pub(crate) fn log_page(frame: &Frame, entries: &[AuditEntry], older: Option<i64>) -> Response {
    let title = frame.say("Log", "Journal");
    let body = html! {
        h1 { (title) }
        div.card {
            p.soft {
                (frame.say(
                    "Who did what, when. Answers never stand here.",
                    "Qui a fait quoi, et quand. Aucune réponse n’y figure.",
                ))
            }
            @if entries.is_empty() {
                p { (frame.say("Nothing yet.", "Rien pour l’instant.")) }
            } @else {
                div.table-scroll tabindex="0" role="region" aria-label=(title) {
                    table {
                        thead { tr {
                            th scope="col" { (frame.say("When", "Quand")) }
                            th scope="col" { (frame.say("Who", "Qui")) }
                            th scope="col" { (frame.say("What", "Quoi")) }
                            th scope="col" { (frame.say("Study", "Étude")) }
                            th scope="col" { (frame.say("Concerns", "Concerne")) }
                        } }
                        tbody {
                            @for entry in entries {
                                tr {
                                    td { (time(Some(entry.at_ms))) }
                                    td { (entry.who) }
                                    td { (entry.action) }
                                    td { (entry.study_id) }
                                    td { (entry.subject) }
                                }
                            }
                        }
                    }
                }
            }
            @if let Some(before) = older {
                p { a href={ "/researcher/log?before=" (before) } { (frame.say("Older", "Plus ancien")) } }
            }
        }
    };
    frame.page(title, "/researcher/log", &body)
}
