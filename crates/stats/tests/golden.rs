//! Every case of the shared data sets, every field that their file of expected values gives, and every
//! distribution tail. A field that this walk does not know fails it.

use std::collections::BTreeMap;

use mimique_stats::{
    Arguments, Factor, Outcome, PROCEDURES, Refusal, Table, chi_square_upper, f_upper,
    normal_upper, t_upper,
};
use mimique_test_support::real_file;
use serde_json::{Value, json};

fn expected(folder: &std::path::Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join("expected.json")).unwrap()).unwrap()
}

#[test]
fn all_cases_of_the_expected_file() {
    let Some(folder) = real_file("all_cases_of_the_expected_file", "stats") else { return };
    let expected = expected(&folder);
    let cases = expected["cases"].as_array().unwrap();
    assert!(cases.len() >= 25, "{} cases", cases.len());
    let mut problems = Vec::new();
    let mut compared = 0;
    for case in cases {
        let id = case["id"].as_str().unwrap();
        let table =
            Table::parse(std::fs::read(folder.join(case["file"].as_str().unwrap())).unwrap())
                .unwrap();
        let actual = match run(case, &table) {
            Ok(value) => value,
            Err(refusal) => json!({"status": "refused", "reason": refusal.to_string()}),
        };
        let wanted = &case["expected"];
        match wanted["status"].as_str() {
            Some(status) => {
                compared += 1;
                if actual["status"] != status {
                    problems.push(format!("{id}: status {} instead of {status}", actual["status"]));
                }
                let reason = actual["reason"].as_str().unwrap_or_default();
                let columns = case["columns"].as_object().unwrap();
                let named = columns
                    .values()
                    .any(|name| reason.contains(&format!("\"{}\"", name.as_str().unwrap())));
                if status == "refused" && !named {
                    problems.push(format!("{id}: the refusal names no column: {reason}"));
                }
                if actual.get("p_value").is_some() {
                    problems.push(format!("{id}: a p although {status}"));
                }
            }
            None => {
                let tolerance = Tolerance::of(case["test"].as_str().unwrap());
                compare(id, wanted, &actual, tolerance, &mut problems, &mut compared);
            }
        }
    }
    assert!(problems.is_empty(), "{} problems:\n{}", problems.len(), problems.join("\n"));
    assert!(compared > 800, "only {compared} values were compared");
}

/// Runs the procedure of a case on the columns that it names, as the command line does, and gives its
/// result as JSON.
fn run(case: &Value, table: &Table) -> Result<Value, Refusal> {
    let test = case["test"].as_str().unwrap();
    let procedure = PROCEDURES.iter().find(|procedure| procedure.golden_cases == test);
    let procedure =
        procedure.unwrap_or_else(|| panic!("{}: the test {test} is not known", case["id"]));
    let mut given: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (key, columns) in case["columns"].as_object().unwrap() {
        let option = if key.starts_with("factor") { "factors" } else { key };
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let values = match columns {
            Value::Array(levels) => levels.iter().map(text).collect(),
            column => vec![text(column)],
        };
        given.entry(option.to_owned()).or_default().extend(values);
    }
    let answer = |given: &BTreeMap<String, Vec<String>>| -> Result<Value, Refusal> {
        let answer = (procedure.run)(table, &Arguments::new(given.clone()))?;
        Ok(serde_json::from_str(&answer.json).unwrap())
    };
    let mut result = answer(&given)?;
    if test == "wilcoxon_signed_rank" {
        // The file of expected values has the one-sided p beside the two-sided ones.
        given.insert("alternative".to_owned(), vec!["greater".to_owned()]);
        let mut one_sided = answer(&given)?["p_by_semantics"].take();
        if let Some(keys) = one_sided.as_object_mut() {
            let thesis = keys["R_le_4.5_default (thesis era)"].clone();
            keys.insert("R_le_4.5_default".to_owned(), thesis);
        }
        if let Some(fields) = result.as_object_mut() {
            fields.insert("one_sided_greater".to_owned(), one_sided);
        }
    }
    Ok(result)
}

/// How far a number may be off.
#[derive(Clone, Copy)]
enum Tolerance {
    Relative,
    /// What another tool found by a root finder.
    Absolute(f64),
}

impl Tolerance {
    fn of(test: &str) -> impl Fn(&str, &Value) -> Tolerance + Copy + use<> {
        let two_samples = test == "mann_whitney";
        move |key: &str, siblings: &Value| match key {
            "estimate" | "ci_low" | "ci_high" => {
                let own = siblings["abs_tolerance"].as_f64();
                Tolerance::Absolute(own.unwrap_or(if two_samples { 2e-4 } else { 0.0 }))
            }
            _ => Tolerance::Relative,
        }
    }
}

/// Remarks of the file, not values.
const REMARKS: [&str; 2] = ["rule_choice", "abs_tolerance"];

fn compare(
    path: &str,
    wanted: &Value,
    actual: &Value,
    tolerance: impl Fn(&str, &Value) -> Tolerance + Copy,
    problems: &mut Vec<String>,
    compared: &mut usize,
) {
    match wanted {
        Value::Object(fields) => {
            for (key, wanted_value) in fields {
                if REMARKS.contains(&key.as_str()) {
                    continue;
                }
                let place = format!("{path}/{key}");
                let Some(actual_value) = actual.get(key) else {
                    problems.push(format!("{place}: there is no such field in the result"));
                    continue;
                };
                match (wanted_value, tolerance(key, wanted)) {
                    (Value::Number(number), Tolerance::Absolute(limit)) => {
                        *compared += 1;
                        let (wanted, actual) = (number.as_f64().unwrap(), actual_value.as_f64());
                        if !actual.is_some_and(|actual| (actual - wanted).abs() <= limit) {
                            problems.push(format!("{place}: {actual_value} instead of {wanted}"));
                        }
                    }
                    _ => compare(&place, wanted_value, actual_value, tolerance, problems, compared),
                }
            }
        }
        Value::Array(items) => {
            let Some(actual_items) = actual.as_array() else {
                problems.push(format!("{path}: {actual} is no array"));
                return;
            };
            if items.len() != actual_items.len() {
                problems.push(format!("{path}: {} items", actual_items.len()));
            }
            for (i, (wanted, actual)) in items.iter().zip(actual_items).enumerate() {
                compare(&format!("{path}/{i}"), wanted, actual, tolerance, problems, compared);
            }
        }
        Value::Number(number) => {
            *compared += 1;
            let wanted = number.as_f64().unwrap();
            if !actual.as_f64().is_some_and(|actual| close(actual, wanted)) {
                problems.push(format!("{path}: {actual} instead of {wanted}"));
            }
        }
        Value::String(text) if matches!(text.as_str(), "NaN" | "NA") => {
            *compared += 1;
            if !actual.is_null() {
                problems.push(format!("{path}: {actual} where nothing is defined"));
            }
        }
        other => {
            *compared += 1;
            if other != actual {
                problems.push(format!("{path}: {actual} instead of {other}"));
            }
        }
    }
}

fn close(actual: f64, wanted: f64) -> bool {
    let relative = if wanted.abs() < 1e-280 { 1e-8 } else { 1e-9 };
    // Zero is met up to the rounding of numbers about one.
    (actual - wanted).abs() <= relative * wanted.abs() || (wanted == 0.0 && actual.abs() < 1e-12)
}

#[test]
fn all_distribution_tails() {
    let Some(folder) = real_file("all_distribution_tails", "stats") else { return };
    let expected = expected(&folder);
    let points = expected["distribution_tails"]["points"].as_array().unwrap();
    assert!(points.len() >= 33);
    for point in points {
        let params: Vec<f64> =
            point["params"].as_array().unwrap().iter().map(|p| p.as_f64().unwrap()).collect();
        let x = point["x"].as_f64().unwrap();
        let tail = match point["dist"].as_str().unwrap() {
            "chi2" => chi_square_upper(x, params[0]),
            "normal" => normal_upper(x),
            "t" => t_upper(x, params[0]),
            "F" => f_upper(x, params[0], params[1]),
            other => panic!("the distribution {other} is not known here"),
        };
        let decimal: f64 = point["sf_decimal"].as_str().unwrap().parse().unwrap();
        assert!(close(tail.p, point["sf"].as_f64().unwrap()), "{point}: {}", tail.p);
        assert!(close(tail.p, decimal), "{point}: {}", tail.p);
        let ln_sf = point["ln_sf"].as_f64().unwrap();
        assert!(close(tail.ln_p, ln_sf), "{point}: ln {}", tail.ln_p);
    }
}

#[test]
fn a_comparison_of_two_groups_is_what_restricting_the_factor_gives() {
    let factor = Factor::from_cells("g", ["b", "a", "c"].into_iter().map(Some), |_| None);
    let restricted = factor.restricted(&["c".to_owned(), "a".to_owned()]).unwrap();
    assert_eq!(restricted.levels, ["c", "a"]);
    assert_eq!(restricted.codes, [Factor::MISSING, 1, 0]);
    assert!(factor.restricted(&["d".to_owned()]).unwrap_err().to_string().contains("\"d\""));
    let outcome: Outcome<u8> = Outcome::undefined("why");
    assert_eq!(outcome.reason(), Some("why"));
}
