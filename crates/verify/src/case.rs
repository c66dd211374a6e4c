//! A case: every value that it expects, what was computed for it, and how far apart they may be.

use serde::Serialize;
use serde_json::{Value, json};

/// How far a computed number may be from the expected one.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Tolerance {
    /// The same.
    Exact,
    /// By so much.
    Absolute(f64),
    /// By this share of the expected number, or of `floor` where that is smaller.
    Relative {
        /// The share.
        share: f64,
        /// What the share is of at least.
        floor: f64,
    },
    /// By a rule of the expected number.
    Of(fn(f64) -> f64),
}

impl Tolerance {
    /// The largest difference that is allowed from an expected number.
    fn allowed(self, expected: f64) -> f64 {
        match self {
            Self::Exact => 0.0,
            Self::Absolute(limit) => limit,
            Self::Relative { share, floor } => share * expected.abs().max(floor),
            Self::Of(rule) => rule(expected),
        }
    }
}

/// A value that a case expects, and what was computed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Checked {
    /// Its place in the case: names and numbers from 0, joined by `/`.
    pub field: String,
    /// What the case expects; `"-inf"` is minus infinity, null is undefined.
    pub expected: Value,
    /// What was computed; null where nothing was, a text where the computation was refused.
    pub got: Value,
    /// The largest difference of two numbers that counts as right; 0 where they must be the same.
    pub tolerance: f64,
}

impl Checked {
    /// Whether what was computed is what is expected.
    pub fn right(&self) -> bool {
        match (self.expected.as_f64(), self.got.as_f64()) {
            (Some(expected), Some(got)) => {
                expected == got || (expected - got).abs() <= self.tolerance
            }
            _ => self.expected == self.got,
        }
    }
}

/// A case and its values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Case {
    /// Its name: the folder's, the file's and its own, joined by `/`.
    pub case: String,
    /// Whether all values are right, of which there is at least one.
    pub right: bool,
    /// The values, in the case's order.
    pub values: Vec<Checked>,
}

impl Case {
    /// A case without values yet.
    pub(crate) fn new(name: impl Into<String>) -> Self {
        Self { case: name.into(), right: false, values: Vec::new() }
    }

    /// The values that are wrong.
    pub fn wrong(&self) -> impl Iterator<Item = &Checked> {
        self.values.iter().filter(|value| !value.right())
    }

    /// The same under a folder's name.
    pub(crate) fn within(mut self, folder: &str) -> Self {
        if !folder.is_empty() {
            self.case = format!("{folder}/{}", self.case);
        }
        self
    }

    fn push(&mut self, field: &str, expected: Value, got: Value, tolerance: f64) {
        let checked = Checked { field: field.to_owned(), expected, got, tolerance };
        let right = checked.right();
        self.right = right && (self.right || self.values.is_empty());
        self.values.push(checked);
    }

    /// Compares everything inside `expected` with what stands in the same place of `got`.
    pub(crate) fn compare(&mut self, field: &str, expected: &Value, got: &Value, by: Tolerance) {
        match expected {
            Value::Object(members) => {
                for (key, own) in members {
                    let got = got.get(key).unwrap_or(&Value::Null);
                    self.compare(&format!("{field}/{key}"), own, got, by);
                }
            }
            Value::Array(items) => {
                let found = got.as_array().map(Vec::len);
                if found != Some(items.len()) || items.is_empty() {
                    let (place, expected) = (format!("{field}/length"), json!(items.len()));
                    self.push(&place, expected, found.map_or(Value::Null, |n| json!(n)), 0.0);
                }
                for (i, own) in items.iter().enumerate() {
                    let got = got.get(i).unwrap_or(&Value::Null);
                    self.compare(&format!("{field}/{i}"), own, got, by);
                }
            }
            Value::Number(number) => {
                let allowed = number.as_f64().map_or(0.0, |expected| by.allowed(expected));
                self.push(field, expected.clone(), got.clone(), allowed);
            }
            other => self.push(field, other.clone(), got.clone(), 0.0),
        }
    }

    /// Compares a computation's outcome; its refusal is a wrong value that says why, unless the case
    /// expects that there is none.
    pub(crate) fn compare_outcome<T, E: std::fmt::Display>(
        &mut self,
        field: &str,
        expected: &Value,
        outcome: Result<T, E>,
        by: Tolerance,
        shown: impl FnOnce(T) -> Value,
    ) {
        match outcome {
            Ok(got) => self.compare(field, expected, &shown(got), by),
            Err(_) if expected.is_null() => self.compare(field, expected, &Value::Null, by),
            Err(refusal) => self.refused(field, &refusal),
        }
    }

    /// Says that a value could not be computed, and why.
    pub(crate) fn refused(&mut self, field: &str, why: &dyn std::fmt::Display) {
        self.push(field, json!("a result"), json!(why.to_string()), 0.0);
    }
}

/// A number as cases write it.
pub(crate) fn number(value: f64) -> Value {
    if value == f64::NEG_INFINITY {
        return json!("-inf");
    }
    serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number)
}

/// Numbers as cases write them.
pub(crate) fn numbers<'a>(values: impl IntoIterator<Item = &'a f64>) -> Value {
    values.into_iter().map(|&value| number(value)).collect()
}

/// Numbers in rows of a width.
pub(crate) fn rows(values: &[f64], width: usize) -> Value {
    values.chunks(width.max(1)).map(numbers).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compared(expected: &Value, got: &Value, by: Tolerance) -> Case {
        let mut case = Case::new("c");
        case.compare("f", expected, got, by);
        case
    }

    fn wrong(case: &Case) -> Vec<&str> {
        case.wrong().map(|value| value.field.as_str()).collect()
    }

    #[test]
    fn every_value_inside_is_compared_and_the_wrong_ones_are_named() {
        let expected = json!({"a": [1.0, 2.0], "b": {"c": "x", "d": null}});
        let right = compared(&expected, &expected, Tolerance::Exact);
        assert!(right.right);
        assert_eq!(right.values.len(), 4);
        let got = json!({"a": [1.0, 2.5], "b": {"c": "x", "d": 3}});
        let case = compared(&expected, &got, Tolerance::Absolute(0.1));
        assert!(!case.right);
        assert_eq!(wrong(&case), ["f/a/1", "f/b/d"]);
    }

    #[test]
    fn what_is_missing_too_much_or_too_little_is_wrong() {
        for (expected, got, places) in [
            (json!({"a": 1}), json!({}), vec!["f/a"]),
            (json!([1, 2]), json!([1]), vec!["f/length", "f/1"]),
            (json!([1]), json!([1, 2]), vec!["f/length"]),
            (json!([]), json!([1]), vec!["f/length"]),
            (json!([]), Value::Null, vec!["f/length"]),
            (json!(1), json!("1"), vec!["f"]),
            (json!("-inf"), json!(-1e300), vec!["f"]),
            (json!(null), json!(0.0), vec!["f"]),
            (json!(0.0), json!(null), vec!["f"]),
        ] {
            let case = compared(&expected, &got, Tolerance::Absolute(1.0));
            assert_eq!(wrong(&case), places, "{expected} {got}");
            assert!(!case.right, "{expected} {got}");
        }
        assert!(compared(&json!([]), &json!([]), Tolerance::Exact).right);
        assert!(!Case::new("without values").right, "a case without a value shows nothing");
    }

    #[test]
    fn a_refusal_is_wrong_unless_nothing_is_expected() {
        let by = Tolerance::Exact;
        let refused: Result<f64, &str> = Err("why");
        let mut case = Case::new("c");
        case.compare_outcome("undefined", &Value::Null, refused, by, number);
        case.compare_outcome("defined", &json!(1), refused, by, number);
        case.compare_outcome("right", &json!(1), Ok::<f64, &str>(1.0), by, number);
        assert_eq!(wrong(&case), ["defined"]);
        assert_eq!(case.values[1].got, "why");
    }

    #[test]
    fn a_wrong_value_stays_wrong_whatever_follows() {
        let mut case = Case::new("c");
        case.compare("a", &json!(1), &json!(2), Tolerance::Exact);
        case.compare("b", &json!(1), &json!(1), Tolerance::Exact);
        assert!(!case.right);
    }

    #[test]
    fn tolerances_are_largest_differences() {
        let allowed = |by: Tolerance, expected: f64| by.allowed(expected);
        assert_eq!(allowed(Tolerance::Relative { share: 0.5, floor: 1.0 }, -50.0), 25.0);
        assert_eq!(allowed(Tolerance::Relative { share: 0.5, floor: 1.0 }, 0.5), 0.5);
        assert_eq!(allowed(Tolerance::Of(|e| e / 2.0), 3.0), 1.5);
        let near = |got: f64| compared(&json!(2.0), &json!(got), Tolerance::Absolute(0.25)).right;
        assert!(near(2.25) && near(1.75) && !near(2.3));
        assert_eq!(number(f64::NEG_INFINITY), json!("-inf"));
        assert_eq!(number(f64::NAN), Value::Null);
        assert_eq!(rows(&[1.0, 2.0, 3.0, 4.0], 2), json!([[1.0, 2.0], [3.0, 4.0]]));
    }
}
