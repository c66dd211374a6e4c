//! How nearly each field of a case must be met, as the case itself says.
//!
//! A name covers every field that is called so or begins so, and all below it, the longest name first. A field
//! without one is met exactly if it is a text or a whole number, else to 1e-6.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::case::Tolerance;
use crate::document::Part;
use crate::{Case, VerifyError};

/// What holds for fields without a name of their own.
const OTHERWISE: f64 = 1e-6;
/// The name that covers every field.
const ALL: &str = "all";

/// The rules of a case, longest name first.
pub(super) struct Tolerances(Vec<(String, Rule)>);

/// How nearly a field must be met.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Rule {
    /// By so much.
    Absolute(f64),
    /// By this share of the expected number.
    Relative(f64),
    /// By so much; expected numbers below `below` by this share of themselves.
    AbsoluteOr { absolute: f64, below: f64, share: f64 },
    /// The ends of an interval, by this share of its width.
    Width(f64),
    /// The same.
    Equal,
    /// The same as a set of pairs, in any order.
    PairsInAnyOrder,
}

impl Rule {
    /// From a number or from words: `1e-9`, `1e-5 relative`, `15 % relative (...)`, `20 % of the interval's
    /// width`, `1e-3, relative where below 1e-3: 2e-2`, `equal`, `equal, as a set of pairs`.
    fn read(part: &Part<'_>) -> Result<Self, VerifyError> {
        if let Some(number) = part.value().as_f64() {
            return Ok(Self::Absolute(number));
        }
        let text = part.text()?;
        let unknown = || part.wrong("a number, or the words of a tolerance");
        if text == "equal" {
            return Ok(Self::Equal);
        }
        if text == "equal, as a set of pairs" {
            return Ok(Self::PairsInAnyOrder);
        }
        if let Some((absolute, rest)) = text.split_once(", relative where below ") {
            let (below, share) = rest.split_once(": ").ok_or_else(unknown)?;
            let number = |text: &str| text.parse().map_err(|_| unknown());
            let (absolute, below) = (number(absolute)?, number(below)?);
            return Ok(Self::AbsoluteOr { absolute, below, share: number(share)? });
        }
        let (number, rest) = text.split_once(' ').ok_or_else(unknown)?;
        let number: f64 = number.parse().map_err(|_| unknown())?;
        let (share, rest) = match rest.strip_prefix("% ") {
            Some(rest) => (number / 100.0, rest),
            None => (number, rest),
        };
        match rest {
            "of the interval's width" => Ok(Self::Width(share)),
            rest if rest == "relative" || rest.starts_with("relative (") => {
                Ok(Self::Relative(share))
            }
            _ => Err(unknown()),
        }
    }

    fn of_number(self, expected: f64) -> Tolerance {
        match self {
            Self::Absolute(limit) => Tolerance::Absolute(limit),
            Self::Relative(share) => Tolerance::Relative { share, floor: 0.0 },
            Self::AbsoluteOr { below, share, .. } if expected.abs() < below => {
                Tolerance::Relative { share, floor: 0.0 }
            }
            Self::AbsoluteOr { absolute, .. } => Tolerance::Absolute(absolute),
            Self::Width(_) | Self::Equal | Self::PairsInAnyOrder => Tolerance::Exact,
        }
    }
}

impl Tolerances {
    pub(super) fn read(part: &Part<'_>) -> Result<Self, VerifyError> {
        let mut rules = Vec::new();
        for (name, rule) in part.members()? {
            rules.push((name.to_owned(), Rule::read(&rule)?));
        }
        rules.sort_by_key(|(name, _)| std::cmp::Reverse(name.len()));
        Ok(Self(rules))
    }

    /// Gives a field that has no name of its own the rule of another one.
    pub(super) fn name_as(&mut self, field: &str, other: &str) {
        let has = |name: &str| self.0.iter().find(|(own, _)| own == name).map(|(_, rule)| *rule);
        if let (None, Some(rule)) = (has(field), has(other)) {
            self.0.push((field.to_owned(), rule));
            self.0.sort_by_key(|(name, _)| std::cmp::Reverse(name.len()));
        }
    }

    /// The rule of a field, by the names on the way to it.
    fn rule(&self, way: &[&str]) -> Option<Rule> {
        let covers = |name: &str| way.iter().any(|field| field.starts_with(name));
        let own = self.0.iter().find(|(name, _)| name != ALL && covers(name));
        let all = || self.0.iter().find(|(name, _)| name == ALL);
        own.or_else(all).map(|(_, rule)| *rule)
    }

    /// Compares everything that is expected with what stands in the same place.
    pub(super) fn compare(&self, case: &mut Case, expected: &Value, got: &Value) {
        self.walk(case, &mut Vec::new(), "", expected, got);
    }

    fn walk<'v>(
        &self,
        case: &mut Case,
        way: &mut Vec<&'v str>,
        field: &str,
        expected: &'v Value,
        got: &Value,
    ) {
        let rule = self.rule(way);
        let below = |key: &str| match field {
            "" => key.to_owned(),
            field => format!("{field}/{key}"),
        };
        match (expected, rule) {
            (Value::Object(members), _) => {
                for (key, own) in members {
                    way.push(key);
                    let got = got.get(key).unwrap_or(&Value::Null);
                    self.walk(case, way, &below(key), own, got);
                    way.pop();
                }
            }
            (Value::Array(_), Some(Rule::PairsInAnyOrder)) => {
                let (expected, got) = (as_set(expected), as_set(got));
                case.compare(field, &expected, &got, Tolerance::Exact);
            }
            (Value::Array(ends), Some(Rule::Width(share))) if width(ends).is_some() => {
                let limit = share * width(ends).unwrap_or_default();
                case.compare(field, expected, got, Tolerance::Absolute(limit));
            }
            (Value::Array(items), _) => {
                let length = got.as_array().map_or(Value::Null, |own| own.len().into());
                if length != items.len() || items.is_empty() {
                    let expected = Value::from(items.len());
                    case.compare(&below("length"), &expected, &length, Tolerance::Exact);
                }
                for (i, own) in items.iter().enumerate() {
                    let got = got.get(i).unwrap_or(&Value::Null);
                    self.walk(case, way, &below(&i.to_string()), own, got);
                }
            }
            (Value::Number(number), rule) => {
                let whole = number.is_i64() || number.is_u64();
                let value = number.as_f64().unwrap_or(f64::NAN);
                let by = match rule {
                    Some(rule) => rule.of_number(value),
                    None if whole => Tolerance::Exact,
                    None => Tolerance::Absolute(OTHERWISE),
                };
                case.compare(field, expected, got, by);
            }
            _ => case.compare(field, expected, got, Tolerance::Exact),
        }
    }
}

/// The width of an interval; none where it is none.
fn width(ends: &[Value]) -> Option<f64> {
    let [low, high] = ends else { return None };
    Some((high.as_f64()? - low.as_f64()?).abs())
}

/// Pairs of names, each pair and all pairs in order.
fn as_set(pairs: &Value) -> Value {
    let pair = |pair: &Value| -> BTreeSet<String> {
        let names = pair.as_array().map(Vec::as_slice).unwrap_or_default();
        names.iter().map(Value::to_string).collect()
    };
    let all = pairs.as_array().map(Vec::as_slice).unwrap_or_default();
    let set: BTreeSet<BTreeSet<String>> = all.iter().map(pair).collect();
    serde_json::to_value(set).unwrap_or(Value::Null)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Document;
    use serde_json::json;

    fn wrong(tolerance: Value, expected: Value, got: Value) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("t.json");
        std::fs::write(&file, tolerance.to_string()).unwrap();
        let document = Document::read(&file).unwrap();
        let tolerances = Tolerances::read(&document.root()).unwrap();
        let mut case = Case::new("c");
        tolerances.compare(&mut case, &expected, &got);
        case.wrong().map(|value| value.field.clone()).collect()
    }

    #[test]
    fn the_longest_name_on_the_way_decides() {
        let rules = json!({"p": 0.1, "pairs": 0.01});
        let expected = json!({"p_holm": 1.0, "pairs": [{"p": 1.0}], "q": 1.0, "n": 3});
        let got = json!({"p_holm": 1.05, "pairs": [{"p": 1.05}], "q": 1.0000005, "n": 3.0000001});
        assert_eq!(wrong(rules, expected, got), ["n", "pairs/0/p"]);
    }

    #[test]
    fn a_field_without_a_name_takes_the_rule_of_another_one() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("t.json");
        std::fs::write(&file, json!({"statistic": 0.01, "p": 1e-6}).to_string()).unwrap();
        let document = Document::read(&file).unwrap();
        let mut tolerances = Tolerances::read(&document.root()).unwrap();
        tolerances.name_as("z", "statistic");
        tolerances.name_as("p", "statistic");
        let mut case = Case::new("c");
        let (expected, got) = (json!({"z": 1.0, "p": 1.0}), json!({"z": 1.005, "p": 1.005}));
        tolerances.compare(&mut case, &expected, &got);
        assert_eq!(case.wrong().map(|value| value.field.as_str()).collect::<Vec<_>>(), ["p"]);
    }

    #[test]
    fn words_are_rules() {
        let one = |rule: &str, expected: f64, got: f64| {
            wrong(json!({"x": rule}), json!({"x": expected}), json!({"x": got})).is_empty()
        };
        assert!(one("1e-2 relative", 100.0, 100.9) && !one("1e-2 relative", 100.0, 101.1));
        assert!(one("15 % relative (600 draws)", 2.0, 2.29));
        let either = "1e-3, relative where below 1e-3: 2e-2";
        assert!(one(either, 0.5, 0.5009) && !one(either, 0.5, 0.502));
        assert!(one(either, 1e-6, 1.01e-6) && !one(either, 1e-6, 1.1e-6));
        assert!(one("equal", 2.0, 2.0) && !one("equal", 2.0, 2.0 + 1e-12));
        let ends = |got: Value| {
            wrong(json!({"ci": "20 % of the interval's width"}), json!({"ci": [1.0, 2.0]}), got)
        };
        assert!(ends(json!({"ci": [1.15, 1.85]})).is_empty());
        assert_eq!(ends(json!({"ci": [1.25, 2.0]})), ["ci/0"]);
        let set = json!({"b": "equal, as a set of pairs"});
        let expected = json!({"b": [["x", "y"], ["y", "z"]]});
        assert!(
            wrong(set.clone(), expected.clone(), json!({"b": [["z", "y"], ["x", "y"]]})).is_empty()
        );
        assert!(!wrong(set, expected, json!({"b": [["x", "y"]]})).is_empty());
    }

    #[test]
    fn everything_below_all_is_covered_and_unknown_words_are_refused() {
        let rules = json!({"all": 0.1, "jerk": "1e-9 relative"});
        let expected = json!({"m": {"a": 1.0, "jerk_rms": 1e6}, "undefined": null});
        let got = json!({"m": {"a": 1.05, "jerk_rms": 1e6 + 1.0}, "undefined": null});
        assert_eq!(wrong(rules, expected, got), ["m/jerk_rms"]);
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("t.json");
        for unknown in [r#"{"x": "about right"}"#, r#"{"x": "5 apples"}"#, r#"{"x": []}"#] {
            std::fs::write(&file, unknown).unwrap();
            let document = Document::read(&file).unwrap();
            assert!(Tolerances::read(&document.root()).is_err(), "{unknown}");
        }
    }
}
