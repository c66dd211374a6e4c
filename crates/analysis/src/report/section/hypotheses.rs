//! The hypotheses of the study file: in short, and one by one.

use mimique_report::document::{Block, slug};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use crate::hypothesis::family;
use crate::hypothesis::other_clips::OtherClipsTests;
use crate::hypothesis::reading;
use crate::hypothesis::{HypothesisResult, is_two_way, test_hypothesis};
use crate::report::figure::conditions::people_by_condition;
use crate::report::section::Writer;
use crate::report::tables;
use crate::trials::measure::MeasureKind;

/// Every hypothesis tested, and corrected for their number.
pub(crate) fn tested(writer: &Writer<'_>) -> Vec<HypothesisResult> {
    let mut results: Vec<HypothesisResult> = writer
        .study
        .hypotheses
        .par_iter()
        .map(|hypothesis| {
            test_hypothesis(
                &writer.naming,
                writer.export,
                writer.study,
                hypothesis,
                OtherClipsTests::All,
            )
        })
        .collect();
    family::correct(&mut results);
    let tested = results.iter().filter(|result| result.p.is_some()).count();
    for result in &mut results {
        if result.p_holm_over_hypotheses.is_some() && tested > 1 {
            let language = writer.naming.language;
            let first = reading::over_hypotheses(language, result, tested);
            result.reading = format!("{first} {}", result.reading);
        }
    }
    results
}

impl Writer<'_> {
    /// The people of each condition, where a hypothesis is about the conditions alone.
    fn people_by_condition(&mut self, result: &HypothesisResult) {
        let conditions: Vec<(String, Vec<(&str, f64)>)> = result
            .people_by_condition
            .iter()
            .filter(|(_, own)| own.people > 0)
            .map(|(name, own)| {
                let people = own.means.iter();
                let id = |person: usize| self.export.people[person].id.as_str();
                (name.to_owned(), people.map(|(person, mean)| (id(*person), *mean)).collect())
            })
            .collect();
        if conditions.len() < 2 || result.factors.len() > 1 {
            return;
        }
        let language = self.language();
        let caption = language.pick(
            format!("{}: mean of each person, by condition", result.id),
            format!("{} : moyenne de chaque personne, par condition", result.id),
        );
        let id = format!("hypothesis-{}-people", slug(&result.id));
        let figure = people_by_condition(language, &id, &caption, result.kind, &conditions);
        self.figure(figure);
    }

    pub(crate) fn hypotheses(&mut self, hypotheses: &[HypothesisResult]) {
        if hypotheses.is_empty() {
            return;
        }
        let language = self.language();
        self.heading(2, "Hypotheses", "Hypothèses");
        self.blocks.push(Block::Caution(reading::trial_level_caution(language).to_owned()));
        self.blocks.push(Block::Caution(reading::these_clips_caution(language).to_owned()));
        if hypotheses.iter().any(|result| is_two_way(result.test)) {
            self.blocks.push(Block::Caution(reading::interaction_caution(language).to_owned()));
        }
        for result in hypotheses {
            self.blocks.push(Block::Heading(3, format!("{}. {}", result.id, result.statement)));
            self.blocks.push(Block::Reading(result.reading.clone()));
            self.equivalence_zone(result);
            self.people_by_condition(result);
            let heading =
                language.pick(format!("Tests of {}", result.id), format!("Tests de {}", result.id));
            self.folded(heading, |writer| writer.tests_of(result));
        }
    }

    /// Every test of a hypothesis: tables, and the mixed model drawn.
    fn tests_of(&mut self, result: &HypothesisResult) {
        let language = self.language();
        let factor = result.factors.first().map_or("", String::as_str);
        let mut table = tables::two_columns(
            &self.naming,
            format!("hypothesis-{}", slug(&result.id)),
            language.pick(
                format!("{}: as in the thesis and recommended", result.id),
                format!("{} : comme dans la thèse et recommandé", result.id),
            ),
            factor,
            result.kind,
            &result.as_in_the_thesis,
            &result.recommended,
        );
        if result.kind == MeasureKind::Choice {
            tables::headings_of_choices(language, &mut table);
        }
        self.blocks.push(Block::Table(table));
        let pairs = tables::many_pairs(
            &self.naming,
            format!("hypothesis-{}-pairs", slug(&result.id)),
            factor,
            result.kind,
            &result.recommended,
        );
        self.blocks.extend(pairs.map(Block::Table));
        let id = format!("hypothesis-{}-effect-sizes", slug(&result.id));
        let sizes = tables::effect_sizes(&self.naming, id, factor, &result.recommended);
        self.blocks.extend(sizes.map(Block::Table));
        self.equivalence_tests(result);
        self.other_clips(result);
    }
}
