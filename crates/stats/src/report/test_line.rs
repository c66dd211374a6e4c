//! One line of a table of tests: what any test gives, reduced to what a report prints.

use serde::Serialize;

use super::call::Call;
use crate::aligned_rank_transform::aligned_rank_transform;
use crate::chi_square::{Contingency, chi_square};
use crate::factor::Factor;
use crate::friedman::{Blocks, friedman};
use crate::kruskal_wallis::kruskal_wallis;
use crate::mann_whitney::mann_whitney;
use crate::outcome::{Outcome, Refusal};
use crate::scheirer_ray_hare::{SumsOfSquares, scheirer_ray_hare};
use crate::spearman::spearman;
use crate::table::Numbers;
use crate::walsh::HodgesLehmann;
use crate::wilcoxon::{WilcoxonOptions, wilcoxon};

/// One test's numbers, whatever the test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct TestLine {
    /// Name and variant.
    pub test: String,
    /// What is compared, where there are several lines of one test.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub term: String,
    /// Name of the statistic: H, W+, F.
    pub statistic_name: &'static str,
    /// Its value.
    pub statistic: f64,
    /// Degrees of freedom, as written.
    pub df: String,
    /// p.
    pub p_value: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
    /// p after Holm's correction, where several were tested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub p_holm: Option<f64>,
    /// Name of the effect size.
    pub effect_name: &'static str,
    /// Effect size.
    pub effect: Option<f64>,
    /// Observations: trials or people.
    pub n: usize,
    /// How other programs compute it.
    #[serde(skip)]
    pub call: Call,
}

impl Outcome<TestLine> {
    /// p, where there is one.
    pub(crate) fn p(&self) -> Option<f64> {
        match self {
            Self::Ok(line) => Some(line.p_value),
            Self::Undefined { .. } => None,
        }
    }

    /// p after a correction over several tests, where there was one.
    pub(crate) fn p_that_counts(&self) -> Option<f64> {
        match self {
            Self::Ok(line) => Some(line.p_holm.unwrap_or(line.p_value)),
            Self::Undefined { .. } => None,
        }
    }
}

impl TestLine {
    /// Kruskal-Wallis; `of` says of what.
    pub(crate) fn kruskal_wallis(values: &Numbers, factor: &Factor, of: &str) -> Outcome<Self> {
        from_refusal(kruskal_wallis(values, factor).map(|outcome| {
            outcome.map(|result| Self {
                statistic: result.statistic,
                df: result.df.to_string(),
                p_value: result.p_value,
                ln_p: result.ln_p,
                effect_name: "epsilon squared",
                effect: Some(result.epsilon_squared),
                n: result.n,
                ..Self::groups(["Kruskal-Wallis", "kruskal_wallis", "H"], values, factor, of)
            })
        }))
    }

    /// Mann-Whitney.
    pub(crate) fn mann_whitney(values: &Numbers, factor: &Factor, of: &str) -> Outcome<Self> {
        from_refusal(mann_whitney(values, factor).map(|outcome| {
            outcome.map(|result| Self {
                term: result.pair.clone(),
                statistic: result.statistic,
                p_value: result.p_value,
                ln_p: result.ln_p,
                effect_name: "rank-biserial",
                effect: Some(result.rank_biserial),
                n: result.n,
                ..Self::groups(["Mann-Whitney", "mann_whitney", "U"], values, factor, of)
            })
        }))
    }

    /// What tests of independent groups have in common, without their numbers. A test has a name for
    /// people, one for scripts, and that of its statistic.
    fn groups(
        [test, function, statistic_name]: [&'static str; 3],
        values: &Numbers,
        factor: &Factor,
        of: &str,
    ) -> Self {
        let call = Call::new(function).text(&values.name).text(&factor.name);
        Self {
            test: format!("{test} of {of}"),
            term: String::new(),
            statistic_name,
            statistic: f64::NAN,
            df: String::new(),
            p_value: f64::NAN,
            ln_p: f64::NAN,
            p_holm: None,
            effect_name: "",
            effect: None,
            n: 0,
            call: call.list(&factor.levels).text(of),
        }
    }

    /// Mann-Whitney of two groups, Kruskal-Wallis of more.
    pub(crate) fn of_groups(values: &Numbers, factor: &Factor, of: &str) -> Outcome<Self> {
        if factor.levels.len() == 2 {
            Self::mann_whitney(values, factor, of)
        } else {
            Self::kruskal_wallis(values, factor, of)
        }
    }

    /// Wilcoxon's signed rank test with the Hodges-Lehmann estimate that goes with it.
    pub(crate) fn wilcoxon(
        differences: &Numbers,
        options: WilcoxonOptions,
        of: &str,
        call: Call,
    ) -> (Outcome<Self>, Option<HodgesLehmann>) {
        match wilcoxon(differences, options) {
            Err(refusal) => (Outcome::undefined(refusal.to_string()), None),
            Ok(Outcome::Undefined { reason }) => (Outcome::Undefined { reason }, None),
            Ok(Outcome::Ok(result)) => {
                let line = Self {
                    test: format!("Wilcoxon {of}, {}", result.variant),
                    term: differences.name.clone(),
                    statistic_name: "W+",
                    statistic: result.statistic,
                    df: String::new(),
                    p_value: result.p_value,
                    ln_p: result.ln_p,
                    p_holm: None,
                    effect_name: "rank-biserial",
                    effect: Some(result.rank_biserial),
                    n: result.n_pairs,
                    call,
                };
                (Outcome::Ok(line), Some(result.hodges_lehmann_ci))
            }
        }
    }

    /// Chi-square of a factor and answers, Yates for two by two.
    pub(crate) fn chi_square(rows: &Factor, answers: &Factor) -> Outcome<Self> {
        let result = Contingency::of(rows, answers).and_then(|table| chi_square(&table));
        from_refusal(result.map(|result| {
            let chosen = &result.default_yates_if_2x2;
            Outcome::Ok(Self {
                test: "chi-square of trials".to_owned(),
                term: String::new(),
                statistic_name: "chi-square",
                statistic: chosen.statistic,
                df: chosen.df.to_string(),
                p_value: chosen.p_value,
                ln_p: chosen.ln_p,
                p_holm: None,
                effect_name: "Cramer's V",
                effect: Some(result.cramers_v),
                n: result.n as usize,
                call: Call::new("chi_square")
                    .text(&answers.name)
                    .text(&rows.name)
                    .list(&rows.levels),
            })
        }))
    }

    /// Spearman.
    pub(crate) fn spearman(x: &Numbers, y: &Numbers, of: &str) -> Outcome<Self> {
        from_refusal(spearman(x, y).map(|outcome| match outcome {
            Outcome::Undefined { reason } => Outcome::Undefined { reason },
            Outcome::Ok(result) => match result.p_value {
                Some(p_value) => Outcome::Ok(Self {
                    test: format!("Spearman of {of}"),
                    term: format!("{} ~ {}", y.name, x.name),
                    statistic_name: "rho",
                    statistic: result.rho,
                    df: result.df.to_string(),
                    p_value,
                    ln_p: p_value.ln(),
                    p_holm: None,
                    effect_name: "rho",
                    effect: Some(result.rho),
                    n: result.n,
                    call: Call::new("spearman").text(&x.name).text(&y.name).text(of),
                }),
                None => Outcome::undefined(result.warnings.join("; ")),
            },
        }))
    }

    /// Friedman with Iman and Davenport's F.
    pub(crate) fn friedman(blocks: &Blocks, call: &Call) -> Outcome<Self> {
        match friedman(blocks) {
            Outcome::Undefined { reason } => Outcome::Undefined { reason },
            Outcome::Ok(result) => match &result.iman_davenport {
                Some(f) => Outcome::Ok(Self {
                    test: "Friedman on person means, Iman-Davenport".to_owned(),
                    term: String::new(),
                    statistic_name: "F",
                    statistic: f.F,
                    df: format!("{}, {}", f.df1, f.df2),
                    p_value: f.p_value,
                    ln_p: f.ln_p,
                    p_holm: None,
                    effect_name: "Kendall's W",
                    effect: Some(result.kendalls_w),
                    n: result.n_blocks,
                    call: call.clone(),
                }),
                None => Outcome::undefined(result.warnings.join("; ")),
            },
        }
    }

    /// Scheirer-Ray-Hare with type I sums of squares: both factors and their interaction.
    pub(crate) fn scheirer_ray_hare(
        values: &Numbers,
        factors: [&Factor; 2],
        of: &str,
    ) -> Vec<Outcome<Self>> {
        match scheirer_ray_hare(values, factors, SumsOfSquares::One) {
            Err(refusal) => vec![Outcome::undefined(refusal.to_string())],
            Ok(Outcome::Undefined { reason }) => vec![Outcome::Undefined { reason }],
            Ok(Outcome::Ok(result)) => (0..3)
                .map(|effect| {
                    let table = &result.type1;
                    match (table.H[effect], table.p[effect], table.ln_p[effect]) {
                        (Some(h), Some(p_value), Some(ln_p)) => Outcome::Ok(Self {
                            test: format!("Scheirer-Ray-Hare of {of}, type I"),
                            term: result.effects[effect].clone(),
                            statistic_name: "H",
                            statistic: h,
                            df: table.df[effect].to_string(),
                            p_value,
                            ln_p,
                            p_holm: None,
                            effect_name: "eta squared H",
                            effect: table.eta_squared_H[effect],
                            n: result.n,
                            call: Call::new("scheirer_ray_hare")
                                .text(&values.name)
                                .text(&factors[0].name)
                                .list(&factors[0].levels)
                                .text(&factors[1].name)
                                .list(&factors[1].levels)
                                .number(effect + 1)
                                .text(of),
                        }),
                        _ => Outcome::undefined(format!(
                            "{}: no degrees of freedom are left",
                            result.effects[effect]
                        )),
                    }
                })
                .collect(),
        }
    }

    /// Aligned rank transform: both factors and their interaction.
    pub(crate) fn aligned_rank_transform(
        values: &Numbers,
        factors: [&Factor; 2],
        person: &Factor,
    ) -> Vec<Outcome<Self>> {
        match aligned_rank_transform(values, &factors, person) {
            Err(refusal) => vec![Outcome::undefined(refusal.to_string())],
            Ok(Outcome::Undefined { reason }) => vec![Outcome::Undefined { reason }],
            Ok(Outcome::Ok(result)) => result
                .effects
                .iter()
                .enumerate()
                .map(|(place, effect)| match (effect.F, effect.p_value, effect.ln_p) {
                    (Some(f), Some(p_value), Some(ln_p)) => Outcome::Ok(Self {
                        test: "aligned rank transform of person means".to_owned(),
                        term: effect.term.clone(),
                        statistic_name: "F",
                        statistic: f,
                        df: format!("{}, {}", effect.df1, effect.df2),
                        p_value,
                        ln_p,
                        p_holm: None,
                        effect_name: "partial eta squared",
                        effect: Some({
                            let explained = f * effect.df1 as f64;
                            explained / (explained + effect.df2 as f64)
                        }),
                        n: result.n_blocks,
                        call: Call::new("aligned_rank_transform")
                            .text(&values.name)
                            .text(&factors[0].name)
                            .list(&factors[0].levels)
                            .text(&factors[1].name)
                            .list(&factors[1].levels)
                            .number(place + 1),
                    }),
                    _ => Outcome::undefined(format!("{}: no residual is left", effect.term)),
                })
                .collect(),
        }
    }
}

/// A refusal inside a report is a stated impossibility.
fn from_refusal(result: Result<Outcome<TestLine>, Refusal>) -> Outcome<TestLine> {
    result.unwrap_or_else(|refusal| Outcome::undefined(refusal.to_string()))
}
