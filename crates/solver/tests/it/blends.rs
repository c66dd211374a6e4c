//! A blend of two methods: its ends are the methods themselves, bit by bit, and between them weights are mixed.

use mimique_solver::{Group, Method, MethodSpec, SpecFault};
use serde_json::json;

use crate::support::sheet::{EXPRESSION, fit, noisy};

fn spec(value: serde_json::Value) -> MethodSpec {
    MethodSpec::checked(&value).expect("a method")
}

fn take() -> Vec<f64> {
    let scaled = |share: f64| noisy(&EXPRESSION.map(|weight| share * weight), 3e-4);
    (0..6).flat_map(|frame| scaled(f64::from(frame) / 5.0)).collect()
}

#[test]
fn the_ends_of_a_blend_are_its_methods_and_weights_are_mixed_between() {
    let d = take();
    let solve = |value| fit(&spec(value)).solve_take(&d).unwrap();
    let first = solve(json!({ "method": "lsts", "alpha": 0.4 }));
    let second = solve(json!({ "method": "sparse", "lambda": 0.02 }));
    let blend = |share: f64| {
        solve(json!({
            "method": "lsts", "alpha": 0.4, "blendWith": "sparse", "lambda": 0.02, "blend": share
        }))
    };
    assert_ne!(first.weights, second.weights);
    assert_eq!(blend(0.0).weights, first.weights, "the same bits");
    assert_eq!(blend(1.0).weights, second.weights, "the same bits");
    let mixed = blend(0.25);
    for ((mixed, first), second) in mixed.weights.iter().zip(&first.weights).zip(&second.weights) {
        assert!((mixed - (0.75 * first + 0.25 * second)).abs() < 1e-15);
    }
    // Residuals are those of the mixed weights.
    let off = |k: usize| mixed.reports[k].residual;
    let [one, other] = [&first, &second].map(|own| own.reports[5].residual);
    assert!(off(5) > 0.0 && off(5) <= one.max(other) + 1e-15, "{} {one} {other}", off(5));
    let frame = fit(&spec(json!({ "method": "lsts", "blendWith": "sparse", "blend": 0.25 })));
    let alone = frame.solve_frame(&d[..36]).unwrap();
    assert_eq!(alone.weights, frame.solve_take(&d[..36]).unwrap().weights);
}

#[test]
fn both_methods_share_what_both_use_and_keep_what_is_their_own() {
    let blend =
        spec(json!({ "method": "lsts", "alpha": 0.7, "blendWith": "lsts-norm", "blend": 0.5 }));
    assert_eq!(blend.second().unwrap().alpha(), 0.7);
    // What is not said is the first method's where it uses it, else the second's own.
    let silent = spec(json!({ "method": "lsts", "blendWith": "lsts-norm" }));
    assert_eq!(silent.second().unwrap().alpha(), MethodSpec::new(Method::Lsts).alpha());
    let other = spec(json!({ "method": "sparse", "blendWith": "lsts-norm" }));
    assert_eq!(other.second().unwrap().alpha(), MethodSpec::new(Method::LstsNorm).alpha());
    for spec in [blend, silent, other] {
        assert_eq!(spec.resolved().second(), spec.second(), "what is written out says the same");
        assert_eq!(spec.second().unwrap().problems(), []);
    }
}

#[test]
fn what_cannot_be_blended_is_refused_with_what_can() {
    let fault = |value: serde_json::Value| MethodSpec::checked(&value).unwrap_err()[0].clone();
    for second in ["lsts", "recorded", "kouadio", "regression", "thin-shell-surface"] {
        let error = fault(json!({ "method": "lsts", "blendWith": second, "blend": 0.5 }));
        assert!(matches!(error.fault, SpecFault::NotBlended { .. }), "{second}: {error:?}");
        assert!(error.remedy().contains("ridge") && !error.remedy().contains("kouadio"));
    }
    let alone = fault(json!({ "method": "lsts", "blend": 0.5 }));
    assert!(alone.field == "blend" && matches!(alone.fault, SpecFault::NoEffect { .. }));
    let recorded = fault(json!({ "method": "recorded", "blendWith": "lsts" }));
    assert!(matches!(recorded.fault, SpecFault::NotUsed { .. }), "{recorded:?}");
    let unused = fault(json!({ "method": "lsts", "blendWith": "ridge", "noise": 0.5 }));
    assert!(matches!(unused.fault, SpecFault::NotUsed { .. }), "{unused:?}");
    // Every method that can be blended can be blended with every other.
    let methods: Vec<Method> =
        Method::ALL.into_iter().filter(|own| own.uses(Group::Blend)).collect();
    assert!(methods.len() > 8);
    for first in &methods {
        let second = methods.iter().find(|other| *other != first).unwrap();
        let blend =
            spec(json!({ "method": first.name(), "blendWith": second.name(), "blend": 0.5 }));
        let solution = fit(&blend).solve_take(&take()).unwrap();
        assert!(solution.weights.iter().all(|weight| weight.is_finite()), "{first} {second}");
    }
}
