//! Scores of answers, intervals, calibration; and words of an ELAN tier.

use mimique_annotate::calibration::{BINS, brier, expected_error};
use mimique_annotate::evaluate::{
    Comparison, Counts, Scores, Segment, SegmentCounts, answered_segments, edit, interval, pairs,
    true_segments,
};
use mimique_annotate::labels::frame_of_ms;
use mimique_annotate::{Mark, Marked, Rows, Temperature, Vocabulary};
use mimique_stimulus::EafDocument;
use serde_json::Value;

use crate::cases::{indices, json, list, near, number, numbers, table, text, words};

fn marked(test: &str, name: &str, words: &Vocabulary) -> Vec<Marked> {
    let (_, rows) = table(&text(test, &format!("evaluate/{name}")).unwrap());
    let frame = |cell: &String| cell.parse::<usize>().unwrap();
    let of = |row: &Vec<String>| Marked {
        frames: frame(&row[1])..frame(&row[2]) + 1,
        mark: words.read_name(&row[0]).unwrap(),
    };
    rows.iter().map(of).collect()
}

/// One number of the scores.
type Score = fn(&Scores) -> Option<f64>;

/// Scores by the names that the cases give them; the labels in the cases' order are `order`.
fn check(counts: &Counts, expected: &Value, names: &[&str], order: &[usize], what: &str) {
    let scores = counts.scores();
    let rows: Vec<&[u64]> = counts.confusion.rows().collect();
    let confusion: Vec<f64> = order
        .iter()
        .flat_map(|&i| order.iter().map(move |&j| (i, j)))
        .map(|(i, j)| rows[i][j] as f64)
        .collect();
    assert_eq!(confusion, numbers(&expected["confusion"]), "{what}");
    let majority = scores.majority.unwrap();
    assert_eq!(names[majority.label], expected["majority"]["label"], "{what}");
    for (section, frames) in [("frames", scores.frames), ("majority", majority.scores)] {
        for (key, value) in [
            ("n", Some(frames.n as f64)),
            ("accuracy", frames.accuracy),
            ("balanced_accuracy", frames.balanced_accuracy),
            ("macro_f1", frames.macro_f1),
            ("kappa", frames.kappa),
            ("kappa_se", frames.kappa_se),
        ] {
            same(value, &expected[section], key, what);
        }
    }
    for (key, value) in segment_scores(&counts.segments) {
        same(value, &expected["segments"], key, what);
    }
    let (borders, found) = (counts.borders, scores.borders);
    for (key, value) in [
        ("truth", Some(borders.truth as f64)),
        ("answer", Some(borders.answer as f64)),
        ("hits", Some(borders.hits as f64)),
        ("precision", found.precision),
        ("recall", found.recall),
        ("f1", found.f1),
        ("distance", found.distance),
    ] {
        same(value, &expected["borders"], key, what);
    }
}

fn segment_scores(counts: &SegmentCounts) -> Vec<(&'static str, Option<f64>)> {
    let scores = counts.scores();
    vec![
        ("truth", Some(counts.truth as f64)),
        ("answer", Some(counts.answer as f64)),
        ("hits@10", Some(counts.hits[0] as f64)),
        ("hits@25", Some(counts.hits[1] as f64)),
        ("hits@50", Some(counts.hits[2] as f64)),
        ("f1@10", scores.f1[0]),
        ("f1@25", scores.f1[1]),
        ("f1@50", scores.f1[2]),
        ("mean_iou", scores.mean_iou),
        ("weighted_iou", scores.weighted_iou),
        ("ratio", scores.ratio),
    ]
}

/// A score as expected, where the case has it.
fn same(found: Option<f64>, section: &Value, key: &str, what: &str) {
    match section.get(key) {
        None => {}
        Some(Value::Null) => assert_eq!(found, None, "{what}, {key}"),
        Some(expected) => {
            near(&[found.unwrap()], &[number(expected)], 1e-12, &format!("{what}, {key}"))
        }
    }
}

#[test]
fn whole_takes_and_their_resamples() {
    let Some(expected) = json("whole_takes", "evaluate/expected.json") else { return };
    let given = words(&expected["labels"]);
    let words = Vocabulary::of_labels(given.iter().map(|&l| l.to_owned()));
    let names: Vec<&str> = words.labels().collect();
    let order: Vec<usize> =
        given.iter().map(|l| names.iter().position(|n| n == l).unwrap()).collect();
    let tolerance = expected["all"]["borders"]["tolerance_frames"].as_u64().unwrap() as usize;
    let mut all = Vec::new();
    for (place, frames) in indices(&expected["frames"]).into_iter().enumerate() {
        let of =
            |kind: &str| marked("whole_takes", &format!("take{}.{kind}.csv", place + 1), &words);
        let (truth, answer) = (of("truth"), of("answer"));
        let comparison = Comparison { labels: names.len(), frames, tolerance };
        let counts = comparison.counts(&truth, &answer).unwrap();
        check(&counts, &expected["takes"][place], &names, &order, &format!("take {}", place + 1));
        let edit = edit(&true_segments(&truth), &answered_segments(&answer));
        near(&[edit.unwrap()], &[number(&expected["edit"][place])], 1e-12, "edit");
        all.push(counts);
    }
    let pooled = Counts::pooled(&all).unwrap();
    check(&pooled, &expected["all"], &names, &order, "all");
    let without = expected["frames_without_answer"].as_u64().unwrap() as usize;
    assert_eq!(pooled.frames_without_answer, without);

    let bootstrap = &expected["bootstrap"];
    let draws: Vec<Vec<usize>> = list(&bootstrap["draws"]).iter().map(indices).collect();
    let scores: [(&str, Score); 4] = [
        ("accuracy", |s| s.frames.accuracy),
        ("macro_f1", |s| s.frames.macro_f1),
        ("kappa", |s| s.frames.kappa),
        ("f1@50", |s| s.segments.f1[2]),
    ];
    for (key, score) in scores {
        let found = interval(&all, &draws, number(&bootstrap["level"]), score).unwrap();
        near(&found.unwrap(), &numbers(&bootstrap["intervals"][key]), 1e-12, key);
    }
}

#[test]
fn segments_of_a_few_frames() {
    let Some(cases) = json("segments_of_a_few_frames", "evaluate/small.json") else { return };
    for (place, case) in list(&cases).iter().enumerate() {
        let segments = |key: &str| -> Vec<Segment> {
            let of = |s: &Value| {
                let [first, end] = [&s[0], &s[1]].map(|v| v.as_u64().unwrap() as usize);
                // A label is its own text here.
                let label = s[2].as_str().unwrap().bytes().fold(0, |n, b| 256 * n + usize::from(b));
                (first..end, label)
            };
            list(&case[key]).iter().map(of).collect()
        };
        let (truth, answer) = (segments("truth"), segments("answer"));
        let what = format!("case {place}");
        let found: Vec<f64> = pairs(&truth, &answer)
            .iter()
            .flat_map(|p| [p.truth as f64, p.answer as f64, p.iou])
            .collect();
        near(&found, &numbers(&case["pairs"]), 1e-12, &what);
        let mut scores = segment_scores(&SegmentCounts::of(&truth, &answer));
        scores.retain(|(key, _)| !["truth", "answer"].contains(key));
        scores.push(("edit", edit(&truth, &answer)));
        scores.into_iter().for_each(|(key, value)| same(value, case, key, &what));
    }
}

#[test]
fn calibrations() {
    let Some(file) = json("calibrations", "evaluate/expected.json") else { return };
    let case = &file["calibration"];
    let probability = numbers(&case["probability"]);
    let right: Vec<bool> = numbers(&case["right"]).iter().map(|&r| r == 1.0).collect();
    assert_eq!(indices(&Value::Array(vec![case["bins"].clone()])), [BINS]);
    let found =
        [expected_error(&probability, &right, BINS).unwrap(), brier(&probability, &right).unwrap()];
    near(&found, &[number(&case["ece"]), number(&case["brier"])], 1e-12, "calibration");
    let logits = Rows::new(numbers(&case["logits"]), list(&case["logits"][0]).len()).unwrap();
    let truth = indices(&case["truth"]);
    let temperature = Temperature::fit(&logits, &truth).unwrap();
    near(&[temperature.value()], &[number(&case["temperature"])], 1e-8, "temperature");
    let loss = temperature.mean_log_loss(&logits, &truth).unwrap();
    near(&[loss], &[number(&case["mean_log_loss"])], 1e-8, "loss");
}

#[test]
fn words_and_frames_of_an_elan_tier() {
    let Some(expected) = json("words_of_a_tier", "elan/expected.json") else { return };
    let document =
        EafDocument::parse(&text("words_of_a_tier", "elan/manual.eaf").unwrap()).unwrap();
    let entries = expected["vocabulary"].as_object().unwrap();
    let words = Vocabulary::new(entries.iter().map(|(l, w)| (l.as_str(), w.as_str().unwrap())));
    let annotations = &document.tier(expected["tier"].as_str().unwrap()).unwrap().annotations;
    for (rate, expected) in expected["read"].as_object().unwrap() {
        let rate_hz: f64 = rate.parse().unwrap();
        assert_eq!(annotations.len(), list(expected).len());
        for (annotation, expected) in annotations.iter().zip(list(expected)) {
            let frames =
                [annotation.start_ms, annotation.end_ms].map(|ms| frame_of_ms(ms, rate_hz));
            let bounds =
                [&expected["first"], &expected["end"]].map(|v| v.as_u64().unwrap() as usize);
            assert_eq!(frames, bounds, "{rate}");
            let mark: Option<Mark> = words.read(&annotation.value);
            let name = mark.and_then(|mark| words.name(mark));
            assert_eq!(name.as_deref(), expected["label"].as_str(), "{}", annotation.value);
        }
    }
}
