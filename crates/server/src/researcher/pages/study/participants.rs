//! The table of a study's participants: how each stands, how far each is, in which browser.

use maud::{Markup, html};
use mimique_session::Standing;
use mimique_storage::SessionRecord;

use crate::researcher::dashboard::overview::{Listed, Notice, ON_A_PAGE, Person, Wanted};
use crate::researcher::pages::frame::{Frame, time};
use crate::researcher::pages::standing_words::{list_word, standing_word};

/// The participants, a row each, page by page.
pub(super) fn participants(frame: &Frame, id: &str, listed: &Listed) -> Markup {
    let title = frame.say("Participants", "Participants");
    html! {
        div.card {
            h2 { (title) }
            (choice(frame, id, listed))
            @if listed.people.is_empty() {
                p.soft {
                    @if listed.wanted.standing.is_none() {
                        (frame.say("Nobody yet.", "Personne pour l’instant."))
                    } @else {
                        (frame.say("Nobody stands so.", "Personne n’est dans cet état."))
                    }
                }
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
                            @for person in &listed.people { (participant(frame, id, person)) }
                        }
                    }
                }
                (pages(frame, id, listed))
            }
        }
    }
}

/// The address of a page of the list.
fn address(id: &str, standing: Option<Standing>, page: usize) -> String {
    let mut query = Vec::new();
    query.extend(standing.map(|standing| format!("standing={}", list_word(standing))));
    query.extend((page > 0).then(|| format!("page={}", page + 1)));
    let mark = if query.is_empty() { "" } else { "?" };
    format!("/researcher/studies/{id}{mark}{}", query.join("&"))
}

/// Which participants are listed.
fn choice(frame: &Frame, id: &str, listed: &Listed) -> Markup {
    let label = frame.say("Participants by status", "Participants par état");
    let current = |standing| (listed.wanted.standing == standing).then_some("true");
    html! {
        nav.row aria-label=(label) {
            a href=(address(id, None, 0)) aria-current=[current(None)] {
                (frame.say("all", "tous"))
            }
            @for standing in Standing::ALL {
                a href=(address(id, Some(standing), 0)) aria-current=[current(Some(standing))] {
                    (standing_word(standing, frame.language))
                }
            }
        }
    }
}

/// Which of how many are on this page, and where the others are.
fn pages(frame: &Frame, id: &str, listed: &Listed) -> Markup {
    let Wanted { standing, page } = listed.wanted;
    let first = page * ON_A_PAGE + 1;
    let last = first + listed.people.len() - 1;
    html! {
        @if listed.of > ON_A_PAGE {
            nav.row aria-label=(frame.say("Pages of participants", "Pages de participants")) {
                @if page > 0 {
                    a rel="prev" href=(address(id, standing, page - 1)) {
                        (frame.say("Newer", "Plus récents"))
                    }
                }
                span { (first) "–" (last) (frame.say(" of ", " sur ")) (listed.of) }
                @if last < listed.of {
                    a rel="next" href=(address(id, standing, page + 1)) {
                        (frame.say("Older", "Plus anciens"))
                    }
                }
            }
        }
    }
}

fn participant(frame: &Frame, id: &str, person: &Person) -> Markup {
    let Person { session, sums, notice } = person;
    let number = session.participant;
    html! {
        tr {
            th scope="row" {
                a href={ "/researcher/studies/" (id) "/participants/" (number) } {
                    (mimique_storage::participant_id(number))
                }
            }
            td { (status(frame, session, *notice)) }
            td.progress {
                @if let Some((done, all)) = sums.as_ref().and_then(|sums| sums.progress) {
                    progress max=(all) value=(done)
                        aria-label={ (done) (frame.say(" of ", " sur ")) (all) (frame.say(" steps", " étapes")) } {}
                    span.number { (done) "/" (all) }
                }
            }
            td {
                @if let (Some(sums), true) = (sums, notice.standing.is_open()) { (sums.step) }
            }
            td { (time(Some(session.started_ms))) }
            td { (time(session.last_event_ms)) }
            td.number { (session.event_count) }
            td.browser { (browser(&session.client)) }
        }
    }
}

/// How a session stands, and what is to be noticed of it.
pub(crate) fn status(frame: &Frame, session: &SessionRecord, notice: Notice) -> Markup {
    let tag = match notice.standing {
        Standing::Completed => "tag good",
        Standing::InProgress => "tag",
        _ => "tag warn",
    };
    html! {
        span class=(tag) { (standing_word(notice.standing, frame.language)) }
        @if session.event_count < session.next_sequence {
            " " span.tag.warn { (frame.say("events missing", "événements manquants")) }
        }
        @if notice.conflicts > 0 {
            " " span.tag.bad { (notice.conflicts) (frame.say(" conflicting", " contradictoires")) }
        }
        @if notice.is_excluded {
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
