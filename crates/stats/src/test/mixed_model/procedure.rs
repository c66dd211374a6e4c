//! `mimique test mixed-model`.

use mimique_locale::{format_number, format_p};

use super::{MixedModel, MixedModelOptions, mixed_model};
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::factor::Factor;

/// `mimique test mixed-model`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "mixed-model",
    question: "Do ratings differ over other people and other clips? Cumulative link mixed model",
    options: &[&[
        ProcedureOption::text("rating", "Column of ratings; of two values: binomial").required(),
        ProcedureOption::list("factors", "Columns of the fixed effects; the first is tested")
            .required(),
        ProcedureOption::list(
            "groups",
            "Columns of the random effects, two joined by a colon for their combination: \
             person,person:method,segment,segment:method; the last is tested too",
        )
        .required(),
        ProcedureOption::flag(
            "interactions",
            "With all interactions of the factors, the last tested",
        ),
    ]],
    run,
    sample: Sample::MixedModel,
    r: r#"
# Cumulative link mixed model of ratings of methods by people over segments, with effects of people, of people
# with methods, of segments and of clips: the likelihood ratio test of the methods, and the widest odds ratio.
mixed_model <- function(rating, method, participant, segment) {
  if (!requireNamespace("ordinal", quietly = TRUE)) {
    stop("the package ordinal is not installed; install.packages(\"ordinal\")")
  }
  d <- data.frame(y = ordered(rating), m = factor(method), p = factor(participant), s = factor(segment))
  full <- ordinal::clmm(y ~ m + (1 | p) + (1 | p:m) + (1 | s) + (1 | s:m), d)
  reduced <- ordinal::clmm(y ~ 1 + (1 | p) + (1 | p:m) + (1 | s) + (1 | s:m), d)
  statistic <- 2 * (as.numeric(logLik(full)) - as.numeric(logLik(reduced)))
  c(statistic = statistic, p = pchisq(statistic, nlevels(d$m) - 1, lower.tail = FALSE),
    effect = exp(diff(range(c(0, full$beta)))), n = length(rating))
}
"#,
    python: r#"
def mixed_model(rating, method, participant, segment):
    """Cumulative link mixed model with effects of people, of people with methods, of segments and of
    clips, by Laplace's approximation: the likelihood ratio test of the methods, and the widest odds
    ratio."""
    from scipy.optimize import minimize

    def codes(*columns):
        return np.unique(np.column_stack(columns), axis=0, return_inverse=True)[1].ravel()

    y, m, p, s = (codes(c) for c in (rating, method, participant, segment))
    groups = [p, codes(p, m), s, codes(s, m)]
    sizes = [g.max() + 1 for g in groups]
    starts = np.cumsum([0] + sizes[:-1])
    z = np.zeros((len(y), sum(sizes)))
    for start, g in zip(starts, groups):
        z[np.arange(len(y)), start + g] = 1
    steps, methods = y.max(), m.max()
    x = (m[:, None] == np.arange(1, methods + 1)).astype(float)

    def logistic(t):
        return 0.5 * (1 + np.tanh(t / 2))

    def fit(fixed):
        modes = np.zeros(sum(sizes))

        def minus_likelihood(theta):
            nonlocal modes
            cuts = np.cumsum(np.append(theta[0], np.exp(theta[1:steps])))
            ends = np.concatenate([[-np.inf], cuts, [np.inf]])
            sds = np.repeat(theta[len(theta) - 4 :], sizes)
            eta = x @ theta[steps : steps + methods] if fixed else np.zeros(len(y))
            scaled = z * sds

            def terms(b):
                u = eta + scaled @ b
                high, low = logistic(ends[y + 1] - u), logistic(ends[y] - u)
                height = b @ b / 2 - np.log(np.maximum(high - low, 1e-300)).sum()
                return height, 1 - high - low, high * (1 - high) + low * (1 - low)

            b = modes
            height, first, second = terms(b)
            for _ in range(100):
                curvature = (scaled.T * second) @ scaled + np.eye(len(b))
                step = np.linalg.solve(curvature, scaled.T @ first + b)
                share = 1.0
                while terms(b - share * step)[0] > height + 1e-10 and share > 1e-8:
                    share /= 2
                b = b - share * step
                height, first, second = terms(b)
                if np.abs(step).max() < 1e-9:
                    break
            modes = b
            curvature = (scaled.T * second) @ scaled + np.eye(len(b))
            return height + np.linalg.slogdet(curvature)[1] / 2

        below = np.cumsum(np.bincount(y))[:-1] / len(y)
        cuts = np.log(below / (1 - below))
        theta = np.concatenate(
            [cuts[:1], np.log(np.diff(cuts)), np.zeros(methods * fixed), np.full(4, 0.5)]
        )
        for _ in range(3):
            found = minimize(minus_likelihood, theta, method="BFGS", options=dict(gtol=1e-6))
            theta = found.x
        return found

    full = fit(True)
    statistic = 2 * (fit(False).fun - full.fun)
    odds = np.append(0, full.x[steps : steps + methods])
    return dict(
        statistic=statistic,
        p=stats.chi2.sf(statistic, methods),
        effect=math.exp(np.ptp(odds)),
        n=len(y),
    )
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factors = arguments.factors(table)?;
    let groups = arguments.list("groups").iter();
    let groups: Vec<Factor> = groups.map(|name| grouping(table, name)).collect::<Result<_, _>>()?;
    let options = MixedModelOptions {
        interactions: arguments.has("interactions") && factors.len() > 1,
        ratio_of_last: true,
    };
    let factors: Vec<&Factor> = factors.iter().collect();
    let groups: Vec<&Factor> = groups.iter().collect();
    let outcome = mixed_model(&arguments.numbers(table, "rating")?, &factors, &groups, options)?;
    Ok(Answer::of_test(&outcome, words))
}

/// A column, or the combination of several joined by colons.
pub(super) fn grouping(table: &Table, name: &str) -> Result<Factor, Refusal> {
    if table.has(name) {
        return table.factor(name);
    }
    let mut columns = name.split(':');
    let mut whole = table.factor(columns.next().unwrap_or_default())?;
    for column in columns {
        whole = whole.crossed(&table.factor(column)?);
    }
    Ok(whole)
}

impl TestResult for MixedModel {
    const NAMES: TestNames = TestNames {
        test: "mixed model",
        short: "LR",
        in_words: [
            "likelihood ratio test of a cumulative link mixed model",
            "test du rapport de vraisemblance d’un modèle mixte à liens cumulatifs",
        ],
        statistic: "chi-square",
        statistic_symbol: "χ²",
        effect: "widest odds ratio",
        effect_symbol: "OR",
        function: "mixed_model",
    };

    /// The effect that is tested.
    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let wide = self.pairs.iter().map(|pair| pair.odds_ratio.max(1.0 / pair.odds_ratio));
        let ratio = &self.lr_effect.ratio;
        vec![Outcome::Ok(TestRow {
            variant: self.variant.to_owned(),
            term: Term::Whole,
            statistic: ratio.statistic,
            degrees_of_freedom: vec![ratio.df],
            p_value: ratio.p,
            ln_p: ratio.ln_p,
            effect: wide.reduce(f64::max),
            n: self.observations,
        })]
    }
}

fn words(result: &MixedModel) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Mixed model ({}, Laplace): {}", result.variant, result.formula));
    lines.add(format!("{} ratings{}", result.observations, lines::dropped(result.dropped)));
    let ratio = &result.lr_effect.ratio;
    lines.add(format!(
        "against the model with {} alone: chi-square = {}, df = {}, p {}",
        result.lr_effect.reduced,
        format_number(ratio.statistic),
        ratio.df,
        format_p(ratio.p, ratio.ln_p)
    ));
    if let Some(last) = &result.lr_last {
        lines.add(format!(
            "against the model without {}: chi-square = {}, half chi-square with df = 1, p {}",
            last.grouping,
            format_number(last.statistic),
            lines::p_value(Some(last.p_half_chi_square))
        ));
    }
    let mut rows = vec![lines::row(["coefficient", "log odds", "se", "z", "p"])];
    for (name, own) in result.coefficients.iter() {
        let numbers = [own.estimate, own.se, own.z, own.p].map(format_number);
        rows.push(lines::row([vec![name.to_owned()], numbers.to_vec()].concat()));
    }
    lines.table(&rows);
    for pair in &result.pairs {
        let [low, high] = pair.interval_95.map(format_number);
        lines.add(format!(
            "{} against {}: odds of a higher rating {} times ({low} to {high}), p {} (Holm); {} is the higher of two in {:.0} %",
            pair.b,
            pair.a,
            format_number(pair.odds_ratio),
            lines::p_value(Some(pair.p_holm)),
            pair.b,
            100.0 * pair.higher
        ));
    }
    let mut rows = vec![lines::row(["random effects", "levels", "sd"])];
    for ((name, sd), (_, levels)) in result.sd.iter().zip(result.levels.iter()) {
        rows.push(lines::row([name.to_owned(), levels.to_string(), format_number(*sd)]));
    }
    lines.table(&rows);
    for name in &result.at_zero {
        lines.add(format!("note: the standard deviation of {name} is 0, a bound"));
    }
    for name in &result.left_out {
        lines.add(format!(
            "note: {name} parts the answers as a grouping before it, and is left out"
        ));
    }
    lines.into_text()
}
