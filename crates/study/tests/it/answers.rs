//! Which answers each type of question takes, and which conditions hold.

use mimique_study::AnswerProblem::{
    self, Incomplete, Missing, NotANumber, NotAnOption, NotWhole, TooFew, TooHigh, TooLong, TooLow,
    TooMany,
};
use mimique_study::{Answers, LONG_TEXT, Question, SHORT_TEXT};
use serde_json::{Value, json};

fn question(mut kind: Value) -> Question {
    let map = kind.as_object_mut().unwrap();
    map.insert("id".to_owned(), json!("q"));
    map.insert("prompt".to_owned(), json!("?"));
    serde_json::from_value(kind).unwrap()
}

fn options(values: &[&str]) -> Value {
    values.iter().map(|value| json!({ "value": value, "label": value })).collect()
}

#[test]
fn each_type_takes_its_answers_and_no_others() {
    let abc = || options(&["a", "b", "c"]);
    let long = |length: usize| json!("é".repeat(length));
    type Case = (Value, Vec<(Value, Result<(), AnswerProblem>)>);
    let cases: Vec<Case> = vec![
        (
            json!({ "type": "singleChoice", "options": abc() }),
            vec![
                (json!("b"), Ok(())),
                (json!("d"), Err(NotAnOption)),
                (json!("B"), Err(NotAnOption)),
                (json!(1), Err(NotAnOption)),
                (json!(["a"]), Err(NotAnOption)),
                (json!(" "), Err(Missing)),
                (json!(null), Err(Missing)),
            ],
        ),
        (
            json!({ "type": "multipleChoice", "options": abc(), "minimum": 2, "maximum": 2 }),
            vec![
                (json!(["a", "c"]), Ok(())),
                (json!(["a"]), Err(TooFew(2))),
                (json!(["a", "b", "c"]), Err(TooMany(2))),
                (json!(["a", "a"]), Err(NotAnOption)),
                (json!(["a", "d"]), Err(NotAnOption)),
                (json!("a"), Err(NotAnOption)),
                (json!([]), Err(Missing)),
            ],
        ),
        (
            json!({ "type": "likert", "numItems": 5, "start": -2, "leftLabel": "l", "rightLabel": "r" }),
            vec![
                (json!(-2), Ok(())),
                (json!(2), Ok(())),
                (json!(-3), Err(NotAnOption)),
                (json!(3), Err(NotAnOption)),
                (json!(0.5), Err(NotAnOption)),
                (json!("0"), Err(NotAnOption)),
            ],
        ),
        // No sum overflows.
        (
            json!({ "type": "likert", "numItems": 5, "start": i64::MAX }),
            vec![(json!(i64::MAX), Ok(())), (json!(0), Err(NotAnOption))],
        ),
        (
            json!({ "type": "slider", "minimum": 0.5, "maximum": 9.5, "leftLabel": "l", "rightLabel": "r" }),
            vec![
                (json!(0.5), Ok(())),
                (json!(9.5), Ok(())),
                (json!(0.4), Err(TooLow(0.5))),
                (json!(10), Err(TooHigh(9.5))),
                (json!("5"), Err(NotANumber)),
            ],
        ),
        (
            json!({ "type": "number", "minimum": 18, "maximum": 99, "integer": true }),
            vec![
                (json!(18), Ok(())),
                (json!(99.0), Ok(())),
                (json!(20.5), Err(NotWhole)),
                (json!(17.9), Err(TooLow(18.0))),
                (json!(100), Err(TooHigh(99.0))),
                (json!("20"), Err(NotANumber)),
            ],
        ),
        (json!({ "type": "number" }), vec![(json!(-1e9), Ok(())), (json!(0.25), Ok(()))]),
        (
            json!({ "type": "shortText", "maxLength": 3 }),
            vec![
                (long(3), Ok(())),
                (long(4), Err(TooLong(3))),
                (json!(3), Err(NotAnOption)),
                (json!(" \n"), Err(Missing)),
            ],
        ),
        (
            json!({ "type": "shortText" }),
            vec![(long(SHORT_TEXT), Ok(())), (long(SHORT_TEXT + 1), Err(TooLong(SHORT_TEXT)))],
        ),
        (
            json!({ "type": "longText" }),
            vec![(long(LONG_TEXT), Ok(())), (long(LONG_TEXT + 1), Err(TooLong(LONG_TEXT)))],
        ),
        (
            json!({ "type": "matrix", "rows": options(&["x", "y"]), "options": abc() }),
            vec![
                (json!({ "x": "a", "y": "a" }), Ok(())),
                (json!({ "x": "a" }), Err(Incomplete)),
                (json!({ "x": "a", "z": "a" }), Err(NotAnOption)),
                (json!({ "x": "a", "y": "d" }), Err(NotAnOption)),
                (json!(["a", "b"]), Err(NotAnOption)),
                (json!({}), Err(Missing)),
            ],
        ),
        (
            json!({ "type": "ranking", "options": abc() }),
            vec![
                (json!(["c", "a", "b"]), Ok(())),
                (json!(["c", "a"]), Err(Incomplete)),
                (json!(["c", "a", "a"]), Err(NotAnOption)),
                (json!(["c", "a", "b", "d"]), Err(NotAnOption)),
                (json!({ "c": 1 }), Err(NotAnOption)),
            ],
        ),
        (
            json!({ "type": "valenceArousal", "numItems": 5, "leftLabel": "l", "rightLabel": "r",
                "bottomLabel": "b", "topLabel": "t" }),
            vec![
                (json!({ "valence": 1, "arousal": 5 }), Ok(())),
                (json!({ "valence": 1 }), Err(Incomplete)),
                (json!({ "valence": 0, "arousal": 5 }), Err(NotAnOption)),
                (json!({ "valence": 1, "arousal": 6 }), Err(NotAnOption)),
                (json!({ "valence": 1.5, "arousal": 5 }), Err(Incomplete)),
            ],
        ),
        (
            json!({ "type": "comparison" }),
            vec![
                (json!("left"), Ok(())),
                (json!("right"), Ok(())),
                (json!("same"), Err(NotAnOption)),
                (json!("top"), Err(NotAnOption)),
            ],
        ),
        (json!({ "type": "comparison", "allowSame": true }), vec![(json!("same"), Ok(()))]),
    ];
    for (kind, answers) in cases {
        let asked = question(kind.clone());
        assert_eq!(asked.accept(None), Err(Missing), "{kind}");
        for (answer, wanted) in answers {
            assert_eq!(asked.accept(Some(&answer)), wanted, "{answer:.80} to {kind}");
            // What need not be answered can be left out, but not answered wrongly.
            let optional = Question { required: false, ..asked.clone() };
            let wanted = if wanted == Err(Missing) { Ok(()) } else { wanted };
            assert_eq!(optional.accept(Some(&answer)), wanted, "{answer:.80} to {kind}");
        }
    }
}

#[test]
fn a_condition_holds_for_the_answers_that_it_names() {
    type Case = (Value, Vec<Value>, Vec<Value>);
    let cases: Vec<Case> = vec![
        (json!({ "equals": "a" }), vec![json!("a")], vec![json!("b"), json!(["a"]), json!(null)]),
        (json!({ "equals": 3 }), vec![json!(3), json!(3.0)], vec![json!(4), json!("3")]),
        (json!({ "equals": ["a", "b"] }), vec![json!(["a", "b"])], vec![json!(["a"]), json!("a")]),
        (
            json!({ "oneOf": ["a", "b"] }),
            vec![json!("a"), json!(["c", "b"])],
            vec![json!("c"), json!(["c"]), json!([])],
        ),
        (json!({ "oneOf": [1, 2] }), vec![json!(2), json!(1.0)], vec![json!(3)]),
        (
            json!({ "atLeast": 18 }),
            vec![json!(18), json!(18.5)],
            vec![json!(17.9), json!("18"), json!(null)],
        ),
        (json!({ "atMost": 2 }), vec![json!(2), json!(-5)], vec![json!(2.1), json!(["a"])]),
        // Every part must hold.
        (json!({ "atLeast": 2, "atMost": 3 }), vec![json!(2), json!(3)], vec![json!(1), json!(4)]),
        (json!({ "oneOf": [1, 5], "atMost": 3 }), vec![json!(1)], vec![json!(5), json!(2)]),
    ];
    for (mut condition, holds, fails) in cases {
        condition["question"] = json!("p");
        let asked = question(json!({ "type": "number", "showIf": condition }));
        let is_shown = |page: &Answers, earlier: &Answers| asked.is_shown(page, earlier);
        let none = Answers::new();
        assert!(!is_shown(&none, &none), "{:?}", asked.show_if);
        for (answers, wanted) in [(holds, true), (fails, false)] {
            for answer in answers {
                let given = Answers::from([("p".to_owned(), answer.clone())]);
                assert_eq!(is_shown(&given, &none), wanted, "{answer} to {:?}", asked.show_if);
                assert_eq!(is_shown(&none, &given), wanted, "{answer} to {:?}", asked.show_if);
                // What stands on the page counts before what was said earlier.
                let other = Answers::from([("p".to_owned(), json!(null))]);
                assert!(!is_shown(&other, &given));
            }
        }
    }
}
