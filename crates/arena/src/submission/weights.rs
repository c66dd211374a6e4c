//! Weights of the arena's head: a table for each capture or segment in, a table for each segment in the head's order out.

use std::collections::BTreeMap;

use mimique_mocap::{WeightOptions, WeightsTable};
use mimique_stimulus::read_performance;

use super::given::{Cover, Place};
use super::{Given, SubmissionProblem};
use crate::arena_file::{Arena, ArenaCapture};

/// Rates that differ by less than this share are one: times are written with a few digits.
const SAME_RATE: f64 = 1e-3;
/// Weights beyond the bounds by less than this are rounding.
const ROUNDING: f64 = 1e-9;

/// A table that is submitted.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenWeights {
    /// Its file, and what it is for.
    pub given: Given,
    /// What the file holds.
    pub table: WeightsTable,
}

/// Weights that may take part.
#[derive(Debug, Clone, PartialEq)]
pub struct WeightSubmission {
    /// The weights of each segment, in the order of the head's shapes.
    pub segments: BTreeMap<String, WeightsTable>,
    /// Shapes of the head that no file has: they rest.
    pub absent: Vec<String>,
}

impl GivenWeights {
    /// Reads a file of any format of weights.
    ///
    /// # Errors
    /// [`SubmissionProblem::Unreadable`].
    pub fn read(given: &Given, shapes: &[String]) -> Result<Self, SubmissionProblem> {
        let options = WeightOptions { shape_names: shapes, ..WeightOptions::default() };
        let read = read_performance(&given.path, &options).map_err(|error| {
            SubmissionProblem::Unreadable { file: given.name(), why: error.to_string() }
        })?;
        Ok(Self { given: given.clone(), table: read.table })
    }
}

/// Checks weights against the arena: `shapes` are those of its head.
///
/// # Errors
/// Everything that is wrong with them.
pub fn check_weights(
    arena: &Arena,
    shapes: &[String],
    given: &[GivenWeights],
) -> Result<WeightSubmission, Vec<SubmissionProblem>> {
    let mut found = Vec::new();
    let mut cover = Cover::new(arena);
    for (place, own) in given.iter().enumerate() {
        match cover.add(place, &own.given, given.len() == 1) {
            Ok(part) => found.extend(table_problems(arena, shapes, own, part)),
            Err(problem) => found.push(problem),
        }
    }
    found.extend(cover.missing());
    if !found.is_empty() {
        return Err(found);
    }
    let cut = |(segment, (place, frames)): (&&str, &(usize, std::ops::Range<usize>))| {
        let table = &given[*place].table;
        let own = arena.segments.iter().find(|own| own.id == **segment);
        let capture = own.and_then(|own| arena.captures.get(&own.capture));
        ((*segment).to_owned(), cut(table, shapes, frames.clone(), capture))
    };
    let segments = cover.cuts.iter().map(cut).collect();
    let known = |shape: &&String| given.iter().any(|own| own.table.shape_names.contains(shape));
    let absent = shapes.iter().filter(|shape| !known(shape)).cloned().collect();
    Ok(WeightSubmission { segments, absent })
}

/// What is wrong with a table.
fn table_problems(
    arena: &Arena,
    shapes: &[String],
    GivenWeights { given, table }: &GivenWeights,
    Place { id, capture, frames }: Place<'_>,
) -> Vec<SubmissionProblem> {
    let file = given.name();
    let mut found = Vec::new();
    if table.frames.len() != frames {
        let (id, found_frames) = (id.to_owned(), table.frames.len());
        found.push(SubmissionProblem::Frames {
            file: file.clone(),
            id,
            found: found_frames,
            wanted: frames,
        });
    }
    let wanted = capture.rate_hz;
    if let Some(rate) = table.rate_hz().filter(|rate| (rate / wanted - 1.0).abs() > SAME_RATE) {
        let (file, id) = (file.clone(), id.to_owned());
        let found_rate = (rate * 1e3).round() / 1e3;
        found.push(SubmissionProblem::Rate { file, id, found: found_rate, wanted });
    }
    for shape in table.shape_names.iter().filter(|shape| !shapes.contains(shape)) {
        let nearest = nearest(shape, shapes);
        found.push(SubmissionProblem::Shape { file: file.clone(), shape: shape.clone(), nearest });
    }
    found.extend(beyond(&file, table, arena.bounds));
    found
}

/// The weights beyond the bounds, or that are no numbers: the first of them, and how many.
fn beyond(file: &str, table: &WeightsTable, [low, high]: [f64; 2]) -> Option<SubmissionProblem> {
    let width = table.shape_names.len();
    let is_beyond =
        |(_, weight): &(usize, &f64)| !(**weight >= low - ROUNDING && **weight <= high + ROUNDING);
    let mut all = table.weights.iter().enumerate().filter(is_beyond);
    let (place, value) = all.next()?;
    Some(SubmissionProblem::Beyond {
        file: file.to_owned(),
        shape: table.shape_names[place % width].clone(),
        frame: table.frames[place / width],
        value: *value,
        count: 1 + all.count(),
        low,
        high,
    })
}

/// Frames of a table in the order of the head's shapes, counted from 0 at the capture's rate.
fn cut(
    table: &WeightsTable,
    shapes: &[String],
    frames: std::ops::Range<usize>,
    capture: Option<&ArenaCapture>,
) -> WeightsTable {
    let width = table.shape_names.len();
    let columns: Vec<Option<usize>> = (shapes.iter())
        .map(|shape| table.shape_names.iter().position(|own| own == shape))
        .collect();
    let weight = |frame: usize, column: &Option<usize>| {
        column.map_or(0.0, |column| table.weights[frame * width + column])
    };
    let rows = frames.flat_map(|frame| columns.iter().map(move |column| weight(frame, column)));
    let rate_hz = capture.map_or(1.0, |capture| capture.rate_hz);
    WeightsTable::at_rate(shapes.to_vec(), rows.collect(), 0, rate_hz)
}

/// The shape whose name is the same but for case and what stands between words.
fn nearest(name: &str, shapes: &[String]) -> Option<String> {
    let plain = |text: &str| -> String {
        text.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_lowercase()
    };
    shapes.iter().find(|shape| plain(shape) == plain(name)).cloned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arena() -> Arena {
        let text = serde_json::json!({
            "id": "faces", "title": "Faces", "opened": "2026-11-27", "avatar": "head.glb",
            "captures": { "take": { "file": "take.c3d", "rateHz": 50.0, "frames": 6 } },
            "segments": [
                { "id": "joy", "capture": "take", "first": 1, "end": 3 },
                { "id": "fear", "capture": "take", "first": 3, "end": 6 },
            ],
        });
        Arena::read(&text.to_string(), None).unwrap()
    }

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    fn given(name: &str, shapes: &[&str], weights: Vec<f64>, rate_hz: f64) -> GivenWeights {
        let table = WeightsTable::at_rate(names(shapes), weights, 0, rate_hz);
        GivenWeights { given: Given::of(name), table }
    }

    #[test]
    fn a_table_of_the_capture_is_cut_and_put_in_the_order_of_the_head() {
        let weights: Vec<f64> = (0..6).flat_map(|k| [f64::from(k) / 10.0, 0.9]).collect();
        let own = given("solved.csv", &["smile", "jaw"], weights, 50.0);
        let checked = check_weights(&arena(), &names(&["jaw", "frown", "smile"]), &[own]).unwrap();
        assert_eq!(checked.segments["joy"].weights, [0.9, 0.0, 0.1, 0.9, 0.0, 0.2]);
        assert_eq!(checked.segments["fear"].frames, [0, 1, 2]);
        assert_eq!(checked.absent, ["frown"]);
    }

    #[test]
    fn tables_of_segments_are_taken_by_the_names_of_their_files_in_any_order() {
        let joy = given("joy.csv", &["jaw"], vec![0.1, 0.2], 50.0);
        let fear = given("fear=other.csv", &["jaw"], vec![0.3, 0.4, 0.5], 50.0);
        let shapes = names(&["jaw"]);
        let one = check_weights(&arena(), &shapes, &[joy.clone(), fear.clone()]).unwrap();
        assert_eq!(one, check_weights(&arena(), &shapes, &[fear, joy]).unwrap());
        assert_eq!(one.segments["fear"].weights, [0.3, 0.4, 0.5]);
    }

    #[test]
    fn all_problems_of_all_files_are_named_at_once() {
        let files = [
            given("joy.csv", &["jaw", "Smi-le"], vec![0.1, 0.2, 1.5, 0.1, 0.0, -0.2], 25.0),
            given("take.csv", &["jaw"], vec![0.0; 6], 50.0),
            given("grief.csv", &["jaw"], vec![0.0; 6], 50.0),
        ];
        let found = check_weights(&arena(), &names(&["jaw", "smile"]), &files).unwrap_err();
        let said: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert!(said[0].starts_with("joy.csv: 3 frames; joy has 2"), "{said:#?}");
        assert!(said[1].starts_with("joy.csv: 25 frames per second; joy has 50"), "{said:#?}");
        assert!(said[2].contains("\"Smi-le\": the head has no such shape (it has \"smile\")"));
        assert!(
            said[3].contains("jaw in frame 1: 1.5 (the first of 2); keep weights within 0 and 1")
        );
        assert!(said[4].starts_with("take.csv: segment joy is in another file"), "{said:#?}");
        assert!(said[5].starts_with("grief.csv: the arena has neither"), "{said:#?}");
        assert!(said[6].starts_with("segment fear: no file has it"), "{said:#?}");
        assert_eq!(said.len(), 7);
    }

    #[test]
    fn what_is_no_number_is_beyond_the_bounds() {
        let own =
            given("take.csv", &["jaw"], vec![0.0, f64::NAN, 0.0, 0.0, f64::INFINITY, 0.0], 50.0);
        let found = check_weights(&arena(), &names(&["jaw"]), &[own]).unwrap_err();
        assert!(matches!(&found[..], [SubmissionProblem::Beyond { frame: 1, count: 2, .. }]));
    }
}
