//! Cases, and how near to their answers is near enough.

use std::path::PathBuf;

use mimique_annotate::Take;
use mimique_test_support::real_file;
use serde_json::Value;

/// A file of the cases: those held back when `MIMIQUE_ANNOTATION` names their folder.
pub fn file(test: &str, name: &str) -> Option<PathBuf> {
    match std::env::var_os("MIMIQUE_ANNOTATION") {
        Some(folder) => Some(PathBuf::from(folder).join(name)),
        None => real_file(test, &format!("annotation/open/{name}")),
    }
}

pub fn text(test: &str, name: &str) -> Option<String> {
    Some(std::fs::read_to_string(file(test, name)?).unwrap())
}

pub fn json(test: &str, name: &str) -> Option<Value> {
    Some(serde_json::from_str(&text(test, name)?).unwrap())
}

/// Header and rows of a CSV without quotes.
pub fn table(text: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let split = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
    let mut lines = text.lines();
    (split(lines.next().unwrap()), lines.map(split).collect())
}

/// A take and the names of its shapes; empty cells are NaN.
pub fn take(test: &str, name: &str, rate_hz: f64) -> Option<(Take, Vec<String>)> {
    let (header, rows) = table(&text(test, &format!("takes/{name}"))?);
    let number = |cell: &String| if cell.is_empty() { f64::NAN } else { cell.parse().unwrap() };
    let values = rows.iter().flat_map(|row| row[2..].iter().map(number)).collect();
    Some((Take::new(values, header.len() - 2, rate_hz).unwrap(), header[2..].to_vec()))
}

/// A number; `"-inf"` is minus infinity.
pub fn number(value: &Value) -> f64 {
    if value == "-inf" { f64::NEG_INFINITY } else { value.as_f64().unwrap() }
}

/// All numbers inside, in order.
pub fn numbers(value: &Value) -> Vec<f64> {
    match value.as_array() {
        Some(list) => list.iter().flat_map(numbers).collect(),
        None => vec![number(value)],
    }
}

pub fn indices(value: &Value) -> Vec<usize> {
    value.as_array().unwrap().iter().map(|v| v.as_u64().unwrap() as usize).collect()
}

pub fn words(value: &Value) -> Vec<&str> {
    value.as_array().unwrap().iter().map(|v| v.as_str().unwrap()).collect()
}

pub fn list(value: &Value) -> &Vec<Value> {
    value.as_array().unwrap()
}

/// As many numbers, none further apart than `tolerance`.
pub fn near(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (place, (f, e)) in found.iter().zip(expected).enumerate() {
        let same = f == e || (f - e).abs() <= tolerance;
        assert!(same, "{what}, {place}: {f} where {e} is expected");
    }
}

/// The same, relative to the expected number, absolute where that is below `floor`.
pub fn relative(found: &[f64], expected: &[f64], tolerance: f64, floor: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (place, (f, e)) in found.iter().zip(expected).enumerate() {
        let same = f == e || (f - e).abs() <= tolerance * e.abs().max(floor);
        assert!(same, "{what}, {place}: {f} where {e} is expected");
    }
}
