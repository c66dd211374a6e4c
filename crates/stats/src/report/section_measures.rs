//! Sections of a report about measures: ratings, and any measure against the factors of the clips.

use mimique_study::QuestionKind;

use super::comparison::within;
use super::document::{Block, slug};
use super::export::AskedQuestion;
use super::figure;
use super::measure::{Measure, MeasureKind};
use super::person_level;
use super::reading;
use super::results::TwoWay;
use super::sections::Writer;
use super::tables;
use super::test_line::TestLine;
use super::trial_level::TrialLevel;
use crate::factor::Factor;
use crate::proportion::Proportion;

impl Writer<'_> {
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
    pub(crate) fn comparisons(&mut self, measure: &Measure) {
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
}

/// Values of each level, in the order of the levels.
pub(crate) fn values_by_level(measure: &Measure, factor: &Factor) -> Vec<(String, Vec<f64>)> {
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
