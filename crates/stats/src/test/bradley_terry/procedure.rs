//! `mimique test bradley-terry`: options, words, and the functions of R and Python.

use super::{BradleyTerry, BradleyTerryOptions, DefaultTest, WorthEstimates, bradley_terry};
use crate::outcome::Outcome;
use crate::procedure::arguments::{
    Arguments, Choice, DEFAULT_ROUNDS, ProcedureOption, ROUNDS, SEED,
};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::comparisons::{COMPARISON_OPTIONS, PairedComparisons};
use crate::undefined::Undefined;
use crate::words::{format_number, format_p};

/// `--side`.
pub(crate) const SIDE: ProcedureOption = ProcedureOption::one_of(
    "side",
    "Whether the model has a side bias",
    &[
        Choice::new("auto", "Where the orders that were shown tell it from the worths"),
        Choice::new("yes", "Always"),
        Choice::new("no", "Never"),
    ],
    Some("auto"),
);

/// What `--side` says.
pub(crate) fn side(arguments: &Arguments) -> Result<Option<bool>, Refusal> {
    Ok(match arguments.chosen(&SIDE)? {
        Some("yes") => Some(true),
        Some("no") => Some(false),
        _ => None,
    })
}

/// `mimique test bradley-terry`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "bradley-terry",
    question: "Which items are chosen over which? Worths from paired comparisons, with ties and a side bias",
    options: &[&COMPARISON_OPTIONS, &[SIDE, ROUNDS, SEED]],
    run,
    sample: Sample::Comparisons,
    r: r#"
# Bradley and Terry's model with a side bias and, where there are ties, Davidson's: Newton on the
# multinomial logit; equal worths by F on the covariance clustered by participant.
bradley_terry <- function(participant, left, right, answer) {
  items <- sort(unique(c(left, right)))
  k <- length(items)
  n <- length(answer)
  item <- function(shown) {
    m <- matrix(0, n, k)
    m[cbind(seq_len(n), match(shown, items))] <- 1
    m[, -k, drop = FALSE] - m[, k]
  }
  l <- item(left)
  r <- item(right)
  slopes <- list(left = cbind(l, 0.5), same = cbind((l + r) / 2, 0), right = cbind(r, -0.5))
  ties <- any(answer == "same")
  slopes <- if (ties) Map(cbind, slopes, c(0, 1, 0)) else slopes[c("left", "right")]
  theta <- numeric(k + ties)
  sum_of <- function(f) Reduce(`+`, lapply(names(slopes), f))
  for (step in 1:100) {
    eta <- sapply(slopes, function(x) x %*% theta)
    p <- exp(eta - apply(eta, 1, max))
    p <- p / rowSums(p)
    centre <- sum_of(function(a) slopes[[a]] * p[, a])
    scores <- sum_of(function(a) slopes[[a]] * (answer == a)) - centre
    information <- sum_of(function(a) crossprod((slopes[[a]] - centre) * sqrt(p[, a])))
    change <- solve(information, colSums(scores))
    theta <- theta + change
    if (max(abs(change)) < 1e-12) break
  }
  people <- rowsum(scores, participant)
  g <- nrow(people)
  q <- k - 1
  covariance <- solve(information) %*% crossprod(people) %*% solve(information) * g / (g - 1)
  w <- theta[1:q]
  f <- sum(w * solve(covariance[1:q, 1:q], w)) * (g - q) / (q * (g - 1))
  c(statistic = f, p = pf(f, q, g - q, lower.tail = FALSE), effect = diff(range(w, -sum(w))) / log(3), n = g)
}
"#,
    python: r#"
def bradley_terry(participant, left, right, answer):
    """With a side bias and, where there are ties, Davidson's: equal worths by F on the covariance
    clustered by participant."""
    items = np.unique(np.concatenate([left, right]))
    k = len(items)

    def item(shown):
        m = (np.asarray(shown)[:, None] == items).astype(float)
        return m[:, :-1] - m[:, -1:]

    l, r = item(left), item(right)
    column = np.ones((len(l), 1))
    slopes = dict(
        left=np.hstack([l, 0.5 * column]),
        same=np.hstack([(l + r) / 2, 0 * column]),
        right=np.hstack([r, -0.5 * column]),
    )
    if (answer == "same").any():
        slopes = {a: np.hstack([x, float(a == "same") * column]) for a, x in slopes.items()}
    else:
        del slopes["same"]
    theta = np.zeros(slopes["left"].shape[1])
    for _ in range(100):
        eta = np.column_stack([x @ theta for x in slopes.values()])
        p = np.exp(eta - eta.max(axis=1, keepdims=True))
        p /= p.sum(axis=1, keepdims=True)
        centre = sum(x * p[:, [i]] for i, x in enumerate(slopes.values()))
        scores = sum(x * (answer == a)[:, None] for a, x in slopes.items()) - centre
        information = sum(
            ((x - centre) * p[:, [i]]).T @ (x - centre) for i, x in enumerate(slopes.values())
        )
        change = np.linalg.solve(information, scores.sum(axis=0))
        theta = theta + change
        if np.abs(change).max() < 1e-12:
            break
    people = np.array([scores[participant == one].sum(axis=0) for one in np.unique(participant)])
    g, q = len(people), k - 1
    inverse = np.linalg.inv(information)
    covariance = inverse @ people.T @ people @ inverse * g / (g - 1)
    w = theta[:q]
    f = w @ np.linalg.solve(covariance[:q, :q], w) * (g - q) / (q * (g - 1))
    worth = np.append(w, -w.sum())
    return dict(statistic=f, p=stats.f.sf(f, q, g - q), effect=np.ptp(worth) / math.log(3), n=g)
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let options = BradleyTerryOptions {
        side: side(arguments)?,
        rounds: arguments.whole("rounds", DEFAULT_ROUNDS)? as usize,
        seed: arguments.whole("seed", 1)?,
        ..BradleyTerryOptions::default()
    };
    let result = bradley_terry(&PairedComparisons::named(table, arguments)?, &options)?;
    let test = Some((BradleyTerry::NAMES, result.rows()));
    Ok(Answer::of_result(&result, words(&result), test))
}

impl TestResult for BradleyTerry {
    const NAMES: TestNames = TestNames {
        test: "Bradley-Terry",
        short: "Bradley-Terry",
        in_words: ["Bradley-Terry model", "modèle de Bradley-Terry"],
        statistic: "F",
        statistic_symbol: "F",
        effect: "range of worths in JND",
        effect_symbol: "JND",
        function: "bradley_terry",
    };

    /// Equal worths, clustered by participant.
    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let found = match &self.estimates {
            Outcome::Ok(found) => found,
            Outcome::Undefined { reason } => return vec![Outcome::undefined(reason.clone())],
        };
        let Some(test) = found.items_cluster else {
            let items = self.items.len();
            let why =
                crate::NoEstimate::TooFewParticipants { participants: self.participants, items };
            return vec![Outcome::undefined(Undefined::from(why))];
        };
        let range =
            |end: fn(f64, f64) -> f64, from: f64| found.worth.iter().copied().fold(from, end);
        let width = range(f64::max, f64::NEG_INFINITY) - range(f64::min, f64::INFINITY);
        vec![Outcome::Ok(TestRow {
            variant: self.variant.to_owned(),
            term: Term::Whole,
            statistic: test.F,
            degrees_of_freedom: vec![test.df1, test.df2],
            p_value: test.p,
            ln_p: test.ln_p,
            effect: Some(width / super::clustered::JND),
            n: self.participants,
        })]
    }
}

fn words(result: &BradleyTerry) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Paired comparisons ({})", result.variant));
    lines.add(format!(
        "{} answers of {} participants about {} items, {} tied{}",
        result.trials,
        result.participants,
        result.items.len(),
        result.tied,
        lines::dropped(result.dropped)
    ));
    match (&result.estimates, &result.penalised) {
        (Outcome::Ok(found), _) => estimates(&mut lines, &result.items, found),
        (Outcome::Undefined { reason }, penalised) => {
            lines.add(format!("undefined: {reason}"));
            if let Some(found) = penalised {
                lines.add(format!("penalised estimates, by {}; no p", found.penalty));
                let mut rows = vec![lines::row(["item", "worth", "se"])];
                for ((item, worth), se) in
                    result.items.iter().zip(&found.worth).zip(&found.se_model)
                {
                    rows.push(vec![item.clone(), format_number(*worth), format_number(*se)]);
                }
                lines.table(&rows);
            }
        }
    }
    lines.into_text()
}

fn estimates(lines: &mut Lines, items: &[String], found: &WorthEstimates) {
    if let Some(test) = &found.items_cluster {
        lines.add(format!(
            "equal worths, clustered by participant: F = {}, df = {} and {}, p {}",
            format_number(test.F),
            test.df1,
            test.df2,
            format_p(test.p, test.ln_p)
        ));
    }
    if let Some(test) = &found.friedman_on_wins {
        let read = found.default_test == DefaultTest::FriedmanOnWins;
        let why = if read { " (read this one: participants are few)" } else { "" };
        lines.add(format!(
            "Friedman's test on the wins: chi-square = {}, df = {}, p {}{why}",
            format_number(test.statistic),
            test.df,
            lines::p_value(Some(test.p))
        ));
    }
    let ratio = &found.lr_items;
    lines.add(format!(
        "equal worths, answers independent: chi-square = {}, df = {}, p {}",
        format_number(ratio.statistic),
        ratio.df,
        format_p(ratio.p, ratio.ln_p)
    ));
    worths(lines, items, found);
    for (name, value) in [("side bias", &found.side), ("tie, ln nu", &found.tie)] {
        if let Some(value) = value {
            lines.add(format!(
                "{name} = {}, se {}{}",
                format_number(value.estimate),
                lines::optional(value.se_cluster),
                interval(value.interval)
            ));
        }
    }
    let fit = &found.lack_of_fit;
    lines.add(format!(
        "lack of fit: G2 = {}, df = {}, p {}",
        format_number(fit.G2),
        fit.df,
        lines::p_value(fit.p_drawn.map(|[g2, _]| g2).or(fit.p_G2))
    ));
    pairs(lines, found);
    if let Some(how) = found.bootstrap {
        let left_out = match how.disconnected {
            0 => String::new(),
            draws => format!(", {draws} without a join between all items left out"),
        };
        lines.add(format!(
            "intervals at 95 %: {} draws of participants, {} of them separated (penalised){left_out}",
            how.rounds, how.separated
        ));
    }
}

fn worths(lines: &mut Lines, items: &[String], found: &WorthEstimates) {
    let mut rows = vec![lines::row(["item", "worth", "se", "95 % interval", "JND"])];
    for (at, item) in items.iter().enumerate() {
        let se = found.se_cluster.as_ref().map(|se| se[at]);
        let ends = found.worth_interval.as_ref().map(|all| all[at]);
        rows.push(vec![
            item.clone(),
            format_number(found.worth[at]),
            lines::optional(se),
            ends.map_or_else(String::new, |[low, high]| {
                format!("{} to {}", format_number(low), format_number(high))
            }),
            format_number(found.worth[at] / super::clustered::JND),
        ]);
    }
    lines.table(&rows);
}

fn pairs(lines: &mut Lines, found: &WorthEstimates) {
    let mut rows = vec![lines::row(["pair", "JND", "preferred", "p", "corrected"])];
    for contrast in &found.contrasts {
        rows.push(vec![
            format!("{} | {}", contrast.a, contrast.b),
            format_number(contrast.jnd),
            format!("{} %", format_number(100.0 * contrast.preferred)),
            lines::p_value(contrast.p),
            lines::p_value(contrast.p_holm),
        ]);
    }
    lines.table(&rows);
}

fn interval(ends: Option<[f64; 2]>) -> String {
    ends.map_or_else(String::new, |[low, high]| {
        format!(", 95 % interval {} to {}", format_number(low), format_number(high))
    })
}
