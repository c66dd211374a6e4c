//! What the trials came to: the balance of their conditions, their times, late frames, attention checks.

use maud::{Markup, html};

use super::bars::{bars, plain, round};
use crate::researcher::dashboard::figures::Times;
use crate::researcher::dashboard::overview::Overview;
use crate::researcher::pages::frame::Frame;

/// Finished trials of each level of each factor.
pub(super) fn balance(frame: &Frame, overview: &Overview) -> Markup {
    html! {
        div.card {
            h2 { (frame.say("Condition balance", "Équilibre des conditions")) }
            p.soft {
                (frame.say(
                    "Clips in finished trials of participants who completed the study, both of a pair.",
                    "Extraits des essais finis des participants qui ont terminé l’étude, les deux d’une paire.",
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

/// The time that trials take, by their place in the order.
pub(super) fn times(frame: &Frame, times: &[Times]) -> Markup {
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
                                    td.bar { progress aria-hidden="true" max=(plain(most)) value=(plain(row.median_s)) {} }
                                    td.number { (round(frame.language, row.median_s)) " s" }
                                    td.number { (round(frame.language, row.low_s)) "–" (round(frame.language, row.high_s)) " s" }
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

/// Frames that were shown late, by device.
pub(super) fn frames(frame: &Frame, overview: &Overview) -> Markup {
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
                                    td.number { (round(frame.language, 100.0 * row.late as f64 / row.frames.max(1) as f64)) " %" }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Attention checks passed and failed.
pub(super) fn checks(frame: &Frame, overview: &Overview) -> Markup {
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
