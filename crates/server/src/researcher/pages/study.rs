//! A study's dashboard as HTML: nothing inline, complete without its script. What the script brings up
//! to date is marked `data-live`.

use axum::response::Response;
use maud::{Markup, html};
use mimique_analysis::Language;
use mimique_session::Standing;
use mimique_storage::{Role, SessionRecord};
use mimique_study::Multilingual as _;

use super::frame::{Frame, time};
use super::standing_words::standing_word;
use crate::export::format::Format;
use crate::researcher::dashboard::distribution::{Distribution, Shape};
use crate::researcher::dashboard::figures::{Stop, StopLabel, Times};
use crate::researcher::dashboard::overview::Overview;
use crate::researcher::dashboard::session_view::SessionView;
use crate::state::hosted_study::{HostedStudy, Stage};

/// The dashboard of a study.
pub(crate) fn study_page(
    frame: &Frame,
    study: &HostedStudy,
    overview: &Overview,
    is_uploaded: bool,
) -> Response {
    let id = study.id();
    let language = study.study().language_for(frame.language.code());
    let address = format!("/researcher/studies/{id}");
    let body = html! {
        p { a href="/researcher" { "← " (frame.say("Studies", "Études")) } }
        div.card {
            h1 lang=(language) { (study.title(language)) }
            p.soft {
                code { (id) } " · " (stage_word(frame.language, study.stage().word())) " · version "
                code { (&study.config_hash()[..12]) } " · "
                a href={ "/s/" (id) "/" } { (frame.say("participant’s page", "page des participants")) }
                " · "
                a href={ "/preview/" (id) } { (frame.say("preview of the stimuli", "aperçu des stimuli")) }
            }
            @if frame.may(Role::Analyst) { (exports(frame, id)) }
            @if frame.may(Role::Owner) && is_uploaded { (hosting(frame, study)) }
        }
        p.live-state role="status" data-live-state=""
            data-on=(frame.say("Live: the page follows what happens.", "En direct : la page suit ce qui se passe."))
            data-off=(frame.say("Not connected: trying again.", "Non connecté : nouvel essai.")) {}
        div data-live={ (address) "/live" } {
            (counts(frame, study, overview))
            (participants(frame, id, overview))
            @if !overview.conditions.is_empty() { (conditions(frame, overview)) }
            (stops(frame, overview))
            @if !overview.balance.is_empty() { (balance(frame, overview)) }
            (times(frame, &overview.times))
            (frames(frame, overview))
            (checks(frame, overview))
            @if !overview.distributions.is_empty() {
                (answers(frame, &overview.distributions, language))
            }
        }
    };
    frame.page(study.title(language), &address, &body)
}

/// The word for a stage.
pub(super) fn stage_word(language: Language, word: &str) -> &str {
    match word {
        "pilot" => language.pick("pilot", "pilote"),
        "live" => language.pick("live", "en cours"),
        other => other,
    }
}

/// What an owner does with a study that came through the page.
fn hosting(frame: &Frame, study: &HostedStudy) -> Markup {
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

fn exports(frame: &Frame, id: &str) -> Markup {
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

fn counts(frame: &Frame, study: &HostedStudy, overview: &Overview) -> Markup {
    html! {
        dl.counts {
            @for (standing, count) in &overview.standings {
                div { dt { (standing_word(*standing, frame.language)) } dd { (count) } }
            }
            @if !overview.excluded.is_empty() {
                div { dt { (frame.say("excluded", "exclus")) } dd { (overview.excluded.len()) } }
            }
            @if let Some(wanted) = study.study().recruitment.participants {
                div { dt { (frame.say("wanted", "prévus")) } dd { (wanted) } }
            }
        }
    }
}

fn participants(frame: &Frame, id: &str, overview: &Overview) -> Markup {
    let title = frame.say("Participants", "Participants");
    html! {
        div.card {
            h2 { (title) }
            @if overview.sessions.is_empty() {
                p.soft { (frame.say("Nobody yet.", "Personne pour l’instant.")) }
            } @else {
                div.table-scroll tabindex="0" role="region" aria-label=(title) {
                    table {
                        thead { tr {
                            th scope="col" { (frame.say("Participant", "Participant")) }
                            th scope="col" { (frame.say("Status", "État")) }
                            th scope="col" { (frame.say("Progress", "Avancement")) }
                            th scope="col" { (frame.say("At", "À la page")) }
                            th scope="col" { (frame.say("Started", "Début")) }
                            th scope="col" { (frame.say("Last event", "Dernier événement")) }
                            th.number scope="col" { (frame.say("Events", "Événements")) }
                            th scope="col" { (frame.say("Browser", "Navigateur")) }
                        } }
                        tbody {
                            // The newest first: they are the ones to be watched.
                            @for (session, view) in overview.sessions.iter().rev() {
                                (participant(frame, id, session, view, overview))
                            }
                        }
                    }
                }
            }
        }
    }
}

fn participant(
    frame: &Frame,
    id: &str,
    session: &SessionRecord,
    view: &SessionView,
    overview: &Overview,
) -> Markup {
    let number = session.participant;
    html! {
        tr {
            th scope="row" {
                a href={ "/researcher/studies/" (id) "/participants/" (number) } {
                    (crate::participant_id::participant_id(number))
                }
            }
            td { (status(frame, session, view, overview)) }
            td.progress {
                @if let (Some((done, all)), true) = (view.progress, !session.is_deleted()) {
                    progress max=(all) value=(done)
                        aria-label={ (done) (frame.say(" of ", " sur ")) (all) (frame.say(" steps", " étapes")) } {}
                    span.number { (done) "/" (all) }
                }
            }
            td { @if overview.standing(session, view).is_open() { (view.step) } }
            td { (time(Some(session.started_ms))) }
            td { (time(session.last_event_ms)) }
            td.number { (session.event_count) }
            td.browser { (browser(&session.client)) }
        }
    }
}

/// How a session stands, and what is to be noticed of it.
pub(super) fn status(
    frame: &Frame,
    session: &SessionRecord,
    view: &SessionView,
    overview: &Overview,
) -> Markup {
    let standing = overview.standing(session, view);
    let tag = match standing {
        Standing::Completed => "tag good",
        Standing::InProgress => "tag",
        _ => "tag warn",
    };
    html! {
        span class=(tag) { (standing_word(standing, frame.language)) }
        @if session.event_count < session.next_sequence {
            " " span.tag.warn { (frame.say("events missing", "événements manquants")) }
        }
        @if let Some(conflicts) = overview.conflicts.get(&session.key) {
            " " span.tag.bad { (conflicts) (frame.say(" conflicting", " contradictoires")) }
        }
        @if overview.excluded.contains_key(&session.key) {
            " " span.tag.bad { (frame.say("excluded", "exclu")) }
        }
    }
}

fn stops(frame: &Frame, overview: &Overview) -> Markup {
    html! {
        @for (condition, stops) in &overview.stops {
            (stops_of(frame, condition.as_deref(), stops))
        }
    }
}

fn stops_of(frame: &Frame, condition: Option<&str>, stops: &[Stop]) -> Markup {
    let mut title = frame
        .say("Where people are and where they leave", "Où en sont les personnes, où elles partent")
        .to_owned();
    if let Some(name) = condition {
        title = format!("{title} ({name})");
    }
    let all = stops.first().map_or(0, |stop| stop.reached).max(1);
    html! {
        div.card {
            h2 { (title) }
            p.soft {
                (frame.say(
                    "Of this version’s participants. Whoever has declined, was not taken, or has given no sign of life for as long as a place is kept, has left.",
                    "Participants de cette version. Est parti qui a refusé, n’a pas été retenu, ou n’a donné aucun signe de vie aussi longtemps qu’une place est gardée.",
                ))
            }
            div.table-scroll.tall tabindex="0" role="region" aria-label=(title) {
                table {
                    thead { tr {
                        th scope="col" { (frame.say("Page", "Page")) }
                        th scope="col" aria-hidden="true" {}
                        th.number scope="col" { (frame.say("Reached", "Atteinte")) }
                        th.number scope="col" { (frame.say("Here now", "Ici maintenant")) }
                        th.number scope="col" { (frame.say("Left here", "Partis ici")) }
                    } }
                    tbody {
                        @for stop in stops {
                            tr {
                                th scope="row" { (stop_label(frame, &stop.label)) }
                                td.bar { progress aria-hidden="true" max=(all) value=(stop.reached) {} }
                                td.number { (stop.reached) }
                                td.number { (some(stop.here)) }
                                td.number { (some(stop.left)) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// How many there are in each condition between participants.
fn conditions(frame: &Frame, overview: &Overview) -> Markup {
    let title = frame.say("Conditions between participants", "Conditions entre participants");
    html! {
        div.card {
            h2 { (title) }
            p.soft {
                (frame.say(
                    "Of this version’s participants. Whoever comes without a condition in the address goes where the fewest have finished or are on their way.",
                    "Participants de cette version. Qui arrive sans condition dans l’adresse va là où le moins de personnes ont fini ou sont en route.",
                ))
            }
            div.table-scroll tabindex="0" role="region" aria-label=(title) {
                table {
                    thead { tr {
                        th scope="col" { (frame.say("Condition", "Condition")) }
                        th.number scope="col" { (standing_word(Standing::Completed, frame.language)) }
                        th.number scope="col" { (standing_word(Standing::InProgress, frame.language)) }
                    } }
                    tbody {
                        @for (name, [completed, active]) in &overview.conditions {
                            tr {
                                th scope="row" { (name) }
                                td.number { (completed) }
                                td.number { (active) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn stop_label(frame: &Frame, label: &StopLabel) -> String {
    match label {
        StopLabel::Page(id) => id.clone(),
        StopLabel::Practice(number) => {
            format!("{} {number}", frame.say("practice", "entraînement"))
        }
        StopLabel::Trial(number) => format!("{} {number}", frame.say("trial", "essai")),
        StopLabel::End => frame.say("end", "fin").to_owned(),
    }
}

/// A count, empty where it is none: what is there stands out.
fn some(count: u64) -> Markup {
    html! { @if count > 0 { (count) } @else { span.visually-hidden { "0" } } }
}

fn balance(frame: &Frame, overview: &Overview) -> Markup {
    html! {
        div.card {
            h2 { (frame.say("Condition balance", "Équilibre des conditions")) }
            p.soft {
                (frame.say(
                    "Finished trials of participants who completed the study.",
                    "Essais finis des participants qui ont terminé l’étude.",
                ))
            }
            div.distributions {
                @for (factor, levels) in &overview.balance {
                    (bars(factor, levels.iter().map(|(level, count)| (level.as_str(), *count))))
                }
            }
        }
    }
}

fn times(frame: &Frame, times: &[Times]) -> Markup {
    let title = frame.say("Time per trial", "Temps par essai");
    let most = times.iter().map(|row| row.high_s).fold(0.0, f64::max).max(0.001);
    html! {
        @if !times.is_empty() {
            div.card {
                h2 { (title) }
                div.table-scroll.tall tabindex="0" role="region" aria-label=(title) {
                    table {
                        thead { tr {
                            th scope="col" { (frame.say("Trial", "Essai")) }
                            th scope="col" aria-hidden="true" {}
                            th.number scope="col" { (frame.say("Median", "Médiane")) }
                            th.number scope="col" { "10–90 %" }
                            th.number scope="col" { (frame.say("Trials", "Essais")) }
                        } }
                        tbody {
                            @for row in times {
                                tr {
                                    th scope="row" {
                                        @if row.number == 0 { (frame.say("all", "tous")) } @else { (row.number) }
                                    }
                                    td.bar { progress aria-hidden="true" max=(round(most)) value=(round(row.median_s)) {} }
                                    td.number { (round(row.median_s)) " s" }
                                    td.number { (round(row.low_s)) "–" (round(row.high_s)) " s" }
                                    td.number { (row.count) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn frames(frame: &Frame, overview: &Overview) -> Markup {
    html! {
        @if !overview.frames.is_empty() {
            div.card {
                h2 { (frame.say("Late frames by device", "Images en retard par appareil")) }
                div.table-scroll tabindex="0" role="region"
                    aria-label=(frame.say("Late frames by device", "Images en retard par appareil")) {
                    table {
                        thead { tr {
                            th scope="col" { (frame.say("Device", "Appareil")) }
                            th.number scope="col" { (frame.say("People", "Personnes")) }
                            th.number scope="col" { (frame.say("Frames", "Images")) }
                            th.number scope="col" { (frame.say("Late", "En retard")) }
                            th.number scope="col" { (frame.say("Share", "Part")) }
                        } }
                        tbody {
                            @for row in &overview.frames {
                                tr {
                                    th scope="row" {
                                        @if row.device.is_empty() { (frame.say("unknown", "inconnu")) } @else { (row.device) }
                                    }
                                    td.number { (row.people) }
                                    td.number { (row.frames) }
                                    td.number { (row.late) }
                                    td.number { (round(100.0 * row.late as f64 / row.frames.max(1) as f64)) " %" }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn checks(frame: &Frame, overview: &Overview) -> Markup {
    html! {
        @if !overview.checks.is_empty() {
            div.card {
                h2 { (frame.say("Attention checks", "Contrôles d’attention")) }
                table {
                    thead { tr {
                        th scope="col" { (frame.say("Check", "Contrôle")) }
                        th.number scope="col" { (frame.say("Passed", "Réussis")) }
                        th.number scope="col" { (frame.say("Failed", "Ratés")) }
                    } }
                    tbody {
                        @for (question, passed, failed) in &overview.checks {
                            tr {
                                th scope="row" { code { (question) } }
                                td.number { (passed) }
                                td.number { (failed) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn answers(frame: &Frame, distributions: &[Distribution], language: &str) -> Markup {
    html! {
        div.card {
            h2 { (frame.say("Answers", "Réponses")) }
            p.soft {
                (frame.say(
                    "Practice and excluded participants left out. Texts are only counted here.",
                    "Sans l’entraînement ni les participants exclus. Les textes sont seulement comptés ici.",
                ))
            }
            div.distributions lang=(language) {
                @for distribution in distributions {
                    (answer(frame, distribution))
                }
            }
        }
    }
}

fn answer(frame: &Frame, distribution: &Distribution) -> Markup {
    let caption = html! {
        (distribution.prompt) " " code { (distribution.question) }
    };
    let count_line = |count: u64| {
        let words = match count {
            1 => frame.say("answer", "réponse"),
            _ => frame.say("answers", "réponses"),
        };
        html! { (count) " " (words) }
    };
    match &distribution.shape {
        Shape::Counts(counts) => {
            bars_with(&caption, counts.iter().map(|(label, count)| (label.as_str(), *count)))
        }
        Shape::Numbers { count, least, mean, greatest } => html! {
            div {
                p.caption { (caption) }
                p lang=(frame.language.code()) {
                    (count_line(*count)) ", " (round(*least)) " – " (round(*greatest)) ", "
                    (frame.say("mean", "moyenne")) " " (round(*mean))
                }
            }
        },
        Shape::Texts(count) => html! {
            div { p.caption { (caption) } p lang=(frame.language.code()) { (count_line(*count)) } }
        },
    }
}

fn bars<'a>(caption: &str, counts: impl Iterator<Item = (&'a str, u64)>) -> Markup {
    bars_with(&html! { code { (caption) } }, counts)
}

fn bars_with<'a>(caption: &Markup, counts: impl Iterator<Item = (&'a str, u64)>) -> Markup {
    let counts: Vec<_> = counts.collect();
    let most = counts.iter().map(|(_, count)| *count).max().unwrap_or(0).max(1);
    html! {
        table.bars {
            caption { (caption) }
            tbody {
                @for (label, count) in counts {
                    tr {
                        th scope="row" { (label) }
                        td.bar { progress aria-hidden="true" max=(most) value=(count) {} }
                        td.number { (count) }
                    }
                }
            }
        }
    }
}

fn round(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// What the page said of its browser, name and version first: `Firefox 140, Linux`.
pub(super) fn browser(client: &str) -> String {
    let mut about: std::collections::BTreeMap<String, String> =
        serde_json::from_str(client).unwrap_or_default();
    let name = [about.remove("browser"), about.remove("version")];
    let name = name.into_iter().flatten().collect::<Vec<_>>().join(" ");
    let others = about.into_values();
    [name].into_iter().chain(others).filter(|text| !text.is_empty()).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_browser_is_named_in_the_order_people_say_it() {
        let client = r#"{"browser":"Firefox","platform":"Linux","version":"140"}"#;
        assert_eq!(browser(client), "Firefox 140, Linux");
        assert_eq!(browser("{}"), "");
    }

    #[test]
    fn numbers_are_written_without_idle_digits() {
        assert_eq!(round(2.0), "2");
        assert_eq!(round(2.126), "2.13");
        assert_eq!(round(0.5), "0.5");
    }
}
