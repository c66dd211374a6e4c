//! The answers to a question that chooses between two clips, as comparisons of the levels of a factor.

use std::collections::BTreeMap;

use mimique_stats::{Chosen, Compared, Factor, Numbers, PairedComparisons};

use crate::trials::export::{Answer, Export};

/// What an answer chooses; none of what is no such answer.
pub(crate) fn chosen(answer: &Answer) -> Option<Chosen> {
    Chosen::ALL.into_iter().find(|chosen| chosen.word() == &*answer.text)
}

/// Choices between the levels of a factor of the clips: of the `levels` that are compared, all if there are none,
/// in their order or else in `order`. Answers about two clips of one level are of none. None where fewer than two
/// levels are left.
pub(crate) fn by_factor(
    export: &Export,
    question: &str,
    factor: &str,
    order: &[String],
    levels: &[String],
) -> Option<PairedComparisons> {
    with_segments(export, question, factor, order, levels).map(|(choices, _)| choices)
}

/// The same with the segment of each answer; a segment that the export does not name is missing.
pub(crate) fn with_segments(
    export: &Export,
    question: &str,
    factor: &str,
    order: &[String],
    levels: &[String],
) -> Option<(PairedComparisons, Factor)> {
    let place = export.factors.iter().position(|name| name == factor)?;
    let is_compared = |level: &str| levels.is_empty() || levels.iter().any(|own| own == level);
    let mut rows = Vec::new();
    let mut segments: Vec<Option<&str>> = Vec::new();
    for answer in export.answers_to(question) {
        let trial = &export.trials[answer.trial];
        let Some(beside) = &trial.beside else { continue };
        let (own, other) = (trial.levels[place].as_deref(), beside.levels[place].as_deref());
        let (Some(own), Some(other), Some(chosen)) = (own, other, chosen(answer)) else { continue };
        if own == other || !is_compared(own) || !is_compared(other) {
            continue;
        }
        let [left, right] = if beside.left { [other, own] } else { [own, other] };
        rows.push((answer.person, left, right, chosen));
        segments.push(trial.segment.as_deref());
    }
    let wanted = if levels.is_empty() { order } else { levels };
    let rank = |level: &str| {
        (wanted.iter().position(|own| own == level).unwrap_or(wanted.len()), level.to_owned())
    };
    let mut items: Vec<&str> =
        rows.iter().flat_map(|(_, left, right, _)| [*left, *right]).collect();
    items.sort_by_key(|level| rank(level));
    items.dedup();
    if items.len() < 2 {
        return None;
    }
    let mut people: BTreeMap<usize, usize> = rows.iter().map(|(person, ..)| (*person, 0)).collect();
    for (place, own) in people.values_mut().enumerate() {
        *own = place;
    }
    let item = |level: &str| items.iter().position(|own| *own == level).unwrap_or(0);
    let answers = rows.iter().map(|(person, left, right, chosen)| Compared {
        participant: people[person],
        left: item(left),
        right: item(right),
        chosen: *chosen,
    });
    let choices = PairedComparisons {
        answers: answers.collect(),
        participants: people.keys().map(|person| export.people[*person].id.clone()).collect(),
        items: items.iter().map(|level| (*level).to_owned()).collect(),
        dropped: 0,
    };
    Some((choices, Factor::from_cells("segment", segments.into_iter(), |_| None)))
}

/// Of two items, 1 for each answer that chooses the first, -1 for the second, 0 for neither.
pub(crate) fn net_of_trials(data: &PairedComparisons) -> Numbers {
    let values = data.answers.iter().map(|answer| match (answer.chosen, answer.left) {
        (Chosen::Same, _) => 0.0,
        (Chosen::Left, 0) | (Chosen::Right, 1) => 1.0,
        _ => -1.0,
    });
    Numbers { name: data.items.join(" | "), values: values.collect() }
}

/// The same summed over each person.
pub(crate) fn net_of_people(data: &PairedComparisons) -> Numbers {
    let trials = net_of_trials(data);
    let mut values = vec![0.0; data.participants.len()];
    for (answer, net) in data.answers.iter().zip(&trials.values) {
        values[answer.participant] += net;
    }
    Numbers { values, ..trials }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_of_the_first_item_count_up_on_either_side() {
        let answer =
            |participant, left, chosen| Compared { participant, left, right: 1 - left, chosen };
        let data = PairedComparisons {
            items: vec!["a".to_owned(), "b".to_owned()],
            participants: vec!["p".to_owned(), "q".to_owned()],
            answers: vec![
                answer(0, 0, Chosen::Left),
                answer(0, 1, Chosen::Right),
                answer(0, 1, Chosen::Left),
                answer(1, 0, Chosen::Right),
                answer(1, 0, Chosen::Same),
            ],
            dropped: 0,
        };
        assert_eq!(net_of_trials(&data).values, [1.0, 1.0, -1.0, -1.0, 0.0]);
        assert_eq!(net_of_people(&data).values, [1.0, -1.0]);
    }
}
