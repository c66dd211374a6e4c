//! What is wrong with a definition: what several kinds of questions check.

use super::Choice;
use crate::check::{Counted, Issues, Problem, below};
use crate::study_file::LocalText;

/// Options: enough of them, each with a value of its own that can stand in a cell.
pub(crate) fn options(
    options: &[Choice],
    place: &str,
    key: &str,
    least: usize,
    issues: &mut Issues,
) {
    let pointer = below(place, key);
    if options.len() < least {
        issues.error(&pointer, Problem::TooFewOptions { options: options.len(), least });
    }
    for (index, option) in options.iter().enumerate() {
        let place = below(&below(&pointer, index), "value");
        let value = option.value.clone();
        if value.trim().is_empty() || value.contains('|') {
            issues.error(place, Problem::OptionValue { value });
        } else if options[..index].iter().any(|each| each.value == value) {
            issues.error(place, Problem::OptionTwice { value });
        }
    }
}

/// Points of a scale.
pub(super) fn points(points: u32, place: &str, issues: &mut Issues) {
    if !(2..=101).contains(&points) {
        issues.error(
            below(place, "numItems"),
            Problem::Points { points: Counted(points as usize, "point") },
        );
    }
}

/// What both ends of a scale mean.
pub(super) fn ends(
    left: &Option<LocalText>,
    right: &Option<LocalText>,
    place: &str,
    issues: &mut Issues,
) {
    let missing: Vec<&'static str> = [("leftLabel", left), ("rightLabel", right)]
        .into_iter()
        .filter(|(_, label)| label.is_none())
        .map(|(key, _)| key)
        .collect();
    if let [first, ..] = missing[..] {
        issues.error(place, Problem::NoEnds { first, missing: missing.join(", no ") });
    }
}

/// Bounds with something between them.
pub(super) fn range(minimum: Option<f64>, maximum: Option<f64>, place: &str, issues: &mut Issues) {
    if let (Some(least), Some(most)) = (minimum, maximum)
        && least >= most
    {
        issues.error(place, Problem::EmptyRange { least, most });
    }
}

/// Most characters of a text.
pub(super) fn max_length(max_length: Option<usize>, place: &str, issues: &mut Issues) {
    if max_length == Some(0) {
        issues.error(below(place, "maxLength"), Problem::NoTextAllowed);
    }
}
