//! The methods and their parameters as the page's fields need them, from the solver's table.

use mimique_solver::{Method, MethodSpec, Needs, PARAMETERS, Parameter, SpecError};
use serde_json::{Value, json};

/// Every method with the rows of the solver's table that it uses, for the fields of the page.
pub fn methods() -> Value {
    let methods = Method::ALL.into_iter().map(|method| {
        let rows = PARAMETERS.iter().filter(|row| method.uses(row.about.group));
        let parameters: Vec<Value> = rows.map(|row| parameter(row, method)).collect();
        let needs = match method.needs() {
            Needs::Shapes => "shapes",
            Needs::Training => "training",
            Needs::Surface => "surface",
            Needs::Weights => "weights",
        };
        let (name, summary) = (method.name(), method.summary());
        json!({ "name": name, "summary": summary, "needs": needs, "parameters": parameters })
    });
    methods.collect()
}

/// A row of the table as a field needs it: what it is, its range, and the method's default.
fn parameter(row: &Parameter, method: Method) -> Value {
    let about = &row.about;
    let help = match about.zero {
        Some(zero) => format!("{} 0: {zero}.", row.help),
        None => row.help.to_owned(),
    };
    let mut field = json!({
        "key": row.key,
        "label": about.label,
        "help": help,
        "heading": about.group.heading(),
        "unit": about.quantity.symbol(),
        "step": about.step,
        "foundBy": about.found_by,
        "default": row.default_of(method),
    });
    let kind = json!(row.kind);
    field["kind"] = kind["kind"].clone();
    field["words"] = kind["words"].clone();
    if about.range.low.is_finite() {
        field["minimum"] = json!(about.range.low);
    }
    if about.range.high.is_finite() {
        field["maximum"] = json!(about.range.high);
    }
    field
}

/// What is wrong with a method (JSON), for the controls that it is about: `{"problems": [...]}`, each
/// with `field`, `entry` (or null), `place`, `text` in English and what it is made of: `is` (the fault) and
/// `alternatives`; `None` for a method without problems, and for text that is not JSON.
pub fn problems(method: &str) -> Option<Value> {
    let given: Value = serde_json::from_str(method).ok()?;
    let problems = MethodSpec::checked(&given).err()?;
    let one = |problem: &SpecError| {
        let entry = problem.entry.as_ref().map_or(String::new(), |entry| format!(".{entry}"));
        json!({
            "field": problem.field,
            "entry": problem.entry,
            "place": format!("{}{entry}", problem.field),
            "text": format!("{}; {}", problem.message(), problem.remedy()),
            "is": problem.fault,
            "alternatives": problem.alternatives(),
        })
    };
    Some(json!({ "problems": problems.iter().map(one).collect::<Vec<_>>() }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_of_every_method_is_a_field_with_the_method_s_default() {
        let all = methods();
        for (method, described) in Method::ALL.into_iter().zip(all.as_array().unwrap()) {
            assert_eq!(described["name"], method.name());
            let fields = described["parameters"].as_array().unwrap();
            let keys: Vec<&str> = fields.iter().filter_map(|field| field["key"].as_str()).collect();
            assert_eq!(keys, method.parameters());
        }
        let lsts = &all[0]["parameters"][0];
        assert_eq!((&lsts["key"], &lsts["default"]), (&json!("alpha"), &json!(0.3)));
        assert_eq!((&lsts["minimum"], &lsts["maximum"]), (&json!(0.0), &json!(1.0)));
        assert_eq!(all[1]["parameters"][0]["default"], json!(0.5));
    }

    #[test]
    fn problems_say_field_and_entry() {
        let wrong = r#"{"method": "lsts", "kappa": -1, "bounds": {"jawOpen": [1, 0]}}"#;
        let found = problems(wrong).unwrap();
        assert_eq!(
            found["problems"],
            json!([
                { "field": "kappa", "entry": null, "place": "kappa",
                  "text": "is -1; give a number above 0", "alternatives": [],
                  "is": { "fault": "out-of-range", "value": -1.0, "zero": null,
                          "range": { "low": 0.0, "lowIncluded": false, "high": null } } },
                { "field": "bounds", "entry": "jawOpen", "place": "bounds.jawOpen",
                  "text": "is [1, 0]; give two numbers, the lower one first", "alternatives": [],
                  "is": { "fault": "no-interval", "value": [1.0, 0.0] } },
            ])
        );
        assert_eq!(problems(r#"{"method": "lsts"}"#), None);
    }
}
