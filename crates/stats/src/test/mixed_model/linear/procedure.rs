//! `mimique test linear-mixed-model`.

use mimique_locale::{format_number, format_p};

use super::{LinearMixedModel, LinearMixedModelOptions, linear_mixed_model};
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::factor::Factor;
use crate::test::mixed_model::procedure::grouping;

/// `mimique test linear-mixed-model`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "linear-mixed-model",
    question: "Do numbers differ over other people and other clips? Linear mixed model by restricted maximum likelihood",
    options: &[&[
        ProcedureOption::text("response", "Column of numbers").required(),
        ProcedureOption::list("factors", "Columns of the fixed effects; the first is tested")
            .required(),
        ProcedureOption::list(
            "groups",
            "Columns of the random effects, two joined by a colon for their combination: \
             person,person:method,segment,segment:method",
        )
        .required(),
        ProcedureOption::flag(
            "interactions",
            "With all interactions of the factors, the last tested",
        ),
    ]],
    run,
    sample: Sample::LinearMixedModel,
    r: r#"
# Linear mixed model of responses to methods by people over segments, with effects of people, of people with methods, of
# segments and of clips: F of the methods with Satterthwaite's degrees of freedom, and the widest difference of means.
linear_mixed_model <- function(response, method, participant, segment) {
  if (!requireNamespace("lmerTest", quietly = TRUE)) {
    stop("the package lmerTest is not installed; install.packages(\"lmerTest\")")
  }
  d <- data.frame(y = response, m = factor(method), p = factor(participant), s = factor(segment))
  found <- lmerTest::lmer(y ~ m + (1 | p) + (1 | p:m) + (1 | s) + (1 | s:m), d)
  tested <- anova(found)
  c(statistic = tested[["F value"]], p = tested[["Pr(>F)"]],
    effect = diff(range(c(0, lme4::fixef(found)[-1]))), n = length(response))
}
"#,
    python: r#"
def linear_mixed_model(response, method, participant, segment):
    """Linear mixed model with effects of people, of people with methods, of segments and of clips, by
    restricted maximum likelihood: F of the methods with Satterthwaite's degrees of freedom, and the
    widest difference of means."""
    from scipy.optimize import minimize

    def codes(*columns):
        return np.unique(np.column_stack(columns), axis=0, return_inverse=True)[1].ravel()

    m, p, s = (codes(c) for c in (method, participant, segment))
    together = [g[:, None] == g for g in (p, codes(p, m), s, codes(s, m))]
    y = (response - response.mean()) / response.std()
    methods = m.max()
    x = np.column_stack([np.ones(len(y)), m[:, None] == np.arange(1, methods + 1)])

    def parts(sds):
        v = sum(sd**2 * both for sd, both in zip(sds, together)) + sds[-1] ** 2 * np.eye(len(y))
        inverse = np.linalg.inv(v)
        covariance = np.linalg.inv(x.T @ inverse @ x)
        beta = covariance @ x.T @ inverse @ y
        return v, inverse, covariance, beta

    def minus_likelihood(sds):
        v, inverse, covariance, beta = parts(sds)
        rest = y - x @ beta
        dets = np.linalg.slogdet(v)[1] - np.linalg.slogdet(covariance)[1]
        return (dets + rest @ inverse @ rest) / 2

    sds = np.full(5, 0.5)
    for _ in range(3):
        sds = np.abs(minimize(minus_likelihood, sds, method="BFGS", options=dict(gtol=1e-7)).x)
        sds[sds < 1e-3] = 0
    free = np.flatnonzero(sds)

    def moved(by):
        at = sds.copy()
        at[free] += by
        return at

    steps = 1e-3 * sds[free] * np.eye(len(free))
    second = np.array(
        [
            [
                sum(
                    a * b * minus_likelihood(moved(a * one + b * other)) for a in (1, -1) for b in (1, -1)
                )
                / (4 * one.sum() * other.sum())
                for other in steps
            ]
            for one in steps
        ]
    )
    known = np.linalg.inv(second)
    _, _, covariance, beta = parts(sds)
    tested = np.eye(methods + 1)[1:]
    of_tested = tested @ covariance @ tested.T
    f = (tested @ beta) @ np.linalg.solve(of_tested, tested @ beta) / methods

    def degrees(contrast):
        def variance(sds):
            return contrast @ parts(sds)[2] @ contrast

        slopes = [
            (variance(moved(step)) - variance(moved(-step))) / (2 * step.sum()) for step in steps
        ]
        return 2 * variance(sds) ** 2 / (slopes @ known @ slopes)

    each = np.array([degrees(axis @ tested) for axis in np.linalg.eigh(of_tested)[1].T])
    total = (each / (each - 2)).sum()
    df = each[0] if methods == 1 else 2 * total / (total - methods) if each.min() > 2 else 2
    return dict(
        statistic=f,
        p=stats.f.sf(f, methods, df),
        effect=response.std() * np.ptp(np.append(0, beta[1:])),
        n=len(y),
    )
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factors = arguments.factors(table)?;
    let groups = arguments.list("groups").iter();
    let groups: Vec<Factor> = groups.map(|name| grouping(table, name)).collect::<Result<_, _>>()?;
    let interactions = arguments.has("interactions") && factors.len() > 1;
    let options = LinearMixedModelOptions { interactions };
    let factors: Vec<&Factor> = factors.iter().collect();
    let groups: Vec<&Factor> = groups.iter().collect();
    let response = arguments.numbers(table, "response")?;
    let outcome = linear_mixed_model(&response, &factors, &groups, options)?;
    Ok(Answer::of_test(&outcome, words))
}

impl TestResult for LinearMixedModel {
    const NAMES: TestNames = TestNames {
        test: "linear mixed model",
        short: "F",
        in_words: [
            "F test of a linear mixed model with Satterthwaite’s degrees of freedom",
            "test F d’un modèle linéaire mixte aux degrés de liberté de Satterthwaite",
        ],
        statistic: "F",
        statistic_symbol: "F",
        effect: "range of means",
        effect_symbol: "range",
        function: "linear_mixed_model",
    };

    /// The effect that is tested.
    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let wide = self.pairs.iter().map(|pair| pair.difference.abs());
        vec![Outcome::Ok(TestRow {
            variant: String::new(),
            term: Term::Whole,
            statistic: self.effect.f,
            // The lower ones are not whole: the result has them.
            degrees_of_freedom: Vec::new(),
            p_value: self.effect.p,
            ln_p: self.effect.ln_p,
            effect: wide.reduce(f64::max),
            n: self.observations,
        })]
    }
}

fn words(result: &LinearMixedModel) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Linear mixed model (REML): {}", result.formula));
    lines.add(format!("{} responses{}", result.observations, lines::dropped(result.dropped)));
    let effect = &result.effect;
    lines.add(format!(
        "F = {}, df = {} and {} (Satterthwaite), p {}",
        format_number(effect.f),
        effect.df,
        format_number(effect.df_denominator),
        format_p(effect.p, effect.ln_p)
    ));
    let mut rows = vec![lines::row(["coefficient", "estimate", "se", "df", "t", "p"])];
    for (name, own) in result.coefficients.iter() {
        let numbers = [own.estimate, own.se, own.df, own.t, own.p].map(format_number);
        rows.push(lines::row([vec![name.to_owned()], numbers.to_vec()].concat()));
    }
    lines.table(&rows);
    for (level, own) in result.means.iter() {
        let [low, high] = own.interval_95.map(format_number);
        lines.add(format!("mean at {level}: {} ({low} to {high})", format_number(own.mean)));
    }
    for pair in &result.pairs {
        let [low, high] = pair.interval_95.map(format_number);
        lines.add(format!(
            "{} less {}: {} ({low} to {high}), p {} (Holm)",
            pair.b,
            pair.a,
            format_number(pair.difference),
            lines::p_value(Some(pair.p_holm)),
        ));
    }
    let mut rows = vec![lines::row(["random effects", "levels", "sd"])];
    for ((name, sd), (_, levels)) in result.sd.iter().zip(result.levels.iter()) {
        rows.push(lines::row([name.to_owned(), levels.to_string(), format_number(*sd)]));
    }
    rows.push(lines::row([
        "residual".to_owned(),
        result.observations.to_string(),
        format_number(result.residual_sd),
    ]));
    lines.table(&rows);
    for name in &result.at_zero {
        lines.add(format!("note: the standard deviation of {name} is 0, a bound"));
    }
    for name in &result.left_out {
        lines.add(format!(
            "note: {name} parts the responses as a grouping before it, or each from all others, and is left out"
        ));
    }
    lines.into_text()
}
