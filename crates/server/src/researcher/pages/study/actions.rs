//! What is done with a study: its exports and reports, its stage, its removal.

use maud::{Markup, html};
use mimique_storage::{Overdue, Role};
use mimique_study::Study;

use crate::export::format::Format;
use crate::researcher::pages::frame::{Frame, time};
use crate::retention::GRACE_MS;
use crate::state::hosted_study::{HostedStudy, Stage};

/// What an owner does with a study that came through the page.
pub(super) fn hosting(frame: &Frame, study: &HostedStudy) -> Markup {
    let base = format!("/researcher/studies/{}", study.id());
    let (next, text) = match study.stage() {
        Stage::Pilot => (
            "live",
            frame.say("End the pilot: answers count", "Fin du pilote : les réponses comptent"),
        ),
        Stage::Live => ("pilot", frame.say("Back to the pilot", "Revenir au pilote")),
    };
    html! {
        h2 { (frame.say("Hosting", "Hébergement")) }
        div.row {
            form method="post" action={ (base) "/stage" } {
                (frame.token())
                input type="hidden" name="stage" value=(next);
                button type="submit" { (text) }
            }
            form method="post" action={ (base) "/remove" } {
                (frame.token())
                button.danger type="submit" { (frame.say("Host it no more (answers stay)", "Ne plus l’héberger (les réponses restent)")) }
            }
        }
    }
}

/// Answers over their time: when they go, and how they are kept.
pub(super) fn overdue(frame: &Frame, id: &str, overdue: &Overdue) -> Markup {
    html! {
        div.notice role="status" {
            p {
                strong { (overdue.sessions) }
                (frame.say(
                    " sessions are over the study’s retentionDays; their answers are deleted from ",
                    " sessions ont dépassé les retentionDays de l’étude ; leurs réponses sont supprimées à partir du ",
                ))
                (time(Some(overdue.first_marked_ms + GRACE_MS)))
                (frame.say(
                    " on. If the server’s clock was wrong, keep them and set it right.",
                    ". Si l’horloge du serveur était fausse, gardez-les et réglez-la.",
                ))
            }
            @if frame.may(Role::Owner) {
                form method="post" action={ "/researcher/studies/" (id) "/keep" } {
                    (frame.token())
                    button type="submit" { (frame.say("Keep the answers", "Garder les réponses")) }
                }
            }
        }
    }
}

/// Deletion by the code that a participant brings.
pub(super) fn withdrawal(frame: &Frame, id: &str) -> Markup {
    html! {
        h2 { (frame.say("Withdrawal", "Retrait")) }
        p.soft {
            (frame.say(
                "Participants delete their answers themselves, with the code of the last page, at ",
                "Les participants suppriment eux-mêmes leurs réponses, avec le code de la dernière page, sur ",
            ))
            a href={ "/s/" (id) "/withdraw" } { "/s/" (id) "/withdraw" }
            (frame.say(
                ". Here you do it for somebody who has sent you the code.",
                ". Ici, vous le faites pour une personne qui vous a envoyé le code.",
            ))
        }
        form.stack method="post" action={ "/researcher/studies/" (id) "/withdraw" } {
            (frame.token())
            div.field {
                label for="code" { (frame.say("Withdrawal code", "Code de retrait")) }
                input #code name="code" type="text" required autocomplete="off" spellcheck="false"
                    maxlength="40";
            }
            div.actions {
                button.danger type="submit" {
                    (frame.say("Delete the answers of this code", "Supprimer les réponses de ce code"))
                }
            }
        }
    }
}

/// What is downloaded of a study, and its statistical report.
pub(super) fn exports(frame: &Frame, study: &Study) -> Markup {
    let id = &study.id;
    let measures_faces = study.mimicry.is_some();
    let label = |format| match format {
        Format::Csv => frame.say("Tidy CSV", "CSV long"),
        Format::Wide => frame.say("Wide CSV", "CSV large"),
        Format::Json => frame.say("JSON lines", "Lignes JSON"),
        Format::Events => frame.say("All events", "Tous les événements"),
        Format::Tracks => frame.say("Measured faces", "Visages mesurés"),
        Format::PsychDs => "Psych-DS (ZIP)",
    };
    let base = format!("/researcher/studies/{id}");
    html! {
        h2 { (frame.say("Export", "Exporter")) }
        div.row {
            @let shown = |format: &Format| measures_faces || *format != Format::Tracks;
            @for format in Format::ALL.into_iter().filter(shown) {
                a.button href={ (base) "/export/" (format.word()) } download { (label(format)) }
            }
            a.button href={ (base) "/export/dictionary" } download {
                (frame.say("Data dictionary", "Dictionnaire des données"))
            }
            a.button href={ (base) "/export/stimuli" } download {
                (frame.say("Stimuli and their measures", "Stimuli et leurs mesures"))
            }
            @if measures_faces {
                a.button href={ (base) "/export/courses" } download {
                    (frame.say("Courses of the clips", "Cours des extraits"))
                }
            }
            a.button href={ (base) "/export/study" } download { (frame.say("Study file", "Fichier de l’étude")) }
            a.button.primary href={ (base) "/report/" (frame.language.code()) "/report.html" } {
                (frame.say("Statistical report", "Rapport statistique"))
            }
            a.button href={ (base) "/report/" (frame.language.code()) "/report.zip" } download {
                (frame.say("Report (ZIP)", "Rapport (ZIP)"))
            }
        }
        p.soft {
            (frame.say("For a spreadsheet: ", "Pour un tableur : "))
            a href={ (base) "/export/csv?neutralised=true" } download { (frame.say("tidy", "long")) }
            " · "
            a href={ (base) "/export/wide?neutralised=true" } download { (frame.say("wide", "large")) }
            (frame.say(
                ", with an apostrophe before texts that begin with = + - @, which a spreadsheet would take for formulas. Scripts want the files above.",
                ", avec une apostrophe devant les textes qui commencent par = + - @, qu’un tableur prendrait pour des formules. Les scripts préfèrent les fichiers ci-dessus.",
            ))
        }
    }
}
