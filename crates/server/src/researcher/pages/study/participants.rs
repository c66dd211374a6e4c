//! The table of a study's participants: how each stands, how far each is, in which browser.

use maud::{Markup, html};
use mimique_session::Standing;
use mimique_storage::SessionRecord;

use crate::researcher::dashboard::overview::Overview;
use crate::researcher::dashboard::session_view::SessionView;
use crate::researcher::pages::frame::{Frame, time};
use crate::researcher::pages::standing_words::standing_word;

/// The participants, a row each.
pub(super) fn participants(frame: &Frame, id: &str, overview: &Overview) -> Markup {
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
                    (mimique_storage::participant_id(number))
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
pub(crate) fn status(
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

/// What the page said of its browser, name and version first: `Firefox 140, Linux`.
pub(crate) fn browser(client: &str) -> String {
    let mut about: std::collections::BTreeMap<String, String> =
        serde_json::from_str(client).unwrap_or_default();
    let name = [about.remove("browser"), about.remove("version")];
    let name = name.into_iter().flatten().collect::<Vec<_>>().join(" ");
    let others = about.into_values();
    [name].into_iter().chain(others).filter(|text| !text.is_empty()).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::browser;

    #[test]
    fn a_browser_is_named_in_the_order_people_say_it() {
        let client = r#"{"browser":"Firefox","platform":"Linux","version":"140"}"#;
        assert_eq!(browser(client), "Firefox 140, Linux");
        assert_eq!(browser("{}"), "");
    }
}
