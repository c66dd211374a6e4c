//! Min F': whether methods differ both over people and over other clips (Clark 1973, Journal of Verbal Learning
//! and Verbal Behavior 12, 335).
//!
//! F1 is the F of a repeated-measures analysis of person means, F2 the same of segment means;
//! min F' = F1 F2 / (F1 + F2) on k - 1 and (F1 + F2)² / (F1² / n2 + F2² / n1) degrees of freedom, n1 and n2 those
//! below F1 and F2. It is a lower bound of the F in which people and segments are both drawn at random.

use mimique_locale::{format_number, format_p};
use serde::Serialize;

use crate::distributions::tail::{Tail, f_upper};
use crate::outcome::{Labelled, Outcome};
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;
use crate::table::{Numbers, Table};
use crate::undefined::NoEstimate;

/// An F of repeated measures.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct RepeatedMeasuresF {
    /// The mean square of the methods by that of their interaction with the units.
    pub F: f64,
    /// Methods less one.
    pub df1: usize,
    /// (methods - 1)(units - 1).
    pub df2: usize,
    /// Upper F tail.
    pub p: f64,
    /// Units: people, or segments.
    pub units: usize,
    /// Units left out because they lack a method.
    pub incomplete: usize,
}

/// Result of [`min_f_prime`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MinFPrime {
    /// Always `min-f`.
    pub test: &'static str,
    /// Over people.
    pub f1: RepeatedMeasuresF,
    /// Over segments.
    pub f2: RepeatedMeasuresF,
    /// F1 F2 / (F1 + F2).
    pub min_f: f64,
    /// Methods less one.
    pub df1: usize,
    /// Its lower degrees of freedom, not whole.
    pub df2: f64,
    /// Upper F tail.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// Ratings.
    pub n: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// Mean rating of each method.
    pub means: Labelled<f64>,
}

/// F1, F2 and min F' of ratings. Refuses fewer than two methods, people or segments; undefined where fewer than two
/// people or segments have all methods, or where nothing is left to compare with.
pub fn min_f_prime(
    rating: &Numbers,
    [method, participant, segment]: [&Factor; 3],
) -> Result<Outcome<MinFPrime>, Refusal> {
    let complete = complete_rows(&[rating], &[method, participant, segment])?;
    let rows = complete.to_vec();
    let values = complete.numbers(rating);
    let [method, participant, segment] =
        [method, participant, segment].map(|factor| factor.rows(&rows));
    for factor in [&method, &participant, &segment] {
        factor.require_levels(2)?;
    }
    let over = |units: &Factor| repeated_measures(&means_of(&values, &method, units));
    let (f1, f2) = match (over(&participant), over(&segment)) {
        (Ok(f1), Ok(f2)) => (f1, f2),
        (Err(why), _) | (_, Err(why)) => return Ok(Outcome::undefined(why)),
    };
    let means =
        means_of(&values, &method, &Factor { codes: vec![0; rows.len()], ..method.clone() });
    Ok(Outcome::Ok(combined(f1, f2).with(rows.len(), complete.dropped(), &method, &means[0])))
}

/// Min F' of two F.
fn combined(f1: RepeatedMeasuresF, f2: RepeatedMeasuresF) -> MinFPrime {
    let sum = f1.F + f2.F;
    // Both are 0 where the methods' means are equal: then so is min F', and any degrees of freedom give p 1.
    let min_f = if sum > 0.0 { f1.F * f2.F / sum } else { 0.0 };
    let below = f1.F * f1.F / f2.df2 as f64 + f2.F * f2.F / f1.df2 as f64;
    let df2 = if below > 0.0 { sum * sum / below } else { f1.df2.min(f2.df2) as f64 };
    let Tail { p, ln_p } = f_upper(min_f, f1.df1 as f64, df2);
    let means = Labelled(Vec::new());
    MinFPrime { test: "min-f", f1, f2, min_f, df1: f1.df1, df2, p, ln_p, n: 0, dropped: 0, means }
}

impl MinFPrime {
    fn with(self, n: usize, dropped: usize, method: &Factor, means: &[Option<f64>]) -> Self {
        let means = Labelled::zip(&method.levels, means.iter().map(|mean| mean.unwrap_or(0.0)));
        Self { n, dropped, means, ..self }
    }
}

/// Mean of each method of each unit; none where there is no rating.
fn means_of(values: &[f64], method: &Factor, unit: &Factor) -> Vec<Vec<Option<f64>>> {
    let (units, methods) = (unit.levels.len(), method.levels.len());
    let mut sums = vec![vec![(0.0, 0_u32); methods]; units];
    for (row, value) in values.iter().enumerate() {
        let own = &mut sums[unit.codes[row] as usize][method.codes[row] as usize];
        own.0 += value;
        own.1 += 1;
    }
    let mean = |&(sum, count): &(f64, u32)| (count > 0).then(|| sum / f64::from(count));
    sums.iter().map(|unit| unit.iter().map(mean).collect()).collect()
}

/// The F of the columns of a table whose rows are repeated measures; rows with a gap are left out.
fn repeated_measures(table: &[Vec<Option<f64>>]) -> Result<RepeatedMeasuresF, NoEstimate> {
    let whole: Vec<Vec<f64>> =
        table.iter().filter_map(|row| row.iter().copied().collect::<Option<Vec<f64>>>()).collect();
    let units = whole.len();
    if units < 2 {
        return Err(NoEstimate::TooFewWholeUnits { whole: units, units: table.len() });
    }
    let (n, k) = (units as f64, whole[0].len() as f64);
    let all = whole.iter().flatten().sum::<f64>() / (n * k);
    let of_unit: Vec<f64> = whole.iter().map(|row| row.iter().sum::<f64>() / k).collect();
    let of_method: Vec<f64> = (0..whole[0].len())
        .map(|method| whole.iter().map(|row| row[method]).sum::<f64>() / n)
        .collect();
    let between: f64 = n * of_method.iter().map(|mean| (mean - all) * (mean - all)).sum::<f64>();
    let mut rest = 0.0;
    for (row, unit) in whole.iter().zip(&of_unit) {
        for (value, method) in row.iter().zip(&of_method) {
            rest += (value - unit - method + all) * (value - unit - method + all);
        }
    }
    let (df1, df2) = (whole[0].len() - 1, (whole[0].len() - 1) * (units - 1));
    let spread: f64 = whole.iter().flatten().map(|value| (value - all) * (value - all)).sum();
    // What rounding leaves of an interaction that is none.
    if rest <= 1e-20 * n * k * all * all || rest <= 1e-14 * spread {
        return Err(NoEstimate::NoVariance);
    }
    let f = (between / df1 as f64) / (rest / df2 as f64);
    let p = f_upper(f, df1 as f64, df2 as f64).p;
    Ok(RepeatedMeasuresF { F: f, df1, df2, p, units, incomplete: table.len() - units })
}

/// `mimique test min-f`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "min-f",
    question: "Do methods differ over other people and other clips alike? Clark's min F'",
    options: &[&[
        ProcedureOption::text("rating", "Column of numbers").required(),
        ProcedureOption::text("method", "Column of the methods, all seen by everybody").required(),
        ProcedureOption::text("participant", "Column of the people").required(),
        ProcedureOption::text("segment", "Column of the segments").required(),
    ]],
    run,
    sample: Sample::PeopleAndSegments,
    r: r#"
# Clark's min F' of ratings of methods by people over segments.
min_f <- function(rating, method, participant, segment) {
  f_over <- function(unit) {
    m <- tapply(rating, list(unit, method), mean)
    m <- m[complete.cases(m), ]
    n <- nrow(m)
    k <- ncol(m)
    rest <- sum((m - outer(rowMeans(m), colMeans(m), "+") + mean(m))^2)
    c(f = n * sum((colMeans(m) - mean(m))^2) / (k - 1) / (rest / ((k - 1) * (n - 1))), df = (k - 1) * (n - 1))
  }
  a <- f_over(participant)
  b <- f_over(segment)
  f <- a[["f"]] * b[["f"]] / (a[["f"]] + b[["f"]])
  df <- (a[["f"]] + b[["f"]])^2 / (a[["f"]]^2 / b[["df"]] + b[["f"]]^2 / a[["df"]])
  means <- tapply(rating, method, mean)
  c(statistic = f, p = pf(f, length(means) - 1, df, lower.tail = FALSE), effect = diff(range(means)),
    n = length(rating))
}
"#,
    python: r#"
def min_f(rating, method, participant, segment):
    """Clark's min F' of ratings of methods by people over segments."""
    methods = np.unique(method)

    def f_over(unit):
        m = np.array(
            [[rating[(unit == u) & (method == a)].mean() for a in methods] for u in np.unique(unit)]
        )
        m = m[~np.isnan(m).any(axis=1)]
        n, k = m.shape
        rest = m - m.mean(axis=1, keepdims=True) - m.mean(axis=0, keepdims=True) + m.mean()
        df = (k - 1) * (n - 1)
        between = n * ((m.mean(axis=0) - m.mean()) ** 2).sum() / (k - 1)
        return between / ((rest**2).sum() / df), df

    (a, n1), (b, n2) = f_over(participant), f_over(segment)
    f = a * b / (a + b)
    df = (a + b) ** 2 / (a**2 / n2 + b**2 / n1)
    means = [rating[method == a].mean() for a in methods]
    return dict(
        statistic=f, p=stats.f.sf(f, len(methods) - 1, df), effect=np.ptp(means), n=len(rating)
    )
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factor = |option: &str| arguments.factor(table, option);
    let factors = [&factor("method")?, &factor("participant")?, &factor("segment")?];
    let outcome = min_f_prime(&arguments.numbers(table, "rating")?, factors)?;
    Ok(Answer::of_test(&outcome, words))
}

impl TestResult for MinFPrime {
    const NAMES: TestNames = TestNames {
        test: "min F'",
        short: "min F'",
        in_words: ["min F' test", "test min F'"],
        statistic: "min F'",
        statistic_symbol: "min F'",
        effect: "range of means",
        effect_symbol: "range",
        function: "min_f",
    };

    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let means = || self.means.iter().map(|(_, mean)| *mean);
        let range =
            means().fold(f64::NEG_INFINITY, f64::max) - means().fold(f64::INFINITY, f64::min);
        vec![Outcome::Ok(TestRow {
            variant: String::new(),
            term: Term::Whole,
            statistic: self.min_f,
            // The lower ones are not whole: the result has them.
            degrees_of_freedom: Vec::new(),
            p_value: self.p,
            ln_p: self.ln_p,
            effect: Some(range),
            n: self.n,
        })]
    }
}

fn words(result: &MinFPrime) -> String {
    let mut lines = Lines::default();
    lines.add("Min F': people and segments both drawn at random (Clark 1973)");
    lines.add(format!("{} ratings{}", result.n, lines::dropped(result.dropped)));
    for (name, found) in [("over people, F1", result.f1), ("over segments, F2", result.f2)] {
        let left_out = match found.incomplete {
            0 => String::new(),
            count => format!(", {count} of them without all methods left out"),
        };
        lines.add(format!(
            "{name} = {}, df = {} and {}, p {}{left_out}",
            format_number(found.F),
            found.df1,
            found.df2,
            lines::p_value(Some(found.p))
        ));
    }
    lines.add(format!(
        "min F' = {}, df = {} and {}, p {}",
        format_number(result.min_f),
        result.df1,
        format_number(result.df2),
        format_p(result.p, result.ln_p)
    ));
    let mut rows = vec![lines::row(["method", "mean"])];
    rows.extend(result.means.iter().map(|(m, mean)| vec![m.to_owned(), format_number(*mean)]));
    lines.table(&rows);
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_test_support::Random;

    fn factor(name: &str, codes: Vec<u32>) -> Factor {
        let most = codes.iter().max().map_or(0, |most| *most + 1);
        Factor { name: name.to_owned(), levels: (0..most).map(|l| l.to_string()).collect(), codes }
    }

    /// Ratings of 3 methods by people over segments, with an effect of each segment x method.
    fn tested(people: u32, segments: u32, clip_sd: f64, random: &mut Random) -> MinFPrime {
        let effects: Vec<f64> = (0..segments * 3).map(|_| clip_sd * random.normal()).collect();
        let (mut y, mut m, mut p, mut s) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for person in 0..people {
            for segment in 0..segments {
                for method in 0..3 {
                    y.push(4.0 + effects[(segment * 3 + method) as usize] + random.normal());
                    m.push(method);
                    p.push(person);
                    s.push(segment);
                }
            }
        }
        let rating = Numbers { name: "y".to_owned(), values: y };
        let factors = [&factor("m", m), &factor("p", p), &factor("s", s)];
        min_f_prime(&rating, factors).unwrap().ok().unwrap()
    }

    #[test]
    fn clips_that_differ_by_chance_do_not_count_as_methods() {
        // The share of positive tests at 5 % where methods are equal and clips differ by half a point.
        let mut random = Random::new(77);
        let (mut people, mut both) = (0, 0);
        for _ in 0..200 {
            let found = tested(12, 9, 0.5, &mut random);
            people += usize::from(found.f1.p < 0.05);
            both += usize::from(found.p < 0.05);
            assert!(found.min_f <= found.f1.F.min(found.f2.F));
        }
        // Binomial, 200 draws of 5 %: 18 is the 99.5 % quantile.
        assert!(both <= 18, "{both} of 200");
        assert!(people > 60, "{people} of 200: over people alone they do count");
    }

    #[test]
    fn gaps_leave_units_out_and_nothing_to_compare_is_undefined() {
        let rating = |values: &[f64]| Numbers { name: "y".to_owned(), values: values.to_vec() };
        let m = factor("m", vec![0, 1, 0, 1, 0, 1, 0, 1, 0]);
        let p = factor("p", vec![0, 0, 0, 0, 1, 1, 1, 1, 2]);
        let s = factor("s", vec![0, 0, 1, 1, 0, 0, 1, 1, 0]);
        let y = rating(&[1.0, 2.0, 2.0, 4.0, 3.0, 3.0, 2.0, 6.0, 4.0]);
        let found = min_f_prime(&y, [&m, &p, &s]).unwrap().ok().unwrap();
        assert_eq!((found.f1.units, found.f1.incomplete, found.f2.incomplete), (2, 1, 0));
        let parallel = rating(&[1.0, 2.0, 1.0, 2.0, 3.0, 4.0, 3.0, 4.0, 3.0]);
        let why = min_f_prime(&parallel, [&m, &p, &s]).unwrap();
        assert_eq!(why.reason(), Some(&NoEstimate::NoVariance.into()));
        let one = factor("p", vec![0; 9]);
        assert!(min_f_prime(&y, [&m, &one, &s]).is_err());
    }
}
