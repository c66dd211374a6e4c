//! The page on which a participant redeems the withdrawal code.

use axum::http::header;
use axum::response::{Html, IntoResponse as _, Response};
use maud::{DOCTYPE, Markup, html};
use mimique_locale::Language;
use mimique_storage::{Withdrawal, participant_id};

use crate::error::Error;

/// Whose page it is.
pub(super) struct Shown<'a> {
    pub assets: &'a str,
    /// Identifier of the study.
    pub study: &'a str,
    /// Its title, in the reader's language if it has one.
    pub title: &'a str,
    pub language: Language,
    /// What makes the form the page's own.
    pub csrf: &'a str,
}

/// What became of the code that was sent.
pub(super) enum Told {
    Nothing,
    Deleted(Withdrawal),
    Refused(Error),
}

/// The whole page.
pub(super) fn withdrawal_page(shown: &Shown<'_>, told: &Told) -> Response {
    let Shown { assets, title, language, .. } = *shown;
    let (other, name) = language.pick(("fr", "Français"), ("en", "English"));
    let heading = language.pick("Have my answers deleted", "Faire effacer mes réponses");
    let page = html! {
        (DOCTYPE)
        html lang=(language.code()) {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="robots" content="noindex";
                meta name="color-scheme" content="light dark";
                title { (heading) }
                link rel="icon" href={ (assets) "/style/icon.svg" } type="image/svg+xml";
                link rel="stylesheet" href={ (assets) "/style/style.css" };
            }
            body {
                header.site-header {
                    span.title { (title) }
                    a lang=(other) hreflang=(other) href={ "?lang=" (other) } { (name) }
                }
                main.page {
                    div.card {
                        h1 { (heading) }
                        @match told {
                            Told::Deleted(withdrawal) => (deleted(language, withdrawal)),
                            Told::Refused(error) => {
                                div.notice.bad role="alert" { p { (error.sentence(language)) } }
                                (form(shown))
                            }
                            Told::Nothing => (form(shown)),
                        }
                    }
                }
            }
        }
    };
    // Forms tell where they come from: without that none could be told from a forged one.
    ([(header::REFERRER_POLICY, "same-origin")], Html(page.into_string())).into_response()
}

fn form(shown: &Shown<'_>) -> Markup {
    let language = shown.language;
    let address = format!("/s/{}/withdraw?lang={}", shown.study, language.code());
    html! {
        p {
            (language.pick(
                "The last page of the study gave you a withdrawal code. With it all your answers and every identifier of yours are deleted for good. You need not say why.",
                "La dernière page de l’étude vous a donné un code de retrait. Avec lui, toutes vos réponses et tous vos identifiants sont effacés définitivement. Vous n’avez pas à vous justifier.",
            ))
        }
        form.stack method="post" action=(address) {
            input type="hidden" name="csrf" value=(shown.csrf);
            div.field {
                label for="code" { (language.pick("Withdrawal code", "Code de retrait")) }
                p.hint #code-hint {
                    (language.pick(
                        "Sixteen letters and digits; capitals and dashes do not matter.",
                        "Seize lettres et chiffres ; majuscules et tirets sont indifférents.",
                    ))
                }
                input #code name="code" type="text" required autocomplete="off" autocapitalize="characters"
                    spellcheck="false" maxlength="40" aria-describedby="code-hint";
            }
            div.actions {
                button.danger type="submit" {
                    (language.pick("Delete my answers", "Effacer mes réponses"))
                }
            }
        }
    }
}

fn deleted(language: Language, withdrawal: &Withdrawal) -> Markup {
    let name = participant_id(withdrawal.participant);
    html! {
        div.notice role="status" {
            p {
                (language.pick("Your answers (participant ", "Vos réponses (participant "))
                strong { (name) }
                @if withdrawal.deleted > 0 {
                    (language.pick(") have been deleted.", ") ont été effacées."))
                } @else {
                    (language.pick(
                        ") are deleted; nothing of them is left here.",
                        ") sont effacées ; il n’en reste rien ici.",
                    ))
                }
            }
        }
        p.soft {
            (language.pick(
                "Backups of the server lose them when the next backup is made. You can close this page.",
                "Les sauvegardes du serveur les perdent à la prochaine sauvegarde. Vous pouvez fermer cette page.",
            ))
        }
    }
}
