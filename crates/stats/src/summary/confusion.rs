//! Confusion matrix of what was shown and what was answered, and agreement.

use mimique_locale::format_number;
use serde::Serialize;

use crate::estimate::proportion::{Proportion, proportion};
use crate::outcome::Labelled;
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::factor::{Factor, alphabetical};
use crate::table::sample::complete_rows;

/// Result of [`confusion`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Confusion {
    /// Always `confusion`.
    pub test: &'static str,
    /// Trials.
    pub n: u64,
    /// Rows dropped because of missing values.
    pub dropped: usize,
    /// All labels shown or answered.
    pub labels: Vec<String>,
    /// Trials by shown label, then answered label.
    pub matrix: Labelled<Labelled<u64>>,
    /// Share of right answers.
    pub accuracy: f64,
    /// Its Clopper-Pearson interval.
    pub accuracy_ci_clopper_pearson: [f64; 2],
    /// Its Wilson interval.
    pub accuracy_ci_wilson: [f64; 2],
    /// Cohen's kappa; none where chance alone gives perfect agreement.
    pub kappa: Option<f64>,
    /// Share of a shown label that was recognised; none if it was never shown.
    pub recall: Labelled<Option<f64>>,
    /// Its Wilson interval.
    pub recall_ci_wilson: Labelled<Option<[f64; 2]>>,
    /// Share of an answered label that was right; none if it was never answered.
    pub precision: Labelled<Option<f64>>,
}

impl Confusion {
    /// Trials in which `truth` was shown and `answer` given.
    pub fn count(&self, truth: &str, answer: &str) -> u64 {
        self.matrix.get(truth).and_then(|row| row.get(answer)).copied().unwrap_or(0)
    }

    /// Labels that were shown.
    pub fn shown(&self) -> Vec<&str> {
        self.matrix
            .iter()
            .filter(|(_, row)| row.iter().any(|(_, count)| *count > 0))
            .map(|(label, _)| label)
            .collect()
    }
}

/// Counts answers. Truths and answers need not have the same labels.
pub fn confusion(truth: &Factor, answer: &Factor) -> Result<Confusion, Refusal> {
    let complete = complete_rows(&[], &[truth, answer])?;
    let dropped = complete.dropped();
    let (truth, answer) = (complete.factor(truth), complete.factor(answer));
    let mut labels = truth.levels.clone();
    labels.extend(answer.levels.iter().filter(|level| !truth.levels.contains(level)).cloned());
    labels.sort_by(|a, b| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => a.total_cmp(&b),
        _ => alphabetical(a, b),
    });
    let place = |level: &str| labels.iter().position(|label| label == level).unwrap_or(0);
    let truth_place: Vec<usize> = truth.levels.iter().map(|level| place(level)).collect();
    let answer_place: Vec<usize> = answer.levels.iter().map(|level| place(level)).collect();
    let size = labels.len();
    let mut counts = vec![vec![0u64; size]; size];
    for (&shown, &answered) in truth.codes.iter().zip(&answer.codes) {
        counts[truth_place[shown as usize]][answer_place[answered as usize]] += 1;
    }
    let shown: Vec<u64> = counts.iter().map(|row| row.iter().sum()).collect();
    let answered: Vec<u64> = (0..size).map(|j| counts.iter().map(|row| row[j]).sum()).collect();
    let right: u64 = (0..size).map(|i| counts[i][i]).sum();
    let n: u64 = shown.iter().sum();
    let total = n as f64;
    let observed = right as f64 / total;
    let chance: f64 =
        shown.iter().zip(&answered).map(|(&s, &a)| s as f64 / total * (a as f64 / total)).sum();
    let recall: Vec<Proportion> = (0..size).map(|i| proportion(counts[i][i], shown[i])).collect();
    let accuracy = proportion(right, n);
    Ok(Confusion {
        test: "confusion",
        n,
        dropped,
        matrix: Labelled::zip(
            &labels,
            counts.iter().map(|row| Labelled::zip(&labels, row.iter().copied())),
        ),
        accuracy: observed,
        accuracy_ci_clopper_pearson: accuracy.clopper_pearson.unwrap_or([0.0, 1.0]),
        accuracy_ci_wilson: accuracy.wilson.unwrap_or([0.0, 1.0]),
        kappa: (chance < 1.0).then(|| (observed - chance) / (1.0 - chance)),
        recall: Labelled::zip(&labels, recall.iter().map(|share| share.proportion)),
        recall_ci_wilson: Labelled::zip(&labels, recall.iter().map(|share| share.wilson)),
        precision: Labelled::zip(
            &labels,
            (0..size).map(|i| (answered[i] > 0).then(|| counts[i][i] as f64 / answered[i] as f64)),
        ),
        labels,
    })
}

/// `mimique test confusion`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "confusion",
    question: "What was shown against what was answered: accuracy, recall, precision, kappa",
    options: &[&[
        ProcedureOption::text("truth", "Column of what was shown").required(),
        ProcedureOption::text("answer", "Column of what was answered").required(),
    ]],
    run,
    sample: Sample::Other,
    r: r#"
confusion <- function(truth, answer) {
  labels <- sort(unique(c(truth, answer)))
  counts <- table(factor(truth, labels), factor(answer, labels))
  n <- sum(counts)
  p <- sum(diag(counts)) / n
  chance <- sum(rowSums(counts) / n * colSums(counts) / n)
  z <- qnorm(0.975)
  centre <- (p + z^2 / (2 * n)) / (1 + z^2 / n)
  reach <- z * sqrt(p * (1 - p) / n + z^2 / (4 * n^2)) / (1 + z^2 / n)
  c(n = n, accuracy = p, wilson_low = max(0, centre - reach), wilson_high = min(1, centre + reach),
    kappa = (p - chance) / (1 - chance))
}
"#,
    python: r#"
def confusion(truth, answer):
    n = len(truth)
    right = (truth == answer).sum()
    interval = stats.binomtest(int(right), n).proportion_ci(method="wilson")
    labels = set(truth) | set(answer)
    chance = sum((truth == label).sum() / n * ((answer == label).sum() / n) for label in labels)
    p = right / n
    return dict(
        n=n,
        accuracy=p,
        wilson_low=interval.low,
        wilson_high=interval.high,
        kappa=(p - chance) / (1 - chance),
    )
"#,
    golden_cases: "confusion",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let truth = arguments.factor(table, "truth")?;
    let result = confusion(&truth, &arguments.factor(table, "answer")?)?;
    Ok(Answer::of(&Outcome::Ok(result), words))
}

fn words(result: &Confusion) -> String {
    let mut lines = Lines::default();
    lines.add("Confusion matrix: shown in rows, answered in columns");
    let heading = result.labels.iter().map(String::as_str).chain(["recall"]);
    let mut rows = vec![lines::row(std::iter::once("").chain(heading))];
    for (label, counts) in result.matrix.iter() {
        let mut cells = vec![label.to_owned()];
        cells.extend(counts.iter().map(|(_, count)| count.to_string()));
        cells.push(lines::optional(result.recall.get(label).copied().flatten()));
        rows.push(cells);
    }
    let mut precision = vec!["precision".to_owned()];
    precision.extend(result.precision.iter().map(|(_, share)| lines::optional(*share)));
    rows.push(precision);
    lines.table(&rows);
    let [low, high] = result.accuracy_ci_wilson;
    lines.add(format!(
        "accuracy = {} of {} trials, 95 % interval {} to {} (Wilson){}",
        format_number(result.accuracy),
        result.n,
        format_number(low),
        format_number(high),
        lines::dropped(result.dropped)
    ));
    lines.add(format!("Cohen's kappa = {}", lines::optional(result.kappa)));
    lines.into_text()
}
