//! Sections of a report about measures: recognition, ratings, timing.

use mimique_study::QuestionKind;

use super::comparison::within;
use super::document::{Block, DataTable, slug};
use super::export::AskedQuestion;
use super::figure;
use super::figure_people;
use super::measure::{Measure, MeasureKind};
use super::person_level;
use super::reading;
use super::sections::{LateFrames, NamedConfusion, TwoWay, Writer};
use super::tables;
use super::test_line::TestLine;
use super::trial_level::TrialLevel;
use crate::confusion::confusion;
use crate::factor::Factor;
use crate::proportion::Proportion;

impl Writer<'_> {
    /// Forced choice against the right answer.
    pub(crate) fn recognition(&mut self, asked: &AskedQuestion<'_>, measure: &Measure) {
        let language = self.language();
        let title = language.pick(
            format!("Recognition: {}", measure.label),
            format!("Reconnaissance : {}", measure.label),
        );
        self.blocks.push(Block::Heading(2, title));
        let truth = match asked.question.map(|question| &question.kind) {
            Some(QuestionKind::SingleChoice(choice)) => choice.truth.clone().unwrap_or_default(),
            _ => String::new(),
        };
        self.confusion_matrices(asked, &truth);

        let chance = match asked.question.map(|question| question.kind.options().len()) {
            Some(options) if options > 1 => Some(1.0 / options as f64),
            _ => None,
        };
        let names = self.factors.clone();
        let method = names.iter().find(|name| **name != truth);
        let mut groups = Vec::new();
        let first = method.map(|name| measure.factor(self.export, name, &[]));
        if let (Some(first), true) = (&first, names.contains(&truth)) {
            let second = measure.factor(self.export, &truth, &[]);
            for (b, shown) in second.levels.iter().enumerate() {
                let rows = (0..first.levels.len())
                    .map(|a| {
                        let share = self.shares_by(measure, |i| {
                            first.codes[i] as usize == a && second.codes[i] as usize == b
                        });
                        (self.naming.level(&first.name, &first.levels[a]), share)
                    })
                    .collect();
                groups.push((self.naming.level(&truth, shown), rows));
            }
        }
        if let Some(first) = &first {
            let rows = (0..first.levels.len())
                .map(|a| {
                    let share = self.shares_by(measure, |i| first.codes[i] as usize == a);
                    (self.naming.level(&first.name, &first.levels[a]), share)
                })
                .collect();
            groups.insert(0, (language.pick("all", "toutes").to_owned(), rows));
        }
        if !groups.is_empty() {
            let caption = language.pick(
                "Share of right answers over all trials, with Wilson’s 95 % interval",
                "Part de réponses justes sur tous les essais, avec l’intervalle de Wilson à 95 %",
            );
            let id = format!("{}-shares", slug(&measure.id));
            self.figure(figure::shares(language, &id, caption, chance, &groups));
            self.person_shares(measure, chance);
            self.paragraph(
                "These intervals describe the trials; comparisons follow below on one value a person.",
                "Ces intervalles décrivent les essais ; les comparaisons suivent, sur une valeur par personne.",
            );
        }
        self.comparisons(measure);
    }

    fn confusion_matrices(&mut self, asked: &AskedQuestion<'_>, truth: &str) {
        let language = self.language();
        let answers: Vec<_> =
            self.export.answers.iter().filter(|answer| answer.question == asked.id).collect();
        let group = self.factors.iter().find(|name| *name != truth).cloned();
        let levels: Vec<Option<String>> = match &group {
            None => vec![None],
            Some(name) => {
                let all = Factor::from_cells(
                    name,
                    answers.iter().map(|answer| self.export.level(answer, name)),
                    |level| level.parse().ok(),
                );
                all.levels.into_iter().map(Some).chain([None]).collect()
            }
        };
        for level in levels {
            let chosen: Vec<_> = answers
                .iter()
                .filter(|answer| match (&group, &level) {
                    (Some(name), Some(level)) => {
                        self.export.level(answer, name) == Some(level.as_str())
                    }
                    _ => true,
                })
                .collect();
            let shown = Factor::from_cells(
                "truth",
                chosen.iter().map(|answer| answer.truth.as_deref()),
                |_| None,
            );
            let answered =
                Factor::from_cells(&asked.id, chosen.iter().map(|a| Some(a.text.as_str())), |_| {
                    None
                });
            let Ok(result) = confusion(&shown, &answered) else { continue };
            let of = match (&group, &level) {
                (Some(name), Some(level)) => self.naming.level(name, level),
                _ => language.pick("All trials", "Tous les essais").to_owned(),
            };
            let id = format!(
                "{}-confusion-{}",
                slug(&asked.id),
                slug(level.as_deref().unwrap_or("all"))
            );
            let drawing = figure::confusion(language, &id, &of, &result, |label| {
                self.naming.level(truth, label)
            });
            self.figure(drawing);
            let by = group.clone().filter(|_| level.is_some());
            let of = level.unwrap_or_else(|| "all".to_owned());
            self.results.confusion.push(NamedConfusion {
                response: asked.id.clone(),
                by,
                of,
                result,
            });
        }
    }

    /// A rating: its answers by each factor, its tests, its interactions with the first factor.
    pub(crate) fn rating(&mut self, asked: &AskedQuestion<'_>, measure: &Measure) {
        let language = self.language();
        let title = language
            .pick(format!("Rating: {}", measure.label), format!("Note : {}", measure.label));
        self.blocks.push(Block::Heading(2, title));
        if let Some(question) = asked.question
            && let QuestionKind::Likert(likert) = &question.kind
        {
            let code = language.code();
            let end = |label: &Option<mimique_study::LocalText>| {
                label.as_ref().map_or_else(String::new, |text| text.in_language(code).to_owned())
            };
            self.blocks.push(Block::Paragraph(language.pick(
                format!(
                    "{} is “{}”, {} is “{}”.",
                    likert.start,
                    end(&likert.left_label),
                    likert.end(),
                    end(&likert.right_label)
                ),
                format!(
                    "{} signifie « {} », {} signifie « {} ».",
                    likert.start,
                    end(&likert.left_label),
                    likert.end(),
                    end(&likert.right_label)
                ),
            )));
        }
        for name in self.factors.clone() {
            let factor = measure.factor(self.export, &name, &[]);
            if factor.levels.len() < 2 {
                continue;
            }
            let rows: Vec<(String, Vec<f64>)> = values_by_level(measure, &factor)
                .into_iter()
                .map(|(level, values)| (self.naming.level(&name, &level), values))
                .collect();
            let caption = language.pick(
                format!("All answers by {}", self.naming.factor(&name)),
                format!("Toutes les réponses par {}", self.naming.factor(&name)),
            );
            let id = format!("{}-by-{}", slug(&measure.id), slug(&name));
            let drawing = match measure.scale {
                Some((first, last)) if last - first <= 10 => {
                    figure::likert(language, &id, &caption, (first, last), &rows)
                }
                _ => figure::boxes(language, &id, &caption, &measure.label, &rows),
            };
            self.figure(drawing);
        }
        self.comparisons(measure);
        let Some(first) = self.factors.first().cloned() else { return };
        for second in self.factors.clone().into_iter().skip(1) {
            self.interaction(measure, [&first, &second]);
        }
    }

    /// A measure against each factor.
    fn comparisons(&mut self, measure: &Measure) {
        let language = self.language();
        for name in self.factors.clone() {
            let factor = measure.factor(self.export, &name, &[]);
            if factor.levels.len() < 2 {
                continue;
            }
            let result = within(self.export, measure, &factor);
            let shown = self.naming.factor(&name);
            let without = result.trials_without_level;
            self.blocks.push(Block::Heading(
                3,
                language.pick(format!("By {shown}"), format!("Par {shown}")),
            ));
            if without > 0 {
                self.blocks.push(Block::Paragraph(language.pick(
                    format!("{without} trials have no value of {shown} (their method has no such parameter): they take no part in this comparison."),
                    format!("{without} essais n’ont pas de valeur de {shown} (leur méthode n’a pas ce paramètre) : ils ne prennent pas part à cette comparaison."),
                )));
            }
            let id = format!("{}-by-{}", slug(&measure.id), slug(&name));
            let caption = language.pick(
                format!("{} by {shown}", measure.label),
                format!("{} par {shown}", measure.label),
            );
            let table = if measure.kind == MeasureKind::Recognition {
                let shares: Vec<(String, Proportion)> = (0..factor.levels.len())
                    .map(|code| {
                        let share = self.shares_by(measure, |i| factor.codes[i] as usize == code);
                        (factor.levels[code].clone(), share)
                    })
                    .collect();
                let means = &result.person_means;
                tables::recognition(
                    &self.naming,
                    format!("{id}-described"),
                    caption,
                    &name,
                    &shares,
                    means,
                )
            } else {
                tables::descriptions(&self.naming, format!("{id}-described"), caption, &result)
            };
            self.blocks.push(Block::Table(table));
            if self.factors.first() == Some(&name) {
                self.person_lines(measure, &factor);
            }
            if result.recommended.people > 0 && (1..=3).contains(&result.recommended.pairs.len()) {
                let pairs: Vec<(String, &person_level::Pair)> = result
                    .recommended
                    .pairs
                    .iter()
                    .map(|pair| (self.naming.pair(&name, &pair.a, &pair.b), pair))
                    .collect();
                let caption = language.pick(
                    "Difference of each person’s means, with the Hodges-Lehmann estimate and its 95 % interval",
                    "Différence des moyennes de chaque personne, avec l’estimation de Hodges-Lehmann et son intervalle à 95 %",
                );
                let drawing =
                    figure::differences(language, &format!("{id}-differences"), caption, &pairs);
                self.figure(drawing);
            }
            let table = tables::two_columns(
                &self.naming,
                format!("{id}-tests"),
                language.pick(
                    format!("Tests of {shown}: as in the thesis and recommended"),
                    format!("Tests de {shown} : comme dans la thèse et recommandés"),
                ),
                &name,
                measure.kind,
                &result.as_in_the_thesis,
                &result.recommended,
            );
            self.blocks.push(Block::Table(table));
            let pairs_id = format!("{id}-pairs");
            let people = &result.recommended;
            let pairs = tables::many_pairs(&self.naming, pairs_id, &name, measure.kind, people);
            self.blocks.extend(pairs.map(Block::Table));
            let words = reading::comparison(&self.naming, &result, &measure.label);
            self.blocks.push(Block::Reading(words));
            self.results.comparisons.push(result);
        }
    }

    fn interaction(&mut self, measure: &Measure, names: [&str; 2]) {
        let language = self.language();
        let factors = names.map(|name| measure.factor(self.export, name, &[]));
        if factors.iter().any(|factor| factor.levels.len() < 2) {
            return;
        }
        let both = [&factors[0], &factors[1]];
        let trials =
            TrialLevel::new(TestLine::scheirer_ray_hare(&measure.numbers(), both, "trials"));
        let people = person_level::two_way(self.export, measure, both);
        let shown = names.map(|name| self.naming.factor(name)).join(" × ");
        self.blocks.push(Block::Heading(3, shown.clone()));
        let table = tables::two_columns(
            &self.naming,
            format!("{}-{}-{}", slug(&measure.id), slug(names[0]), slug(names[1])),
            language.pick(
                format!("{shown}: as in the thesis and recommended"),
                format!("{shown} : comme dans la thèse et recommandé"),
            ),
            names[0],
            measure.kind,
            &trials,
            &people,
        );
        self.blocks.push(Block::Table(table));
        self.results.two_way.push(TwoWay {
            measure: measure.id.clone(),
            factors: names.map(str::to_owned),
            as_in_the_thesis: trials,
            recommended: people,
        });
    }

    /// Response times and late frames.
    pub(crate) fn timing(&mut self) {
        let language = self.language();
        self.heading(2, "Timing", "Temps");
        let asked = self.export.questions(self.study);
        let Some(first) = self.factors.first().cloned() else { return };
        if let Some(asked) = asked.first()
            && let Some(measure) = Measure::response_time(self.export, asked, language)
        {
            let factor = measure.factor(self.export, &first, &[]);
            let rows: Vec<(String, Vec<f64>)> = values_by_level(&measure, &factor)
                .into_iter()
                .map(|(level, values)| (self.naming.level(&first, &level), values))
                .collect();
            let caption = language.pick(
                format!("Time from the first frame to the last answer to “{}”: median, quartiles, 5th and 95th percentile", asked.label("en")),
                format!("Temps de la première image à la dernière réponse à « {} » : médiane, quartiles, 5e et 95e centiles", asked.label("fr")),
            );
            let unit = language.pick("seconds", "secondes");
            self.figure(figure::boxes(language, "response-times", &caption, unit, &rows));
            if factor.levels.len() > 1 && measure.kind == MeasureKind::ResponseTime {
                let result = within(self.export, &measure, &factor);
                let words = reading::comparison(&self.naming, &result, &measure.label);
                self.blocks.push(Block::Reading(words));
                self.results.comparisons.push(result);
            }
        }
        self.late_frames(&first);
    }

    fn late_frames(&mut self, name: &str) {
        let language = self.language();
        let Some(place) = self.export.factors.iter().position(|factor| factor == name) else {
            return;
        };
        let cells = self.export.trials.iter().map(|trial| trial.levels[place].as_deref());
        let factor = Factor::from_cells(name, cells, |level| level.parse().ok());
        let heading = language.pick(
            [
                "",
                "trials",
                "frames",
                "late frames",
                "share",
                "trials with late frames",
                "longest frame (ms)",
            ],
            [
                "",
                "essais",
                "images",
                "en retard",
                "part",
                "essais avec retard",
                "image la plus longue (ms)",
            ],
        );
        let caption = language.pick(
            format!("Frames that came late, by {}", self.naming.factor(name)),
            format!("Images en retard, par {}", self.naming.factor(name)),
        );
        let mut table = DataTable::new("late-frames", caption, heading);
        for (code, level) in factor.levels.iter().enumerate() {
            let trials = || {
                self.export
                    .trials
                    .iter()
                    .zip(&factor.codes)
                    .filter(|(trial, own)| **own as usize == code && trial.frames.is_some())
                    .map(|(trial, _)| trial)
            };
            let result = LateFrames {
                level: level.clone(),
                trials: trials().count(),
                frames: trials().filter_map(|trial| trial.frames).sum(),
                late: trials().filter_map(|trial| trial.late).sum(),
                trials_with_late_frames: trials().filter(|trial| trial.late > Some(0.0)).count(),
                longest_ms: trials().filter_map(|trial| trial.longest_ms).reduce(f64::max),
            };
            let share = if result.frames > 0.0 {
                format!("{} %", language.fixed(result.late / result.frames * 100.0, 2))
            } else {
                "–".to_owned()
            };
            table.row([
                self.naming.level(name, level),
                result.trials.to_string(),
                format!("{:.0}", result.frames),
                format!("{:.0}", result.late),
                share,
                result.trials_with_late_frames.to_string(),
                result.longest_ms.map_or_else(|| "–".to_owned(), |ms| language.fixed(ms, 1)),
            ]);
            self.results.late_frames.push(result);
        }
        self.blocks.push(Block::Table(table));
        let rows: Vec<(String, Vec<f64>)> = factor
            .levels
            .iter()
            .enumerate()
            .map(|(code, level)| {
                let own = self.export.trials.iter().zip(&factor.codes);
                let own = own.filter(|(_, own)| **own as usize == code).map(|(trial, _)| trial);
                let shares = own.filter_map(|trial| Some((trial.late?, trial.frames?)));
                let shares = shares.filter(|(_, frames)| *frames > 0.0);
                (self.naming.level(name, level), shares.map(|(late, all)| late / all).collect())
            })
            .filter(|(_, shares): &(String, Vec<f64>)| !shares.is_empty())
            .collect();
        if !rows.is_empty() {
            let caption = language.pick(
                format!("Trials by their share of late frames, by {}", self.naming.factor(name)),
                format!(
                    "Essais selon leur part d’images en retard, par {}",
                    self.naming.factor(name)
                ),
            );
            let drawing =
                figure_people::late_frames(language, "late-frames-share", &caption, &rows);
            self.figure(drawing);
        }
    }
}

fn values_by_level(measure: &Measure, factor: &Factor) -> Vec<(String, Vec<f64>)> {
    factor
        .levels
        .iter()
        .enumerate()
        .map(|(code, level)| {
            let values = (0..measure.values.len())
                .filter(|&i| factor.codes[i] as usize == code)
                .map(|i| measure.values[i])
                .collect();
            (level.clone(), values)
        })
        .collect()
}
