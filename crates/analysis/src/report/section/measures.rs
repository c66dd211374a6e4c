//! Sections of a report about measures: ratings, and any measure against the factors of the clips.

use mimique_report::document::{Block, DataTable, slug};
use mimique_stats::{Factor, Proportion};
use mimique_study::{AnswerOfPair, KindOfQuestion as _, Measure as What};

use crate::hypothesis::comparison::{Comparison, within};
use crate::hypothesis::not_tested::of_pair_in_words;
use crate::hypothesis::person_level::{self, Pair};
use crate::hypothesis::reading;
use crate::hypothesis::test_line::{TestLine, Unit};
use crate::hypothesis::trial_level::TrialLevel;
use crate::report::figure;
use crate::report::results::TwoWay;
use crate::report::section::Writer;
use crate::report::tables;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::measure::{Measure, MeasureKind};

impl Writer<'_> {
    /// A rating: its answers by each factor, its tests, its interactions with the first factor.
    pub(crate) fn rating(&mut self, asked: &AskedQuestion<'_>, measure: &Measure) {
        let language = self.language();
        let title = language
            .pick(format!("Rating: {}", measure.label), format!("Note : {}", measure.label));
        self.blocks.push(Block::Heading(2, title));
        let kind = asked.question.map(|question| &question.kind);
        if let Some(points) = kind.and_then(|kind| kind.points())
            && let Some(ends) = kind.and_then(|kind| kind.ends())
        {
            let [low, high] =
                ends.map(|end| end.map_or("", |text| text.in_language(language.code())));
            let (first, last) = (points.start(), points.end());
            self.blocks.push(Block::Paragraph(language.pick(
                format!("{first} is “{low}”, {last} is “{high}”."),
                format!("{first} signifie « {low} », {last} signifie « {high} »."),
            )));
        }
        let factors = self.factors_told(asked);
        for name in &factors {
            let factor = measure.factor(self.export, name, &[]);
            if factor.levels.len() < 2 {
                continue;
            }
            let (matched, factor) = measure.matched(self.export, &factor);
            let rows: Vec<(String, Vec<f64>)> = values_by_level(&matched, &factor)
                .into_iter()
                .map(|(level, values)| (self.naming.level(name, &level), values))
                .collect();
            let shown = self.naming.factor(name);
            let caption = match matched.values.len() == measure.values.len() {
                true => language.pick(
                    format!("All answers by {shown}"),
                    format!("Toutes les réponses par {shown}"),
                ),
                false => language.pick(
                    format!("Compared answers by {shown}"),
                    format!("Réponses comparées par {shown}"),
                ),
            };
            let id = format!("{}-by-{}", slug(&measure.id), slug(name));
            let drawing = match measure.scale {
                Some((first, last)) if last - first <= 10 => {
                    figure::likert(language, &id, &caption, (first, last), &rows)
                }
                _ => figure::boxes(language, &id, &caption, &measure.label, &rows),
            };
            self.figure(drawing);
        }
        self.traces(measure, &factors);
        self.comparisons(measure, &factors);
        let Some((first, others)) = factors.split_first() else { return };
        if others.is_empty() {
            return;
        }
        let heading = language.pick(
            format!("Tables: interactions, {}", measure.label),
            format!("Tableaux : interactions, {}", measure.label),
        );
        self.folded(heading, |writer| {
            for second in others {
                writer.interaction(measure, [first, second]);
            }
        });
    }

    /// The factors in use that answers to a question can be told of. Why the others are none of them is
    /// written.
    pub(crate) fn factors_told(&mut self, asked: &AskedQuestion<'_>) -> Vec<String> {
        let mut told = Vec::new();
        for factor in self.factors.clone() {
            match self.of_pair(asked, What::Answer, &factor) {
                None => told.push(factor),
                Some(why) => {
                    let mut words = of_pair_in_words(&why, self.language());
                    words.push('.');
                    self.blocks.push(Block::Caution(words));
                }
            }
        }
        told
    }

    /// Why answers to a question cannot be told of a factor, where they are about two clips.
    pub(crate) fn of_pair(
        &self,
        asked: &AskedQuestion<'_>,
        measure: What,
        factor: &str,
    ) -> Option<AnswerOfPair> {
        self.study.answer_of_pair(asked.question?, measure, factor, &[])
    }

    /// A measure against each of some factors.
    pub(crate) fn comparisons(&mut self, measure: &Measure, factors: &[String]) {
        for name in factors {
            let factor = measure.factor(self.export, name, &[]);
            if factor.levels.len() >= 2 {
                self.comparison(measure, &factor);
            }
        }
    }

    /// A measure against a factor: described, drawn, tested in both columns, read.
    fn comparison(&mut self, measure: &Measure, factor: &Factor) {
        let language = self.language();
        let name = &factor.name;
        let result = within(self.export, measure, factor);
        let shown = self.naming.factor(name);
        let without = result.trials_without_level;
        self.blocks
            .push(Block::Heading(3, language.pick(format!("By {shown}"), format!("Par {shown}"))));
        if without > 0 {
            let words = reading::trials_without_level(language, without);
            self.blocks.push(Block::Paragraph(words));
        }
        let words = reading::comparison(&self.naming, &result, &measure.label);
        let unmatched = reading::unmatched(&self.naming, &result.matching);
        self.blocks.extend(unmatched.map(Block::Paragraph));
        self.blocks.push(Block::Reading(words));
        let spoken = reading::distribution(&self.naming, &result.answer_distribution, measure.kind);
        self.blocks.extend(spoken.map(Block::Caution));
        let id = format!("{}-by-{}", slug(&measure.id), slug(name));
        if self.factors.first() == Some(name) {
            self.person_lines(measure, factor);
        }
        if result.recommended.people > 0 && (1..=3).contains(&result.recommended.pairs.len()) {
            self.differences(&result, &format!("{id}-differences"));
        }
        let heading = language.pick(
            format!("Tables: {} by {shown}", measure.label),
            format!("Tableaux : {} par {shown}", measure.label),
        );
        self.folded(heading, |writer| writer.comparison_tables(measure, factor, &result, &id));
        self.results.comparisons.push(result);
    }

    /// How answers lie at each level, and every test of the levels.
    fn comparison_tables(
        &mut self,
        measure: &Measure,
        factor: &Factor,
        result: &Comparison,
        id: &str,
    ) {
        let language = self.language();
        let name = &factor.name;
        let shown = self.naming.factor(name);
        let table = self.described(measure, factor, result, format!("{id}-described"));
        self.blocks.push(Block::Table(table));
        let table = tables::two_columns(
            &self.naming,
            format!("{id}-tests"),
            language.pick(
                format!("Tests of {shown}: as in the thesis and recommended"),
                format!("Tests de {shown} : comme dans la thèse et recommandés"),
            ),
            name,
            measure.kind,
            &result.as_in_the_thesis,
            &result.recommended,
        );
        self.blocks.push(Block::Table(table));
        let pairs_id = format!("{id}-pairs");
        let people = &result.recommended;
        let pairs = tables::many_pairs(&self.naming, pairs_id, name, measure.kind, people);
        self.blocks.extend(pairs.map(Block::Table));
        let sizes = tables::effect_sizes(&self.naming, format!("{id}-effect-sizes"), name, people);
        self.blocks.extend(sizes.map(Block::Table));
    }

    /// What the levels look like: shares of right answers, or how answers lie.
    fn described(
        &self,
        measure: &Measure,
        factor: &Factor,
        result: &Comparison,
        id: String,
    ) -> DataTable {
        let (name, shown) = (&factor.name, self.naming.factor(&factor.name));
        let caption = self.language().pick(
            format!("{} by {shown}", measure.label),
            format!("{} par {shown}", measure.label),
        );
        if measure.kind != MeasureKind::Recognition {
            return tables::descriptions(&self.naming, id, caption, result);
        }
        let (measure, factor) = &measure.at(factor, &result.matching.rows());
        let share = |code: usize| {
            let share = self.shares_by(measure, |i| factor.codes[i] as usize == code);
            (factor.levels[code].clone(), share)
        };
        let shares: Vec<(String, Proportion)> = (0..factor.levels.len()).map(share).collect();
        tables::recognition(&self.naming, id, caption, name, &shares, &result.person_means)
    }

    /// The differences of each person between every two levels.
    fn differences(&mut self, result: &Comparison, id: &str) {
        let language = self.language();
        let named =
            |pair: &Pair| [&pair.a, &pair.b].map(|level| self.naming.level(&result.factor, level));
        let pairs = result.recommended.pairs.iter();
        let pairs: Vec<([String; 2], &Pair)> = pairs.map(|pair| (named(pair), pair)).collect();
        let caption = language.pick(
            "Difference of each person’s means, with the Hodges-Lehmann estimate and its 95 % interval",
            "Différence des moyennes de chaque personne, avec l’estimation de Hodges-Lehmann et son intervalle à 95 %",
        );
        self.figure(figure::differences(language, id, caption, result.kind, &pairs));
    }

    fn interaction(&mut self, measure: &Measure, names: [&str; 2]) {
        let language = self.language();
        let factors = names.map(|name| measure.factor(self.export, name, &[]));
        if factors.iter().any(|factor| factor.levels.len() < 2) {
            return;
        }
        let both = [&factors[0], &factors[1]];
        let trials =
            TrialLevel::new(TestLine::scheirer_ray_hare(&measure.numbers(), both, &Unit::Trials));
        let people = person_level::two_way(self.export, measure, both);
        let shown = names.map(|name| self.naming.factor(name)).join(" × ");
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
