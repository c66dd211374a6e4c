//! `mimique test equivalence`: options, words, and the functions of R and Python.

use mimique_locale::{format_number, format_p};

use super::{
    EquivalenceOfGroups, EquivalenceOfPairs, EquivalenceOptions, EquivalenceT, EquivalenceVerdict,
    equivalence_of_groups, equivalence_of_pairs,
};
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::{Refusal, Unfit};
use crate::table::factor::Factor;
use crate::table::pairs::{PAIR_OPTIONS, differences};
use crate::table::{Numbers, Table};

/// Those of pairs, without which rows of two groups are independent.
const COLUMNS: [ProcedureOption; 7] = [
    PAIR_OPTIONS[0],
    PAIR_OPTIONS[1],
    PAIR_OPTIONS[2],
    ProcedureOption::text("response", "Column of numbers of a long table").requires(&["group"]),
    PAIR_OPTIONS[4],
    PAIR_OPTIONS[5],
    ProcedureOption::text(
        "pair",
        "Column, or several with commas between, that tells which rows make a pair; without it the \
         groups are independent",
    )
    .requires(&["response"]),
];

/// `mimique test equivalence`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "equivalence",
    question: "Is a difference smaller than the smallest one that matters? Two one-sided tests",
    options: &[
        &COLUMNS,
        &[
            ProcedureOption::text(
                "smallest-effect",
                "The smallest difference that matters, either way",
            )
            .required_unless("bounds"),
            ProcedureOption::list("bounds", "Lower and upper bound instead, such as -0.3,0.5")
                .excludes(&["smallest-effect"]),
            ProcedureOption::text("alpha", "Level of each of the two tests [default: 0.05]"),
        ],
    ],
    run,
    sample: Sample::Equivalence,
    r: r#"
# Two one-sided signed rank tests, exact and conditional on the ranks, Pratt's zeros.
equivalence <- function(d, low, high) {
  tail_of <- function(d) {
    d <- round(d, 9)
    r <- rank(abs(d))
    distribution <- 1
    for (k in round(2 * r[d != 0])) distribution <- (c(distribution, numeric(k)) + c(numeric(k), distribution)) / 2
    w <- round(2 * sum(r[d > 0]))
    sum(distribution[(w + 1):length(distribution)])
  }
  p <- c(tail_of(d - low), tail_of(high - d))
  walsh <- outer(d, d, "+") / 2
  c(statistic = max(p), p = max(p), effect = median(walsh[lower.tri(walsh, diag = TRUE)]), n = length(d))
}

# The same by t.
equivalence_t <- function(d, low, high) {
  p <- c(t.test(d, mu = low, alternative = "greater")$p.value, t.test(d, mu = high, alternative = "less")$p.value)
  c(statistic = max(p), p = max(p), effect = mean(d), n = length(d))
}

# Two one-sided Mann-Whitney tests of two groups, normal with corrections for ties and continuity.
equivalence_of_groups <- function(d, low, high) {
  own <- split(d$values, d$groups)
  tail_of <- function(shift, alternative) {
    wilcox.test(round(own[[1]] - shift, 9), round(own[[2]], 9), alternative = alternative, exact = FALSE)$p.value
  }
  p <- c(tail_of(low, "greater"), tail_of(high, "less"))
  c(statistic = max(p), p = max(p), effect = mean(own[[1]]) - mean(own[[2]]), n = length(d$values))
}

# The same by Welch's t.
equivalence_welch <- function(d, low, high) {
  own <- split(d$values, d$groups)
  p <- c(t.test(own[[1]], own[[2]], mu = low, alternative = "greater")$p.value,
         t.test(own[[1]], own[[2]], mu = high, alternative = "less")$p.value)
  c(statistic = max(p), p = max(p), effect = mean(own[[1]]) - mean(own[[2]]), n = length(d$values))
}
"#,
    python: r#"
def equivalence(d, low, high):
    """Two one-sided signed rank tests, exact and conditional on the ranks, Pratt's zeros."""

    def tail_of(d):
        d = np.round(d, 9)
        r = stats.rankdata(np.abs(d))
        distribution = np.ones(1)
        for k in np.round(2 * r[d != 0]).astype(int):
            zeros = np.zeros(k)
            distribution = (np.append(distribution, zeros) + np.append(zeros, distribution)) / 2
        return distribution[int(round(2 * r[d > 0].sum())) :].sum()

    p = max(tail_of(d - low), tail_of(high - d))
    i, j = np.triu_indices(len(d))
    return dict(statistic=p, p=p, effect=np.median((d[i] + d[j]) / 2), n=len(d))


def equivalence_t(d, low, high):
    """The same by t."""
    greater = stats.ttest_1samp(d, low, alternative="greater").pvalue
    p = max(greater, stats.ttest_1samp(d, high, alternative="less").pvalue)
    return dict(statistic=p, p=p, effect=np.mean(d), n=len(d))


def equivalence_of_groups(g, low, high):
    """Two one-sided Mann-Whitney tests, normal with corrections for ties and continuity."""

    def tail_of(shift, alternative):
        a, b = np.round(g[0] - shift, 9), np.round(g[1], 9)
        return stats.mannwhitneyu(a, b, alternative=alternative, method="asymptotic").pvalue

    p = max(tail_of(low, "greater"), tail_of(high, "less"))
    return dict(statistic=p, p=p, effect=np.mean(g[0]) - np.mean(g[1]), n=len(g[0]) + len(g[1]))


def equivalence_welch(g, low, high):
    """The same by Welch's t."""
    a, b = g
    greater = stats.ttest_ind(a - low, b, equal_var=False, alternative="greater").pvalue
    p = max(greater, stats.ttest_ind(a - high, b, equal_var=False, alternative="less").pvalue)
    return dict(statistic=p, p=p, effect=np.mean(a) - np.mean(b), n=len(a) + len(b))
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let options = options(arguments)?;
    if arguments.has("response") && !arguments.has("pair") {
        let [a, b] = groups(table, arguments)?;
        let result = equivalence_of_groups(&a, &b, &options)?;
        let test = Some((EquivalenceOfGroups::NAMES, result.rows()));
        return Ok(Answer::of_result(&result, words_of_groups(&result), test));
    }
    let differences = differences(table, arguments)?;
    let result = equivalence_of_pairs(&differences, &options)?;
    let test = Some((EquivalenceOfPairs::NAMES, result.rows()));
    Ok(Answer::of_result(&result, words_of_pairs(&result, &differences.name), test))
}

fn options(arguments: &Arguments) -> Result<EquivalenceOptions, Refusal> {
    let alpha = arguments.real("alpha", [1e-6, 0.499_999])?.unwrap_or(0.05);
    if let Some(smallest) = arguments.real("smallest-effect", [f64::MIN_POSITIVE, f64::MAX])? {
        return Ok(EquivalenceOptions { alpha, ..EquivalenceOptions::smallest_effect(smallest) });
    }
    let words = arguments.list("bounds");
    let numbers: Option<Vec<f64>> = words.iter().map(|word| word.trim().parse().ok()).collect();
    let bounds = numbers.and_then(|numbers| <[f64; 2]>::try_from(numbers).ok());
    let wrong = || Unfit::NotARange { option: "bounds", word: words.join(",") };
    Ok(EquivalenceOptions { bounds: bounds.ok_or_else(wrong)?, alpha })
}

/// The numbers of both groups.
fn groups(table: &Table, arguments: &Arguments) -> Result<[Numbers; 2], Refusal> {
    let (response, group) = (arguments.numbers(table, "response")?, arguments.groups(table)?);
    if group.levels.len() != 2 {
        return Err(Refusal::NotTwoLevels { column: group.name, levels: group.levels.len() });
    }
    let of = |level: usize| {
        let own = |(code, _): &(&u32, &f64)| **code != Factor::MISSING && **code as usize == level;
        let values = group.codes.iter().zip(&response.values).filter(own).map(|(_, y)| *y);
        Numbers { name: group.levels[level].clone(), values: values.collect() }
    };
    Ok([of(0), of(1)])
}

impl TestResult for EquivalenceOfPairs {
    const NAMES: TestNames = TestNames {
        test: "equivalence of pairs",
        short: "equivalence",
        in_words: ["two one-sided signed rank tests", "deux tests unilatéraux des rangs signés"],
        statistic: "larger p",
        statistic_symbol: "p",
        effect: "Hodges-Lehmann estimate",
        effect_symbol: "HL",
        function: "equivalence",
    };

    fn rows(&self) -> Vec<Outcome<TestRow>> {
        vec![self.wilcoxon.clone().map(|found| TestRow {
            variant: found.variant,
            term: Term::Whole,
            statistic: found.p,
            degrees_of_freedom: Vec::new(),
            p_value: found.p,
            ln_p: found.ln_p,
            effect: Some(found.hodges_lehmann),
            n: self.n,
        })]
    }
}

impl TestResult for EquivalenceOfGroups {
    const NAMES: TestNames = TestNames {
        test: "equivalence of groups",
        short: "equivalence",
        in_words: ["two one-sided Mann-Whitney tests", "deux tests unilatéraux de Mann-Whitney"],
        statistic: "larger p",
        statistic_symbol: "p",
        effect: "difference of means",
        effect_symbol: "difference",
        function: "equivalence_of_groups",
    };

    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let difference = self.welch.clone().ok().map(|found| found.difference);
        vec![self.mann_whitney_normal.clone().map(|found| TestRow {
            variant: found.variant.to_owned(),
            term: Term::Pair(self.groups.clone()),
            statistic: found.p,
            degrees_of_freedom: Vec::new(),
            p_value: found.p,
            ln_p: found.ln_p,
            effect: difference,
            n: self.n[0] + self.n[1],
        })]
    }
}

/// What the paired t tests beside [`EquivalenceOfPairs`] are called.
pub const EQUIVALENCE_PAIRED_T: TestNames = TestNames {
    test: "equivalence of pairs by t",
    short: "equivalence, paired t",
    in_words: ["two one-sided paired t tests", "deux tests t appariés unilatéraux"],
    statistic: "larger p",
    statistic_symbol: "p",
    effect: "mean difference",
    effect_symbol: "difference",
    function: "equivalence_t",
};

/// What Welch's t tests beside [`EquivalenceOfGroups`] are called.
pub const EQUIVALENCE_WELCH: TestNames = TestNames {
    test: "equivalence of groups by Welch's t",
    short: "equivalence, Welch’s t",
    in_words: ["two one-sided Welch t tests", "deux tests t de Welch unilatéraux"],
    statistic: "larger p",
    statistic_symbol: "p",
    effect: "difference of means",
    effect_symbol: "difference",
    function: "equivalence_welch",
};

impl EquivalenceT {
    /// As a line of a table of tests, of `n` observations.
    pub fn row(&self, n: usize) -> TestRow {
        TestRow {
            variant: String::new(),
            term: Term::Whole,
            statistic: self.p,
            // Welch's are not whole.
            degrees_of_freedom: Vec::new(),
            p_value: self.p,
            ln_p: self.ln_p,
            effect: Some(self.difference),
            n,
        }
    }
}

fn verdict(verdict: EquivalenceVerdict) -> &'static str {
    match verdict {
        EquivalenceVerdict::Equivalent => "equivalent",
        EquivalenceVerdict::Different => "different",
        EquivalenceVerdict::DifferentButSmall => "different, but less than matters",
        EquivalenceVerdict::Undecided => "undecided: neither equivalence nor a difference is shown",
    }
}

fn bounds([low, high]: [f64; 2]) -> String {
    format!("between {} and {}", format_number(low), format_number(high))
}

fn interval(alpha: f64, [low, high]: [f64; 2]) -> String {
    let level = format_number(100.0 * (1.0 - 2.0 * alpha));
    format!("{level} % interval {} to {}", format_number(low), format_number(high))
}

fn t_line(lines: &mut Lines, name: &str, outcome: &Outcome<EquivalenceT>, alpha: f64) {
    match outcome {
        Outcome::Undefined { reason } => lines.add(format!("{name}: undefined: {reason}")),
        Outcome::Ok(found) => lines.add(format!(
            "{name}: difference {}, {}, df = {}, p {}: {}",
            format_number(found.difference),
            interval(alpha, found.interval_90),
            format_number(found.df),
            format_p(found.p, found.ln_p),
            verdict(found.verdict)
        )),
    }
}

fn words_of_pairs(result: &EquivalenceOfPairs, name: &str) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Is {name} {}? Two one-sided tests", bounds(result.bounds)));
    lines.add(format!("{} pairs{}", result.n, lines::dropped(result.dropped)));
    match &result.wilcoxon {
        Outcome::Undefined { reason } => lines.add(format!("Wilcoxon: undefined: {reason}")),
        Outcome::Ok(found) => lines.add(format!(
            "Wilcoxon ({}): Hodges-Lehmann {}, {}, p {}: {}",
            found.variant,
            format_number(found.hodges_lehmann),
            interval(result.alpha, found.interval_90),
            format_p(found.p, found.ln_p),
            verdict(found.verdict)
        )),
    }
    t_line(&mut lines, "paired t", &result.paired_t, result.alpha);
    lines.into_text()
}

fn words_of_groups(result: &EquivalenceOfGroups) -> String {
    let mut lines = Lines::default();
    let [a, b] = &result.groups;
    lines.add(format!("Is {a} less {b} {}? Two one-sided tests", bounds(result.bounds)));
    lines.add(format!(
        "{} and {} observations{}",
        result.n[0],
        result.n[1],
        lines::dropped(result.dropped)
    ));
    match &result.mann_whitney_normal {
        Outcome::Undefined { reason } => lines.add(format!("Mann-Whitney: undefined: {reason}")),
        Outcome::Ok(found) => lines.add(format!(
            "Mann-Whitney ({}): p {}: {}",
            found.variant,
            format_p(found.p, found.ln_p),
            verdict(found.verdict)
        )),
    }
    t_line(&mut lines, "Welch's t", &result.welch, result.alpha);
    t_line(&mut lines, "pooled t", &result.pooled, result.alpha);
    lines.into_text()
}
