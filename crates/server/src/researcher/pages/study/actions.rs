//! What is done with a study: its exports and reports, its stage, its removal.

use maud::{Markup, html};

use crate::export::format::Format;
use crate::researcher::pages::frame::Frame;
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

/// What is downloaded of a study, and its statistical report.
pub(super) fn exports(frame: &Frame, id: &str) -> Markup {
    let label = |format| match format {
        Format::Csv => frame.say("Tidy CSV", "CSV long"),
        Format::Wide => frame.say("Wide CSV", "CSV large"),
        Format::Json => frame.say("JSON lines", "Lignes JSON"),
        Format::Events => frame.say("All events", "Tous les événements"),
        Format::PsychDs => "Psych-DS (ZIP)",
    };
    let base = format!("/researcher/studies/{id}");
    html! {
        h2 { (frame.say("Export", "Exporter")) }
        div.row {
            @for format in Format::ALL {
                a.button href={ (base) "/export/" (format.word()) } download { (label(format)) }
            }
            a.button href={ (base) "/export/dictionary" } download {
                (frame.say("Data dictionary", "Dictionnaire des données"))
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
