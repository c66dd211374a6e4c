//! How far the study and its people are: the conditions they were given, the pages they are on and those they leave.

use maud::{Markup, html};
use mimique_session::Standing;

use super::bars::round;
use crate::researcher::dashboard::figures::{Stop, StopLabel};
use crate::researcher::dashboard::overview::Overview;
use crate::researcher::dashboard::pace::Pace;
use crate::researcher::pages::frame::{Frame, day};
use crate::researcher::pages::standing_words::standing_word;

/// How many are done of how many are wanted, and when the study will be full at this pace.
pub(super) fn pace(frame: &Frame, pace: &Pace) -> Markup {
    let Pace { done, wanted, per_day, full_ms } = *pace;
    html! {
        p.pace {
            strong {
                (done)
                @if let Some(wanted) = wanted { (frame.say(" of ", " sur ")) (wanted) }
                @if done == 1 && wanted.is_none() {
                    (frame.say(" person has completed the study", " personne a terminé l’étude"))
                } @else {
                    (frame.say(" people have completed the study", " personnes ont terminé l’étude"))
                }
            }
            @if let Some(wanted) = wanted {
                " " progress aria-hidden="true" max=(wanted.max(1)) value=(done.min(wanted)) {}
            }
            @if let Some(per_day) = per_day {
                (frame.say("; lately ", " ; dernièrement ")) (round(frame.language, per_day)) (frame.say(" per day", " par jour"))
            }
            @if let Some(full_ms) = full_ms {
                (frame.say(": full about ", " : complète vers le ")) (day(full_ms))
            }
            "."
        }
    }
}

/// How many there are in each condition between participants.
pub(super) fn conditions(frame: &Frame, overview: &Overview) -> Markup {
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

/// Where people are and where they leave, for each condition apart.
pub(super) fn stops(frame: &Frame, overview: &Overview) -> Markup {
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
