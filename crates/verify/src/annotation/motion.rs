//! `segmentation.json`, `features.json`: energies, borders, stretches and features of whole takes.

use std::ops::Range;

use mimique_annotate::features::{StretchFeatures, level, mean, velocity};
use mimique_annotate::stretches::Segmentation;
use mimique_annotate::{CUTOFF_HZ, Take};
use mimique_stimulus::{ActivityOptions, BorderRule, Literal, stretches};
use serde_json::{Value, json};

use super::{Checking, Source, Stop, shown};
use crate::case::{Tolerance, numbers};
use crate::document::{Part, Table};
use crate::{Case, VerifyError};

/// Every number of features.
const NEAR: Tolerance = Tolerance::Absolute(1e-9);
/// Every number of energies: relative, however small.
const RELATIVE: Tolerance = Tolerance::Relative { share: 1e-9, floor: 1e-300 };
/// The stretches of the features: borders without blinks and gaze at 3 Hz, in a tenth of a second.
const OF_FEATURES: Segmentation = Segmentation {
    activity: ActivityOptions { cutoff_hz: 3.0, time_unit_s: 0.1, blinks_and_gaze: false },
    rule: BorderRule::Peaks,
};

/// The take of a case and the names of its shapes.
fn take(source: &Source<'_>, case: &Part<'_>) -> Result<(Take, Vec<String>), VerifyError> {
    let name = case.get("take")?;
    let file = source.folder.join("takes").join(name.text()?);
    let table = Table::read(&file)?;
    let mut values = Vec::new();
    for row in 0..table.rows.len() {
        values.extend(table.numbers(row, 2)?);
    }
    let shapes = table.header.get(2..).unwrap_or_default().to_vec();
    let take = Take::new(values, shapes.len(), case.get("rate_hz")?.number()?);
    Ok((take.map_err(|error| VerifyError::file(&file, &error))?, shapes))
}

/// A take without some of its shapes.
fn without(take: &Take, shapes: &[String], out: impl Fn(&str) -> bool) -> Result<Take, Stop> {
    let kept: Vec<usize> = (0..shapes.len()).filter(|&i| !out(&shapes[i])).collect();
    Ok(take.columns(&kept)?)
}

/// Frames of a take that a case names.
fn frames(case: &Part<'_>, take: &Take) -> Result<Vec<usize>, VerifyError> {
    case.get("frames")?.indices_below(take.frames(), "a frame of the take")
}

fn ranges(found: &[Range<usize>]) -> Value {
    found.iter().map(|r| json!([r.start, r.end])).collect()
}

/// Energies at frames, borders of both rules, stretches.
pub(super) fn segmentation(
    source: &Source<'_>,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    for (place, expected) in source.document.root().list()?.into_iter().enumerate() {
        let name = source.case(format_args!("{place}/{}", expected.get("take")?.text()?));
        let mut checking = Checking { case: name, expected };
        let computed = segmented(source, &mut checking);
        each(checking.done(computed)?);
    }
    Ok(())
}

fn segmented(source: &Source<'_>, checking: &mut Checking<'_>) -> Result<(), Stop> {
    let case = checking.expected.clone();
    let (take, shapes) = take(source, &case)?;
    let ignored = case.get("ignore")?.texts()?;
    let take = without(&take, &shapes, |shape| ignored.contains(&shape))?;
    let activity = ActivityOptions {
        cutoff_hz: case.get("cutoff_hz")?.number()?,
        time_unit_s: case.get("time_unit_s")?.number()?,
        blinks_and_gaze: true,
    };
    let segmentation = Segmentation { activity, rule: BorderRule::Peaks };
    let activity = segmentation.activity(&take, &[])?;
    let at = frames(&case, &take)?;
    for (key, found) in [
        ("velocity", &activity.velocity),
        ("acceleration", &activity.acceleration),
        ("energy", &activity.energy),
    ] {
        checking.member(key, RELATIVE, numbers(at.iter().map(|&frame| &found[frame])));
    }
    let found = segmentation.rule.borders(&activity, take.rate_hz);
    checking.member("borders", Tolerance::Exact, json!(found));
    let parts = stretches(&found, take.frames());
    checking.member("stretches", Tolerance::Exact, ranges(&parts));
    let literal = case.get("literal")?;
    let rule = Literal {
        window_s: literal.get("window_s")?.number()?,
        share: literal.get("share")?.number()?,
    };
    let found = json!(BorderRule::Literal(rule).borders(&activity, take.rate_hz));
    let expected = literal.get("borders")?;
    checking.case.compare("literal/borders", expected.value(), &found, Tolerance::Exact);
    Ok(())
}

/// The frames that the annotator of a take called neutral.
fn neutral_frames(
    source: &Source<'_>,
    case: &Part<'_>,
    take: &Take,
) -> Result<Vec<usize>, VerifyError> {
    let name = case.get("take")?.text()?.trim_end_matches(".csv");
    let table = Table::read(&source.folder.join(format!("takes/{name}.labels.csv")))?;
    let [label, first, last] = ["label", "first_frame", "last_frame"].map(|c| table.column(c));
    let (label, first, last) = (label?, first?, last?);
    let mut frames = Vec::new();
    for row in 0..table.rows.len() {
        if table.rows[row][label] == "neutral" {
            let within = |cell: &str| cell.parse().ok().filter(|&frame| frame < take.frames());
            let end = table.cell(row, last, "a frame of the take", within)?;
            frames.extend(table.index(row, first)?..=end);
        }
    }
    Ok(frames)
}

/// Weights, low-pass, neutral, velocity and level at frames; features of the stretches.
pub(super) fn features(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    for expected in source.document.root().list()? {
        let name = source.case(expected.get("take")?.text()?);
        let mut checking = Checking { case: name, expected };
        let computed = take_in_numbers(source, &mut checking);
        each(checking.done(computed)?);
    }
    Ok(())
}

fn take_in_numbers(source: &Source<'_>, checking: &mut Checking<'_>) -> Result<(), Stop> {
    let case = checking.expected.clone();
    let (take, shapes) = take(source, &case)?;
    let smooth = take.smooth(CUTOFF_HZ)?;
    let neutral = neutral_frames(source, &case, &take)?;
    checking.member("neutral_frames", Tolerance::Exact, json!(neutral.len()));
    let face = mean(&smooth, neutral);
    checking.member("neutral", NEAR, numbers(&face));
    let speed = velocity(&smooth, take.rate_hz)?;
    let at = frames(&case, &take)?;
    let picked = smooth.select(at.iter().copied());
    checking.member("weights", NEAR, shown(&take.weights.select(at.iter().copied())));
    checking.member("smooth", NEAR, shown(&picked));
    let fast = Tolerance::Absolute(1e-9 * take.rate_hz);
    checking.member("velocity", fast, shown(&speed.select(at.iter().copied())));
    let away =
        |row: &[f64]| numbers(&row.iter().zip(&face).map(|(w, n)| w - n).collect::<Vec<_>>());
    checking.member("minus_neutral", NEAR, picked.iter().map(away).collect());
    let levels = level(&smooth, &face);
    checking.member("level", NEAR, numbers(at.iter().map(|&frame| &levels[frame])));

    let root = OF_FEATURES.activity(&take, &shapes)?.root();
    let found = OF_FEATURES.stretches(&take, &shapes)?;
    let expected = case.get("segments")?.list()?;
    checking.case.compare(
        "segments/length",
        &json!(expected.len()),
        &json!(found.len()),
        Tolerance::Exact,
    );
    for (place, (stretch, expected)) in found.into_iter().zip(expected).enumerate() {
        let features = StretchFeatures::of(&take, &speed, &root, stretch.clone())?;
        for (key, got, by) in stretch_in_numbers(&stretch, &features, fast) {
            let (field, expected) = (format!("segments/{place}/{key}"), expected.get(key)?);
            checking.case.compare(&field, expected.value(), &got, by);
        }
    }
    Ok(())
}

/// What is expected of a stretch.
fn stretch_in_numbers(
    stretch: &Range<usize>,
    found: &StretchFeatures,
    fast: Tolerance,
) -> [(&'static str, Value, Tolerance); 10] {
    let exact = Tolerance::Exact;
    [
        ("first", json!(stretch.start), exact),
        ("end", json!(stretch.end), exact),
        ("mean", numbers(&found.mean), NEAR),
        ("median", numbers(&found.median), NEAR),
        ("deviation", numbers(&found.deviation), NEAR),
        ("speed", numbers(&found.speed), fast),
        ("calm_mean", numbers(&found.calm_mean), NEAR),
        ("calm_frames", json!(found.calm.len()), exact),
        ("calm_first", json!(found.calm.first()), exact),
        ("calm_last", json!(found.calm.last()), exact),
    ]
}
