//! P-values corrected for the number of comparisons, as R's `p.adjust`.

use mimique_locale::format_number;
use serde::Serialize;

use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;

/// A correction for several comparisons.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Adjustment {
    /// Holm 1979, step-down.
    #[default]
    Holm,
    /// Bonferroni.
    Bonferroni,
    /// Benjamini and Hochberg 1995: false discovery rate.
    Bh,
    /// Benjamini and Yekutieli 2001: false discovery rate under dependence.
    By,
    /// Hochberg 1988, step-up.
    Hochberg,
}

impl Adjustment {
    /// All corrections.
    pub const ALL: [Self; 5] = [Self::Holm, Self::Bonferroni, Self::Bh, Self::By, Self::Hochberg];

    /// The word used on the command line.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Holm => "holm",
            Self::Bonferroni => "bonferroni",
            Self::Bh => "bh",
            Self::By => "by",
            Self::Hochberg => "hochberg",
        }
    }

    /// The correction of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|adjustment| adjustment.as_str() == name)
    }

    /// Adjusts p-values: monotone in their order, at most 1. A missing p stays missing and does not
    /// count as a comparison.
    pub fn apply(self, p: &[Option<f64>]) -> Vec<Option<f64>> {
        let mut order: Vec<usize> = (0..p.len()).filter(|&i| p[i].is_some()).collect();
        let value = |i: usize| p[i].unwrap_or(1.0);
        order.sort_by(|&a, &b| value(a).total_cmp(&value(b)));
        let n = order.len();
        let count = n as f64;
        let harmonic: f64 = (1..=n).map(|i| 1.0 / i as f64).sum();
        let factor = |position: usize| match self {
            Self::Bonferroni => count,
            Self::Holm | Self::Hochberg => (n - position) as f64,
            Self::Bh => count / (position + 1) as f64,
            Self::By => harmonic * count / (position + 1) as f64,
        };
        let mut adjusted = vec![None; p.len()];
        let mut running: f64 = if self == Self::Holm { 0.0 } else { 1.0 };
        let mut set = |position: usize| {
            let own = value(order[position]) * factor(position);
            running = match self {
                Self::Holm => running.max(own),
                Self::Bonferroni => own,
                Self::Hochberg | Self::Bh | Self::By => running.min(own),
            };
            adjusted[order[position]] = Some(running.min(1.0));
        };
        match self {
            Self::Holm | Self::Bonferroni => (0..n).for_each(&mut set),
            Self::Hochberg | Self::Bh | Self::By => (0..n).rev().for_each(&mut set),
        }
        adjusted
    }
}

/// All corrections of one list of p-values.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(non_snake_case, missing_docs)]
pub struct AdjustedP {
    pub n: usize,
    pub missing: usize,
    pub p: Vec<Option<f64>>,
    pub holm: Vec<Option<f64>>,
    pub bonferroni: Vec<Option<f64>>,
    pub BH: Vec<Option<f64>>,
    pub BY: Vec<Option<f64>>,
    pub hochberg: Vec<Option<f64>>,
}

/// Adjusts p-values by every correction; NaN is missing.
pub fn adjust_all(p: &[f64]) -> AdjustedP {
    let p: Vec<Option<f64>> = p.iter().map(|&p| (!p.is_nan()).then_some(p)).collect();
    AdjustedP {
        n: p.iter().flatten().count(),
        missing: p.iter().filter(|p| p.is_none()).count(),
        holm: Adjustment::Holm.apply(&p),
        bonferroni: Adjustment::Bonferroni.apply(&p),
        BH: Adjustment::Bh.apply(&p),
        BY: Adjustment::By.apply(&p),
        hochberg: Adjustment::Hochberg.apply(&p),
        p,
    }
}

/// `mimique test adjust`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "adjust",
    question: "Correct p-values for the number of comparisons",
    options: &[&[ProcedureOption::text("p", "Column of p-values").required()]],
    run,
    sample: Sample::Other,
    r: "",
    python: "",
    golden_cases: "p_adjust",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let column = arguments.numbers(table, "p")?;
    let wrong = |&row: &usize| {
        let p = column.values[row];
        !(0.0..=1.0).contains(&p) && !p.is_nan()
    };
    if let Some(row) = (0..table.rows()).find(wrong) {
        return Err(Refusal::NotAProbability {
            column: arguments.needed("p")?.to_owned(),
            line: table.line(row),
            value: column.values[row],
        });
    }
    Ok(Answer::of(&Outcome::Ok(adjust_all(&column.values)), words))
}

fn words(result: &AdjustedP) -> String {
    let mut lines = Lines::default();
    lines.add(format!("{} p-values, {} missing", result.n, result.missing));
    let mut rows = vec![lines::row(["p", "holm", "bonferroni", "BH", "BY", "hochberg"])];
    let cell = |value: Option<f64>| value.map_or_else(|| "NA".to_owned(), format_number);
    for i in 0..result.p.len() {
        rows.push(vec![
            cell(result.p[i]),
            cell(result.holm[i]),
            cell(result.bonferroni[i]),
            cell(result.BH[i]),
            cell(result.BY[i]),
            cell(result.hochberg[i]),
        ]);
    }
    lines.table(&rows);
    lines.into_text()
}
