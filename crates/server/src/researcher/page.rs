//! The researcher's page as HTML: nothing inline, complete without its script.

use std::sync::Arc;

use maud::{DOCTYPE, Markup, html};
use mimique_study::responses::iso_time;

use super::distribution::{Distribution, Shape};
use super::overview::Overview;
use super::session_view::{SessionView, Standing};
use crate::export::Format;
use crate::hosted::HostedStudy;
use crate::storage::SessionRecord;

/// The page for those who may see it; the script in it brings the part with `data-live` up to date.
pub(crate) fn dashboard(assets: &str, studies: &[(Arc<HostedStudy>, Overview)]) -> String {
    let body = html! {
        header.site-header.wide {
            span.title { "Mimique" }
            span.soft { "researcher’s page" }
        }
        main.page.wide data-live="" {
            h1.visually-hidden { "Studies" }
            @for (study, overview) in studies {
                (study_section(study, overview))
            }
        }
    };
    document(assets, "Researcher’s page", true, &body)
}

/// The page for those who may not.
pub(crate) fn denied(assets: &str) -> String {
    let body = html! {
        main.page {
            div.card {
                h1 { "This page is the researcher’s" }
                p {
                    "Open the address that " code { "mimique serve" }
                    " printed when it started. It works for seven days; each start prints a new one."
                }
            }
        }
    };
    document(assets, "Researcher’s page", false, &body)
}

fn document(assets: &str, title: &str, live: bool, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="robots" content="noindex";
                meta name="color-scheme" content="light dark";
                title { (title) }
                link rel="icon" href={ (assets) "/icon.svg" } type="image/svg+xml";
                link rel="stylesheet" href={ (assets) "/style.css" };
                link rel="stylesheet" href={ (assets) "/researcher.css" };
                @if live {
                    script type="module" src={ (assets) "/researcher.js" } {}
                }
            }
            body { (body) }
        }
    };
    page.into_string()
}

fn study_section(study: &HostedStudy, overview: &Overview) -> Markup {
    let language = study.study().default_language();
    let id = study.id();
    html! {
        section.study aria-labelledby={ "study-" (id) } {
            div.card {
                h2 id={ "study-" (id) } lang=(language) { (study.title(language)) }
                p.soft {
                    code { (id) } " · " (study.stage().word()) " · version "
                    code { (&study.config_hash()[..12]) } " · "
                    a href={ "/s/" (id) "/" } { "participant’s page" } " · "
                    a href={ "/preview/" (id) } { "preview of the stimuli" }
                }
                dl.counts {
                    @for (standing, count) in &overview.standings {
                        div { dt { (standing.word()) } dd { (count) } }
                    }
                    @if let Some(wanted) = study.study().recruitment.participants {
                        div { dt { "wanted" } dd { (wanted) } }
                    }
                }
                (exports(id))
            }
            (participants(overview))
            @if !overview.balance.is_empty() { (balance(overview)) }
            @if !overview.distributions.is_empty() { (answers(&overview.distributions, language)) }
        }
    }
}

fn exports(id: &str) -> Markup {
    let label = |format| match format {
        Format::Csv => "Tidy CSV",
        Format::Wide => "Wide CSV",
        Format::Json => "JSON lines",
        Format::Events => "All events",
        Format::PsychDs => "Psych-DS (ZIP)",
    };
    html! {
        h3 { "Export" }
        div.row {
            @for format in Format::ALL {
                a.button href={ "/researcher/" (id) "/export/" (format.word()) } download {
                    (label(format))
                }
            }
        }
    }
}

fn participants(overview: &Overview) -> Markup {
    html! {
        div.card {
            h3 { "Participants" }
            @if overview.sessions.is_empty() {
                p.soft { "Nobody yet." }
            } @else {
                div.table-scroll tabindex="0" role="region" aria-label="Participants" {
                    table {
                        thead { tr {
                            th scope="col" { "Participant" }
                            th scope="col" { "Status" }
                            th scope="col" { "Progress" }
                            th scope="col" { "At" }
                            th scope="col" { "Started" }
                            th scope="col" { "Last event" }
                            th.number scope="col" { "Events" }
                            th scope="col" { "Browser" }
                        } }
                        tbody {
                            // The newest first: they are the ones to be watched.
                            @for (session, view) in overview.sessions.iter().rev() {
                                (participant(session, view, overview.conflicts.get(&session.key)))
                            }
                        }
                    }
                }
            }
        }
    }
}

fn participant(session: &SessionRecord, view: &SessionView, conflicts: Option<&u64>) -> Markup {
    let tag = match view.standing {
        Standing::Completed => "tag good",
        Standing::Active => "tag",
        Standing::Declined | Standing::Withdrawn => "tag warn",
    };
    html! {
        tr {
            th scope="row" { (crate::participant_id(session.participant)) }
            td {
                span class=(tag) { (view.standing.word()) }
                @if session.event_count < session.next_sequence {
                    " " span class="tag warn" { "events missing" }
                }
                @if let Some(conflicts) = conflicts {
                    " " span class="tag bad" { (conflicts) " conflicting" }
                }
            }
            td.progress {
                @if let (Some((done, all)), true) = (view.progress, view.standing != Standing::Withdrawn) {
                    progress max=(all) value=(done) aria-label={ (done) " of " (all) " steps" } {}
                    span.number { (done) "/" (all) }
                }
            }
            td { @if view.standing == Standing::Active { (view.step) } }
            td { (time(Some(session.started_ms))) }
            td { (time(session.last_event_ms)) }
            td.number { (session.event_count) }
            td.browser { (browser(&session.client)) }
        }
    }
}

fn balance(overview: &Overview) -> Markup {
    html! {
        div.card {
            h3 { "Condition balance" }
            p.soft { "Finished trials of participants who completed the study." }
            div.distributions {
                @for (factor, levels) in &overview.balance {
                    (bars(factor, levels.iter().map(|(level, count)| (level.as_str(), *count))))
                }
            }
        }
    }
}

fn answers(distributions: &[Distribution], language: &str) -> Markup {
    html! {
        div.card {
            h3 { "Answers" }
            p.soft { "Every participant’s, practice left out." }
            div.distributions lang=(language) {
                @for distribution in distributions {
                    (answer(distribution))
                }
            }
        }
    }
}

fn answer(distribution: &Distribution) -> Markup {
    let caption = html! {
        (distribution.prompt) " " code { (distribution.question) }
    };
    match &distribution.shape {
        Shape::Counts(counts) => {
            bars_with(&caption, counts.iter().map(|(label, count)| (label.as_str(), *count)))
        }
        Shape::Numbers { count, least, mean, greatest } => html! {
            div {
                p.caption { (caption) }
                p lang="en" {
                    (count) " answers, from " (round(*least)) " to " (round(*greatest))
                    ", mean " (round(*mean))
                }
            }
        },
        Shape::Texts(count) => html! {
            div { p.caption { (caption) } p lang="en" { (count) " answers" } }
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

/// `2026-11-21 08:30` in a `time` element that scripts turn into the reader's own time.
fn time(at_ms: Option<i64>) -> Markup {
    let Some(at_ms) = at_ms else { return html! {} };
    let text = iso_time(at_ms as f64);
    let short = text.get(..16).map(|text| text.replace('T', " ")).unwrap_or_default();
    html! { time datetime=(text) { (short) " UTC" } }
}

/// What the page said of its browser, name and version first: `Firefox 140, Linux`.
fn browser(client: &str) -> String {
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

    #[test]
    fn times_are_in_the_page_for_people_and_for_scripts() {
        let markup = time(Some(1_795_251_845_678)).into_string();
        let expected = "<time datetime=\"2026-11-21T09:04:05.678Z\">2026-11-21 09:04 UTC</time>";
        assert_eq!(markup, expected);
    }
}
