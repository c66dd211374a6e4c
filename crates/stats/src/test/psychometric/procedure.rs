//! `mimique test psychometric`: options, words, and the functions of R and Python.

use mimique_adaptive::Shape;
use mimique_locale::format_number;
use serde::Serialize;

use super::{
    BootstrapInterval, Lapse, LevelCount, PsychometricFit, PsychometricOptions, ThresholdPlace,
    bootstrap, psychometric,
};
use crate::outcome::Outcome;
use crate::procedure::arguments::{
    Arguments, Choice, DEFAULT_ROUNDS, ProcedureOption, ROUNDS, SEED,
};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::{Refusal, Unfit};
use crate::table::Table;
use crate::table::sample::complete_rows;

/// `--function`.
const FUNCTION: ProcedureOption = ProcedureOption::one_of(
    "function",
    "Form of the function",
    &[
        Choice::new("normal", "Cumulative normal"),
        Choice::new("logistic", "Logistic"),
        Choice::new("weibull", "Weibull, for levels above 0"),
    ],
    Some("normal"),
);

/// `mimique test psychometric`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "psychometric",
    question: "At which level is a difference seen? Psychometric function with threshold and intervals",
    options: &[&[
        ProcedureOption::text("level", "Column of the levels").required(),
        ProcedureOption::text("correct", "Column of right answers: counts with --n, else 0 or 1")
            .required(),
        ProcedureOption::text("n", "Column of how many answers a row stands for"),
        ProcedureOption::text("guess", "Share of right answers by chance [default: 0.5]"),
        ProcedureOption::text(
            "lapse",
            "Share of wrong answers where all is seen, or free: 0 to 0.2, prior Beta(1, 10) [default: free]",
        ),
        FUNCTION,
        ROUNDS,
        SEED,
    ]],
    run,
    sample: Sample::Coefficient,
    r: r#"
# A psychometric function by maximum likelihood; lapse is fixed, or NULL: free from 0 to 0.2 with the prior Beta(1, 10).
psychometric <- function(level, n, correct, guess = 0.5, lapse = 0.02, shape = "normal") {
  free <- is.null(lapse)
  weibull <- shape == "weibull"
  # theta: the level where F = 1/2, or its logarithm; the logarithm of spread or slope; the lapse. F with its slopes.
  seen <- function(theta) {
    spread <- exp(theta[2])
    if (weibull) {
      ratio <- ifelse(level > 0, spread * (log(pmax(level, 0)) - theta[1]), -1e3)
      u <- log(2) * exp(ratio)
      return(cbind(-expm1(-u), -spread * u * exp(-u), u * exp(-u) * ratio))
    }
    z <- (level - theta[1]) / spread
    density <- if (shape == "normal") dnorm(z) else dlogis(z)
    cbind(if (shape == "normal") pnorm(z) else plogis(z), -density / spread, -density * z)
  }
  share <- function(theta) guess + (1 - guess - theta[3]) * seen(theta)[, 1]
  prior <- function(own) if (free) 9 * log1p(-own) else 0
  height <- function(theta) {
    p <- share(theta)
    sum(ifelse(correct > 0, correct * log(p), 0) + ifelse(n > correct, (n - correct) * log(pmax(1 - p, 1e-300)), 0)) + prior(theta[3])
  }
  slope <- function(theta) {
    p <- share(theta)
    f <- seen(theta)
    surprise <- ifelse(p * (1 - p) > 0, (correct - n * p) / (p * (1 - p)), 0)
    c((1 - guess - theta[3]) * colSums(surprise * f[, 2:3]), -sum(surprise * f[, 1]) - if (free) 9 / (1 - theta[3]) else 0)
  }
  ends <- range(level[level > 0 | !weibull])
  if (weibull) ends <- log(ends)
  width <- diff(ends)
  spreads <- if (weibull) 0.5 * 2^(0:7) else width / 80 * 2.2^(0:7)
  reach <- if (weibull) c(0.01, 1000) else width * c(0.001, 1000)
  climb <- function(own) {
    starts <- as.matrix(expand.grid(seq(ends[1] - width / 4, ends[2] + width / 4, length.out = 17), log(spreads), own))
    theta <- starts[which.max(apply(starts, 1, height)), ]
    for (round in 1:3) {
      found <- optim(theta, height, slope, method = "L-BFGS-B", lower = c(ends[1] - 20 * width, log(reach[1]), if (free) 0 else own),
                     upper = c(ends[2] + 20 * width, log(reach[2]), if (free) 0.2 else own),
                     control = list(fnscale = -1, factr = 1, maxit = 1000))
      theta <- found$par
    }
    found
  }
  found <- lapply(if (free) c(0.01, 0.07, 0.15) else lapse, climb)
  best <- found[[which.max(vapply(found, `[[`, 0, "value"))]]
  half <- if (weibull) exp(best$par[[1]]) else best$par[[1]]
  spread <- exp(best$par[[2]])
  location <- if (weibull) half * log(2)^(-1 / spread) else half
  c(threshold = half, location = location, scale = spread, lapse = best$par[[3]], loglik = best$value - prior(best$par[[3]]))
}
"#,
    python: r#"
def psychometric(level, n, correct, guess=0.5, lapse=0.02, shape="normal"):
    """A psychometric function by maximum likelihood; lapse is fixed, or None: free from 0 to 0.2 with the prior
    Beta(1, 10)."""
    from scipy.optimize import minimize
    from scipy.special import expit, ndtr, xlog1py, xlogy

    weibull, free = shape == "weibull", lapse is None

    def prior(lapse):
        return 9 * np.log1p(-lapse) if free else 0.0

    def seen(theta):
        """F with its slopes. theta: the level where F = 1/2, or its logarithm; the logarithm of spread or slope; the
        lapse."""
        spread = np.exp(theta[1])
        if weibull:
            with np.errstate(divide="ignore"):
                ratio = np.maximum(spread * (np.log(level) - theta[0]), -1e3)
            u = math.log(2) * np.exp(ratio)
            return -np.expm1(-u), -spread * u * np.exp(-u), u * np.exp(-u) * ratio
        z = (level - theta[0]) / spread
        density = np.exp(-z * z / 2) / math.sqrt(2 * math.pi) if shape == "normal" else expit(z) * expit(-z)
        return ndtr(z) if shape == "normal" else expit(z), -density / spread, -density * z

    def minus_height(theta):
        f, by_half, by_spread = seen(theta)
        room = 1 - guess - theta[2]
        p = guess + room * f
        spread = p * (1 - p)
        surprise = np.where(spread > 0, (correct - n * p) / np.where(spread > 0, spread, 1), 0)
        slope = [room * surprise @ by_half, room * surprise @ by_spread, -surprise @ f - (9 / (1 - theta[2]) if free else 0)]
        return -(xlogy(correct, p) + xlog1py(n - correct, -p)).sum() - prior(theta[2]), -np.array(slope)

    used = level[level > 0] if weibull else level
    low, high = (math.log(end) if weibull else end for end in (used.min(), used.max()))
    width = high - low
    spreads = 0.5 * 2.0 ** np.arange(8) if weibull else width / 80 * 2.2 ** np.arange(8)
    least, most = (0.01, 1000) if weibull else (width / 1000, 1000 * width)
    places = np.linspace(low - width / 4, high + width / 4, 17)
    best = None
    for own in (0.01, 0.07, 0.15) if free else (lapse,):
        bounds = [(low - 20 * width, high + 20 * width), (math.log(least), math.log(most)), (0, 0.2) if free else (own, own)]
        starts = [(m, math.log(s), own) for m in places for s in spreads]
        theta = min(starts, key=lambda start: minus_height(start)[0])
        for _ in range(3):
            found = minimize(minus_height, theta, jac=True, method="L-BFGS-B", bounds=bounds, options=dict(ftol=1e-16, gtol=1e-11))
            theta = found.x
        if best is None or found.fun < best.fun:
            best = found
    half, spread, own = math.exp(best.x[0]) if weibull else best.x[0], math.exp(best.x[1]), best.x[2]
    location = half * math.log(2) ** (-1 / spread) if weibull else half
    return dict(threshold=half, location=location, scale=spread, lapse=own, loglik=-best.fun - prior(own))
"#,
    golden_cases: "",
};

/// What the command prints.
#[derive(Serialize)]
struct Told {
    test: &'static str,
    levels: Vec<LevelCount>,
    dropped: usize,
    lapse: Lapse,
    #[serde(flatten)]
    fit: PsychometricFit,
    bootstrap: Option<BootstrapInterval>,
    seed: u64,
}

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let (counts, dropped) = counts(table, arguments)?;
    let shape = arguments.chosen(&FUNCTION)?.and_then(Shape::from_name).unwrap_or(Shape::Normal);
    let lapse = match arguments.text("lapse") {
        None | Some("free") => Lapse::Free,
        Some(_) => Lapse::Fixed(arguments.real("lapse", [0.0, 0.999])?.unwrap_or(0.0)),
    };
    let guess = arguments.real("guess", [0.0, 0.999])?.unwrap_or(0.5);
    let options = PsychometricOptions { shape, guess, lapse };
    let (rounds, seed) = (arguments.whole("rounds", DEFAULT_ROUNDS)?, arguments.whole("seed", 1)?);
    let found = match psychometric(&counts, &options)? {
        Outcome::Undefined { reason } => {
            return Ok(Answer::of(&Outcome::<Told>::Undefined { reason }, words));
        }
        Outcome::Ok(found) => found,
    };
    let drawn = bootstrap(&counts, &options, &found.psychometric(), rounds as usize, seed)?;
    let told = Told {
        test: "psychometric",
        levels: counts,
        dropped,
        lapse,
        fit: found,
        bootstrap: drawn,
        seed,
    };
    Ok(Answer::of(&Outcome::Ok(told), words))
}

/// The answers of each level, in the order of the levels, and the rows left out.
fn counts(table: &Table, arguments: &Arguments) -> Result<(Vec<LevelCount>, usize), Refusal> {
    let level = arguments.numbers(table, "level")?;
    let correct = arguments.numbers(table, "correct")?;
    let n = arguments.has("n").then(|| arguments.numbers(table, "n")).transpose()?;
    let mut columns = vec![&level, &correct];
    columns.extend(n.as_ref());
    let complete = complete_rows(&columns, &[])?;
    let mut counts = Vec::with_capacity(complete.len());
    for row in complete.to_vec() {
        for column in &columns[1..] {
            let value = column.values[row];
            if value < 0.0 || value.fract() != 0.0 {
                let (column, line) = (column.name.clone(), table.line(row));
                return Err(Refusal::NotACount { column, line, value });
            }
        }
        let all = n.as_ref().map_or(1.0, |n| n.values[row]);
        let (right, level) = (correct.values[row], level.values[row]);
        if right > all {
            let (n, correct) = (all as u64, right as u64);
            return Err(Unfit::CountsOfLevel { row: row + 1, level, n, correct }.into());
        }
        counts.push(LevelCount { level, n: all as u64, correct: right as u64 });
    }
    counts.sort_by(|one: &LevelCount, other| one.level.total_cmp(&other.level));
    counts.dedup_by(|next, kept| {
        let same = next.level == kept.level;
        if same {
            kept.n += next.n;
            kept.correct += next.correct;
        }
        same
    });
    Ok((counts, complete.dropped()))
}

fn words(told: &Told) -> String {
    let fit = &told.fit;
    let mut lines = Lines::default();
    let answers: u64 = told.levels.iter().map(|own| own.n).sum();
    lines.add(format!(
        "Psychometric function ({}, guess {})",
        fit.function,
        format_number(fit.guess)
    ));
    lines.add(format!(
        "{answers} answers at {} levels{}",
        told.levels.len(),
        lines::dropped(told.dropped)
    ));
    let end = |end: Option<f64>| end.map_or_else(|| "without bound".to_owned(), format_number);
    lines.add(format!(
        "threshold, where F = 1/2: {}{}, 95 % interval {} to {} (profile)",
        format_number(fit.level_at_half),
        match fit.place {
            ThresholdPlace::Within => "",
            ThresholdPlace::Below => " (below all levels)",
            ThresholdPlace::Above => " (above all levels)",
        },
        end(fit.profile_95[0]),
        end(fit.profile_95[1])
    ));
    if let Some(drawn) = &told.bootstrap {
        let [low, high] = drawn.level_at_half;
        lines.add(format!(
            "  {} to {} by {} draws of answers, {} without a finite estimate",
            format_number(low),
            format_number(high),
            drawn.rounds,
            drawn.unbounded
        ));
    }
    lines.add(format!(
        "location {}, {} {}, lapse {}{}",
        format_number(fit.location),
        if fit.function == "weibull" { "slope" } else { "spread" },
        format_number(fit.scale_or_shape),
        format_number(fit.lapse_estimate),
        if told.lapse == Lapse::Free { " (free)" } else { " (fixed)" }
    ));
    lines.add(format!("deviance = {}, df = {}", format_number(fit.deviance), fit.df));
    let mut rows = vec![lines::row(["level", "right", "of", "share", "fitted"])];
    let function = fit.psychometric();
    for own in &told.levels {
        rows.push(vec![
            format_number(own.level),
            own.correct.to_string(),
            own.n.to_string(),
            format_number(own.correct as f64 / own.n as f64),
            format_number(function.right(own.level)),
        ]);
    }
    lines.table(&rows);
    lines.into_text()
}
