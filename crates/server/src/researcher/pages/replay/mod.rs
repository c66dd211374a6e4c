//! The replay of a session: every page that the participant saw, in order, with its answers and their times. The
//! page's script shows one after the other, and draws each clip again on the frames of its log.

mod answers;
pub(crate) mod player;
mod screen;
pub(crate) mod words;

use axum::response::Response;
use maud::{Markup, html};
use mimique_session::flow::{SeenPage, SeenPlay};
use mimique_storage::SessionRecord;
use serde_json::Value;

use super::frame::{Frame, time};
use super::study::browser;
use crate::researcher::replay::Replay;
use answers::answer_in_words;
use player::player;
use screen::{Screen, screen};
use words::script_words;

/// The page. `packs` is the address of the clips' packs.
pub(crate) fn replay_page(
    frame: &Frame,
    study: &str,
    packs: &str,
    session: &SessionRecord,
    replay: &Replay,
) -> Response {
    let name = mimique_storage::participant_id(session.participant);
    let person = format!("/researcher/studies/{study}/participants/{}", session.participant);
    let address = format!("{person}/replay");
    let title = frame.say(format!("Replay of {name}"), format!("{name} revu"));
    let screens: Vec<Screen> = replay.pages.iter().map(|page| screen(frame, &page.view)).collect();
    let head = html! {
        meta name="mimique-packs" content=(packs);
        link rel="stylesheet" href={ (frame.assets) "/researcher/preview.css" };
        link rel="stylesheet" href={ (frame.assets) "/researcher/replay.css" };
        script type="module" src={ (frame.assets) "/researcher/replay.js" } {}
    };
    let body = html! {
        p { a href=(person) { "← " (name) } }
        h1 { (title) }
        dl.facts {
            div { dt { (frame.say("Started", "Début")) } dd { (time(Some(session.started_ms))) } }
            div { dt { (frame.say("Language", "Langue")) } dd { (session.language) } }
            div { dt { (frame.say("Browser", "Navigateur")) } dd { (browser(&session.client)) } }
            div { dt { (frame.say("Pages seen", "Pages vues")) } dd { (screens.len()) } }
        }
        noscript {
            p.notice.warn {
                (frame.say(
                    "The clips are drawn by this page’s script: without JavaScript there are their logs in figures.",
                    "Les clips sont dessinés par le script de la page : sans JavaScript, il ne reste que leurs relevés en chiffres.",
                ))
            }
        }
        @if screens.is_empty() {
            p.soft { (frame.say("Nothing is stored.", "Rien n’est conservé.")) }
        } @else {
            (pages_bar(frame, &screens, &session.language))
            div #replay data-study=(study) data-plays=(address) data-words=(script_words(frame.language)) {
                @for (number, (page, screen)) in (1..).zip(replay.pages.iter().zip(&screens)) {
                    (seen_page(frame, number, page, screen, &session.language))
                }
            }
            (player(frame.language))
        }
    };
    frame.page_with(&format!("{title} · {study}"), &address, &head, &body)
}

/// From page to page; the script shows it.
fn pages_bar(frame: &Frame, screens: &[Screen], language: &str) -> Markup {
    html! {
        div.card.replay-bar #pages role="group" aria-label=(frame.say("Pages seen", "Pages vues")) hidden {
            button #before type="button" aria-keyshortcuts="P" { "← " (frame.say("previous", "précédente")) }
            label {
                (frame.say("Page", "Page")) " "
                select #page {
                    @for (number, screen) in (1..).zip(screens) {
                        option value=(number) lang=(language) { (number) ". " (screen.heading) }
                    }
                }
            }
            button #after type="button" aria-keyshortcuts="N" { (frame.say("next", "suivante")) " →" }
        }
    }
}

/// A page or trial with what was answered.
fn seen_page(
    frame: &Frame,
    number: usize,
    page: &SeenPage,
    screen: &Screen,
    language: &str,
) -> Markup {
    // Of a trial times are told from the first frame, as response times are.
    let onset = page.plays.iter().find(|play| play.log.is_whole()).map(|play| play.log.onset_ms);
    let seconds = |ms: f64| frame.language.fixed(ms / 1000.0, 2);
    let from = onset.unwrap_or(page.shown_ms);
    html! {
        article.card.seen id={ "page-" (number) } data-plays[!page.plays.is_empty()] {
            h2 lang=(language) { (screen.heading) }
            p.soft {
                (frame.say("Shown ", "Affichée ")) (time(Some(page.shown_ms as i64)))
                @match page.left_ms {
                    Some(left_ms) => {
                        (frame.say(", stood there ", ", restée ")) (seconds(left_ms - page.shown_ms)) " s"
                    }
                    None => { (frame.say(", not left", ", non quittée")) }
                }
            }
            div lang=(language) {
                @for text in &screen.text { p { (text) } }
            }
            @if !page.plays.is_empty() {
                ol.replay-plays {
                    @for play in &page.plays { li { (play_line(frame, play)) } }
                }
            }
            @if !screen.questions.is_empty() {
                dl.replay-answers {
                    @for question in &screen.questions {
                        div {
                            dt lang=(language) { (question.prompt) }
                            dd {
                                @match &question.value {
                                    Some(value) => span lang=(language) { (answer_in_words(&question.kind, value)) },
                                    None => span.soft { (frame.say("no answer", "sans réponse")) },
                                }
                                @if let Some(at_ms) = page.answered_ms.get(&question.id) {
                                    " " span.soft {
                                        @if onset.is_some() {
                                            (frame.say("after the first frame: ", "après la première image : "))
                                        } @else {
                                            (frame.say("after: ", "après : "))
                                        }
                                        (seconds(at_ms - from)) " s"
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A play in figures.
fn play_line(frame: &Frame, SeenPlay { clips, frames, log, .. }: &SeenPlay) -> Markup {
    let names: Vec<&str> = clips.iter().map(|clip| &*clip.clip).collect();
    let longest = frame.language.fixed(log.longest_ms, 1);
    let late = log.late;
    html! {
        strong { (names.join(" · ")) } (frame.say(": ", " : "))
        (frame.say(
            format!("{frames} frames, {late} late, longest {longest} ms"),
            format!("{frames} images, {late} en retard, la plus longue {longest} ms"),
        ))
        @if let Some(why) = &log.aborted {
            " (" (frame.say("cut short: ", "interrompu : ")) code { (why) } ")"
        }
    }
}

/// A question as it was asked, and its answer.
struct Asked {
    id: String,
    prompt: String,
    kind: mimique_session::flow::QuestionKindView,
    value: Option<Value>,
}
