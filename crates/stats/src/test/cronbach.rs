//! Cronbach's α: whether questions that are added up measure one thing.
//!
//! α = k / (k - 1) (1 - Σ var_i / var of the sum) (Cronbach 1951), its interval by Feldt 1965:
//! (1 - α) F with n - 1 and (n - 1)(k - 1) degrees of freedom.

use mimique_locale::format_number;
use serde::Serialize;

use crate::distributions::tail::f_quantile;
use crate::outcome::{Labelled, Outcome};
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::{Refusal, Unfit};
use crate::summary::describe::moments;
use crate::table::sample::complete_rows;
use crate::table::{Numbers, Table};
use crate::undefined::NoEstimate;

/// Result of [`cronbach`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cronbach {
    /// Always `cronbach`.
    pub test: &'static str,
    /// People who answered all questions.
    pub n: usize,
    /// People left out because of a missing answer.
    pub dropped: usize,
    /// Questions.
    pub k: usize,
    /// α of the sum.
    pub alpha: f64,
    /// α of the standardised answers, from the mean correlation; none where a question has no variance.
    pub standardised: Option<f64>,
    /// Feldt's interval at 95 %.
    pub interval_95_feldt: [f64; 2],
    /// α without each question; none with two questions, or where the rest has no variance.
    pub alpha_if_dropped: Labelled<Option<f64>>,
    /// Correlation of each question with the sum of the others; none where one of them has no variance.
    pub item_rest_correlation: Labelled<Option<f64>>,
}

/// Questions whose answers are turned round before they are added up: low + high - answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Reversed {
    /// Names of the questions.
    pub questions: Vec<String>,
    /// Lowest and highest answer that can be given.
    pub range: [f64; 2],
}

/// α of the columns. Refuses fewer than two questions or people, a reversed question that is none of them or has
/// an answer outside the range; undefined where the sum has no variance.
pub fn cronbach(
    questions: &[Numbers],
    reversed: Option<&Reversed>,
) -> Result<Outcome<Cronbach>, Refusal> {
    let columns: Vec<&Numbers> = questions.iter().collect();
    if questions.len() < 2 {
        return Err(Unfit::TooFewQuestions { questions: questions.len() }.into());
    }
    let complete = complete_rows(&columns, &[])?;
    let mut values: Vec<Vec<f64>> =
        columns.iter().map(|column| complete.numbers(column).into_owned()).collect();
    let (n, k) = (complete.len(), questions.len());
    if n < 2 {
        let column = questions[0].name.clone();
        return Err(Unfit::TooFewPeople { column, people: n, needed: 2 }.into());
    }
    if let Some(reversed) = reversed {
        turn(questions, &mut values, reversed)?;
    }
    let Some(alpha) = alpha_of(&values, None) else {
        return Ok(Outcome::undefined(NoEstimate::NoVariance));
    };
    let names: Vec<String> = questions.iter().map(|question| question.name.clone()).collect();
    let (df1, df2) = ((n - 1) as f64, ((n - 1) * (k - 1)) as f64);
    let feldt = |p: f64| 1.0 - (1.0 - alpha) * f_quantile(p, df1, df2);
    let rest = |item: usize| {
        let others = sum_without(&values, Some(item));
        correlation(&values[item], &others)
    };
    Ok(Outcome::Ok(Cronbach {
        test: "cronbach",
        n,
        dropped: complete.dropped(),
        k,
        alpha,
        standardised: standardised(&values),
        interval_95_feldt: [feldt(0.975), feldt(0.025)],
        alpha_if_dropped: Labelled::zip(
            &names,
            (0..k).map(|item| (k > 2).then(|| alpha_of(&values, Some(item))).flatten()),
        ),
        item_rest_correlation: Labelled::zip(&names, (0..k).map(rest)),
    }))
}

fn turn(
    questions: &[Numbers],
    values: &mut [Vec<f64>],
    reversed: &Reversed,
) -> Result<(), Refusal> {
    let [low, high] = reversed.range;
    for name in &reversed.questions {
        let place = questions.iter().position(|question| question.name == *name);
        let place = place.ok_or_else(|| Refusal::NoColumn {
            column: name.clone(),
            columns: questions.iter().map(|question| question.name.clone()).collect(),
        })?;
        if let Some(value) = values[place].iter().find(|value| !(low..=high).contains(*value)) {
            return Err(
                Unfit::OutsideRange { column: name.clone(), value: *value, low, high }.into()
            );
        }
        values[place].iter_mut().for_each(|value| *value = low + high - *value);
    }
    Ok(())
}

fn variance(values: &[f64]) -> f64 {
    moments(values).1.unwrap_or(0.0)
}

fn sum_without(values: &[Vec<f64>], dropped: Option<usize>) -> Vec<f64> {
    let used = || values.iter().enumerate().filter(|(item, _)| Some(*item) != dropped);
    (0..values[0].len()).map(|row| used().map(|(_, column)| column[row]).sum()).collect()
}

/// α of all questions but one; none where their sum has no variance.
fn alpha_of(values: &[Vec<f64>], dropped: Option<usize>) -> Option<f64> {
    let k = (values.len() - usize::from(dropped.is_some())) as f64;
    let own = values.iter().enumerate().filter(|(item, _)| Some(*item) != dropped);
    let parts: f64 = own.map(|(_, column)| variance(column)).sum();
    let whole = variance(&sum_without(values, dropped));
    // What rounding leaves of answers that always add up to the same.
    (whole > 1e-12 * parts).then(|| k / (k - 1.0) * (1.0 - parts / whole))
}

fn correlation(x: &[f64], y: &[f64]) -> Option<f64> {
    let ((mean_x, var_x), (mean_y, var_y)) = (moments(x), moments(y));
    let spread = (var_x? * var_y?).sqrt();
    let product: f64 = x.iter().zip(y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    (spread > 0.0).then(|| product / (x.len() - 1) as f64 / spread)
}

/// k r / (1 + (k - 1) r) with r the mean correlation.
fn standardised(values: &[Vec<f64>]) -> Option<f64> {
    let pairs = mimique_adaptive::all_pairs(values.len());
    let all: Option<Vec<f64>> =
        pairs.iter().map(|&(a, b)| correlation(&values[a], &values[b])).collect();
    let (k, r) = (values.len() as f64, all?.iter().sum::<f64>() / pairs.len() as f64);
    let below = 1.0 + (k - 1.0) * r;
    (below > 1e-12).then(|| k * r / below)
}

/// `mimique test cronbach`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "cronbach",
    question: "Do questions that are added up measure one thing? Cronbach's alpha",
    options: &[&[
        ProcedureOption::list("questions", "Columns of numbers, one a question").required(),
        ProcedureOption::list("reversed", "Those of them that are turned round")
            .requires(&["range"]),
        ProcedureOption::list("range", "Lowest and highest answer, for what is turned round"),
    ]],
    run,
    sample: Sample::Coefficient,
    r: r#"
# Cronbach's alpha with Feldt's interval; m has a row per person, a column per question.
cronbach <- function(m) {
  k <- ncol(m)
  alpha <- k / (k - 1) * (1 - sum(apply(m, 2, var)) / var(rowSums(m)))
  ends <- 1 - (1 - alpha) * qf(c(0.975, 0.025), nrow(m) - 1, (nrow(m) - 1) * (k - 1))
  c(alpha = alpha, low = ends[1], high = ends[2])
}
"#,
    python: r#"
def cronbach(m):
    """Cronbach's alpha with Feldt's interval; a row per person, a column per question."""
    n, k = m.shape
    alpha = k / (k - 1) * (1 - m.var(axis=0, ddof=1).sum() / m.sum(axis=1).var(ddof=1))
    low, high = 1 - (1 - alpha) * stats.f.ppf([0.975, 0.025], n - 1, (n - 1) * (k - 1))
    return dict(alpha=alpha, low=low, high=high)
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let names = arguments.list("questions");
    let questions = names.iter().map(|name| table.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let reversed = match arguments.list("reversed") {
        [] => None,
        questions => {
            let numbers: Vec<f64> = arguments
                .list("range")
                .iter()
                .filter_map(|word| word.trim().parse().ok())
                .collect();
            let range = <[f64; 2]>::try_from(numbers).ok().filter(|[low, high]| low < high);
            let word = arguments.list("range").join(",");
            let range = range.ok_or(Refusal::Unfit(Unfit::NotARange { option: "range", word }))?;
            Some(Reversed { questions: questions.to_vec(), range })
        }
    };
    Ok(Answer::of(&cronbach(&questions, reversed.as_ref())?, words))
}

fn words(result: &Cronbach) -> String {
    let mut lines = Lines::default();
    lines.add(format!(
        "Cronbach's alpha of {} questions, {} people{}",
        result.k,
        result.n,
        lines::dropped(result.dropped)
    ));
    let [low, high] = result.interval_95_feldt;
    lines.add(format!(
        "alpha = {}, 95 % interval {} to {} (Feldt); standardised {}",
        format_number(result.alpha),
        format_number(low),
        format_number(high),
        lines::optional(result.standardised)
    ));
    let mut rows = vec![lines::row(["question", "alpha without it", "correlation with the rest"])];
    for (question, alpha) in result.alpha_if_dropped.iter() {
        let rest = result.item_rest_correlation.get(question).copied().flatten();
        rows.push(vec![question.to_owned(), lines::optional(*alpha), lines::optional(rest)]);
    }
    lines.table(&rows);
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(values: &[&[f64]]) -> Vec<Numbers> {
        let name = |place: usize| format!("q{}", place + 1);
        let of = |(place, values): (usize, &&[f64])| Numbers {
            name: name(place),
            values: values.to_vec(),
        };
        values.iter().enumerate().map(of).collect()
    }

    #[test]
    fn questions_that_say_the_same_have_one_and_a_reversed_one_is_turned() {
        let same = columns(&[&[1.0, 4.0, 2.0, 5.0], &[1.0, 4.0, 2.0, 5.0]]);
        let found = cronbach(&same, None).unwrap().ok().unwrap();
        assert!((found.alpha - 1.0).abs() < 1e-14 && found.standardised == Some(1.0));
        assert_eq!(found.alpha_if_dropped.get("q1"), Some(&None), "one question has no alpha");
        let turned = columns(&[&[1.0, 4.0, 2.0, 5.0], &[6.0, 3.0, 5.0, 2.0]]);
        let reversed = Reversed { questions: vec!["q2".to_owned()], range: [1.0, 6.0] };
        let other = cronbach(&turned, Some(&reversed)).unwrap().ok().unwrap();
        assert!((other.alpha - found.alpha).abs() < 1e-14);
        assert!(cronbach(&turned, None).unwrap().reason().is_some(), "they add up to 7 always");
    }

    #[test]
    fn a_question_without_variance_is_told_apart() {
        let flat = columns(&[&[1.0, 4.0, 2.0, 5.0], &[2.0, 4.0, 1.0, 5.0], &[3.0; 4]]);
        let found = cronbach(&flat, None).unwrap().ok().unwrap();
        assert_eq!(found.standardised, None);
        assert_eq!(found.item_rest_correlation.get("q3"), Some(&None));
        assert!(found.item_rest_correlation.get("q1").unwrap().is_some());
        let none = columns(&[&[3.0; 4], &[2.0; 4]]);
        assert!(cronbach(&none, None).unwrap().reason().is_some());
    }

    #[test]
    fn missing_answers_leave_a_person_out_and_wrong_ranges_are_refused() {
        let gaps = columns(&[&[1.0, f64::NAN, 2.0, 5.0], &[2.0, 4.0, 1.0, 5.0]]);
        let found = cronbach(&gaps, None).unwrap().ok().unwrap();
        assert_eq!((found.n, found.dropped), (3, 1));
        let of = |question: &str, range| Reversed { questions: vec![question.to_owned()], range };
        let said = |reversed: &Reversed| cronbach(&gaps, Some(reversed)).unwrap_err().to_string();
        assert!(said(&of("q2", [1.0, 3.0])).contains('5'));
        assert!(said(&of("q9", [1.0, 7.0])).contains("\"q9\""));
        assert!(cronbach(&gaps[..1], None).is_err());
    }
}
