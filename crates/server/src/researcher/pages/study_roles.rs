//! Roles in single studies, on the pages of accounts.

use maud::{Markup, html};
use mimique_storage::{Account, Role};

use super::frame::{Frame, role_word};
use super::people::Everybody;
use crate::accounts::identity::Researcher;

/// One's own roles in single studies.
pub(super) fn own_roles(frame: &Frame, who: &Researcher) -> Markup {
    html! {
        @if !who.studies().is_empty() {
            ul {
                @for (study, role) in who.studies() {
                    li { code { (study) } ": " (role_word(frame.language, *role)) }
                }
            }
        }
    }
}

/// In which studies the role of an invitation is.
pub(super) fn study_choice(frame: &Frame, studies: &[String]) -> Markup {
    html! {
        div.field {
            label for="study" { (frame.say("In", "Dans")) }
            select #study name="study" {
                option value="" { (frame.say("all studies", "toutes les études")) }
                @for study in studies { option value=(study) { (study) } }
            }
        }
    }
}

/// An account's roles in single studies, and the form that gives it one more or takes one away.
pub(super) fn study_roles(frame: &Frame, account: &Account, everybody: &Everybody<'_>) -> Markup {
    let own = || everybody.roles.iter().filter(|role| role.account_key == account.key);
    let action = format!("/researcher/people/{}", account.key);
    let form = |fields: Markup, label: &str, text: &str| {
        html! {
            form.row method="post" action=(action) {
                (frame.token())
                input type="hidden" name="action" value="study-role";
                (fields)
                button type="submit" aria-label={ (text) ": " (label) } { (text) }
            }
        }
    };
    html! {
        @for role in own() {
            @let fields = html! {
                input type="hidden" name="study" value=(role.study_id);
                input type="hidden" name="role" value=(Role::Nothing.word());
                span { code { (role.study_id) } ": " (role_word(frame.language, role.role)) }
            };
            @let label = format!("{}, {}", account.email, role.study_id);
            (form(fields, &label, frame.say("Take away", "Retirer")))
        }
        @if account.disabled_ms.is_none() && !everybody.studies.is_empty() {
            @let fields = html! {
                select name="study" aria-label={ (frame.say("Study for ", "Étude pour ")) (account.email) } {
                    @for study in everybody.studies { option value=(study) { (study) } }
                }
                select name="role" aria-label={ (frame.say("Role in the study of ", "Rôle dans l’étude de ")) (account.email) } {
                    @for role in Role::ALL {
                        option value=(role.word()) { (role_word(frame.language, role)) }
                    }
                }
            };
            (form(fields, &account.email, frame.say("Give", "Donner")))
        }
    }
}
