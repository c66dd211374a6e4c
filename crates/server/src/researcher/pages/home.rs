//! The list of studies: what is hosted, in which stage, how many came.

use axum::response::Response;
use maud::{Markup, html};
use mimique_storage::Role;

use super::frame::{Frame, time};
use super::study::stage_word;
use crate::retention::ClockDoubt;
use crate::state::hosted_study::HostedStudy;
use mimique_study::Multilingual as _;

/// A study and how many sessions it has, of which so many complete.
pub(crate) struct Listed {
    pub study: std::sync::Arc<HostedStudy>,
    pub sessions: u64,
    pub completed: u64,
    /// When it came through the page, if it did.
    pub uploaded_ms: Option<i64>,
}

/// The list of studies.
pub(crate) fn home_page(
    frame: &Frame,
    studies: &[Listed],
    doubt: Option<ClockDoubt>,
    may_upload: bool,
) -> Response {
    let title = frame.say("Studies", "Études");
    let body = html! {
        h1 { (title) }
        @if let Some(doubt) = doubt { (clock_notice(frame, doubt)) }
        div.card {
            @if studies.is_empty() {
                p { (frame.say("No study yet.", "Aucune étude pour l’instant.")) }
            } @else {
                div.table-scroll tabindex="0" role="region" aria-label=(title) {
                    table {
                        thead { tr {
                            th scope="col" { (frame.say("Study", "Étude")) }
                            th scope="col" { (frame.say("Stage", "Étape")) }
                            th.number scope="col" { (frame.say("Sessions", "Sessions")) }
                            th.number scope="col" { (frame.say("Completed", "Terminées")) }
                            th scope="col" { (frame.say("Uploaded", "Déposée")) }
                            th scope="col" { "Version" }
                        } }
                        tbody {
                            @for listed in studies {
                                @let study = &listed.study;
                                @let language = study.study().language_for(frame.language.code());
                                tr {
                                    th scope="row" lang=(language) {
                                        a href={ "/researcher/studies/" (study.id()) } { (study.title(language)) }
                                    }
                                    td { (stage_word(frame.language, study.stage().word())) }
                                    td.number { (listed.sessions) }
                                    td.number { (listed.completed) }
                                    td { (time(listed.uploaded_ms)) }
                                    td { code { (&study.config_hash()[..12]) } }
                                }
                            }
                        }
                    }
                }
            }
            @if may_upload {
                div.actions {
                    a.button href="/researcher/upload" { (frame.say("Upload a study", "Déposer une étude")) }
                }
            }
        }
    };
    frame.page(title, "/researcher", &body)
}

/// The server's clock is not believed, and who can say that it is right.
fn clock_notice(frame: &Frame, doubt: ClockDoubt) -> Markup {
    html! {
        div.notice.bad role="alert" {
            p {
                (frame.say("The server’s clock shows ", "L’horloge du serveur indique "))
                (time(Some(doubt.now_ms)))
                (frame.say("; what it has seen before is ", " ; elle avait vu auparavant "))
                (time(Some(doubt.seen_ms)))
                (frame.say(
                    ". Nothing is deleted for its age until an owner says that the clock is right.",
                    ". Rien n’est supprimé pour son âge tant qu’une personne responsable n’a pas dit que l’horloge est juste.",
                ))
            }
            @if frame.may(Role::Owner) {
                form method="post" action="/researcher/clock" {
                    (frame.token())
                    button type="submit" { (frame.say("The clock is right", "L’horloge est juste")) }
                }
            }
        }
    }
}
