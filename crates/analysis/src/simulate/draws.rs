//! Answers that are drawn: several options, whole numbers, answers that a check does not expect.

use mimique_stats::Chosen;
use mimique_study::KindOfQuestion as _;
use serde_json::Value;

use super::model::{Asked, Way};
use super::person::Raw;
use super::random::Draws;

/// Places of several options, ascending: at least `fewest`, at most `most`.
pub(super) fn several(
    draws: &mut Draws,
    weights: &[f64],
    fewest: usize,
    most: usize,
) -> Vec<usize> {
    let most_likely = weights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let mut chosen: Vec<usize> = (0..weights.len())
        .filter(|&place| draws.happens(0.5 * weights[place] / most_likely))
        .collect();
    while chosen.len() > most {
        let place = draws.below(chosen.len());
        chosen.remove(place);
    }
    while chosen.len() < fewest && chosen.len() < weights.len() {
        let place = draws.below(weights.len());
        if !chosen.contains(&place) {
            chosen.push(place);
        }
    }
    chosen.sort_unstable();
    chosen
}

/// The nearest whole number within bounds.
pub(super) fn whole_number(value: f64, low: f64, high: f64) -> f64 {
    let value = value.round();
    // Rounding must not leave bounds that are no whole numbers.
    if value < low {
        low.ceil()
    } else if value > high {
        high.floor()
    } else {
        value
    }
}

/// Most answers that are drawn to find one that an attention check does not expect.
const MOST_DRAWS: usize = 100;

/// An answer that an attention check does not expect.
pub(super) fn other_than(asked: &Asked<'_>, expected: &Value, draws: &mut Draws) -> Option<Raw> {
    match &asked.way {
        Way::Compared(between) => {
            let sides =
                Chosen::ALL.iter().filter(|side| between.tie.is_some() || **side != Chosen::Same);
            let mut others = sides.map(|side| side.word()).filter(|side| expected != side);
            others.next().map(|side| Raw::Json(side.into()))
        }
        Way::Drawn { weights } => {
            let mut drawn = (0..MOST_DRAWS).map(|_| asked.question.kind.drawn(weights, draws));
            drawn.find(|answer| answer != expected).map(Raw::Json)
        }
        Way::Scales(rated) => {
            let scale = rated.first()?.scale;
            let other = (0..scale.points).map(|point| scale.value(point));
            other.into_iter().find(|value| expected.as_f64() != Some(*value)).map(Raw::Number)
        }
        _ => {
            let options = asked.question.kind.options();
            let other = options.iter().position(|option| expected.as_str() != Some(&option.value));
            other.map(Raw::Option)
        }
    }
}
