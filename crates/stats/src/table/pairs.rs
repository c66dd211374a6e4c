//! Differences of pairs: of two columns, of a column of differences, or of the rows of a long table.

use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::refusal::Refusal;
use crate::table::blocks::Blocks;
use crate::table::{Numbers, Table};

/// The options that name pairs, in the order of the help text.
pub(crate) const PAIR_OPTIONS: [ProcedureOption; 7] = [
    ProcedureOption::text("x", "First column of each pair")
        .requires(&["y"])
        .excludes(&["difference", "response"]),
    ProcedureOption::text("y", "Second column of each pair").requires(&["x"]),
    ProcedureOption::text("difference", "Column of differences").excludes(&["response"]),
    ProcedureOption::text("response", "Column of numbers of a long table")
        .requires(&["group", "pair"]),
    ProcedureOption::text("group", "Column that tells the two sides of a pair apart")
        .requires(&["response"]),
    ProcedureOption::list("levels", "The two sides: differences are the first minus the second")
        .requires(&["group"]),
    ProcedureOption::text(
        "pair",
        "Column, or several with commas between, that tells which rows make a pair",
    )
    .requires(&["response"]),
];

/// The differences that the options of [`PAIR_OPTIONS`] name.
pub(crate) fn differences(table: &Table, arguments: &Arguments) -> Result<Numbers, Refusal> {
    let has = |options: &[&str]| options.iter().all(|option| arguments.has(option));
    if has(&["x", "y"]) {
        let (x, y) = (arguments.numbers(table, "x")?, arguments.numbers(table, "y")?);
        return Ok(paired_differences(&x, &y));
    }
    if has(&["difference"]) {
        return arguments.numbers(table, "difference");
    }
    if !has(&["response", "group", "pair"]) {
        return Err(Refusal::NoPairs);
    }
    let group = arguments.groups(table)?;
    if group.levels.len() != 2 {
        let column = arguments.needed("group")?.to_owned();
        return Err(Refusal::NotTwoLevels { column, levels: group.levels.len() });
    }
    let pair = table.combined_factor(arguments.needed("pair")?)?;
    Ok(Blocks::of(&arguments.numbers(table, "response")?, &group, &pair)?.differences(0, 1))
}

/// Differences of two columns, `x - y`.
pub fn paired_differences(x: &Numbers, y: &Numbers) -> Numbers {
    Numbers {
        name: format!("{} - {}", x.name, y.name),
        values: x.values.iter().zip(&y.values).map(|(x, y)| x - y).collect(),
    }
}

/// Rounded to 9 decimals, where that changes anything.
pub fn rounded(difference: f64) -> f64 {
    // Ratings and their halves are exact as they are.
    let doubled = difference * 2.0;
    if doubled.abs() < 1e6 && f64::from(doubled as i32) == doubled {
        return difference;
    }
    let scaled = difference * 1e9;
    if scaled.abs() < 9e15 { scaled.round() / 1e9 } else { difference }
}
