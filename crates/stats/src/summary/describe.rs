//! Description of one sample: location, spread, quartiles (type 7), t interval of the mean.

use mimique_locale::format_number;
use serde::Serialize;

use crate::distributions::tail::t_quantile_upper;
use crate::outcome::Labelled;
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption, RESPONSE};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::undefined::Undefined;

/// Result of [`describe`]. A field is none where it is not defined (spread of one value).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Description {
    /// Values.
    pub n: usize,
    /// Missing values.
    pub missing: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation with n - 1.
    pub sd: Option<f64>,
    /// Standard error of the mean.
    pub se: Option<f64>,
    /// 95 % t interval of the mean.
    pub mean_ci_t: Option<[f64; 2]>,
    /// Median.
    pub median: f64,
    /// Lower quartile, type 7 of Hyndman and Fan.
    pub q1: f64,
    /// Upper quartile, type 7.
    pub q3: f64,
    /// q3 - q1.
    pub iqr: f64,
    /// Median absolute deviation from the median, not scaled.
    pub mad_raw: f64,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

/// Describes a sample; NaN is missing.
pub fn describe(values: &[f64]) -> Outcome<Description> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    let missing = values.len() - sorted.len();
    let n = sorted.len();
    if n == 0 {
        return Outcome::undefined(Undefined::NoValue { missing });
    }
    sorted.sort_unstable_by(f64::total_cmp);
    let (mean, variance) = moments(&sorted);
    let sd = variance.map(f64::sqrt);
    let se = sd.map(|sd| sd / (n as f64).sqrt());
    let median = quantile_sorted(&sorted, 0.5);
    let (q1, q3) = (quantile_sorted(&sorted, 0.25), quantile_sorted(&sorted, 0.75));
    let mut deviations: Vec<f64> = sorted.iter().map(|value| (value - median).abs()).collect();
    Outcome::Ok(Description {
        n,
        missing,
        mean,
        sd,
        se,
        mean_ci_t: se.map(|se| {
            let reach = t_quantile_upper(0.025, (n - 1) as f64) * se;
            [mean - reach, mean + reach]
        }),
        median,
        q1,
        q3,
        iqr: q3 - q1,
        mad_raw: self::median(&mut deviations),
        min: sorted[0],
        max: sorted[n - 1],
    })
}

/// Mean and variance (n - 1) in two passes about a shifted origin, so that a large mean costs no digits
/// (Chan, Golub and LeVeque 1983). The variance of one value is none.
pub fn moments(values: &[f64]) -> (f64, Option<f64>) {
    let n = values.len() as f64;
    let origin = values.first().copied().unwrap_or(0.0);
    let mean_shift = compensated_sum(values.iter().map(|value| value - origin)) / n;
    if values.len() < 2 {
        return (origin + mean_shift, None);
    }
    let deviations = || values.iter().map(|value| (value - origin) - mean_shift);
    let squares = compensated_sum(deviations().map(|deviation| deviation * deviation));
    let rest = compensated_sum(deviations());
    let variance = (squares - rest * rest / n) / (n - 1.0);
    (origin + mean_shift, Some(variance.max(0.0)))
}

/// Neumaier's sum: the rounding errors are carried along.
pub(crate) fn compensated_sum(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0f64, 0.0f64);
    for value in values {
        let next = sum + value;
        lost += if sum.abs() >= value.abs() { (sum - next) + value } else { (value - next) + sum };
        sum = next;
    }
    sum + lost
}

/// Median; sorts its argument. Zero for no values.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    quantile_sorted(values, 0.5)
}

/// Quantile of ascending values by linear interpolation (type 7). Zero for no values.
pub fn quantile_sorted(sorted: &[f64], probability: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let place = probability * last as f64;
    let below = place.floor();
    let low = sorted[below as usize];
    let high = sorted[(below as usize + 1).min(last)];
    low + (place - below) * (high - low)
}

/// `mimique test describe`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "describe",
    question: "Mean, median, spread, quartiles",
    options: &[&[RESPONSE, ProcedureOption::text("by", "Describe each level of this column")]],
    run,
    sample: Sample::Other,
    r: r#"
describe <- function(v) {
  q <- quantile(v, c(0.25, 0.75), names = FALSE)
  c(n = length(v), mean = mean(v), sd = sd(v), median = median(v), q1 = q[1], q3 = q[2])
}
"#,
    python: r#"
def describe(v):
    q1, q3 = np.quantile(v, [0.25, 0.75])
    return dict(n=len(v), mean=v.mean(), sd=v.std(ddof=1), median=np.median(v), q1=q1, q3=q3)
"#,
    golden_cases: "descriptives",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let response = arguments.numbers(table, "response")?;
    let Some(by) = arguments.text("by") else {
        return Ok(Answer::of(&describe(&response.values), |result| words(&[("", result)])));
    };
    let factor = table.factor(by)?;
    factor.require_levels(1)?;
    let groups = (0..factor.levels.len() as u32).map(|level| {
        let rows = (0..factor.codes.len()).filter(|&row| factor.codes[row] == level);
        describe(&rows.map(|row| response.values[row]).collect::<Vec<_>>())
    });
    let groups = Labelled::zip(&factor.levels, groups.collect::<Vec<_>>());
    let described = DescribedGroups { test: "describe", by: by.to_owned(), groups };
    Ok(Answer::of(&Outcome::Ok(described), |result| words_of_groups(&result.groups)))
}

/// Descriptions by level, as a result of its own.
#[derive(Serialize)]
struct DescribedGroups {
    test: &'static str,
    by: String,
    groups: Labelled<Outcome<Description>>,
}

fn words(groups: &[(&str, &Description)]) -> String {
    let mut lines = Lines::default();
    let named = groups.iter().any(|(name, _)| !name.is_empty());
    let heading = lines::row([
        "",
        "n",
        "missing",
        "mean",
        "sd",
        "se",
        "95 % interval",
        "min",
        "q1",
        "median",
        "q3",
        "max",
        "MAD",
    ]);
    let mut rows = vec![heading];
    for (name, d) in groups {
        rows.push(vec![
            (*name).to_owned(),
            d.n.to_string(),
            d.missing.to_string(),
            format_number(d.mean),
            lines::optional(d.sd),
            lines::optional(d.se),
            d.mean_ci_t.map_or_else(
                || "undefined".to_owned(),
                |[low, high]| format!("{} to {}", format_number(low), format_number(high)),
            ),
            format_number(d.min),
            format_number(d.q1),
            format_number(d.median),
            format_number(d.q3),
            format_number(d.max),
            format_number(d.mad_raw),
        ]);
    }
    if named {
        lines.table(&rows);
    } else {
        // One sample reads better from top to bottom.
        let sample: Vec<Vec<String>> = rows[0]
            .iter()
            .zip(&rows[1])
            .skip(1)
            .map(|(name, value)| vec![name.clone(), value.clone()])
            .collect();
        lines.table(&sample);
    }
    lines.into_text()
}

fn words_of_groups(groups: &Labelled<Outcome<Description>>) -> String {
    let defined: Vec<(&str, &Description)> = groups
        .iter()
        .filter_map(|(level, outcome)| match outcome {
            Outcome::Ok(description) => Some((level, description)),
            Outcome::Undefined { .. } => None,
        })
        .collect();
    let mut text = if defined.is_empty() { String::new() } else { words(&defined) };
    for (level, outcome) in groups.iter() {
        if let Some(reason) = outcome.reason() {
            text += &format!("note: {level}: {reason}\n");
        }
    }
    text
}
