//! Signal detection, one category against all others: sensitivity d', criterion c, bias ln β.
//!
//! A hit is the answer "anger" to anger, a false alarm the answer "anger" to anything else. With the rates
//! H = (h + 0.5) / (s + 1) and F = (f + 0.5) / (n + 1) (log-linear, Hautus 1995), d' = z(H) - z(F),
//! c = -(z(H) + z(F)) / 2, ln β = (z(F)² - z(H)²) / 2 (Macmillan and Creelman 2005); the standard error of d' is
//! by Gourevitch and Galanter 1967. Means over people come with t intervals.

use mimique_locale::{format_number, format_p};
use serde::Serialize;

use crate::distributions::tail::{normal_quantile_upper, t_quantile_upper, t_two_sided};
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::summary::describe::moments;
use crate::table::Table;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;
use crate::undefined::NoEstimate;

/// Signals of a person below which the person's own d' says little.
pub(crate) const FEW_SIGNALS: u64 = 5;

/// What was answered to signals and to noise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct SignalCounts {
    /// Answers "yes" to signals.
    pub hits: u64,
    /// Signals.
    pub signals: u64,
    /// Answers "yes" to noise.
    pub false_alarms: u64,
    /// Noise.
    pub noise: u64,
}

/// Sensitivity and bias.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sensitivity {
    /// z(H) - z(F).
    pub d_prime: f64,
    /// -(z(H) + z(F)) / 2: above 0 where "yes" is said rarely.
    pub criterion: f64,
    /// (z(F)² - z(H)²) / 2.
    pub ln_beta: f64,
    /// Standard error of d'.
    pub se_d_prime: f64,
}

impl SignalCounts {
    /// From log-linear rates, which are never 0 or 1. None without signals or without noise.
    pub fn log_linear(&self) -> Option<Sensitivity> {
        let rate = |yes: u64, all: u64| (yes as f64 + 0.5) / (all as f64 + 1.0);
        (self.signals > 0 && self.noise > 0).then(|| {
            self.of_rates(rate(self.hits, self.signals), rate(self.false_alarms, self.noise))
        })
    }

    /// From the rates as they are; none where one is 0 or 1.
    pub fn uncorrected(&self) -> Option<Sensitivity> {
        let inside = |yes: u64, all: u64| yes > 0 && yes < all;
        let defined = inside(self.hits, self.signals) && inside(self.false_alarms, self.noise);
        defined.then(|| {
            let rate = |yes: u64, all: u64| yes as f64 / all as f64;
            self.of_rates(rate(self.hits, self.signals), rate(self.false_alarms, self.noise))
        })
    }

    fn of_rates(&self, hit: f64, false_alarm: f64) -> Sensitivity {
        let z = |rate: f64| -normal_quantile_upper(rate);
        let (yes, no) = (z(hit), z(false_alarm));
        let variance = |rate: f64, z: f64, count: u64| {
            let density = libm::exp(-0.5 * z * z) / (2.0 * std::f64::consts::PI).sqrt();
            rate * (1.0 - rate) / (count as f64 * density * density)
        };
        let sum = variance(hit, yes, self.signals) + variance(false_alarm, no, self.noise);
        Sensitivity {
            d_prime: yes - no,
            criterion: -(yes + no) / 2.0,
            ln_beta: (no * no - yes * yes) / 2.0,
            se_d_prime: sum.sqrt(),
        }
    }
}

/// A person and the sensitivity to a category.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PersonSensitivity {
    /// The person.
    pub participant: String,
    /// What was answered.
    #[serde(flatten)]
    pub counts: SignalCounts,
    /// Log-linear; none where the person was shown no signal or no noise.
    pub sensitivity: Option<Sensitivity>,
}

/// Detection of a category among all others.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DetectedCategory {
    /// The category.
    pub category: String,
    /// The answers of all people together.
    #[serde(flatten)]
    pub counts: SignalCounts,
    /// Of all people together, log-linear.
    pub pooled_loglinear: Outcome<Sensitivity>,
    /// Of all people together, from the rates as they are.
    pub pooled_uncorrected: Outcome<Sensitivity>,
    /// Each person.
    pub people: Vec<PersonSensitivity>,
    /// Mean d' of the people; none where nobody has one.
    pub d_prime_mean: Option<f64>,
    /// Its standard deviation; none with one person.
    pub d_prime_sd: Option<f64>,
    /// Its t interval at 95 %.
    pub d_prime_interval_95: Option<[f64; 2]>,
    /// Mean criterion of the people.
    pub criterion_mean: Option<f64>,
    /// t of the mean d' against 0, its degrees of freedom, p and its logarithm.
    pub t: Option<MeanTest>,
    /// Whether somebody was shown fewer than 5 signals: then the pooled numbers are the ones to read.
    pub few_signals: bool,
}

/// A mean against 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MeanTest {
    /// Mean / standard error.
    pub statistic: f64,
    /// People less one.
    pub df: usize,
    /// Two-sided t tail.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
}

/// Result of [`detection`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Detection {
    /// Always `detection`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// People.
    pub participants: usize,
    /// Answers.
    pub n: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// Each category that was shown.
    pub categories: Vec<DetectedCategory>,
}

/// Sensitivity to each category that was shown. Refuses fewer than two of them.
pub fn detection(
    participant: &Factor,
    truth: &Factor,
    answer: &Factor,
) -> Result<Detection, Refusal> {
    let complete = complete_rows(&[], &[participant, truth, answer])?;
    let (rows, dropped) = (complete.to_vec(), complete.dropped());
    let [participant, truth, answer] = [participant, truth, answer].map(|f| f.rows(&rows));
    truth.require_levels(2)?;
    let person_count = participant.levels.len();
    let categories = truth.levels.iter().enumerate().map(|(shown, name)| {
        let said = answer.levels.iter().position(|level| level == name);
        let mut people =
            vec![SignalCounts { hits: 0, signals: 0, false_alarms: 0, noise: 0 }; person_count];
        for row in 0..rows.len() {
            let own = &mut people[participant.codes[row] as usize];
            let yes = u64::from(said == Some(answer.codes[row] as usize));
            if truth.codes[row] as usize == shown {
                own.signals += 1;
                own.hits += yes;
            } else {
                own.noise += 1;
                own.false_alarms += yes;
            }
        }
        category(name, &participant.levels, &people)
    });
    Ok(Detection {
        test: "detection",
        variant: "one category against all others; log-linear rates (Hautus 1995)",
        participants: person_count,
        n: rows.len(),
        dropped,
        categories: categories.collect(),
    })
}

fn category(name: &str, names: &[String], people: &[SignalCounts]) -> DetectedCategory {
    let sum = |of: fn(&SignalCounts) -> u64| people.iter().map(of).sum();
    let counts = SignalCounts {
        hits: sum(|own| own.hits),
        signals: sum(|own| own.signals),
        false_alarms: sum(|own| own.false_alarms),
        noise: sum(|own| own.noise),
    };
    let own = |(participant, counts): (&String, &SignalCounts)| PersonSensitivity {
        participant: participant.clone(),
        counts: *counts,
        sensitivity: counts.log_linear(),
    };
    let each: Vec<PersonSensitivity> = names.iter().zip(people).map(own).collect();
    let of_people = |of: fn(&Sensitivity) -> f64| -> Vec<f64> {
        each.iter().filter_map(|person| person.sensitivity.as_ref()).map(of).collect()
    };
    let sensitivities = of_people(|own| own.d_prime);
    let criteria = of_people(|own| own.criterion);
    let some = |values: &[f64]| (!values.is_empty()).then(|| moments(values));
    let (mean, sd) = some(&sensitivities)
        .map_or((None, None), |(mean, variance)| (Some(mean), variance.map(f64::sqrt)));
    let size = sensitivities.len() as f64;
    let spread = mean.zip(sd).map(|(mean, sd)| (mean, sd / size.sqrt()));
    let defined = |found: Option<Sensitivity>, why: NoEstimate| {
        found.map_or_else(|| Outcome::undefined(why), Outcome::Ok)
    };
    DetectedCategory {
        category: name.to_owned(),
        counts,
        pooled_loglinear: defined(counts.log_linear(), NoEstimate::OnlySignalsOrNoise),
        pooled_uncorrected: defined(counts.uncorrected(), NoEstimate::RateAtBound),
        few_signals: people.iter().any(|own| own.signals < FEW_SIGNALS),
        people: each,
        d_prime_mean: mean,
        d_prime_sd: sd,
        d_prime_interval_95: spread.map(|(mean, se)| {
            let reach = t_quantile_upper(0.025, size - 1.0) * se;
            [mean - reach, mean + reach]
        }),
        criterion_mean: some(&criteria).map(|(mean, _)| mean),
        t: spread.filter(|(_, se)| *se > 0.0).map(|(mean, se)| {
            let tail = t_two_sided(mean / se, size - 1.0);
            let df = sensitivities.len() - 1;
            MeanTest { statistic: mean / se, df, p: tail.p, ln_p: tail.ln_p }
        }),
    }
}

/// `mimique test detection`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "detection",
    question: "How well is each category told from all others? d', criterion, ln beta",
    options: &[&[
        ProcedureOption::text("participant", "Column of the people").required(),
        ProcedureOption::text("truth", "Column of what was shown").required(),
        ProcedureOption::text("answer", "Column of what was answered").required(),
    ]],
    run,
    sample: Sample::Answers,
    r: r#"
# d' and criterion (rows) of one category against all others by log-linear rates, of each person (columns); NA of who
# was shown no signal or no noise.
sensitivity <- function(participant, truth, answer, category) {
  sapply(split(seq_along(truth), participant), function(own) {
    signal <- truth[own] == category
    yes <- answer[own] == category
    if (all(signal) || !any(signal)) return(c(d_prime = NA, criterion = NA))
    z <- qnorm(c((sum(yes & signal) + 0.5) / (sum(signal) + 1), (sum(yes & !signal) + 0.5) / (sum(!signal) + 1)))
    c(d_prime = z[1] - z[2], criterion = -(z[1] + z[2]) / 2)
  })
}
# The mean of d' over people against 0.
detection <- function(participant, truth, answer, category) {
  d_prime <- sensitivity(participant, truth, answer, category)["d_prime", ]
  test <- t.test(d_prime)
  c(statistic = unname(test$statistic), p = test$p.value, effect = mean(d_prime), n = length(d_prime))
}
"#,
    python: r#"
def sensitivity(participant, truth, answer, category):
    """d' and criterion of one category against all others by log-linear rates, person by person; nan of who was
    shown no signal or no noise."""
    found = {}
    for person in np.unique(participant):
        signal = truth[participant == person] == category
        yes = answer[participant == person] == category
        hit = stats.norm.ppf(((yes & signal).sum() + 0.5) / (signal.sum() + 1))
        false_alarm = stats.norm.ppf(((yes & ~signal).sum() + 0.5) / ((~signal).sum() + 1))
        one_kind = signal.all() or not signal.any()
        both = dict(d_prime=hit - false_alarm, criterion=-(hit + false_alarm) / 2)
        found[person] = {name: math.nan if one_kind else value for name, value in both.items()}
    return found


def detection(participant, truth, answer, category):
    """The mean of d' over people against 0."""
    found = sensitivity(participant, truth, answer, category).values()
    d_prime = [own["d_prime"] for own in found]
    test = stats.ttest_1samp(d_prime, 0)
    return dict(statistic=test.statistic, p=test.pvalue, effect=np.mean(d_prime), n=len(d_prime))
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factor = |option: &str| arguments.factor(table, option);
    let result = detection(&factor("participant")?, &factor("truth")?, &factor("answer")?)?;
    Ok(Answer::of_test(&Outcome::Ok(result), words))
}

impl TestResult for Detection {
    const NAMES: TestNames = TestNames {
        test: "d' against 0",
        short: "d'",
        in_words: ["t test of d' against 0", "test t de d' contre 0"],
        statistic: "t",
        statistic_symbol: "t",
        effect: "mean d'",
        effect_symbol: "d'",
        function: "detection",
    };

    /// A row for each category.
    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let row = |found: &DetectedCategory| match (found.t, found.d_prime_mean) {
            (Some(test), Some(mean)) => Outcome::Ok(TestRow {
                variant: "log-linear".to_owned(),
                term: Term::Differences(found.category.clone()),
                statistic: test.statistic,
                degrees_of_freedom: vec![test.df],
                p_value: test.p,
                ln_p: test.ln_p,
                effect: Some(mean),
                n: test.df + 1,
            }),
            _ => Outcome::undefined(NoEstimate::NoSpreadOfPeople),
        };
        self.categories.iter().map(row).collect()
    }
}

fn words(result: &Detection) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Signal detection ({})", result.variant));
    lines.add(format!(
        "{} answers of {} people{}",
        result.n,
        result.participants,
        lines::dropped(result.dropped)
    ));
    let heads = [
        "category",
        "hits",
        "false alarms",
        "d' of all",
        "se",
        "c of all",
        "mean d'",
        "95 % interval",
        "p",
    ];
    let mut rows = vec![lines::row(heads)];
    for found in &result.categories {
        let counts = found.counts;
        let pooled = found.pooled_loglinear.clone().ok();
        let of = |value: fn(&Sensitivity) -> f64| lines::optional(pooled.as_ref().map(value));
        let interval = found.d_prime_interval_95.map_or_else(String::new, |[low, high]| {
            format!("{} to {}", format_number(low), format_number(high))
        });
        rows.push(vec![
            found.category.clone(),
            format!("{} of {}", counts.hits, counts.signals),
            format!("{} of {}", counts.false_alarms, counts.noise),
            of(|own| own.d_prime),
            of(|own| own.se_d_prime),
            of(|own| own.criterion),
            lines::optional(found.d_prime_mean),
            interval,
            found.t.map_or_else(|| "undefined".to_owned(), |test| format_p(test.p, test.ln_p)),
        ]);
    }
    lines.table(&rows);
    if result.categories.iter().any(|found| found.few_signals) {
        lines.add(format!(
            "note: somebody was shown a category fewer than {FEW_SIGNALS} times: read d' of all answers together"
        ));
    }
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_tells_nothing_has_no_sensitivity_and_bias_has_its_sign() {
        let counts = SignalCounts { hits: 7, signals: 19, false_alarms: 7, noise: 19 };
        let found = counts.log_linear().unwrap();
        assert!(found.d_prime.abs() < 1e-15 && found.ln_beta.abs() < 1e-15);
        assert!(found.criterion > 0.0, "says yes rarely");
        let mirrored = SignalCounts { hits: 12, signals: 19, false_alarms: 12, noise: 19 };
        let other = mirrored.log_linear().unwrap();
        assert!((found.criterion + other.criterion).abs() < 1e-14);
        assert!((found.se_d_prime - other.se_d_prime).abs() < 1e-14);
    }

    #[test]
    fn rates_of_nothing_and_all_are_undefined_unless_corrected() {
        for counts in [
            SignalCounts { hits: 0, signals: 5, false_alarms: 2, noise: 5 },
            SignalCounts { hits: 5, signals: 5, false_alarms: 2, noise: 5 },
            SignalCounts { hits: 2, signals: 5, false_alarms: 0, noise: 5 },
            SignalCounts { hits: 2, signals: 5, false_alarms: 5, noise: 5 },
        ] {
            assert_eq!(counts.uncorrected(), None);
            assert!(counts.log_linear().unwrap().se_d_prime.is_finite());
        }
        let none = SignalCounts { hits: 0, signals: 0, false_alarms: 2, noise: 5 };
        assert_eq!((none.log_linear(), none.uncorrected()), (None, None));
    }

    #[test]
    fn who_was_shown_no_signal_is_not_in_the_mean() {
        let text = "p,t,a\n1,x,x\n1,x,y\n1,y,y\n2,x,x\n2,y,x\n2,y,y\n3,y,y\n3,y,x\n";
        let table = Table::parse(text.as_bytes()).unwrap();
        let factor = |name: &str| table.factor(name).unwrap();
        let found = detection(&factor("p"), &factor("t"), &factor("a")).unwrap();
        let x = &found.categories[0];
        let own: Vec<f64> =
            x.people.iter().filter_map(|p| p.sensitivity.map(|s| s.d_prime)).collect();
        assert_eq!((x.people.len(), own.len()), (3, 2));
        assert!((x.d_prime_mean.unwrap() - (own[0] + own[1]) / 2.0).abs() < 1e-15);
        assert!(x.few_signals);
        let one = "p,t,a\n1,x,x\n1,x,y\n";
        let table = Table::parse(one.as_bytes()).unwrap();
        let factor = |name: &str| table.factor(name).unwrap();
        assert!(detection(&factor("p"), &factor("t"), &factor("a")).is_err());
    }
}
