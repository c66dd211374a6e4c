//! Thurstone's case V with ties and a side bias: worths on the scale of a normal judgement.
//!
//! With d = w_l - w_r + s: P(left) = Φ(d - τ), P(right) = Φ(-d - τ), P(same) the rest (Thurstone 1927; Glenn and
//! David 1960). A worth is in standard deviations of the judgement of one pair; 0.67449 of them are a just
//! noticeable difference, at which 75 % of the choices fall on one item.

use mimique_locale::{format_number, format_p};
use nalgebra::{Cholesky, DMatrix, DVector};
use serde::Serialize;

use crate::distributions::tail::normal_upper;
use crate::outcome::Outcome;
use crate::procedure::arguments::Arguments;
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::comparisons::{COMPARISON_OPTIONS, PairedComparisons, Presentation};
use crate::test::bradley_terry::{
    BradleyTerryOptions, EqualWorths, LikelihoodRatio, Model, SIDE, clustered_of, equal_worths,
    model_of, side,
};
use crate::undefined::NoEstimate;

/// Φ^-1(0.75): the difference of worths at which 75 % of choices fall on one item.
const JND: f64 = 0.674_489_750_196_081_7;
/// Newton's steps, at most; the likelihood is concave.
const STEPS: usize = 100;
/// A step below this is rounding.
const SETTLED: f64 = 1e-12;

/// Result of [`thurstone`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Thurstone {
    /// Always `thurstone`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// The items, in the order of the lists.
    pub items: Vec<String>,
    /// Participants.
    pub participants: usize,
    /// Answers.
    pub trials: usize,
    /// Rows left out.
    pub dropped: usize,
    /// Worths, sum 0.
    pub worth: Vec<f64>,
    /// Their standard errors, answers independent.
    pub se_model: Vec<f64>,
    /// Their standard errors, clustered by participant; none with one participant.
    pub se_cluster: Option<Vec<f64>>,
    /// Worths in just noticeable differences.
    pub jnd: Vec<f64>,
    /// The side bias.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<f64>,
    /// The threshold of ties.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tau: Option<f64>,
    /// Log likelihood.
    pub loglik: f64,
    /// Equal worths, clustered by participant; none where participants are too few.
    pub items_cluster: Option<EqualWorths>,
    /// Equal worths, answers independent.
    pub lr_items: LikelihoodRatio,
}

/// Worths on a normal scale. Refuses items that no answers join; separated answers are undefined.
pub fn thurstone(
    data: &PairedComparisons,
    options: &BradleyTerryOptions,
) -> Result<Outcome<Thurstone>, Refusal> {
    let shown = data.presentations();
    let model = model_of(data, &shown, options)?;
    if let Some(why) = model.separation(&shown, &data.items) {
        return Ok(Outcome::undefined(NoEstimate::Separated(why)));
    }
    let found = maximise(model, &shown);
    let (_, information) = derivatives(model, &found.at, &shown);
    let Some(inverse) = Cholesky::new(information).map(|factor| factor.inverse()) else {
        return Ok(Outcome::undefined(NoEstimate::Singular));
    };
    let worth = model.worth(&found.at);
    let participants = data.participants.len();
    let clustered = clustered_of(model, data, &inverse, |answer| {
        let (d, tau) = difference(model, &found.at, &worth, (answer.left, answer.right));
        let [by_d, by_tau] = terms(d, tau, answer.chosen as usize).first;
        [by_d, -by_d, by_d, by_tau]
    });
    let covariance = clustered.as_ref();
    let without = maximise(Model { worths: false, ..model }, &shown).log_likelihood;
    let df = model.items - 1;
    Ok(Outcome::Ok(Thurstone {
        test: "thurstone",
        variant: match (model.ties, model.side) {
            (false, false) => "case V",
            (false, true) => "case V, with a side bias",
            (true, false) => "case V, with a threshold of ties",
            (true, true) => "case V, with a threshold of ties and a side bias",
        },
        items: data.items.clone(),
        participants,
        trials: data.answers.len(),
        dropped: data.dropped,
        se_model: model.worth_errors(&inverse),
        se_cluster: covariance.map(|covariance| model.worth_errors(covariance)),
        jnd: worth.iter().map(|worth| worth / JND).collect(),
        side: model.side.then(|| model.side_bias(&found.at)),
        tau: model.ties.then(|| model.tie(&found.at)),
        loglik: found.log_likelihood,
        items_cluster: covariance.and_then(|c| equal_worths(model.items, participants, &worth, c)),
        lr_items: LikelihoodRatio::of(found.log_likelihood, without, df),
        worth,
    }))
}

struct Found {
    at: DVector<f64>,
    log_likelihood: f64,
}

/// d and τ of a presentation.
fn difference(
    model: Model,
    at: &DVector<f64>,
    worth: &[f64],
    (left, right): (usize, usize),
) -> (f64, f64) {
    let tau = if model.ties { model.tie(at) } else { 0.0 };
    (worth[left] - worth[right] + model.side_bias(at), tau)
}

/// The log probability of an answer with its first and second derivatives by d and τ.
struct Terms {
    ln_p: f64,
    first: [f64; 2],
    second: [[f64; 2]; 2],
}

/// Of the answer left (0), same (1) or right (2). Each is Φ(u) - Φ(v) with u and v linear in d and τ.
fn terms(d: f64, tau: f64, answer: usize) -> Terms {
    // u with its slopes, and v where it is not minus infinity. "Same" is as likely at -d as at d: at d > 0
    // both ends are negative, where differences of Φ lose nothing.
    let sign = if d < 0.0 { -1.0 } else { 1.0 };
    let (u, by_u, v) = match answer {
        0 => (d - tau, [1.0, -1.0], None),
        2 => (-d - tau, [-1.0, -1.0], None),
        _ => (tau - sign * d, [-sign, 1.0], Some((-tau - sign * d, [-sign, -1.0]))),
    };
    let ln_density = |z: f64| -0.5 * z * z - 0.5 * libm::log(2.0 * std::f64::consts::PI);
    let ln_below = |z: f64| normal_upper(-z).ln_p;
    let ln_p = match v {
        None => ln_below(u),
        Some((v, _)) => {
            let high = ln_below(u);
            high + libm::log(-libm::expm1(ln_below(v) - high))
        }
    };
    let mut first = [0.0; 2];
    let mut second = [[0.0; 2]; 2];
    let mut add = |z: f64, slopes: [f64; 2], by: f64| {
        let density = by * libm::exp(ln_density(z) - ln_p);
        for i in 0..2 {
            first[i] += density * slopes[i];
            for j in 0..2 {
                second[i][j] -= z * density * slopes[i] * slopes[j];
            }
        }
    };
    add(u, by_u, 1.0);
    if let Some((v, by_v)) = v {
        add(v, by_v, -1.0);
    }
    for i in 0..2 {
        for j in 0..2 {
            second[i][j] -= first[i] * first[j];
        }
    }
    Terms { ln_p, first, second }
}

fn log_likelihood(model: Model, at: &DVector<f64>, shown: &[Presentation]) -> f64 {
    let worth = model.worth(at);
    let mut sum = 0.0;
    for p in shown {
        let (d, tau) = difference(model, at, &worth, (p.left, p.right));
        for (answer, count) in p.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            sum += *count as f64 * terms(d, tau, answer).ln_p;
        }
    }
    sum
}

/// The score, and minus the second derivatives.
fn derivatives(
    model: Model,
    at: &DVector<f64>,
    shown: &[Presentation],
) -> (DVector<f64>, DMatrix<f64>) {
    let size = model.parameters();
    let worth = model.worth(at);
    let mut score = DVector::zeros(size);
    let mut information = DMatrix::zeros(size, size);
    for p in shown {
        let pair = (p.left, p.right);
        let (d, tau) = difference(model, at, &worth, pair);
        let mut slopes = [DVector::zeros(size), DVector::zeros(size)];
        model.scatter(pair, [1.0, -1.0, 1.0, 0.0], slopes[0].as_mut_slice());
        model.scatter(pair, [0.0, 0.0, 0.0, 1.0], slopes[1].as_mut_slice());
        for (answer, count) in p.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let own = terms(d, tau, answer);
            let count = *count as f64;
            for i in 0..2 {
                score.axpy(count * own.first[i], &slopes[i], 1.0);
                for j in 0..2 {
                    information.ger(-count * own.second[i][j], &slopes[i], &slopes[j], 1.0);
                }
            }
        }
    }
    (score, information)
}

fn maximise(model: Model, shown: &[Presentation]) -> Found {
    let mut at = DVector::zeros(model.parameters());
    if model.ties {
        // A threshold above 0, or the tie has no probability to begin with.
        at[model.parameters() - 1] = 0.5;
    }
    let mut height = log_likelihood(model, &at, shown);
    for _ in 0..STEPS {
        let (score, information) = derivatives(model, &at, shown);
        let Some(factor) = Cholesky::new(information) else { break };
        let step = factor.solve(&score);
        let mut share = 1.0;
        let found = loop {
            let next = &at + share * &step;
            let next_height = log_likelihood(model, &next, shown);
            if next_height >= height - 1e-12 * height.abs() {
                break Some((next, next_height));
            }
            share /= 2.0;
            if share < 1e-6 {
                break None;
            }
        };
        let Some((next, next_height)) = found else { break };
        let way = (&next - &at).amax();
        (at, height) = (next, next_height.max(height));
        if way <= SETTLED * (1.0 + at.amax()) {
            break;
        }
    }
    Found { at, log_likelihood: height }
}

/// `mimique test thurstone`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "thurstone",
    question: "Which items are chosen over which? Worths on a normal scale, Thurstone's case V",
    options: &[&COMPARISON_OPTIONS, &[SIDE]],
    run,
    sample: Sample::Comparisons,
    r: r#"
# Thurstone's case V with a side bias and, where there are ties, their threshold: equal worths by the
# likelihood ratio.
thurstone <- function(participant, left, right, answer) {
  items <- sort(unique(c(left, right)))
  k <- length(items)
  ties <- any(answer == "same")
  l <- match(left, items)
  r <- match(right, items)
  minus_likelihood <- function(theta, worths) {
    w <- if (worths) c(theta[1:(k - 1)], -sum(theta[1:(k - 1)])) else numeric(k)
    rest <- if (worths) theta[-(1:(k - 1))] else theta
    d <- w[l] - w[r] + rest[1]
    tau <- if (ties) exp(rest[2]) else 0
    p <- ifelse(answer == "left", pnorm(d - tau),
      ifelse(answer == "right", pnorm(-d - tau), pnorm(tau - abs(d)) - pnorm(-tau - abs(d))))
    -sum(log(p))
  }
  fit <- function(worths) {
    start <- c(if (worths) numeric(k - 1), 0, if (ties) log(0.5))
    for (round in 1:5) {
      found <- optim(start, minus_likelihood, worths = worths, method = "BFGS",
        control = list(reltol = 1e-15, maxit = 1000))
      start <- found$par
    }
    found
  }
  full <- fit(TRUE)
  statistic <- 2 * (fit(FALSE)$value - full$value)
  w <- full$par[1:(k - 1)]
  c(statistic = statistic, p = pchisq(statistic, k - 1, lower.tail = FALSE),
    effect = diff(range(w, -sum(w))) / qnorm(0.75), n = length(unique(participant)))
}
"#,
    python: r#"
def thurstone(participant, left, right, answer):
    """Case V with a side bias and, where there are ties, their threshold: equal worths by the
    likelihood ratio."""
    items = np.unique(np.concatenate([left, right]))
    k = len(items)
    l, r = np.searchsorted(items, left), np.searchsorted(items, right)
    ties = (answer == "same").any()

    def minus_likelihood(theta, worths):
        w = np.append(theta[: k - 1], -theta[: k - 1].sum()) if worths else np.zeros(k)
        rest = theta[k - 1 :] if worths else theta
        d = w[l] - w[r] + rest[0]
        tau = math.exp(rest[1]) if ties else 0.0
        same = stats.norm.cdf(tau - np.abs(d)) - stats.norm.cdf(-tau - np.abs(d))
        p = np.where(answer == "left", stats.norm.cdf(d - tau), stats.norm.cdf(-d - tau))
        return -np.log(np.where(answer == "same", same, p)).sum()

    def fit(worths):
        from scipy.optimize import minimize

        theta = np.zeros((k - 1) * worths + 1 + ties)
        if ties:
            theta[-1] = math.log(0.5)
        for _ in range(5):
            found = minimize(minus_likelihood, theta, worths, method="BFGS", options=dict(gtol=1e-9))
            theta = found.x
        return found

    full = fit(True)
    statistic = 2 * (fit(False).fun - full.fun)
    worth = np.append(full.x[: k - 1], -full.x[: k - 1].sum())
    return dict(
        statistic=statistic,
        p=stats.chi2.sf(statistic, k - 1),
        effect=np.ptp(worth) / stats.norm.ppf(0.75),
        n=len(set(participant)),
    )
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let options = BradleyTerryOptions { side: side(arguments)?, ..BradleyTerryOptions::default() };
    let outcome = thurstone(&PairedComparisons::named(table, arguments)?, &options)?;
    Ok(Answer::of_test(&outcome, words))
}

impl TestResult for Thurstone {
    const NAMES: TestNames = TestNames {
        test: "Thurstone",
        short: "Thurstone",
        in_words: ["Thurstone's case V", "cas V de Thurstone"],
        statistic: "chi-square",
        statistic_symbol: "χ²",
        effect: "range of worths in JND",
        effect_symbol: "JND",
        function: "thurstone",
    };

    /// Equal worths, answers independent.
    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let most = self.jnd.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = self.jnd.iter().copied().fold(f64::INFINITY, f64::min);
        vec![Outcome::Ok(TestRow {
            variant: self.variant.to_owned(),
            term: Term::Whole,
            statistic: self.lr_items.statistic,
            degrees_of_freedom: vec![self.lr_items.df],
            p_value: self.lr_items.p,
            ln_p: self.lr_items.ln_p,
            effect: Some(most - least),
            n: self.participants,
        })]
    }
}

fn words(result: &Thurstone) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Thurstone ({})", result.variant));
    lines.add(format!(
        "{} answers of {} participants about {} items{}",
        result.trials,
        result.participants,
        result.items.len(),
        lines::dropped(result.dropped)
    ));
    if let Some(test) = &result.items_cluster {
        lines.add(format!(
            "equal worths, clustered by participant: F = {}, df = {} and {}, p {}",
            format_number(test.F),
            test.df1,
            test.df2,
            format_p(test.p, test.ln_p)
        ));
    }
    let ratio = &result.lr_items;
    lines.add(format!(
        "equal worths, answers independent: chi-square = {}, df = {}, p {}",
        format_number(ratio.statistic),
        ratio.df,
        format_p(ratio.p, ratio.ln_p)
    ));
    let mut rows = vec![lines::row(["item", "worth", "se", "JND"])];
    for (at, item) in result.items.iter().enumerate() {
        rows.push(vec![
            item.clone(),
            format_number(result.worth[at]),
            lines::optional(result.se_cluster.as_ref().map(|se| se[at])),
            format_number(result.jnd[at]),
        ]);
    }
    lines.table(&rows);
    for (name, value) in [("side bias", result.side), ("threshold of ties", result.tau)] {
        if let Some(value) = value {
            lines.add(format!("{name} = {}", format_number(value)));
        }
    }
    lines.into_text()
}
