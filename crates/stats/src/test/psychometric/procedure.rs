//! `mimique test psychometric`: options, words, and the functions of R and Python.

use mimique_adaptive::Shape;
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
use crate::words::format_number;

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
# A cumulative normal psychometric function by maximum likelihood; lapse is fixed.
psychometric <- function(level, n, correct, guess = 0.5, lapse = 0.02) {
  minus_likelihood <- function(theta) {
    p <- guess + (1 - guess - lapse) * pnorm((level - theta[1]) / exp(theta[2]))
    -sum(ifelse(correct > 0, correct * log(p), 0) + ifelse(n > correct, (n - correct) * log(1 - p), 0))
  }
  starts <- expand.grid(quantile(level, 1:9 / 10), log(diff(range(level)) / c(2, 5, 12, 30)))
  heights <- apply(starts, 1, minus_likelihood)
  found <- list(par = unlist(starts[which.min(heights), ]))
  for (round in 1:5) found <- optim(found$par, minus_likelihood, method = "BFGS", control = list(reltol = 1e-15))
  c(location = found$par[[1]], scale = exp(found$par[[2]]), loglik = -found$value)
}
"#,
    python: r#"
def psychometric(level, n, correct, guess=0.5, lapse=0.02):
    """A cumulative normal psychometric function by maximum likelihood; lapse is fixed."""
    from scipy.optimize import minimize
    from scipy.special import xlog1py, xlogy

    def minus_likelihood(theta):
        p = guess + (1 - guess - lapse) * stats.norm.cdf((level - theta[0]) / math.exp(theta[1]))
        return -(xlogy(correct, p) + xlog1py(n - correct, -p)).sum()

    width = np.ptp(level)
    starts = [
        (m, math.log(width / share))
        for m in np.quantile(level, np.arange(1, 10) / 10)
        for share in (2, 5, 12, 30)
    ]
    theta = min(starts, key=minus_likelihood)
    for _ in range(5):
        found = minimize(minus_likelihood, theta, method="BFGS", options=dict(gtol=1e-9))
        theta = found.x
    return dict(location=theta[0], scale=math.exp(theta[1]), loglik=-found.fun)
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
