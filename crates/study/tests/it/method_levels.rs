//! The levels of the factor `method`: the names of the study file.

use std::collections::BTreeSet;

use mimique_study::Study;
use mimique_test_support::study_text;
use serde_json::{Value, json};

fn study(methods: Value) -> Study {
    let mut value = mimique_study::parse(&study_text("demo.json")).unwrap();
    value["stimuli"]["methods"] = methods;
    Study::from_value(&value).unwrap()
}

fn levels(study: &Study, factor: &str) -> BTreeSet<String> {
    study.clips().iter().filter_map(|clip| clip.factor_text(factor)).collect()
}

fn named<const N: usize>(names: [&str; N]) -> BTreeSet<String> {
    names.map(str::to_owned).into()
}

#[test]
fn one_method_with_two_parameters_has_two_levels() {
    let own = study(json!({
        "lsts30": { "method": "lsts", "alpha": 0.3 },
        "lsts70": { "method": "lsts", "alpha": 0.7 },
        "box": { "method": "box" },
    }));
    assert_eq!(levels(&own, "method"), named(["box", "lsts30", "lsts70"]));
    assert_eq!(levels(&own, "solverMethod"), named(["box", "lsts"]));
    assert!(own.factor_names().contains(&"solverMethod".to_owned()));
}

#[test]
fn names_that_group_nothing_are_one_factor() {
    for methods in [
        json!({ "shell": { "method": "lsts" }, "box": { "method": "box" } }),
        json!({ "lsts30": { "method": "lsts", "alpha": 0.3 }, "lsts70": { "method": "lsts", "alpha": 0.7 } }),
    ] {
        let names: BTreeSet<String> = methods.as_object().unwrap().keys().cloned().collect();
        let own = study(methods);
        assert_eq!(levels(&own, "method"), names);
        assert!(!own.factor_names().contains(&"solverMethod".to_owned()));
    }
}

#[test]
fn a_level_can_be_given() {
    let own = study(json!({
        "a": { "method": "lsts", "factors": { "method": "thin shell" } },
        "box": { "method": "box" },
    }));
    assert_eq!(levels(&own, "method"), named(["box", "thin shell"]));
}
