//! `evaluate/`: scores of answers, their resamples, and calibration.

use mimique_annotate::calibration::reliability;
use mimique_annotate::evaluate::{
    Comparison, Counts, FrameScores, Score, Segment, SegmentCounts, answered_segments, edit,
    intervals, pairs, true_segments,
};
use mimique_annotate::{Marked, Temperature, Vocabulary};
use serde_json::{Value, json};

use super::{Checking, Source, Stop, rows};
use crate::case::{Tolerance, number, numbers};
use crate::document::{Part, Table};
use crate::{Case, VerifyError};

/// Every score.
const NEAR: Tolerance = Tolerance::Absolute(1e-12);
/// Temperature and its loss.
const FITTED: Tolerance = Tolerance::Absolute(1e-8);

/// The scores that are resampled, by their names in the cases.
const RESAMPLED: [(&str, Score); 4] = [
    ("accuracy", Score::Accuracy),
    ("macro_f1", Score::MacroF1),
    ("kappa", Score::Kappa),
    ("f1@50", Score::F1At50),
];

fn optional(value: Option<f64>) -> Value {
    value.map_or(Value::Null, number)
}

/// Intervals of a table, by their names.
fn marked(file: &std::path::Path, words: &Vocabulary) -> Result<Vec<Marked>, VerifyError> {
    let table = Table::read(file)?;
    let [label, first, last] = ["label", "first_frame", "last_frame"].map(|c| table.column(c));
    let (label, first, last) = (label?, first?, last?);
    let row = |row| {
        Ok(Marked {
            frames: table.index(row, first)?..table.index(row, last)?.saturating_add(1),
            mark: table.cell(row, label, "a label of the file", |name| words.read_name(name))?,
        })
    };
    (0..table.rows.len()).map(row).collect()
}

fn frame_scores(scores: &FrameScores) -> Value {
    json!({
        "n": scores.n,
        "accuracy": optional(scores.accuracy),
        "balanced_accuracy": optional(scores.balanced_accuracy),
        "macro_f1": optional(scores.macro_f1),
        "kappa": optional(scores.kappa),
        "kappa_se": optional(scores.kappa_se),
    })
}

fn segment_scores(counts: &SegmentCounts) -> Value {
    let scores = counts.scores();
    json!({
        "truth": counts.truth,
        "answer": counts.answer,
        "hits@10": counts.hits[0],
        "hits@25": counts.hits[1],
        "hits@50": counts.hits[2],
        "f1@10": optional(scores.f1[0]),
        "f1@25": optional(scores.f1[1]),
        "f1@50": optional(scores.f1[2]),
        "mean_iou": optional(scores.mean_iou),
        "weighted_iou": optional(scores.weighted_iou),
        "ratio": optional(scores.ratio),
    })
}

/// All scores as the cases write them; `order` is the place of each of their labels among ours.
fn all_scores(counts: &Counts, names: &[&str], order: &[usize], tolerance: usize) -> Value {
    let (scores, borders) = (counts.scores(), counts.borders);
    let confusion: Vec<&[u64]> = counts.confusion.rows().collect();
    let row = |&i: &usize| order.iter().map(|&j| json!(confusion[i][j])).collect::<Value>();
    let majority = scores.majority.map_or(Value::Null, |majority| {
        let mut value = frame_scores(&majority.scores);
        value["label"] = json!(names[majority.label]);
        value
    });
    json!({
        "confusion": order.iter().map(row).collect::<Value>(),
        "frames": frame_scores(&scores.frames),
        "majority": majority,
        "segments": segment_scores(&counts.segments),
        "borders": {
            "tolerance_frames": tolerance,
            "truth": borders.truth,
            "answer": borders.answer,
            "hits": borders.hits,
            "precision": optional(scores.borders.precision),
            "recall": optional(scores.borders.recall),
            "f1": optional(scores.borders.f1),
            "distance": optional(scores.borders.distance),
        },
    })
}

/// Whole takes, all of them together, resamples of them, calibration.
pub(super) fn takes(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let given = root.get("labels")?.texts()?;
    let words = Vocabulary::of_labels(given.iter().map(|&label| label.to_owned()));
    let names: Vec<&str> = words.labels().collect();
    let place = |label: &&str| names.iter().position(|name| name == label);
    let order: Vec<usize> = given.iter().filter_map(place).collect();
    let tolerance = |part: &Part<'_>| part.get("borders")?.get("tolerance_frames")?.index();
    let mut all = Vec::new();
    for (at, own) in root.get("takes")?.list()?.into_iter().enumerate() {
        let frames = root.get("frames")?.indices()?;
        let frames = *frames.get(at).ok_or_else(|| root.wrong("the frames of every take"))?;
        let tolerance = tolerance(&own)?;
        let file = |kind: &str| source.folder.join(format!("evaluate/take{}.{kind}.csv", at + 1));
        let (truth, answer) = (marked(&file("truth"), &words)?, marked(&file("answer"), &words)?);
        let comparison = Comparison { labels: names.len(), frames, tolerance };
        let mut case = source.case(format_args!("take{}", at + 1));
        let counts = match comparison.counts(&truth, &answer) {
            Ok(counts) => counts,
            Err(why) => {
                case.refused("counts", &why);
                each(case);
                continue;
            }
        };
        case_of(&mut case, &own, &all_scores(&counts, &names, &order, tolerance));
        let edits = root.get("edit")?.list()?;
        let expected = edits.get(at).ok_or_else(|| root.wrong("the edit score of every take"))?;
        let edit = optional(edit(&true_segments(&truth), &answered_segments(&answer)));
        case.compare("edit", expected.value(), &edit, NEAR);
        each(case);
        all.push(counts);
    }
    if let Some(pooled) = Counts::pooled(&all) {
        let own = root.get("all")?;
        let mut case = source.case("all");
        case_of(&mut case, &own, &all_scores(&pooled, &names, &order, tolerance(&own)?));
        let without = root.get("frames_without_answer")?;
        let got = json!(pooled.frames_without_answer);
        case.compare("frames_without_answer", without.value(), &got, Tolerance::Exact);
        each(case);
    }
    each(resampled(source, &all)?);
    each(calibration(source)?);
    Ok(())
}

/// Compares every score that the file has.
fn case_of(case: &mut Case, expected: &Part<'_>, got: &Value) {
    if let Some(members) = expected.value().as_object() {
        for (key, expected) in members {
            case.compare(key, expected, &got[key.as_str()], NEAR);
        }
    }
}

/// Percentile intervals over given resamples of the takes.
fn resampled(source: &Source<'_>, all: &[Counts]) -> Result<Case, VerifyError> {
    let bootstrap = source.document.root().get("bootstrap")?;
    let draw = |draw: &Part<'_>| draw.indices_below(all.len(), "the number of a take");
    let draws = bootstrap.get("draws")?.list()?.iter().map(draw).collect::<Result<Vec<_>, _>>()?;
    let level = bootstrap.get("level")?.number()?;
    let mut case = source.case("bootstrap");
    for (key, expected) in bootstrap.get("intervals")?.members()? {
        let Some((_, score)) = RESAMPLED.iter().find(|(name, _)| *name == key) else {
            case.refused(key, &"no score of that name is resampled");
            continue;
        };
        let found = intervals(all, &draws, level, &[*score]).map(|found| found[0]);
        let shown = |found: Option<[f64; 2]>| found.map_or(Value::Null, |two| numbers(&two));
        case.compare_outcome(key, expected.value(), found, NEAR, shown);
    }
    Ok(case)
}

/// How far probabilities are from shares, and the temperature that mends it.
fn calibration(source: &Source<'_>) -> Result<Case, VerifyError> {
    let expected = source.document.root().get("calibration")?;
    let case = expected.clone();
    let mut checking = Checking { case: source.case("calibration"), expected };
    let computed: Result<(), Stop> = (|| {
        let probability = case.get("probability")?.numbers()?;
        let right: Vec<bool> = case.get("right")?.numbers()?.iter().map(|&r| r == 1.0).collect();
        let found = reliability(&probability, &right, case.get("bins")?.index()?)?;
        checking.member("ece", NEAR, optional(found.expected_error()));
        checking.member("brier", NEAR, optional(found.brier()));
        let (logits, truth) = (rows(&case.get("logits")?)?, case.get("truth")?.indices()?);
        let temperature = Temperature::fit(&logits, &truth)?;
        checking.member("temperature", FITTED, number(temperature.value()));
        let loss = temperature.mean_log_loss(&logits, &truth);
        checking.outcome("mean_log_loss", FITTED, loss, number);
        Ok(())
    })();
    checking.done(computed)
}

/// Segments of a few frames: which are pairs, and their scores.
pub(super) fn small(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    for (place, expected) in source.document.root().list()?.into_iter().enumerate() {
        let mut labels = Vec::new();
        let mut segments = |key: &str| -> Result<Vec<Segment>, VerifyError> {
            let segment = |part: Part<'_>| {
                let [first, end, label] = &part.list()?[..] else {
                    return Err(part.wrong("first frame, end and label"));
                };
                let name = label.text()?.to_owned();
                let known = labels.iter().position(|own| *own == name).unwrap_or_else(|| {
                    labels.push(name);
                    labels.len() - 1
                });
                Ok((first.index()?..end.index()?, known))
            };
            expected.get(key)?.list()?.into_iter().map(segment).collect()
        };
        let (truth, answer) = (segments("truth")?, segments("answer")?);
        let mut got = segment_scores(&SegmentCounts::of(&truth, &answer));
        let pair =
            |p: mimique_annotate::evaluate::Pairing| json!([p.truth, p.answer, number(p.iou)]);
        got["pairs"] = pairs(&truth, &answer).into_iter().map(pair).collect();
        got["edit"] = optional(edit(&truth, &answer));
        let mut case = source.case(place);
        for (key, own) in expected.members()? {
            if !["truth", "answer"].contains(&key) {
                case.compare(key, own.value(), &got[key], NEAR);
            }
        }
        each(case);
    }
    Ok(())
}
