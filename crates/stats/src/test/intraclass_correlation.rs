//! Intraclass correlation: how alike different raters rate the same clips, in six forms (Shrout and Fleiss 1979,
//! McGraw and Wong 1996).
//!
//! | form | model | of |
//! |---|---|---|
//! | ICC1, ICC1k | one-way: raters differ from clip to clip | one rating; the mean of k |
//! | ICC2, ICC2k | two-way, raters drawn at random: agreement | the same |
//! | ICC3, ICC3k | two-way, these raters only: consistency | the same |

use mimique_locale::{format_number, format_p};
use serde::Serialize;

use crate::distributions::tail::{Tail, f_quantile, f_upper};
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::blocks::Blocks;
use crate::undefined::NoEstimate;

/// Clips and raters below which the coefficients say nothing.
const CLIPS_NEEDED: usize = 5;
const RATERS_NEEDED: usize = 3;

/// Mean squares of the two-way table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RatingMeanSquares {
    /// Between clips.
    pub clips: f64,
    /// Between raters.
    pub raters: f64,
    /// What is left.
    pub residual: f64,
    /// Within clips: raters and residual together.
    pub within: f64,
}

/// One form of the coefficient.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct IccForm {
    /// Which form.
    pub form: &'static str,
    /// The coefficient.
    pub icc: f64,
    /// F against 0.
    pub F: f64,
    /// Clips less one.
    pub df1: usize,
    /// Degrees of freedom of the mean square below.
    pub df2: usize,
    /// Upper F tail.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// Interval at 95 %.
    pub interval_95: [f64; 2],
}

/// Result of [`intraclass_correlation`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct IntraclassCorrelation {
    /// Always `icc`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// Clips that every rater rated.
    pub clips_used: usize,
    /// Clips that some rater did not rate: left out.
    pub clips_dropped: usize,
    /// Raters.
    pub raters: usize,
    /// Mean squares.
    pub mean_squares: RatingMeanSquares,
    /// The six forms. For ratings of new raters read ICC2, for their mean ICC2k.
    pub forms: Vec<IccForm>,
}

impl IntraclassCorrelation {
    /// ICC2: of one rating, two-way random, agreement.
    pub fn agreement_of_one(&self) -> &IccForm {
        &self.forms[1]
    }

    /// ICC2k: of the mean of the raters.
    pub fn agreement_of_mean(&self) -> &IccForm {
        &self.forms[4]
    }
}

/// Agreement of the groups (raters) over the blocks (clips). Refuses fewer than 5 whole clips or 3 raters;
/// undefined where clips or ratings do not differ.
pub fn intraclass_correlation(ratings: &Blocks) -> Result<Outcome<IntraclassCorrelation>, Refusal> {
    let (clips, raters) = (ratings.blocks.len(), ratings.groups.len());
    for (column, levels, needed) in
        [("clip", &ratings.blocks, CLIPS_NEEDED), ("rater", &ratings.groups, RATERS_NEEDED)]
    {
        if levels.len() < needed {
            let (levels, rows) = (levels.clone(), clips * raters);
            let column = column.to_owned();
            return Err(Refusal::TooFewLevels { column, levels, rows, needed });
        }
    }
    let squares = mean_squares(ratings);
    // What rounding leaves of a spread that is none.
    let rounding = 1e-12 * (squares.clips + squares.raters + squares.residual);
    if squares.residual <= rounding || squares.clips <= rounding {
        return Ok(Outcome::undefined(NoEstimate::NoVariance));
    }
    Ok(Outcome::Ok(IntraclassCorrelation {
        test: "icc",
        variant: "complete clips only",
        clips_used: clips,
        clips_dropped: ratings.incomplete,
        raters,
        mean_squares: squares,
        forms: forms(squares, clips, raters),
    }))
}

fn mean_squares(ratings: &Blocks) -> RatingMeanSquares {
    let (n, k) = (ratings.blocks.len() as f64, ratings.groups.len() as f64);
    let rows = &ratings.responses;
    let all: f64 = rows.iter().flatten().sum::<f64>() / (n * k);
    let clip_means: Vec<f64> = rows.iter().map(|row| row.iter().sum::<f64>() / k).collect();
    let rater_means: Vec<f64> = (0..ratings.groups.len())
        .map(|rater| rows.iter().map(|row| row[rater]).sum::<f64>() / n)
        .collect();
    let squares = |values: &[f64]| values.iter().map(|v| (v - all) * (v - all)).sum::<f64>();
    let (clips, raters) = (k * squares(&clip_means), n * squares(&rater_means));
    let residual: f64 = rows
        .iter()
        .zip(&clip_means)
        .flat_map(|(row, clip)| {
            row.iter().zip(&rater_means).map(move |(y, rater)| y - clip - rater + all)
        })
        .map(|rest| rest * rest)
        .sum();
    RatingMeanSquares {
        clips: clips / (n - 1.0),
        raters: raters / (k - 1.0),
        residual: residual / ((n - 1.0) * (k - 1.0)),
        within: (raters + residual) / (n * (k - 1.0)),
    }
}

/// Coefficient of single ratings and of their mean, and the ends of both intervals.
struct Pair {
    icc: [f64; 2],
    low: [f64; 2],
    high: [f64; 2],
}

fn forms(squares: RatingMeanSquares, clips: usize, raters: usize) -> Vec<IccForm> {
    let RatingMeanSquares { clips: between, residual, within, .. } = squares;
    let k = raters as f64;
    let (df1, one_way, two_way) = (clips - 1, clips * (raters - 1), (clips - 1) * (raters - 1));
    // Of one F alone (McGraw and Wong 1996, table 7): forms 1 and 3.
    let of_f = |below: f64, df2: usize| {
        let f = between / below;
        let ends = [
            f / f_quantile(0.975, df1 as f64, df2 as f64),
            f * f_quantile(0.975, df2 as f64, df1 as f64),
        ];
        let single = |f: f64| (f - 1.0) / (f + k - 1.0);
        let mean = |f: f64| 1.0 - 1.0 / f;
        let both = |f: f64| [single(f), mean(f)];
        Pair { icc: both(f), low: both(ends[0]), high: both(ends[1]) }
    };
    let agreement = agreement(squares, clips as f64, k);
    let all = [
        (["ICC1 (one-way, single)", "ICC1k"], of_f(within, one_way), between / within, one_way),
        (
            ["ICC2 (two-way random, agreement, single)", "ICC2k"],
            agreement,
            between / residual,
            two_way,
        ),
        (
            ["ICC3 (two-way mixed, consistency, single)", "ICC3k"],
            of_f(residual, two_way),
            between / residual,
            two_way,
        ),
    ];
    let form = |which: usize| {
        all.iter().map(move |(names, pair, f, df2)| {
            let Tail { p, ln_p } = f_upper(*f, df1 as f64, *df2 as f64);
            IccForm {
                form: names[which],
                icc: pair.icc[which],
                F: *f,
                df1,
                df2: *df2,
                p,
                ln_p,
                interval_95: [pair.low[which], pair.high[which]],
            }
        })
    };
    form(0).chain(form(1)).collect()
}

/// Form 2: its interval is by Satterthwaite's degrees of freedom (Shrout and Fleiss 1979, equations 5 and 6).
fn agreement(squares: RatingMeanSquares, n: f64, k: f64) -> Pair {
    let RatingMeanSquares { clips: between, raters: judges, residual, .. } = squares;
    let extra = (judges - residual) / n;
    let single = (between - residual) / (between + (k - 1.0) * residual + k * extra);
    let mean = (between - residual) / (between + extra);
    let f = judges / residual;
    let a = k * single * f;
    let b = n * (1.0 + (k - 1.0) * single) - k * single;
    let df = (k - 1.0) * (n - 1.0) * (a + b) * (a + b) / ((n - 1.0) * a * a + b * b);
    let (low_f, high_f) = (f_quantile(0.975, n - 1.0, df), f_quantile(0.975, df, n - 1.0));
    let rest = k * judges + (k * n - k - n) * residual;
    let low = n * (between - low_f * residual) / (low_f * rest + n * between);
    let high = n * (high_f * between - residual) / (rest + n * high_f * between);
    // Spearman and Brown: the mean of k ratings.
    let of_mean = |icc: f64| icc * k / (1.0 + icc * (k - 1.0));
    Pair { icc: [single, mean], low: [low, of_mean(low)], high: [high, of_mean(high)] }
}

/// `mimique test icc`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "icc",
    question: "How alike do raters rate the same clips? Intraclass correlation in six forms",
    options: &[&[
        ProcedureOption::text("rating", "Column of numbers").required(),
        ProcedureOption::text("clip", "Column of the clips that were rated").required(),
        ProcedureOption::text("rater", "Column of the raters").required(),
    ]],
    run,
    sample: Sample::Ratings,
    r: r#"
# Intraclass correlation of one rating, two-way random, agreement: ICC(2,1); m has a row per clip.
icc <- function(m) {
  n <- nrow(m)
  k <- ncol(m)
  between <- k * var(rowMeans(m))
  raters <- n * var(colMeans(m))
  residual <- sum((m - outer(rowMeans(m), colMeans(m), "+") + mean(m))^2) / ((n - 1) * (k - 1))
  f <- between / residual
  c(statistic = f, p = pf(f, n - 1, (n - 1) * (k - 1), lower.tail = FALSE),
    effect = (between - residual) / (between + (k - 1) * residual + k * (raters - residual) / n), n = n)
}
"#,
    python: r#"
def icc(m):
    """Intraclass correlation of one rating, two-way random, agreement: ICC(2,1); a row per clip."""
    n, k = m.shape
    between = k * m.mean(axis=1).var(ddof=1)
    raters = n * m.mean(axis=0).var(ddof=1)
    rest = m - m.mean(axis=1, keepdims=True) - m.mean(axis=0, keepdims=True) + m.mean()
    residual = (rest**2).sum() / ((n - 1) * (k - 1))
    f = between / residual
    effect = (between - residual) / (between + (k - 1) * residual + k * (raters - residual) / n)
    return dict(statistic=f, p=stats.f.sf(f, n - 1, (n - 1) * (k - 1)), effect=effect, n=n)
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factor = |option: &str| arguments.factor(table, option);
    let rating = arguments.numbers(table, "rating")?;
    let ratings = Blocks::of(&rating, &factor("rater")?, &factor("clip")?)?;
    Ok(Answer::of_test(&intraclass_correlation(&ratings)?, words))
}

impl TestResult for IntraclassCorrelation {
    const NAMES: TestNames = TestNames {
        test: "intraclass correlation",
        short: "ICC",
        in_words: ["test of the intraclass correlation", "test de la corrélation intraclasse"],
        statistic: "F",
        statistic_symbol: "F",
        effect: "ICC(2,1)",
        effect_symbol: "ICC",
        function: "icc",
    };

    /// The headline: ICC2 of one rating.
    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let form = self.agreement_of_one();
        vec![Outcome::Ok(TestRow {
            variant: form.form.to_owned(),
            term: Term::Whole,
            statistic: form.F,
            degrees_of_freedom: vec![form.df1, form.df2],
            p_value: form.p,
            ln_p: form.ln_p,
            effect: Some(form.icc),
            n: self.clips_used,
        })]
    }
}

fn words(result: &IntraclassCorrelation) -> String {
    let mut lines = Lines::default();
    lines.add(format!(
        "Intraclass correlation of {} raters over {} clips, {} incomplete clips left out",
        result.raters, result.clips_used, result.clips_dropped
    ));
    let mut rows = vec![lines::row(["form", "ICC", "95 % interval", "F", "df", "p"])];
    for form in &result.forms {
        let [low, high] = form.interval_95;
        rows.push(vec![
            form.form.to_owned(),
            format_number(form.icc),
            format!("{} to {}", format_number(low), format_number(high)),
            format_number(form.F),
            format!("{} and {}", form.df1, form.df2),
            format_p(form.p, form.ln_p),
        ]);
    }
    lines.table(&rows);
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ratings(rows: &[[f64; 3]]) -> Blocks {
        Blocks {
            groups: ["a", "b", "c"].map(str::to_owned).to_vec(),
            blocks: (0..rows.len()).map(|row| row.to_string()).collect(),
            responses: rows.iter().map(|row| row.to_vec()).collect(),
            incomplete: 0,
            dropped: 0,
        }
    }

    #[test]
    fn raters_who_differ_by_a_constant_are_consistent_but_do_not_agree() {
        let rows = [1.0, 3.0, 4.0, 6.0, 9.0].map(|y| [y, y + 1.0 + 1e-3 * y, y + 2.0]);
        let found = intraclass_correlation(&ratings(&rows)).unwrap().ok().unwrap();
        let of = |place: usize| found.forms[place].icc;
        assert!(of(2) > 0.99999 && of(1) < 0.95 && of(0) < of(1), "{:?}", found.forms);
        for form in &found.forms {
            let [low, high] = form.interval_95;
            assert!(low < form.icc && form.icc < high, "{form:?}");
        }
    }

    #[test]
    fn what_does_not_differ_is_undefined_and_too_few_are_refused() {
        let equal = ratings(&[[4.0; 3]; 6]);
        assert!(intraclass_correlation(&equal).unwrap().reason().is_some());
        let alike = ratings(&[1.0, 2.0, 3.0, 4.0, 5.0].map(|y| [y; 3]));
        assert!(intraclass_correlation(&alike).unwrap().reason().is_some(), "no residual is left");
        let few = ratings(&[[1.0, 2.0, 3.0], [2.0, 3.0, 5.0], [1.0, 1.0, 2.0], [7.0, 6.0, 7.0]]);
        let said = intraclass_correlation(&few).unwrap_err().to_string();
        assert!(said.contains("\"clip\"") && said.contains("at least 5"), "{said}");
    }

    #[test]
    fn units_do_not_matter() {
        let rows =
            [[1.0, 2.0, 2.5], [3.0, 3.5, 2.0], [4.0, 5.0, 4.5], [2.0, 2.0, 3.0], [5.0, 4.0, 6.0]];
        let scaled = rows.map(|row| row.map(|y| 100.0 - 12.5 * y));
        let of = |rows: &[[f64; 3]]| intraclass_correlation(&ratings(rows)).unwrap().ok().unwrap();
        for (own, other) in of(&rows).forms.iter().zip(of(&scaled).forms) {
            assert!((own.icc - other.icc).abs() < 1e-12 && (own.p - other.p).abs() < 1e-12);
        }
    }
}
