//! Tables of tests: as in the thesis beside recommended.

use super::comparison::{Comparison, Pair, PersonLevel, TestLine, TrialLevel};
use super::document::DataTable;
use super::language::Language;
use super::measure::MeasureKind;
use super::naming::Naming;
use crate::outcome::Outcome;

/// Cells of one test: what was computed, p, effect.
fn line(language: Language, outcome: &Outcome<TestLine>, holm: bool) -> [String; 3] {
    match outcome {
        Outcome::Undefined { reason } => [
            language.pick(format!("undefined: {reason}"), format!("non défini : {reason}")),
            String::new(),
            String::new(),
        ],
        Outcome::Ok(line) => {
            let df = if line.df.is_empty() { String::new() } else { format!("({})", line.df) };
            let p = if holm { line.p_holm.unwrap_or(line.p_value) } else { line.p_value };
            let ln_p = if holm { p.ln() } else { line.ln_p };
            [
                format!(
                    "{}{df} = {}; n = {}",
                    line.statistic_name,
                    language.number(line.statistic),
                    line.n
                ),
                language.p_cell(p, ln_p),
                line.effect.map_or_else(String::new, |effect| {
                    format!("{} {}", line.effect_name, language.fixed(effect, 2))
                }),
            ]
        }
    }
}

fn name_of(outcome: &Outcome<TestLine>) -> String {
    match outcome {
        Outcome::Ok(line) if line.term.is_empty() => line.test.clone(),
        Outcome::Ok(line) => format!("{} [{}]", line.test, line.term),
        Outcome::Undefined { .. } => String::new(),
    }
}

fn difference(language: Language, kind: MeasureKind, pair: &Pair) -> String {
    let decimals = if kind == MeasureKind::Recognition { 3 } else { 2 };
    pair.difference.map_or_else(String::new, |d| {
        format!(
            "{} [{}; {}]",
            language.fixed(d.estimate, decimals),
            language.fixed(d.ci_low, decimals),
            language.fixed(d.ci_high, decimals)
        )
    })
}

/// Both kinds of test of one measure and factor in one table.
pub(crate) fn two_columns(
    naming: &Naming<'_>,
    id: String,
    caption: String,
    factor: &str,
    kind: MeasureKind,
    trials: &TrialLevel,
    people: &PersonLevel,
) -> DataTable {
    let language = naming.language;
    let heading = language.pick(
        ["", "statistic", "p", "effect", "statistic", "p (Holm)", "effect", "difference [95 %]"],
        ["", "statistique", "p", "effet", "statistique", "p (Holm)", "effet", "différence [95 %]"],
    );
    let mut table = DataTable::new(id, caption, heading);
    table.groups = vec![
        (String::new(), 1),
        (
            language
                .pick(
                    "As in the thesis (assumes independent observations)",
                    "Comme dans la thèse (suppose des observations indépendantes)",
                )
                .to_owned(),
            3,
        ),
        (
            language
                .pick("Recommended (one value a person)", "Recommandé (une valeur par personne)")
                .to_owned(),
            4,
        ),
    ];
    let empty = || [String::new(), String::new(), String::new()];
    for outcome in &trials.tests {
        let mut cells = vec![name_of(outcome)];
        cells.extend(line(language, outcome, false));
        cells.extend(empty());
        cells.push(String::new());
        table.row(cells);
    }
    for outcome in &people.overall {
        let mut cells = vec![name_of(outcome)];
        cells.extend(empty());
        cells.extend(line(language, outcome, true));
        cells.push(String::new());
        table.row(cells);
    }
    for pair in &people.pairs {
        let mut cells = vec![naming.pair(factor, &pair.a, &pair.b)];
        cells.extend(empty());
        cells.extend(line(language, &pair.wilcoxon, true));
        cells.push(difference(language, kind, pair));
        table.row(cells);
    }
    table
}

/// Description of each level.
pub(crate) fn descriptions(
    naming: &Naming<'_>,
    id: String,
    caption: String,
    result: &Comparison,
) -> DataTable {
    let language = naming.language;
    let heading = language.pick(
        ["", "trials", "mean", "sd", "median", "q1", "q3", "mean of person means"],
        ["", "essais", "moyenne", "écart type", "médiane", "q1", "q3", "moyenne des personnes"],
    );
    let mut table = DataTable::new(id, caption, heading);
    for (level, outcome) in result.descriptions.iter() {
        let mut cells = vec![naming.level(&result.factor, level)];
        match outcome {
            Outcome::Ok(d) => {
                cells.push(d.n.to_string());
                cells.push(language.fixed(d.mean, 2));
                cells.push(d.sd.map_or_else(|| "–".to_owned(), |sd| language.fixed(sd, 2)));
                cells.extend([d.median, d.q1, d.q3].map(|value| language.number(value)));
            }
            Outcome::Undefined { .. } => {
                cells.extend(["0", "–", "–", "–", "–", "–"].map(str::to_owned));
            }
        }
        let mean = result.person_means.get(level).copied().flatten();
        cells.push(mean.map_or_else(|| "–".to_owned(), |mean| language.fixed(mean, 2)));
        table.row(cells);
    }
    table
}
