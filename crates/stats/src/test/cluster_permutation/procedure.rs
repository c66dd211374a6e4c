//! `mimique test cluster-permutation`.

use std::collections::BTreeMap;

use super::{ClusterPermutation, ClusterPermutationOptions, cluster_permutation};
use crate::numerics::largest::FEWEST_PERMUTATIONS;
use crate::procedure::arguments::{Arguments, ProcedureOption, SEED};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::table::Table;
use crate::table::sample::complete_rows;
use crate::words::format_number;

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
    r: "",
    python: "",
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
