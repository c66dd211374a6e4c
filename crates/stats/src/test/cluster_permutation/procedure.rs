//! `mimique test cluster-permutation`.

use std::collections::BTreeMap;

use mimique_locale::format_number;

use super::{ClusterPermutation, ClusterPermutationOptions, cluster_permutation};
use crate::numerics::largest::FEWEST_PERMUTATIONS;
use crate::procedure::arguments::{Arguments, ProcedureOption, SEED};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::sample::complete_rows;

const DEFAULT_PERMUTATIONS: u64 = 5000;

/// `mimique test cluster-permutation`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "cluster-permutation",
    question: "Do two courses over time differ within people? Cluster-based permutation test",
    options: &[&[
        ProcedureOption::text("participant", "Column of the people").required(),
        ProcedureOption::text("condition", "Column of the two conditions").required(),
        ProcedureOption::text("time", "Column of the instants, in any unit").required(),
        ProcedureOption::text("value", "Column of values; several of one instant are averaged")
            .required(),
        ProcedureOption::text("permutations", "Draws of the test, at least 19 [default: 5000]"),
        SEED,
    ]],
    run,
    sample: Sample::Other,
    r: r#"
# Clusters of differences within people over time: a row per person, a column per instant. t for rows of signs.
signed_t <- function(d, signs) {
  people <- nrow(d)
  squares <- colSums(d^2)
  sums <- signs %*% d
  about <- pmax(rep(squares, each = nrow(signs)) - sums^2 / people, 1e-6 * max(squares))
  t <- sums / sqrt(about / (people - 1) * people)
  t[, squares == 0] <- 0
  side <- ifelse(abs(t) > qt(0.975, people - 1), sign(t), 0)
  list(t = t, side = side)
}
numbered <- function(name, values) setNames(values, sprintf("%s.%d", rep(name, length(values)), seq_along(values)))
clusters <- function(d) {
  if (NROW(d) < 2) return(c(clusters = 0))
  own <- signed_t(d, matrix(1, 1, nrow(d)))
  runs <- rle(own$side[1, ])
  last <- cumsum(runs$lengths)
  first <- last - runs$lengths + 1
  found <- which(runs$values != 0)
  mass <- vapply(found, function(i) sum(own$t[1, first[i]:last[i]]), 0)
  c(clusters = length(found), numbered("first", first[found] - 1), numbered("last", last[found] - 1),
    numbered("mass", mass))
}
# Their p by all changes of sign of up to 12 people, of more by 5000 random ones.
cluster_p <- function(d) {
  mass <- clusters(d)
  mass <- abs(mass[startsWith(names(mass), "mass")])
  if (length(mass) == 0) return(c(p = 1))
  all <- nrow(d) <= 12
  signs <- if (all) as.matrix(expand.grid(rep(list(c(-1, 1)), nrow(d)))) else {
    matrix(sample(c(-1, 1), 5000 * nrow(d), TRUE), 5000)
  }
  own <- signed_t(d, signs)
  largest <- run <- before <- numeric(nrow(signs))
  for (instant in seq_len(ncol(d))) {
    t <- own$t[, instant]
    side <- own$side[, instant]
    run <- ifelse(side == 0, 0, ifelse(side == before, run + t, t))
    largest <- pmax(largest, abs(run))
    before <- side
  }
  reached <- vapply(mass, function(one) sum(largest >= one - 1e-9), 0)
  p <- unname(if (all) reached / nrow(signs) else (1 + reached) / (1 + nrow(signs)))
  c(p = min(p), numbered("p", p))
}
"#,
    python: r#"
def signed_t(d, signs):
    """t of differences within people (rows) at each instant (columns) for each row of signs, and its side beyond the
    quantile."""
    people = len(d)
    squares = (d**2).sum(axis=0)
    sums = signs @ d
    about = np.maximum(squares - sums**2 / people, 1e-6 * squares.max())
    with np.errstate(invalid="ignore"):
        t = np.where(squares == 0, 0.0, sums / np.sqrt(about / (people - 1) * people))
    return t, np.where(np.abs(t) > stats.t.ppf(0.975, people - 1), np.sign(t), 0.0)


def numbered(name, values):
    return {f"{name}.{place + 1}": value for place, value in enumerate(values)}


def clusters(d):
    """Clusters of differences within people over time: a row per person, a column per instant."""
    if len(d) < 2:
        return dict(clusters=0)
    (t,), (side,) = signed_t(d, np.ones((1, len(d))))
    edges = [0, *(np.flatnonzero(np.diff(side)) + 1), len(side)]
    found = [(first, end - 1) for first, end in itertools.pairwise(edges) if side[first] != 0]
    mass = [t[first : last + 1].sum() for first, last in found]
    first, last = ([span[end] for span in found] for end in (0, 1))
    return dict(clusters=len(found), **numbered("first", first), **numbered("last", last), **numbered("mass", mass))


def cluster_p(d):
    """Their p by all changes of sign of up to 12 people, of more by 5000 random ones."""
    mass = [abs(value) for name, value in clusters(d).items() if name.startswith("mass")]
    if not mass:
        return dict(p=1.0)
    every = len(d) <= 12
    if every:
        signs = np.array(list(itertools.product([-1.0, 1.0], repeat=len(d))))
    else:
        signs = np.random.default_rng(1).choice([-1.0, 1.0], size=(5000, len(d)))
    t, side = signed_t(d, signs)
    largest, run, before = (np.zeros(len(signs)) for _ in range(3))
    for own, beyond in zip(t.T, side.T):
        run = np.where(beyond == 0, 0.0, np.where(beyond == before, run + own, own))
        largest, before = np.maximum(largest, np.abs(run)), beyond
    reached = np.array([(largest >= one - 1e-9).sum() for one in mass])
    p = reached / len(signs) if every else (1 + reached) / (1 + len(signs))
    return dict(p=p.min(), **numbered("p", p))
"#,
    golden_cases: "",
};

/// The result with the instants' times.
struct Timed<'r> {
    conditions: &'r [String],
    times: &'r [f64],
    left_out: usize,
}

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factor = |option: &str| arguments.factor(table, option);
    let (participant, condition) = (factor("participant")?, factor("condition")?);
    let [time, value] = [arguments.numbers(table, "time")?, arguments.numbers(table, "value")?];
    let complete = complete_rows(&[&time, &value], &[&participant, &condition])?;
    let rows = complete.to_vec();
    let (participant, condition) = (participant.rows(&rows), condition.rows(&rows));
    if condition.levels.len() != 2 {
        let levels = condition.levels.len();
        return Err(Refusal::NotTwoLevels { column: condition.name, levels });
    }
    let mut times: Vec<f64> = rows.iter().map(|row| time.values[*row]).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let mut people: BTreeMap<u32, [Vec<(f64, f64)>; 2]> = BTreeMap::new();
    for (place, row) in rows.iter().enumerate() {
        let empty = || [(); 2].map(|()| vec![(0.0, 0.0); times.len()]);
        let own = people.entry(participant.codes[place]).or_insert_with(empty);
        let instant = times.partition_point(|own| *own < time.values[*row]);
        let cell = &mut own[condition.codes[place] as usize][instant];
        *cell = (cell.0 + value.values[*row], cell.1 + 1.0);
    }
    let all = people.len();
    let is_whole = |own: &[Vec<(f64, f64)>; 2]| own.iter().flatten().all(|(_, count)| *count > 0.0);
    let differences: Vec<Vec<f64>> = people
        .into_values()
        .filter(is_whole)
        .map(|[a, b]| a.iter().zip(&b).map(|((a, of_a), (b, of_b))| a / of_a - b / of_b).collect())
        .collect();
    let permutations = arguments.whole("permutations", DEFAULT_PERMUTATIONS)?;
    arguments.real("permutations", [FEWEST_PERMUTATIONS as f64, 1e6])?;
    let options = ClusterPermutationOptions {
        permutations: permutations as usize,
        seed: arguments.whole("seed", 1)?,
    };
    let timed =
        Timed { conditions: &condition.levels, times: &times, left_out: all - differences.len() };
    Ok(Answer::of(&cluster_permutation(&differences, options)?, |found| words(found, &timed)))
}

fn words(result: &ClusterPermutation, of: &Timed<'_>) -> String {
    let mut lines = Lines::default();
    lines.add(format!(
        "Cluster-based permutation test: {} - {}",
        of.conditions[0], of.conditions[1]
    ));
    lines.add(format!(
        "{} people, {} without a value at each instant left out; {} instants, {} draws with seed {}",
        result.participants, of.left_out, result.instants, result.permutations, result.seed
    ));
    lines.add(format!(
        "clusters of |t| above {}; significant from a mass of {}",
        format_number(result.threshold_t),
        format_number(result.critical_mass)
    ));
    if result.clusters.is_empty() {
        lines.add("no cluster");
        return lines.into_text();
    }
    let mut rows = vec![lines::row(["from", "to", "sum of t", "p"])];
    for cluster in &result.clusters {
        rows.push(lines::row([
            format_number(of.times[cluster.first]),
            format_number(of.times[cluster.last]),
            format_number(cluster.mass),
            lines::p_value(Some(cluster.p)),
        ]));
    }
    lines.table(&rows);
    lines.into_text()
}
