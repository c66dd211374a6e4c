//! One participant: how the session stands, what happened when, excluded or not and by whom.

use axum::response::Response;
use maud::{Markup, html};
use mimique_storage::{Exclusion, Role, StoredEvent};
use mimique_study::Multilingual as _;
use serde_json::Value;

use super::frame::{Frame, time};
use super::study::{browser, status};
use crate::researcher::dashboard::overview::Person;
use crate::state::hosted_study::HostedStudy;

/// Events on the page at most; the export has all of them.
pub(crate) const MOST_EVENTS: usize = 1000;
/// Characters of an event's answers on the page at most.
const LONGEST_ANSWER: usize = 2000;

/// What the page shows.
pub(crate) struct Shown<'a> {
    pub study: &'a HostedStudy,
    pub person: &'a Person,
    pub events: &'a [EventRow],
    pub exclusions: &'a [Exclusion],
}

/// What the page shows of an event.
pub(crate) struct EventRow {
    sequence: u64,
    at_ms: f64,
    kind: String,
    place: String,
    answers: String,
    misfit: Option<String>,
}

impl EventRow {
    /// That of an event as it is stored.
    pub fn of(stored: &StoredEvent) -> Self {
        let body: Value = serde_json::from_str(&stored.body).unwrap_or_default();
        let text = |name: &str| body[name].as_str().unwrap_or_default();
        let place = match text("clip") {
            "" => text("step").to_owned(),
            clip if text("step").is_empty() => clip.to_owned(),
            clip => format!("{} ({clip})", text("step")),
        };
        let cut = |text: &str| text.chars().take(LONGEST_ANSWER).collect();
        Self {
            sequence: stored.sequence,
            at_ms: stored.at_ms,
            kind: cut(text("type")),
            place: cut(&place),
            answers: cut(&answers(&body)),
            misfit: stored.misfit.clone(),
        }
    }
}

/// One participant.
pub(crate) fn participant_page(frame: &Frame, shown: &Shown<'_>) -> Response {
    let Shown { study, person, .. } = shown;
    let session = &person.session;
    let id = study.id();
    let name = mimique_storage::participant_id(session.participant);
    let address = format!("/researcher/studies/{id}/participants/{}", session.participant);
    let title = format!("{name} · {id}");
    let language = study.study().language_for(frame.language.code());
    let body = html! {
        p {
            a href={ "/researcher/studies/" (id) } {
                "← " span lang=(language) { (study.title(language)) }
            }
        }
        div.card {
            h1 { (name) }
            p { (status(frame, session, person.notice)) }
            dl.facts {
                div { dt { (frame.say("Started", "Début")) } dd { (time(Some(session.started_ms))) } }
                div { dt { (frame.say("Last event", "Dernier événement")) } dd { (time(session.last_event_ms)) } }
                @if let Some((done, all)) = person.sums.as_ref().and_then(|sums| sums.progress) {
                    div { dt { (frame.say("Steps", "Étapes")) } dd { (done) "/" (all) } }
                }
                div { dt { (frame.say("Events", "Événements")) } dd { (session.event_count) } }
                @if let Some(name) = &session.condition {
                    div { dt { "Condition" } dd { (name) } }
                }
                div { dt { (frame.say("Language", "Langue")) } dd { (session.language) } }
                div { dt { (frame.say("Browser", "Navigateur")) } dd { (browser(&session.client)) } }
                div { dt { "Version" } dd { code { (session.config_hash.get(..12).unwrap_or_default()) } } }
            }
            @if frame.may(Role::Analyst) && !shown.events.is_empty() {
                p {
                    a href={ (address) "/replay" } {
                        (frame.say("Replay: what this person saw", "Revoir : ce que cette personne a vu"))
                    }
                }
            }
        }
        (exclusion(frame, shown, &address))
        (timeline(frame, shown))
        @if frame.may(Role::Owner) && !session.is_deleted() {
            (deletion(frame, &name, &address))
        }
    };
    frame.page(&title, &address, &body)
}

fn exclusion(frame: &Frame, shown: &Shown<'_>, address: &str) -> Markup {
    let reason = shown.exclusions.last().and_then(|last| last.reason.as_ref());
    html! {
        div.card {
            h2 { (frame.say("Exclusion", "Exclusion")) }
            @if let Some(reason) = reason {
                p { (frame.say("Excluded: ", "Exclu : ")) strong { (reason) } }
            }
            @if frame.may(Role::Analyst) {
                @if reason.is_some() {
                    form method="post" action={ (address) "/include" } {
                        (frame.token())
                        button type="submit" { (frame.say("Take the exclusion back", "Annuler l’exclusion")) }
                    }
                } @else {
                    form.stack method="post" action={ (address) "/exclude" } {
                        (frame.token())
                        div.field {
                            label for="reason" { (frame.say("Reason", "Raison")) }
                            p.hint #reason-hint {
                                (frame.say(
                                    "It stands in the export and in the report. Nothing is deleted.",
                                    "Elle figure dans l’export et dans le rapport. Rien n’est supprimé.",
                                ))
                            }
                            input #reason name="reason" type="text" maxlength="200" required
                                autocomplete="off" aria-describedby="reason-hint";
                        }
                        div.actions {
                            button.danger type="submit" { (frame.say("Exclude", "Exclure")) }
                        }
                    }
                }
            }
            @if !shown.exclusions.is_empty() {
                ol.history {
                    @for change in shown.exclusions {
                        li {
                            (time(Some(change.at_ms))) " · " (change.who) " · "
                            @match &change.reason {
                                Some(reason) => { (frame.say("excluded: ", "exclu : ")) (reason) }
                                None => { (frame.say("taken back", "annulée")) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Deletion, for an owner who types the participant's name.
fn deletion(frame: &Frame, name: &str, address: &str) -> Markup {
    html! {
        div.card {
            h2 { (frame.say("Deletion", "Suppression")) }
            p {
                (frame.say(
                    "Every answer of this participant and every recruitment identifier is deleted for good, as if they had withdrawn. The number stays taken.",
                    "Toutes les réponses de cette personne et tous ses identifiants de recrutement sont supprimés définitivement, comme si elle s’était retirée. Le numéro reste pris.",
                ))
            }
            p {
                (frame.say("Backups still hold them until the next ", "Les sauvegardes les contiennent jusqu’au prochain "))
                code { "mimique backup --folder" }
                (frame.say(
                    ", which takes them out of every backup of its folder; a backup restored before that has them deleted again from its list of deletions, if that was written since. Copies kept elsewhere you must correct yourself.",
                    ", qui les retire de toutes les sauvegardes de son dossier ; une sauvegarde restaurée avant cela les perd à nouveau d’après sa liste de suppressions, si elle a été écrite depuis. Les copies gardées ailleurs restent à votre charge.",
                ))
            }
            form.stack method="post" action={ (address) "/erase" } {
                (frame.token())
                div.field {
                    label for="confirmation" {
                        (frame.say("Type ", "Saisissez ")) strong { (name) }
                        (frame.say(" to confirm", " pour confirmer"))
                    }
                    input #confirmation name="confirmation" type="text" required autocomplete="off"
                        pattern=(name);
                }
                div.actions {
                    button.danger type="submit" {
                        (frame.say("Delete the answers", "Supprimer les réponses"))
                    }
                }
            }
        }
    }
}

fn timeline(frame: &Frame, shown: &Shown<'_>) -> Markup {
    let title = frame.say("What happened", "Ce qui s’est passé");
    let with_answers = frame.may(Role::Analyst);
    html! {
        div.card {
            h2 { (title) }
            @if shown.events.is_empty() {
                p.soft { (frame.say("Nothing is stored.", "Rien n’est conservé.")) }
            } @else {
                div.table-scroll.tall tabindex="0" role="region" aria-label=(title) {
                    table {
                        thead { tr {
                            th.number scope="col" { "#" }
                            th scope="col" { (frame.say("When", "Quand")) }
                            th scope="col" { (frame.say("What", "Quoi")) }
                            th scope="col" { (frame.say("Where", "Où")) }
                            @if with_answers { th scope="col" { (frame.say("Answer", "Réponse")) } }
                        } }
                        tbody {
                            @for event in shown.events.iter().take(MOST_EVENTS) {
                                (row(frame, event, with_answers))
                            }
                        }
                    }
                }
                @if shown.events.len() > MOST_EVENTS {
                    p.soft { (frame.say("The export has all of them.", "L’export les contient tous.")) }
                }
            }
        }
    }
}

fn row(frame: &Frame, event: &EventRow, with_answers: bool) -> Markup {
    html! {
        tr {
            td.number { (event.sequence) }
            td { (time(Some(event.at_ms as i64))) }
            td {
                (event.kind)
                @if let Some(misfit) = &event.misfit {
                    span.soft {
                        (frame.say(" (counts for nothing: ", " (ne compte pas : "))
                        code { (misfit) } ")"
                    }
                }
            }
            td { (event.place) }
            @if with_answers { td { (event.answers) } }
        }
    }
}

/// What was answered, question by question.
fn answers(body: &Value) -> String {
    let cell = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    if let Some(question) = body["question"].as_str() {
        return format!("{question}: {}", cell(&body["value"]));
    }
    let Some(answers) = body["answers"].as_object() else { return String::new() };
    let pairs: Vec<_> =
        answers.iter().map(|(question, value)| format!("{question}: {}", cell(value))).collect();
    pairs.join("; ")
}
