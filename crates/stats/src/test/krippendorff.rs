//! Krippendorff's α: agreement of any number of raters on units, with gaps, for four levels of measurement.
//!
//! α = 1 - D_o / D_e on the coincidence matrix o: each pair of values of a unit of m values counts
//! 1 / (m - 1) (Krippendorff 2004, Content Analysis, chapter 11). Units with fewer than two values tell nothing.

use mimique_locale::format_number;
use serde::Serialize;

use crate::estimate::resampled::resampled_interval;
use crate::outcome::{Labelled, Outcome};
use crate::procedure::arguments::{
    Arguments, Choice, DEFAULT_ROUNDS, ProcedureOption, ROUNDS, SEED,
};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::{Refusal, Unfit};
use crate::table::Table;
use crate::table::factor::Factor;
use crate::table::number::parse_number;
use crate::table::sample::complete_rows;
use crate::undefined::NoEstimate;

/// What distances between values mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum MeasurementLevel {
    /// Values differ or not.
    Nominal,
    /// Values have an order.
    Ordinal,
    /// Differences have a meaning.
    Interval,
    /// Ratios have a meaning: there is a zero.
    Ratio,
}

impl MeasurementLevel {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Nominal, Self::Ordinal, Self::Interval, Self::Ratio];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nominal => "nominal",
            Self::Ordinal => "ordinal",
            Self::Interval => "interval",
            Self::Ratio => "ratio",
        }
    }
}

/// Values of units by several raters.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitValues {
    /// The values that occur, in order; for nominal ones, names.
    pub names: Vec<String>,
    /// The same as numbers; NaN for names.
    numbers: Vec<f64>,
    /// For each unit, the places of its values.
    units: Vec<Vec<usize>>,
    /// Rows left out because of missing values.
    pub dropped: usize,
}

/// α at one level.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AlphaEstimate {
    /// 1 where all agree, 0 where they agree as by chance.
    pub alpha: f64,
    /// Percentile interval at 95 % over resampled units; none without draws.
    pub interval: Option<[f64; 2]>,
}

/// Result of [`krippendorff`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Krippendorff {
    /// Always `krippendorff`.
    pub test: &'static str,
    /// α by level of measurement.
    pub levels: Labelled<Outcome<AlphaEstimate>>,
    /// Values in units that have two or more.
    pub pairable_values: usize,
    /// Units with two or more values.
    pub units_with_two_or_more: usize,
    /// Units.
    pub units: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// Draws of units.
    pub rounds: usize,
    /// Their seed.
    pub seed: u64,
}

impl UnitValues {
    /// From columns. Refuses two values of one unit by one rater.
    pub fn of(unit: &Factor, rater: &Factor, value: &Factor) -> Result<Self, Refusal> {
        let complete = complete_rows(&[], &[unit, rater, value])?;
        let all_units = unit.levels.len();
        let (rows, dropped) = (complete.to_vec(), complete.dropped());
        let value = value.rows(&rows);
        let mut seen = vec![false; all_units * rater.levels.len()];
        let mut units = vec![Vec::new(); all_units];
        for (at, &row) in rows.iter().enumerate() {
            let (own, judge) = (unit.codes[row] as usize, rater.codes[row] as usize);
            if std::mem::replace(&mut seen[own * rater.levels.len() + judge], true) {
                return Err(Refusal::RepeatedInBlock {
                    column: unit.name.clone(),
                    block: unit.levels[own].clone(),
                    group: rater.name.clone(),
                    level: rater.levels[judge].clone(),
                });
            }
            units[own].push(value.codes[at] as usize);
        }
        let number = |name: &String| parse_number(name, true).unwrap_or(f64::NAN);
        Ok(Self {
            numbers: value.levels.iter().map(number).collect(),
            names: value.levels,
            units,
            dropped,
        })
    }

    /// Whether all values are numbers.
    pub fn are_numbers(&self) -> bool {
        self.numbers.iter().all(|value| value.is_finite())
    }
}

/// Agreement at the given levels of measurement. Refuses names where numbers are needed.
pub fn krippendorff(
    values: &UnitValues,
    levels: &[MeasurementLevel],
    rounds: usize,
    seed: u64,
) -> Result<Krippendorff, Refusal> {
    let numbers = [MeasurementLevel::Ordinal, MeasurementLevel::Interval, MeasurementLevel::Ratio];
    if let Some(level) = levels.iter().find(|level| numbers.contains(level))
        && let Some(place) = values.numbers.iter().position(|number| number.is_nan())
    {
        let value = values.names[place].clone();
        return Err(Unfit::NameWhereNumber { value, level: level.name() }.into());
    }
    let pairable: Vec<&Vec<usize>> = values.units.iter().filter(|unit| unit.len() > 1).collect();
    let counted: Vec<CountedUnit> =
        pairable.iter().map(|unit| CountedUnit::of(unit, &values.numbers)).collect();
    let all: Vec<usize> = (0..pairable.len()).collect();
    let of = |level: MeasurementLevel| match alpha(values, &counted, &all, level) {
        None => Outcome::undefined(NoEstimate::NoDisagreementPossible),
        Some(found) => {
            let drawn = |draw: &[usize]| alpha(values, &counted, draw, level);
            let interval = resampled_interval(pairable.len(), rounds, seed, drawn);
            Outcome::Ok(AlphaEstimate { alpha: found, interval })
        }
    };
    Ok(Krippendorff {
        test: "krippendorff",
        levels: Labelled(
            levels.iter().map(|level| (level.name().to_owned(), of(*level))).collect(),
        ),
        pairable_values: pairable.iter().map(|unit| unit.len()).sum(),
        units_with_two_or_more: pairable.len(),
        units: values.units.len(),
        dropped: values.dropped,
        rounds,
        seed,
    })
}

/// How often each value occurs in a unit, values that do not left out, and one less than the number of values.
struct CountedUnit {
    counts: Vec<(usize, f64)>,
    others: f64,
    /// Sum and sum of squares of the values less the least of all.
    sums: [f64; 2],
}

impl CountedUnit {
    fn of(unit: &[usize], numbers: &[f64]) -> Self {
        let mut all = vec![0.0; numbers.len()];
        unit.iter().for_each(|value| all[*value] += 1.0);
        let counts = all.into_iter().enumerate().filter(|(_, count)| *count > 0.0).collect();
        let above = || unit.iter().map(|value| numbers[*value] - numbers[0]);
        let sums = [above().sum(), above().map(|x| x * x).sum()];
        Self { counts, others: (unit.len() - 1) as f64, sums }
    }
}

/// α of some of the units, each perhaps several times; none where all their values are equal.
fn alpha(
    values: &UnitValues,
    units: &[CountedUnit],
    chosen: &[usize],
    level: MeasurementLevel,
) -> Option<f64> {
    if level == MeasurementLevel::Interval {
        return alpha_of_differences(units, chosen);
    }
    let size = values.names.len();
    let mut coincidences = vec![0.0; size * size];
    for &unit in chosen {
        let unit = &units[unit];
        for &(c, of_c) in &unit.counts {
            for &(k, of_k) in &unit.counts {
                let with = if c == k { of_k - 1.0 } else { of_k };
                coincidences[c * size + k] += of_c * with / unit.others;
            }
        }
    }
    let counts: Vec<f64> = coincidences.chunks_exact(size).map(|row| row.iter().sum()).collect();
    let total: f64 = counts.iter().sum();
    let distances = Distances { level, values: &values.numbers, counts: &counts };
    let (mut observed, mut expected) = (0.0, 0.0);
    for c in 0..size {
        // Those of larger values are the same once more.
        distances.above(c, |k, distance| {
            observed += 2.0 * coincidences[c * size + k] * distance;
            expected += 2.0 * counts[c] * counts[k] * distance;
        });
    }
    (expected > 0.0).then(|| 1.0 - (total - 1.0) * observed / expected)
}

/// The same of squared differences, without a table of the values, of which there may be thousands.
fn alpha_of_differences(units: &[CountedUnit], chosen: &[usize]) -> Option<f64> {
    let (mut observed, mut total, mut sum, mut squares) = (0.0, 0.0, 0.0, 0.0);
    for &unit in chosen {
        let CountedUnit { others, sums: [own_sum, own_squares], .. } = units[unit];
        let size = others + 1.0;
        observed += (size * own_squares - own_sum * own_sum) / others;
        total += size;
        sum += own_sum;
        squares += own_squares;
    }
    let expected = total * squares - sum * sum;
    // What rounding leaves of a spread that is none.
    (expected > 1e-12 * total * squares).then(|| 1.0 - (total - 1.0) * observed / expected)
}

/// Squared distances of values.
struct Distances<'v> {
    level: MeasurementLevel,
    values: &'v [f64],
    /// How often each value occurs.
    counts: &'v [f64],
}

impl Distances<'_> {
    /// Tells the distance of a value from each value after it, values being named by their places.
    fn above(&self, c: usize, mut tell: impl FnMut(usize, f64)) {
        let mut between = self.counts[c];
        for k in c + 1..self.counts.len() {
            between += self.counts[k];
            let distance = match self.level {
                MeasurementLevel::Nominal => 1.0,
                MeasurementLevel::Ordinal => {
                    (between - (self.counts[c] + self.counts[k]) / 2.0).powi(2)
                }
                MeasurementLevel::Interval => (self.values[c] - self.values[k]).powi(2),
                MeasurementLevel::Ratio => {
                    let sum = self.values[c] + self.values[k];
                    let share = (self.values[c] - self.values[k]) / sum;
                    if sum == 0.0 { 0.0 } else { share.powi(2) }
                }
            };
            tell(k, distance);
        }
    }
}

/// `--level`.
const LEVEL: ProcedureOption = ProcedureOption::one_of(
    "level",
    "Level of measurement",
    &[
        Choice::new("nominal", "Values differ or not"),
        Choice::new("ordinal", "Values have an order"),
        Choice::new("interval", "Differences have a meaning"),
        Choice::new("ratio", "Ratios have a meaning"),
        Choice::new("all", "All four, or nominal alone where values are names"),
    ],
    Some("all"),
);

/// `mimique test krippendorff`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "krippendorff",
    question: "Do raters agree, with gaps and at any level of measurement? Krippendorff's alpha",
    options: &[&[
        ProcedureOption::text("value", "Column of what was answered").required(),
        ProcedureOption::text("clip", "Column of the clips that were rated").required(),
        ProcedureOption::text("rater", "Column of the raters").required(),
        LEVEL,
        ROUNDS,
        SEED,
    ]],
    run,
    sample: Sample::Coefficient,
    r: r#"
# Krippendorff's alpha; m has a row per clip, a column per rater, and NA where nothing was rated.
krippendorff <- function(m, level = "interval") {
  units <- lapply(seq_len(nrow(m)), function(i) m[i, !is.na(m[i, ])])
  units <- units[lengths(units) > 1]
  values <- sort(unique(unlist(units)))
  o <- Reduce(`+`, lapply(units, function(unit) {
    counts <- tabulate(match(unit, values), length(values))
    (outer(counts, counts) - diag(counts, length(values))) / (length(unit) - 1)
  }))
  n <- rowSums(o)
  distance <- outer(seq_along(values), seq_along(values), Vectorize(function(c, k) {
    switch(level,
      nominal = c != k,
      ordinal = (sum(n[min(c, k):max(c, k)]) - (n[c] + n[k]) / 2)^2,
      interval = (values[c] - values[k])^2,
      ratio = if (c == k) 0 else ((values[c] - values[k]) / (values[c] + values[k]))^2)
  }))
  c(alpha = 1 - (sum(n) - 1) * sum(o * distance) / sum(outer(n, n) * distance))
}
"#,
    python: r#"
def krippendorff(m, level="interval"):
    """Krippendorff's alpha; a row per clip, a column per rater, and NaN where nothing was rated."""
    units = [row[~np.isnan(row)] for row in m]
    units = [unit for unit in units if len(unit) > 1]
    values = np.unique(np.concatenate(units))
    o = np.zeros((len(values), len(values)))
    for unit in units:
        counts = (unit[:, None] == values).sum(axis=0)
        o += (np.outer(counts, counts) - np.diag(counts)) / (len(unit) - 1)
    n = o.sum(axis=1)
    places = range(len(values))

    def distance(c, k):
        if c == k:
            return 0.0
        if level == "nominal":
            return 1.0
        if level == "ordinal":
            return (n[min(c, k) : max(c, k) + 1].sum() - (n[c] + n[k]) / 2) ** 2
        if level == "interval":
            return (values[c] - values[k]) ** 2
        return ((values[c] - values[k]) / (values[c] + values[k])) ** 2

    d = np.array([[distance(c, k) for k in places] for c in places])
    return dict(alpha=1 - (n.sum() - 1) * (o * d).sum() / (np.outer(n, n) * d).sum())
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factor = |option: &str| arguments.factor(table, option);
    let values = UnitValues::of(&factor("clip")?, &factor("rater")?, &factor("value")?)?;
    let chosen = arguments.chosen(&LEVEL)?;
    let level = MeasurementLevel::ALL.into_iter().find(|level| Some(level.name()) == chosen);
    let levels = match level {
        Some(level) => vec![level],
        None if values.are_numbers() => MeasurementLevel::ALL.to_vec(),
        None => vec![MeasurementLevel::Nominal],
    };
    let rounds = arguments.whole("rounds", DEFAULT_ROUNDS)? as usize;
    let result = krippendorff(&values, &levels, rounds, arguments.whole("seed", 1)?)?;
    Ok(Answer::of(&Outcome::Ok(result), words))
}

fn words(result: &Krippendorff) -> String {
    let mut lines = Lines::default();
    lines.add(format!(
        "Krippendorff's alpha: {} values in {} of {} clips with two or more{}",
        result.pairable_values,
        result.units_with_two_or_more,
        result.units,
        lines::dropped(result.dropped)
    ));
    let mut rows = vec![lines::row(["level", "alpha", "95 % interval"])];
    let mut reasons = Vec::new();
    for (level, outcome) in result.levels.iter() {
        match outcome {
            Outcome::Ok(found) => rows.push(vec![
                level.to_owned(),
                format_number(found.alpha),
                found.interval.map_or_else(String::new, |[low, high]| {
                    format!("{} to {}", format_number(low), format_number(high))
                }),
            ]),
            Outcome::Undefined { reason } => {
                rows.push(lines::row([level, "undefined"]));
                reasons.push(format!("{level}: {reason}"));
            }
        }
    }
    lines.table(&rows);
    lines.warnings(&reasons);
    if result.rounds > 0 {
        lines.add(format!("intervals: {} draws of clips", result.rounds));
    }
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> UnitValues {
        let table = Table::parse(text.as_bytes()).unwrap();
        let factor = |name: &str| table.factor(name).unwrap();
        UnitValues::of(&factor("u"), &factor("r"), &factor("v")).unwrap()
    }

    fn alpha_of(values: &UnitValues, level: MeasurementLevel) -> Option<f64> {
        let found = krippendorff(values, &[level], 50, 3).unwrap();
        found.levels.0[0].1.clone().ok().map(|found| found.alpha)
    }

    #[test]
    fn who_agrees_has_one_and_what_never_differs_has_none() {
        let agreed = values("u,r,v\n1,a,3\n1,b,3\n2,a,5\n2,b,5\n3,a,1\n");
        let equal = values("u,r,v\n1,a,3\n1,b,3\n2,a,3\n2,b,3\n");
        let alone = values("u,r,v\n1,a,3\n2,a,5\n");
        for level in MeasurementLevel::ALL {
            assert_eq!(alpha_of(&agreed, level), Some(1.0), "{level:?}");
            assert_eq!(alpha_of(&equal, level), None, "{level:?}");
            assert_eq!(alpha_of(&alone, level), None, "{level:?}");
        }
    }

    #[test]
    fn intervals_hold_the_estimate_and_repeat_by_seed() {
        let mut text = "u,r,v\n".to_owned();
        let mut random = mimique_test_support::Random::new(8);
        for unit in 0..30 {
            let true_value = (random.uniform() * 5.0).floor();
            for rater in 0..3 {
                let value = if random.uniform() < 0.7 {
                    true_value
                } else {
                    (random.uniform() * 5.0).floor()
                };
                text += &format!("{unit},{rater},{value}\n");
            }
        }
        let values = values(&text);
        let of = |seed| krippendorff(&values, &MeasurementLevel::ALL, 400, seed).unwrap();
        assert_eq!(of(1), of(1));
        for (level, outcome) in of(1).levels.iter() {
            let found = outcome.clone().ok().unwrap();
            let [low, high] = found.interval.unwrap();
            assert!(
                low < found.alpha && found.alpha < high && high - low < 0.6,
                "{level} {found:?}"
            );
        }
    }

    #[test]
    fn names_are_nominal_only() {
        let named = values("u,r,v\n1,a,joy\n1,b,joy\n2,a,fear\n2,b,joy\n");
        assert!(alpha_of(&named, MeasurementLevel::Nominal).is_some());
        let refused = krippendorff(&named, &[MeasurementLevel::Interval], 0, 1).unwrap_err();
        assert!(refused.to_string().contains("\"fear\""), "{refused}");
        let table = Table::parse(b"u,r,v\n1,a,3\n1,a,4\n").unwrap();
        let factor = |name: &str| table.factor(name).unwrap();
        assert!(UnitValues::of(&factor("u"), &factor("r"), &factor("v")).is_err());
    }
}
