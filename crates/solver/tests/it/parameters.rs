//! The table of parameters, and what follows from it: defaults, JSON, schema, problems.

use std::collections::BTreeSet;

use mimique_solver::{Kind, Method, MethodSpec, PARAMETERS, Parameter, parameter_schemas};
use serde_json::{Value, json};

/// A value that a parameter may have.
fn sample(row: &Parameter) -> Value {
    let number = if row.about.range.contains(0.25) { 0.25 } else { 20.0 };
    match row.kind {
        Kind::Number => json!(number),
        Kind::WholeNumber => json!(20),
        Kind::Interval => json!([-0.25, 1.5]),
        Kind::Word(words) => json!(words.last()),
        Kind::Names => json!(["jawOpen", "browInnerUp"]),
        Kind::NumberByName => json!({ "A": 0.0, "M3": 2.5 }),
        Kind::IntervalByName => json!({ "a": [-1.0, 1.0], "mouthClose": [0.0, 0.5] }),
    }
}

/// `lsts` with one parameter.
fn with(row: &Parameter, value: Value) -> Value {
    json!({ "method": "lsts", row.key: value })
}

#[test]
fn rows_have_names_help_and_options_of_their_own() {
    let keys: BTreeSet<&str> = PARAMETERS.iter().map(|row| row.key).collect();
    let options: BTreeSet<String> = PARAMETERS.iter().map(Parameter::option).collect();
    assert_eq!((keys.len(), options.len()), (PARAMETERS.len(), PARAMETERS.len()));
    for row in PARAMETERS {
        assert!(row.help.ends_with('.') && row.help.len() > 10, "{}: {}", row.key, row.help);
        assert!(!row.about.label.is_empty(), "{}", row.key);
        assert!(row.methods().next().is_some(), "no method uses {}", row.key);
        let by_name = matches!(row.kind, Kind::Names | Kind::NumberByName | Kind::IntervalByName);
        assert_eq!(row.about.names_of.is_some(), by_name, "{}", row.key);
    }
}

#[test]
fn defaults_of_every_method_are_within_their_ranges() {
    for method in Method::ALL {
        let resolved = MethodSpec::new(method).resolved();
        assert_eq!(resolved.problems(), [], "{method}");
        assert_eq!(resolved.resolved(), resolved, "{method}");
    }
    // A form writes every default out.
    for method in Method::ALL {
        let mut written = json!({ "method": method.name() });
        for row in PARAMETERS.iter().filter(|row| method.uses(row.about.group)) {
            if let Some(default) = row.default_of(method) {
                written[row.key] = default;
            }
        }
        assert!(MethodSpec::checked(&written).is_ok(), "{written}");
    }
    let of = |method, key| Parameter::of(key).unwrap().default_of(method);
    assert_eq!(of(Method::Lsts, "alpha"), Some(json!(0.3)));
    assert_eq!(of(Method::LstsNorm, "alpha"), Some(json!(0.5)));
    assert_eq!(of(Method::LstsShort, "eps"), Some(json!(1e-4)));
    assert_eq!(of(Method::ShortLiteral, "eps"), Some(json!(1e-6 * 1000.0)));
    assert_eq!(of(Method::Regression, "noise"), None);
    let text = |key| Parameter::of(key).unwrap().default_text();
    let alpha = text("alpha").unwrap();
    assert!(alpha.starts_with("0.3 for lsts") && alpha.ends_with(", otherwise 0.5"), "{alpha}");
    assert_eq!(text("softBounds").as_deref(), Some("-0.1:1.1"));
    assert_eq!(text("noise").as_deref(), Some("by the marginal likelihood"));
    assert_eq!(text("locked"), None);
}

#[test]
fn every_parameter_is_written_as_it_is_read() {
    let mut whole = json!({ "method": "lsts" });
    for row in PARAMETERS {
        let spec = MethodSpec::from_value(&with(row, sample(row))).unwrap();
        assert_eq!(serde_json::to_value(&spec).unwrap(), with(row, sample(row)));
        whole[row.key] = sample(row);
    }
    let spec: MethodSpec = serde_json::from_value(whole.clone()).unwrap();
    assert_eq!(serde_json::to_value(&spec).unwrap(), whole);
    // What is null is not given.
    let null = MethodSpec::from_value(&json!({ "method": "box", "alpha": null })).unwrap();
    assert_eq!(null, MethodSpec::new(Method::Box));
}

#[test]
fn every_mistake_has_its_own_pointer_and_remedy() {
    let method = json!({
        "method": "lsts", "alpha": "0.3", "kappa": 0, "laplacian": "cotan", "sigma": 0.01,
        "beta": 2, "locked": ["a", 5], "bounds": { "x/y": [1, 0], "b": 3 }, "kS": 0, "kB": 0,
    });
    let problems = MethodSpec::checked(&method).unwrap_err();
    let mut said: Vec<String> =
        problems.iter().map(|p| format!("{} [{}] {p}", p.pointer(), p.code())).collect();
    said.sort();
    let taken = Method::Lsts.parameters();
    for key in ["alpha", "kappa", "kS", "kB", "laplacian", "bounds", "locked", "importance"] {
        assert!(taken.contains(&key), "{key}");
    }
    let unused = format!(
        "/sigma [not-used] sigma: 'lsts' does not use it; remove it (it takes {})",
        taken.join(", ")
    );
    assert_eq!(
        said,
        [
            "/alpha [wrong-type] alpha: is \"0.3\"; give a number",
            "/beta [unknown-key] beta: unknown parameter; correct its name or remove it",
            "/bounds/b [wrong-type] bounds.b: is 3; give two numbers [low, high]",
            "/bounds/x~1y [out-of-range] bounds.x/y: is [1, 0]; give two numbers, the lower one first",
            "/kS [no-thin-shell] kS: kS and kB are both 0, which leaves no thin shell; make one positive",
            "/kappa [out-of-range] kappa: is 0; give a number above 0",
            "/laplacian [unknown-word] laplacian: is 'cotan'; use uniform, umbrella, cotan-clamped or cotan-literal",
            "/locked/1 [wrong-type] locked.1: is 5; give a list of names",
            unused.as_str(),
        ]
    );
    for (wrong, place) in [
        (json!([]), ""),
        (json!({}), ""),
        (json!({ "method": 5 }), "/method"),
        (json!({ "method": "lasso" }), "/method"),
    ] {
        let problems = MethodSpec::checked(&wrong).unwrap_err();
        assert_eq!((problems.len(), problems[0].pointer().as_str()), (1, place), "{wrong}");
    }
}

#[test]
fn every_kind_refuses_what_it_is_not() {
    for row in PARAMETERS {
        for wrong in [json!(true), json!([1]), json!({ "a": "b" }), json!("?")] {
            let problems = MethodSpec::from_value(&with(row, wrong.clone())).unwrap_err();
            assert!(problems.iter().all(|p| p.field == row.key), "{wrong}: {problems:?}");
        }
    }
}

#[test]
fn the_schema_has_type_description_and_users_of_every_parameter() {
    let schemas = parameter_schemas();
    assert_eq!(schemas.len(), PARAMETERS.len());
    for (key, schema) in &schemas {
        assert!(schema["type"] != Value::Null || schema["anyOf"] != Value::Null, "{key}: {schema}");
        let description = schema["description"].as_str().unwrap();
        assert!(description.contains("Used by "), "{key}: {description}");
    }
    let alpha = &schemas["alpha"];
    assert_eq!((&alpha["minimum"], &alpha["maximum"]), (&json!(0), &json!(1)));
    assert_eq!(alpha["default"], Value::Null, "it differs between the methods");
    assert_eq!(schemas["kappa"]["exclusiveMinimum"], json!(0));
    assert_eq!(schemas["kappa"]["default"], json!(0.1));
    assert!(schemas["sigma"]["description"].as_str().unwrap().contains("Unit: m."));
}
