//! `mimique test bradley-terry`: options, words, and the functions of R and Python.

use mimique_locale::{format_number, format_p};

use super::{BradleyTerry, BradleyTerryOptions, DefaultTest, WorthEstimates, bradley_terry};
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, Choice, ProcedureOption, SEED};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::comparisons::{COMPARISON_OPTIONS, PairedComparisons};
use crate::undefined::Undefined;

/// `--rounds`: how often participants are drawn again.
const DRAWS: ProcedureOption = ProcedureOption::text(
    "rounds",
    "Draws of participants for the standard deviations of the worths over them [default: 0]",
);

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
    options: &[&COMPARISON_OPTIONS, &[SIDE, DRAWS, SEED]],
    run,
    sample: Sample::Comparisons,
    r: r#"
# Bradley and Terry's model with a side bias, where it is asked for, and, where there are ties,
# Davidson's: Newton on the multinomial logit; without worths all items are alike.
bradley_terry_fit <- function(left, right, answer, side, worths = TRUE) {
  items <- sort(unique(c(left, right)))
  k <- length(items)
  n <- length(answer)
  item <- function(shown) {
    m <- matrix(0, n, k)
    m[cbind(seq_len(n), match(shown, items))] <- 1
    if (worths) m[, -k, drop = FALSE] - m[, k] else m[, integer(), drop = FALSE]
  }
  l <- item(left)
  r <- item(right)
  slopes <- list(left = l, same = (l + r) / 2, right = r)
  if (side) slopes <- Map(cbind, slopes, c(0.5, 0, -0.5))
  slopes <- if (any(answer == "same")) Map(cbind, slopes, c(0, 1, 0)) else slopes[c("left", "right")]
  theta <- numeric(ncol(slopes$left))
  sum_of <- function(f) Reduce(`+`, lapply(names(slopes), f))
  for (step in 1:100) {
    eta <- sapply(slopes, function(x) x %*% theta)
    p <- exp(eta - apply(eta, 1, max))
    p <- p / rowSums(p)
    centre <- sum_of(function(a) slopes[[a]] * p[, a])
    scores <- sum_of(function(a) slopes[[a]] * (answer == a)) - centre
    information <- sum_of(function(a) crossprod((slopes[[a]] - centre) * sqrt(p[, a])))
    if (length(theta) == 0) break
    change <- solve(information, colSums(scores))
    theta <- theta + change
    if (max(abs(change)) < 1e-12) break
  }
  list(theta = theta, scores = scores, information = information, q = k - 1,
    loglik = sum(log(p[cbind(seq_len(n), match(answer, names(slopes)))])))
}
worth_range <- function(w) diff(range(w, -sum(w))) / log(3)

# Equal worths by F on the covariance clustered by participant.
bradley_terry <- function(participant, left, right, answer, side = TRUE) {
  fit <- bradley_terry_fit(left, right, answer, side)
  people <- rowsum(fit$scores, participant)
  g <- nrow(people)
  q <- fit$q
  covariance <- solve(fit$information) %*% crossprod(people) %*% solve(fit$information) * g / (g - 1)
  w <- fit$theta[1:q]
  f <- sum(w * solve(covariance[1:q, 1:q], w)) * (g - q) / (q * (g - 1))
  c(statistic = f, p = pf(f, q, g - q, lower.tail = FALSE), effect = worth_range(w), n = g)
}

# The same by the likelihood ratio, answers taken for independent.
bradley_terry_ratio <- function(participant, left, right, answer, side = TRUE) {
  fit <- bradley_terry_fit(left, right, answer, side)
  none <- bradley_terry_fit(left, right, answer, side, worths = FALSE)
  statistic <- 2 * (fit$loglik - none$loglik)
  c(statistic = statistic, p = pchisq(statistic, fit$q, lower.tail = FALSE),
    effect = worth_range(fit$theta[1:fit$q]), n = length(answer))
}
"#,
    python: r#"
def bradley_terry_fit(left, right, answer, side, worths=True):
    """Bradley and Terry's model with a side bias, where it is asked for, and, where there are ties,
    Davidson's: Newton on the multinomial logit; without worths all items are alike."""
    items = np.unique(np.concatenate([left, right]))
    k, n = len(items), len(answer)

    def item(shown):
        m = (np.asarray(shown)[:, None] == items).astype(float)
        return m[:, :-1] - m[:, -1:] if worths else m[:, :0]

    l, r = item(left), item(right)
    column = np.ones((n, 1))
    slopes = dict(left=l, same=(l + r) / 2, right=r)
    if side:
        slopes = {a: np.hstack([x, by * column]) for (a, x), by in zip(slopes.items(), (0.5, 0, -0.5))}
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
        if not len(theta):
            break
        change = np.linalg.solve(information, scores.sum(axis=0))
        theta = theta + change
        if np.abs(change).max() < 1e-12:
            break
    loglik = sum(np.log(p[answer == a, i]).sum() for i, a in enumerate(slopes))
    return theta, scores, information, loglik, k - 1


def worth_range(w):
    return np.ptp(np.append(w, -w.sum())) / math.log(3)


def bradley_terry(participant, left, right, answer, side=True):
    """Equal worths by F on the covariance clustered by participant."""
    theta, scores, information, _, q = bradley_terry_fit(left, right, answer, side)
    people = np.array([scores[participant == one].sum(axis=0) for one in np.unique(participant)])
    g = len(people)
    inverse = np.linalg.inv(information)
    covariance = inverse @ people.T @ people @ inverse * g / (g - 1)
    w = theta[:q]
    f = w @ np.linalg.solve(covariance[:q, :q], w) * (g - q) / (q * (g - 1))
    return dict(statistic=f, p=stats.f.sf(f, q, g - q), effect=worth_range(w), n=g)


def bradley_terry_ratio(participant, left, right, answer, side=True):
    """The same by the likelihood ratio, answers taken for independent."""
    theta, _, _, loglik, q = bradley_terry_fit(left, right, answer, side)
    *_, none, _ = bradley_terry_fit(left, right, answer, side, worths=False)
    statistic = 2 * (loglik - none)
    return dict(
        statistic=statistic,
        p=stats.chi2.sf(statistic, q),
        effect=worth_range(theta[:q]),
        n=len(answer),
    )
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let options = BradleyTerryOptions {
        side: side(arguments)?,
        rounds: arguments.whole("rounds", 0)? as usize,
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
        vec![Outcome::Ok(TestRow {
            variant: self.variant.to_owned(),
            term: Term::Whole,
            statistic: test.F,
            degrees_of_freedom: vec![test.df1, test.df2],
            p_value: test.p,
            ln_p: test.ln_p,
            effect: Some(found.range_in_jnd()),
            n: self.participants,
        })]
    }
}

/// Of the likelihood-ratio test of equal worths, which takes the answers for independent.
pub const WORTHS_RATIO: TestNames = TestNames {
    test: "Bradley-Terry, likelihood ratio",
    short: "LR",
    in_words: [
        "likelihood-ratio test of equal worths in the Bradley-Terry model",
        "test du rapport de vraisemblance des valeurs égales dans le modèle de Bradley-Terry",
    ],
    statistic: "chi-square",
    statistic_symbol: "χ²",
    function: "bradley_terry_ratio",
    ..BradleyTerry::NAMES
};

impl BradleyTerry {
    /// The row of [`WORTHS_RATIO`] in a table of tests.
    pub fn ratio_row(&self) -> Outcome<TestRow> {
        self.estimates.clone().map(|found| TestRow {
            variant: self.variant.to_owned(),
            term: Term::Whole,
            statistic: found.lr_items.statistic,
            degrees_of_freedom: vec![found.lr_items.df],
            p_value: found.lr_items.p,
            ln_p: found.lr_items.ln_p,
            effect: Some(found.range_in_jnd()),
            n: self.trials,
        })
    }
}

impl WorthEstimates {
    /// From the least to the greatest worth, in just noticeable differences.
    pub fn range_in_jnd(&self) -> f64 {
        let range =
            |end: fn(f64, f64) -> f64, from: f64| self.worth.iter().copied().fold(from, end);
        let width = range(f64::max, f64::NEG_INFINITY) - range(f64::min, f64::INFINITY);
        width / super::clustered::JND
    }

    /// Worths in just noticeable differences, each with its interval.
    pub fn in_jnd(&self) -> Vec<(f64, Option<[f64; 2]>)> {
        let interval = |item: usize| {
            let ends = self.worth_interval.as_ref().map(|all| all[item]);
            ends.map(|ends| ends.map(|end| end / super::clustered::JND))
        };
        let own = |(item, worth): (usize, &f64)| (worth / super::clustered::JND, interval(item));
        self.worth.iter().enumerate().map(own).collect()
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
        let sd = found.bootstrap_sd.iter().flatten().zip(items);
        let sd: Vec<String> =
            sd.map(|(sd, item)| format!("{item} {}", format_number(*sd))).collect();
        lines.add(format!(
            "standard deviations over {} draws of participants, {} of them separated (penalised){left_out}: {}",
            how.rounds,
            how.separated,
            sd.join(", ")
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
