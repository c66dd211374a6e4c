//! Cases of statistics: `expected.json` names tests, files, columns and the values of R and SciPy.

use std::collections::BTreeMap;
use std::path::Path;

use mimique_stats::{
    Arguments, PROCEDURES, Procedure, Refusal, Table, Tail, chi_square_upper, f_upper,
    normal_upper, t_upper,
};
use serde_json::{Value, json};

use crate::case::{Tolerance, number};
use crate::document::{Document, Part};
use crate::{Case, Family, VerifyError};

/// The file of expected values.
const EXPECTED: &str = "expected.json";
/// Remarks of the file, no values.
const REMARKS: [&str; 2] = ["rule_choice", "abs_tolerance"];

/// The family.
pub(crate) struct Statistics;

impl Family for Statistics {
    fn name(&self) -> &'static str {
        "statistics"
    }

    fn holds(&self, folder: &Path) -> bool {
        folder.join(EXPECTED).is_file()
    }

    fn run(&self, folder: &Path, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
        let document = Document::read(&folder.join(EXPECTED))?;
        let root = document.root();
        for case in root.get("cases")?.list()? {
            each(test(folder, &case)?);
        }
        if let Some(tails) = root.find("distribution_tails") {
            for point in tails.get("points")?.list()? {
                each(tail(&point)?);
            }
        }
        Ok(())
    }
}

/// A test on columns of a file.
fn test(folder: &Path, case: &Part<'_>) -> Result<Case, VerifyError> {
    let mut checked = Case::new(case.get("id")?.text()?);
    let name = case.get("test")?.text()?;
    let known = PROCEDURES.iter().find(|p| !name.is_empty() && p.golden_cases == name);
    let Some(procedure) = known else {
        checked.refused("test", &format!("{name} is no test that is known"));
        return Ok(checked);
    };
    let file = folder.join(case.get("file")?.text()?);
    let bytes = std::fs::read(&file).map_err(|error| VerifyError::read(&file, &error))?;
    let table = Table::parse(bytes).map_err(|error| VerifyError::file(&file, &error))?;
    let arguments = arguments(&case.get("columns")?)?;
    let expected = case.get("expected")?;
    let actual = answer(procedure, &table, arguments)
        .unwrap_or_else(|refusal| json!({"status": "refused", "reason": refusal.to_string()}));
    match expected.find("status") {
        Some(status) => unanswered(&mut checked, status.text()?, &actual, &case.get("columns")?)?,
        None => {
            let intervals = (name == "mann_whitney").then_some(2e-4);
            compare(&mut checked, "", expected.value(), &actual, intervals);
        }
    }
    Ok(checked)
}

/// What is refused or undefined: its status, no p value, and a refusal names one of the columns.
fn unanswered(
    case: &mut Case,
    status: &str,
    actual: &Value,
    columns: &Part<'_>,
) -> Result<(), VerifyError> {
    let mut same = |field, expected: Value, got: Value| {
        case.compare(field, &expected, &got, Tolerance::Exact);
    };
    same("status", json!(status), actual["status"].clone());
    same("has p_value", json!(false), json!(actual.get("p_value").is_some()));
    if status == "refused" {
        let reason = actual["reason"].as_str().unwrap_or_default();
        let names = columns.members()?;
        let named = |name: &str| reason.contains(&format!("\"{name}\""));
        let named = names.iter().any(|(_, column)| column.value().as_str().is_some_and(named));
        same("names a column", json!(true), json!(named));
    }
    Ok(())
}

/// The columns of a case as the command line takes them.
fn arguments(columns: &Part<'_>) -> Result<BTreeMap<String, Vec<String>>, VerifyError> {
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let mut given: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (key, column) in columns.members()? {
        let option = if key.starts_with("factor") { "factors" } else { key };
        let values = match column.value() {
            Value::Array(levels) => levels.iter().map(text).collect(),
            column => vec![text(column)],
        };
        given.entry(option.to_owned()).or_default().extend(values);
    }
    Ok(given)
}

/// What a procedure computes, as the command line prints it.
fn answer(
    procedure: &Procedure,
    table: &Table,
    mut given: BTreeMap<String, Vec<String>>,
) -> Result<Value, Refusal> {
    let run = |given: &BTreeMap<String, Vec<String>>| -> Result<Value, Refusal> {
        let answer = (procedure.run)(table, &Arguments::new(given.clone()))?;
        Ok(serde_json::from_str(&answer.json).unwrap_or(Value::Null))
    };
    let mut result = run(&given)?;
    if procedure.golden_cases == "wilcoxon_signed_rank" {
        // The file of expected values has the one-sided p beside the two-sided ones.
        given.insert("alternative".to_owned(), vec!["greater".to_owned()]);
        let mut one_sided = run(&given)?["p_by_semantics"].take();
        if let Some(keys) = one_sided.as_object_mut() {
            let thesis = keys.get("R_le_4.5_default (thesis era)").cloned().unwrap_or_default();
            keys.insert("R_le_4.5_default".to_owned(), thesis);
        }
        if let Some(fields) = result.as_object_mut() {
            fields.insert("one_sided_greater".to_owned(), one_sided);
        }
    }
    Ok(result)
}

/// 1e-9 relative; 1e-8 where nothing but rounding is left; zero up to the rounding of numbers about one.
fn relative(expected: f64) -> f64 {
    match expected.abs() {
        0.0 => 1e-12,
        tiny if tiny < 1e-280 => 1e-8 * tiny,
        size => 1e-9 * size,
    }
}

/// Compares field by field: intervals that others find by a search of a root have `abs_tolerance`
/// beside them, or that of `intervals`; `"NaN"` and `"NA"` are what is undefined.
fn compare(case: &mut Case, at: &str, expected: &Value, got: &Value, intervals: Option<f64>) {
    match expected {
        Value::Object(fields) => {
            let own = fields.get("abs_tolerance").and_then(Value::as_f64).or(intervals);
            for (key, expected) in fields.iter().filter(|(k, _)| !REMARKS.contains(&k.as_str())) {
                let field = if at.is_empty() { key.clone() } else { format!("{at}/{key}") };
                let got = got.get(key).unwrap_or(&Value::Null);
                let found = ["estimate", "ci_low", "ci_high"].contains(&key.as_str());
                match own {
                    Some(limit) if found && expected.is_number() => {
                        case.compare(&field, expected, got, Tolerance::Absolute(limit));
                    }
                    _ => compare(case, &field, expected, got, intervals),
                }
            }
        }
        Value::Array(items) => {
            // Lengths, and lists that are empty.
            let lengths = |list: &Value| json!(list.as_array().map(Vec::len));
            case.compare(
                &format!("{at}/length"),
                &lengths(expected),
                &lengths(got),
                Tolerance::Exact,
            );
            for (i, expected) in items.iter().enumerate() {
                let got = got.get(i).unwrap_or(&Value::Null);
                compare(case, &format!("{at}/{i}"), expected, got, intervals);
            }
        }
        Value::String(text) if matches!(text.as_str(), "NaN" | "NA") => {
            case.compare(at, &Value::Null, got, Tolerance::Exact);
        }
        other => case.compare(at, other, got, Tolerance::Of(relative)),
    }
}

/// A point of a distribution's upper tail.
fn tail(point: &Part<'_>) -> Result<Case, VerifyError> {
    let parameters = point.get("params")?.numbers()?;
    let x = point.get("x")?.number()?;
    let name = point.get("dist")?.text()?;
    let list: Vec<String> = parameters.iter().map(f64::to_string).collect();
    let mut checked = Case::new(format!("distribution_tails/{name}({})/{x:?}", list.join(", ")));
    let tail: Tail = match (name, &parameters[..]) {
        ("chi2", [df]) => chi_square_upper(x, *df),
        ("normal", []) => normal_upper(x),
        ("t", [df]) => t_upper(x, *df),
        ("F", [above, below]) => f_upper(x, *above, *below),
        _ => {
            let count = parameters.len();
            let why = format!("no distribution {name} of {count} parameters is known");
            checked.refused("dist", &why);
            return Ok(checked);
        }
    };
    let by = Tolerance::Of(relative);
    checked.compare("sf", point.get("sf")?.value(), &number(tail.p), by);
    checked.compare("ln_sf", point.get("ln_sf")?.value(), &number(tail.ln_p), by);
    let decimal = point.get("sf_decimal")?;
    let exact: f64 = decimal.text()?.parse().map_err(|_| decimal.wrong("a number as a text"))?;
    checked.compare("sf_decimal", &number(exact), &number(tail.p), by);
    Ok(checked)
}
