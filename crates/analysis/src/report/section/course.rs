//! Sections of a report about people and about time: lines of each person, the course of the session.

use mimique_locale::Language;
use mimique_report::document::{Block, slug};
use mimique_stats::{Factor, Numbers, Outcome, describe, proportion};
use serde::Serialize;

use crate::hypothesis::person_level;
use crate::hypothesis::undefined::TestOutcome;
use crate::naming::people_counted;
use crate::report::figure::people::{self, Part};
use crate::report::section::Writer;
use crate::trials::measure::{Measure, MeasureKind};

/// Parts that a session is cut into.
const PARTS: usize = 6;

/// A measure over the course of the session.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Course {
    pub measure: String,
    /// Wilcoxon of each person's correlation with the place of the trial.
    pub trend: TestOutcome,
}

impl Writer<'_> {
    /// A line a person over the levels of the factor that the study compares.
    pub(crate) fn person_lines(&mut self, measure: &Measure, factor: &Factor) {
        let language = self.language();
        let matching = measure.matching(self.export, factor);
        let blocks = measure.person_means(self.export, factor, &matching);
        if blocks.responses.is_empty() {
            return;
        }
        let levels: Vec<String> =
            factor.levels.iter().map(|level| self.naming.level(&factor.name, level)).collect();
        let people: Vec<(String, Vec<f64>)> =
            blocks.blocks.into_iter().zip(blocks.responses).collect();
        let id = format!("{}-by-{}-people", slug(&measure.id), slug(&factor.name));
        let caption = language.pick(
            "Mean of each person at each level, and the mean of all people",
            "Moyenne de chaque personne à chaque niveau, et moyenne de toutes les personnes",
        );
        let factor = self.naming.factor(&factor.name);
        let levels = (factor.as_str(), levels.as_slice());
        self.figure(people::person_lines(language, &id, caption, measure.kind, levels, &people));
    }

    /// Right answers of each person.
    pub(crate) fn person_shares(&mut self, measure: &Measure, chance: Option<f64>) {
        let language = self.language();
        let mut counts = vec![(0_u64, 0_u64); measure.people()];
        for (&person, &value) in measure.person.iter().zip(&measure.values) {
            counts[person].0 += u64::from(value > 0.5);
            counts[person].1 += 1;
        }
        let people: Vec<_> = counts
            .into_iter()
            .enumerate()
            .filter(|(_, (_, all))| *all > 0)
            .map(|(person, (right, all))| {
                (self.export.people[person].id.clone(), proportion(right, all))
            })
            .collect();
        let id = format!("{}-people", slug(&measure.id));
        let caption = language.pick(
            "Share of right answers of each person, with Wilson’s 95 % interval",
            "Part de réponses justes de chaque personne, avec l’intervalle de Wilson à 95 %",
        );
        self.figure(people::person_shares(language, &id, caption, chance, &people));
    }

    /// Do answers change as the session goes on?
    pub(crate) fn course_of_the_session(&mut self, measures: &[&Measure]) {
        let language = self.language();
        let last = self.export.trials.iter().filter_map(|trial| trial.order).max().unwrap_or(0);
        if last < 2 || measures.is_empty() {
            return;
        }
        self.heading(2, "Course of the session", "Au fil de la session");
        self.paragraph(
            "Trials were shown in an order of each person’s own, so what changes with the place of a trial is practice or fatigue. The test asks whether people’s own correlations with the place lean one way.",
            "Les essais ont été présentés dans un ordre propre à chaque personne : ce qui change avec le rang d’un essai est un effet d’entraînement ou de fatigue. Le test demande si les corrélations propres aux personnes avec le rang penchent d’un côté.",
        );
        let mut drawings = Vec::new();
        for measure in measures {
            let place = Numbers {
                name: "trial_order".to_owned(),
                values: measure
                    .trial
                    .iter()
                    .map(|&trial| self.export.trials[trial].order.map_or(f64::NAN, |o| o as f64))
                    .collect(),
            };
            let parts = parts(measure, &place.values, last);
            if parts.len() < 2 {
                continue;
            }
            let trend = person_level::correlation_within_people(&place, measure);
            let unit = if measure.kind == MeasureKind::Recognition {
                language.pick(" (share of right answers)", " (part de réponses justes)")
            } else {
                ""
            };
            let caption = language.pick(
                format!("{}{unit} by the place of the trial: mean of people, 95 % t interval", measure.label),
                format!("{}{unit} selon le rang de l’essai : moyenne des personnes, intervalle t à 95 %", measure.label),
            );
            let id = format!("course-{}", slug(&measure.id));
            let drawing = people::course(language, &id, &caption, measure.kind, &parts);
            drawings.push(drawing);
            let words = trend_in_words(language, &measure.label, &trend);
            self.blocks.push(Block::Reading(words));
            self.results.course.push(Course { measure: measure.id.clone(), trend });
        }
        for drawing in drawings {
            self.figure(drawing);
        }
    }
}

/// Whether answers change with the place of the trial.
fn trend_in_words(language: Language, label: &str, trend: &TestOutcome) -> String {
    match trend {
        Outcome::Ok(line) => {
            let p = language.p(line.row.p_value);
            let rho = language.fixed(line.row.effect.unwrap_or(0.0), 2);
            if line.row.p_value < 0.05 {
                language.pick(
                    format!("{label}: answers change as the session goes on: median correlation of people with the place of the trial {rho}, {p}, {}.", people_counted(language, line.row.n)),
                    format!("{label} : les réponses changent au fil de la session : corrélation médiane des personnes avec le rang de l’essai {rho}, {p}, {}.", people_counted(language, line.row.n)),
                )
            } else {
                language.pick(
                    format!("{label}: no change over the session was shown: median correlation of people with the place of the trial {rho}, {p}, {}; that is no proof that there is none.", people_counted(language, line.row.n)),
                    format!("{label} : aucun changement au fil de la session n’a été montré : corrélation médiane des personnes avec le rang de l’essai {rho}, {p}, {} ; cela ne prouve pas qu’il n’y en a pas.", people_counted(language, line.row.n)),
                )
            }
        }
        Outcome::Undefined { reason } => {
            let reason = reason.words(language);
            language.pick(
                format!("{label}: no test is defined ({reason})."),
                format!("{label} : aucun test n’est défini ({reason})."),
            )
        }
    }
}

/// Mean over people of their means in each part of the session.
fn parts(measure: &Measure, places: &[f64], last: usize) -> Vec<Part> {
    let count = PARTS.min(last);
    let border = |part: usize| part * last / count;
    (0..count)
        .filter_map(|part| {
            let (first, last) = (border(part) + 1, border(part + 1));
            let mut sums = vec![(0.0, 0.0); measure.people()];
            for (i, &place) in places.iter().enumerate() {
                if place >= first as f64 && place <= last as f64 {
                    let cell = &mut sums[measure.person[i]];
                    cell.0 += measure.values[i];
                    cell.1 += 1.0;
                }
            }
            let met = sums.iter().filter(|(_, n)| *n > 0.0);
            let means: Vec<f64> = met.map(|(sum, n)| sum / n).collect();
            let described = describe(&means).ok()?;
            let mean = described.mean;
            let interval = described.mean_ci_t.unwrap_or([mean, mean]);
            Some(Part { trials: (first, last), mean, interval, people: means.len() })
        })
        .collect()
}
