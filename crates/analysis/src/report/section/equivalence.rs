//! Tests of equivalence below those of a hypothesis: a table, and the intervals in the zone of differences that do not
//! matter.

use mimique_report::document::{Block, DataTable, slug};
use mimique_stats::EquivalenceT;

use crate::hypothesis::HypothesisResult;
use crate::hypothesis::equivalence::{Equivalence, OneSidedTests};
use crate::hypothesis::reading;
use crate::report::figure::{EquivalenceInterval, equivalence_zone};
use crate::report::section::Writer;
use crate::report::tables;
use crate::trials::measure::MeasureKind;

impl Writer<'_> {
    /// The table of a hypothesis of equivalence; nothing of another one.
    pub(crate) fn equivalence_tests(&mut self, result: &HypothesisResult) {
        if let Some(found) = &result.equivalence {
            let table = self.equivalence_table(result, found);
            self.blocks.push(Block::Table(table));
        }
    }

    /// The intervals of a hypothesis of equivalence in the zone of differences that do not matter.
    pub(crate) fn equivalence_zone(&mut self, result: &HypothesisResult) {
        let Some(found) = &result.equivalence else { return };
        let language = self.language();
        let [of_model, of_ranks, of_t] = language.pick(
            ["linear mixed model, other clips", "Hodges-Lehmann difference", "mean difference"],
            [
                "modèle linéaire mixte, autres extraits",
                "différence de Hodges-Lehmann",
                "différence moyenne",
            ],
        );
        let model = found.for_other_clips.map(|own| (of_model, own.difference, own.interval_90));
        let tests = [(of_ranks, &found.by_ranks), (of_t, &found.by_t)];
        let tests = tests
            .into_iter()
            .filter_map(|(label, own)| Some((label, own.estimate?, own.interval_90?)));
        let intervals: Vec<EquivalenceInterval> = model
            .into_iter()
            .chain(tests)
            .map(|(label, estimate, ends)| EquivalenceInterval {
                label,
                estimate: scaled(result.kind, estimate),
                ends: ends.map(|end| scaled(result.kind, end)),
            })
            .collect();
        if intervals.is_empty() {
            return;
        }
        let factor = result.factors.first().map_or("", String::as_str);
        let [a, b] = &found.levels;
        let pair = self.naming.pair(factor, a, b);
        let least = language.number(scaled(result.kind, found.smallest_effect));
        let caption = language.pick(
            format!(
                "{}: {pair}, 90 % intervals in the zone of differences below {least}",
                result.id
            ),
            format!(
                "{} : {pair}, intervalles à 90 % dans la zone des différences sous {least}",
                result.id
            ),
        );
        let id = format!("hypothesis-{}-zone", slug(&result.id));
        let differences: Vec<f64> =
            found.differences.iter().map(|value| scaled(result.kind, *value)).collect();
        let zone = scaled(result.kind, found.smallest_effect);
        let kind = result.kind;
        let figure =
            equivalence_zone(language, &id, &caption, kind, zone, &intervals, &differences);
        self.figure(figure);
    }

    fn equivalence_table(&self, result: &HypothesisResult, found: &Equivalence) -> DataTable {
        let language = self.language();
        let heading = language.pick(
            [
                "two one-sided tests",
                "p (larger)",
                "difference [90 %]",
                "p of any difference",
                "verdict",
            ],
            [
                "deux tests unilatéraux",
                "p (le plus grand)",
                "différence [90 %]",
                "p d’une différence quelconque",
                "verdict",
            ],
        );
        let factor = result.factors.first().map_or("", String::as_str);
        let [a, b] = &found.levels;
        let pair = self.naming.pair(factor, a, b);
        let caption = language.pick(
            format!("{}: is {pair} smaller than what matters?", result.id),
            format!("{} : {pair} est-elle plus petite que ce qui compte ?", result.id),
        );
        let id = format!("hypothesis-{}-equivalence", slug(&result.id));
        let mut table = DataTable::new(id, caption, heading);
        if let Some(own) = &found.for_other_clips {
            table.row(self.row_for_other_clips(result.kind, own));
        }
        for tests in [&found.by_ranks, &found.by_t] {
            table.row(self.equivalence_row(result.kind, tests));
        }
        table
    }

    fn row_for_other_clips(&self, kind: MeasureKind, own: &EquivalenceT) -> [String; 5] {
        let language = self.language();
        let name = reading::equivalence_by_model(language);
        [
            language.pick(
                format!("{name}, for other clips"),
                format!("{name}, pour d’autres extraits"),
            ),
            language.p_cell(own.p, own.ln_p),
            self.difference_with_interval(kind, own.difference, own.interval_90),
            language.p_cell(own.p_difference, own.p_difference.ln()),
            reading::verdict(language, own.verdict).to_owned(),
        ]
    }

    fn difference_with_interval(
        &self,
        kind: MeasureKind,
        estimate: f64,
        [low, high]: [f64; 2],
    ) -> String {
        let language = self.language();
        let [estimate, low, high] =
            [estimate, low, high].map(|value| reading::difference(language, kind, value));
        format!("{estimate} [{low}; {high}]")
    }

    fn equivalence_row(&self, kind: MeasureKind, tests: &OneSidedTests) -> [String; 5] {
        let language = self.language();
        let [test, p, _] = tables::cells(language, &tests.line);
        let name = tests.line.clone().ok().map(|line| line.names.in_words[language.pick(0, 1)]);
        let interval = tests.estimate.zip(tests.interval_90);
        let interval = interval.map(|(own, ends)| self.difference_with_interval(kind, own, ends));
        [
            name.map_or(test, str::to_owned),
            p,
            interval.unwrap_or_else(|| "–".to_owned()),
            tests.p_difference.map_or_else(|| "–".to_owned(), |p| language.p_cell(p, p.ln())),
            tests.verdict.map_or("–", |verdict| reading::verdict(language, verdict)).to_owned(),
        ]
    }
}

/// In the unit that people read: points of percent for right answers.
fn scaled(kind: MeasureKind, value: f64) -> f64 {
    if kind == MeasureKind::Recognition { value * 100.0 } else { value }
}
