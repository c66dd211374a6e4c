//! What a scale shows.

use mimique_session::flow::{QuestionKindView, View};
use mimique_study::parse;
use serde_json::{Value, json};

use crate::support::{self, Page, study_text};

/// The points of the scale that opens a study.
fn points(scale: Value) -> Vec<(i64, String)> {
    let mut file = parse(&study_text("demo.json")).unwrap();
    let mut scale = scale;
    scale["id"] = json!("scale");
    scale["prompt"] = json!("?");
    scale["type"] = json!("likert");
    file["demographics"] = json!({ "questions": [scale] });
    let mut page = Page::open(&file.to_string(), 1);
    loop {
        if let View::Questions { questions, .. } = page.view() {
            let QuestionKindView::Likert { points, .. } = &questions[0].kind else {
                panic!("{:?}", questions[0].kind)
            };
            return points.clone();
        }
        assert!(page.act(&mut support::first_answer));
    }
}

#[test]
fn a_scale_shows_its_numbers_with_their_labels() {
    let labels = json!([{ "en": "never", "fr": "jamais" }, "sometimes", "always"]);
    let labelled = points(json!({ "numItems": 3, "start": 0, "labels": labels }));
    let wanted = [(0, "never"), (1, "sometimes"), (2, "always")];
    assert_eq!(labelled, wanted.map(|(number, label)| (number, label.to_owned())));
    let ends = points(json!({ "numItems": 5, "start": -2, "leftLabel": "l", "rightLabel": "r" }));
    let numbers: Vec<i64> = ends.iter().map(|point| point.0).collect();
    assert_eq!(numbers, [-2, -1, 0, 1, 2]);
    assert!(ends.iter().all(|point| point.1.is_empty()), "{ends:?}");
    let plain = points(json!({ "numItems": 2, "leftLabel": "l", "rightLabel": "r" }));
    assert_eq!(plain.iter().map(|point| point.0).collect::<Vec<_>>(), [1, 2]);
}
