//! A study's dashboard as HTML: nothing inline, complete without its script. What the script brings up
//! to date is marked `data-live`.

mod actions;
mod answers;
mod bars;
mod participants;
mod progress;
mod trials;

use axum::response::Response;
use maud::{Markup, html};
use mimique_locale::Language;
use mimique_storage::{Overdue, Role};
use mimique_study::Multilingual as _;

use self::actions::{exports, withdrawal};
use self::answers::answers;
use self::participants::participants;
pub(super) use self::participants::{browser, status};
use self::progress::{conditions, stops};
use self::trials::{balance, checks, frames, times};
use super::frame::Frame;
use super::standing_words::standing_word;
use crate::researcher::dashboard::overview::Overview;
use crate::state::hosted_study::HostedStudy;

/// How the study is hosted, beside what was answered.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hosting {
    /// It came through the page.
    pub is_uploaded: bool,
    /// Sessions whose answers wait to be deleted.
    pub overdue: Option<Overdue>,
}

/// The dashboard of a study.
pub(crate) fn study_page(
    frame: &Frame,
    study: &HostedStudy,
    overview: &Overview,
    hosting: Hosting,
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
                " · "
                a href="/studio" { (frame.say("studio", "studio")) }
                @if frame.may(Role::Analyst) {
                    " · "
                    a href="#export" { (frame.say("export and report", "export et rapport")) }
                }
            }
            @if let Some(overdue) = &hosting.overdue { (actions::overdue(frame, id, overdue)) }
        }
        p.live-state role="status" data-live-state=""
            data-on=(frame.say("Live: the page follows what happens.", "En direct : la page suit ce qui se passe."))
            data-off=(frame.say("Not connected: trying again.", "Non connecté : nouvel essai.")) {}
        div data-live={ (address) "/live" } {
            (progress::pace(frame, &overview.pace))
            (counts(frame, overview))
            @if overview.behind > 0 { (behind(frame, overview.behind)) }
            (participants(frame, id, &overview.listed))
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
        @if frame.may(Role::Analyst) {
            div.card #export {
                (exports(frame, study.study()))
                @if frame.may(Role::Owner) { (withdrawal(frame, id)) }
                @if frame.may(Role::Owner) && hosting.is_uploaded { (actions::hosting(frame, study)) }
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

/// Some sessions have changed more than can be counted while somebody waits.
fn behind(frame: &Frame, sessions: usize) -> Markup {
    html! {
        p.soft role="status" {
            (frame.say(
                "Of so many sessions the figures below do not count the newest events yet: ",
                "Pour ce nombre de sessions, les chiffres ci-dessous ne comptent pas encore les derniers événements : ",
            ))
            (sessions) "."
        }
    }
}

/// How many participants there are of each standing.
fn counts(frame: &Frame, overview: &Overview) -> Markup {
    html! {
        dl.counts {
            @for (standing, count) in &overview.standings {
                div { dt { (standing_word(*standing, frame.language)) } dd { (count) } }
            }
            @if overview.excluded > 0 {
                div { dt { (frame.say("excluded", "exclus")) } dd { (overview.excluded) } }
            }
        }
    }
}
