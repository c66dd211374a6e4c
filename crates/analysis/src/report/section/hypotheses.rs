//! The hypotheses of the study file: in short, and one by one.

use mimique_stats::Adjustment;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use crate::hypothesis::other_clips::OtherClipsTests;
use crate::hypothesis::reading;
use crate::hypothesis::{HypothesisResult, test_hypothesis};
use crate::report::document::{Block, DataTable, slug};
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
                OtherClipsTests::Both,
            )
        })
        .collect();
    let p: Vec<Option<f64>> = results.iter().map(|result| result.p).collect();
    let tested = p.iter().flatten().count();
    for (result, corrected) in results.iter_mut().zip(Adjustment::Holm.apply(&p)) {
        result.p_holm_over_hypotheses = corrected;
        if let (Some(p), Some(corrected), true) = (result.p, corrected, tested > 1) {
            let language = writer.naming.language;
            result.reading.push(' ');
            result.reading += &reading::over_hypotheses(language, p, corrected, tested);
        }
    }
    results
}

impl Writer<'_> {
    pub(crate) fn in_short(&mut self, hypotheses: &[HypothesisResult]) {
        self.heading(2, "In short", "En bref");
        if hypotheses.is_empty() {
            self.paragraph(
                "The study file states no hypothesis; every comparison below is exploratory.",
                "Le fichier de l’étude n’énonce aucune hypothèse ; toutes les comparaisons ci-dessous sont exploratoires.",
            );
        }
        for result in hypotheses {
            self.blocks.push(Block::Reading(format!("{}. {}", result.id, result.reading)));
        }
        let n = self.export.flow.people_used;
        if n < 6 {
            self.blocks.push(Block::Caution(self.language().pick(
                format!("With {n} people in the analysis no paired test can reach p < 0.05: six are the least, and most effects need many more. Take what follows as a trial run of the analysis."),
                format!("Avec {n} personnes dans l’analyse, aucun test apparié ne peut atteindre p < 0,05 : il en faut au moins six, et la plupart des effets en demandent bien plus. Considérez ce qui suit comme un essai de l’analyse."),
            )));
        }
    }

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
        for result in hypotheses {
            self.blocks.push(Block::Heading(3, format!("{}. {}", result.id, result.statement)));
            let mut table = tables::two_columns(
                &self.naming,
                format!("hypothesis-{}", slug(&result.id)),
                language.pick(
                    format!("{}: as in the thesis and recommended", result.id),
                    format!("{} : comme dans la thèse et recommandé", result.id),
                ),
                result.factors.first().map_or("", String::as_str),
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
                result.factors.first().map_or("", String::as_str),
                result.kind,
                &result.recommended,
            );
            self.blocks.extend(pairs.map(Block::Table));
            self.equivalence(result);
            self.other_clips(result);
            self.people_by_condition(result);
            self.blocks.push(Block::Reading(result.reading.clone()));
        }
        if hypotheses.iter().filter(|result| result.p.is_some()).count() > 1 {
            let heading = language.pick(
                ["hypothesis", "p (test that decides)", "p corrected for all hypotheses (Holm)"],
                ["hypothèse", "p (test qui décide)", "p corrigé pour toutes les hypothèses (Holm)"],
            );
            let caption =
                language.pick("All hypotheses together", "Toutes les hypothèses ensemble");
            let mut table = DataTable::new("hypotheses", caption, heading);
            for result in hypotheses {
                let cell = |p: Option<f64>| {
                    p.map_or_else(|| "–".to_owned(), |p| language.p_cell(p, p.ln()))
                };
                table.row([result.id.clone(), cell(result.p), cell(result.p_holm_over_hypotheses)]);
            }
            self.blocks.push(Block::Table(table));
        }
    }
}
