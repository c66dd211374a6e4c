//! The answers that agreement is computed of.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use mimique_stats::{Blocks, Table};
use mimique_study::Study;

use crate::trials::column::Column;
use crate::trials::error::ExportError;
use crate::trials::export::Export;
use crate::trials::measure::Measure;

/// The first answer of each person to each clip, a row each.
pub(super) struct FirstAnswers<'e> {
    pub clips: Vec<&'e str>,
    pub people: Vec<&'e str>,
    pub given: Vec<&'e str>,
    /// Later answers of a person to the same clip.
    pub repeated: usize,
}

/// The first answers to a question.
pub(super) fn first_answers<'e>(export: &'e Export, question: &str) -> FirstAnswers<'e> {
    let mut first =
        FirstAnswers { clips: Vec::new(), people: Vec::new(), given: Vec::new(), repeated: 0 };
    let mut seen = HashSet::new();
    for answer in export.answers_to(question) {
        let clip: &str = &export.trials[answer.trial].stimulus;
        if !seen.insert((clip, answer.person)) {
            first.repeated += 1;
            continue;
        }
        first.clips.push(clip);
        first.people.push(&export.people[answer.person].id);
        first.given.push(&answer.text);
    }
    first
}

/// Mean rating of each clip (a block) by each person (a group); clips that somebody did not rate are incomplete.
pub(super) fn by_clip(export: &Export, measure: &Measure) -> Blocks {
    let people: BTreeSet<usize> = measure.person.iter().copied().collect();
    let people: Vec<usize> = people.into_iter().collect();
    let mut clips: HashMap<&str, Vec<(f64, f64)>> = HashMap::new();
    for (row, value) in measure.values.iter().enumerate() {
        let clip: &str = &export.trials[measure.trial[row]].stimulus;
        let own = clips.entry(clip).or_insert_with(|| vec![(0.0, 0.0); people.len()]);
        if let Ok(place) = people.binary_search(&measure.person[row]) {
            own[place].0 += value;
            own[place].1 += 1.0;
        }
    }
    let all = clips.len();
    let mut whole: Vec<(&str, Vec<f64>)> = clips
        .into_iter()
        .filter(|(_, own)| own.iter().all(|(_, count)| *count > 0.0))
        .map(|(clip, own)| (clip, own.into_iter().map(|(sum, count)| sum / count).collect()))
        .collect();
    whole.sort_unstable_by_key(|(clip, _)| *clip);
    Blocks {
        groups: people.iter().map(|person| export.people[*person].id.clone()).collect(),
        incomplete: all - whole.len(),
        blocks: whole.iter().map(|(clip, _)| (*clip).to_owned()).collect(),
        responses: whole.into_iter().map(|(_, means)| means).collect(),
        dropped: 0,
    }
}

/// The answer of each person who has a trial in the analysis to an item of a scale: what was answered on a page, or the mean over trials; NaN
/// where there is none.
pub(super) fn of_people(export: &Export, item: &str) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); export.people.len()];
    for answer in export.answers_to(item) {
        if let Some(number) = answer.number {
            sums[answer.person].0 += number;
            sums[answer.person].1 += 1.0;
        }
    }
    let pages = export.page_answers.get(item);
    let of = |person: usize| match sums[person] {
        (_, 0.0) => pages.and_then(|pages| pages[person]).unwrap_or(f64::NAN),
        (sum, count) => sum / count,
    };
    // Who has no trial left is not in the analysis.
    let used: BTreeSet<usize> = export.answers.values().flatten().map(|own| own.person).collect();
    used.into_iter().map(of).collect()
}

/// Answers to the items of the study's scales that stand on pages, by item and person.
pub(crate) fn on_pages(
    table: &Table,
    study: &Study,
    person_of_row: &[usize],
    people: usize,
) -> Result<BTreeMap<String, Vec<Option<f64>>>, ExportError> {
    let mut found: BTreeMap<String, Vec<Option<f64>>> = BTreeMap::new();
    let items: BTreeSet<&str> =
        study.scales.values().flat_map(|scale| &scale.items).map(String::as_str).collect();
    if items.is_empty() {
        return Ok(found);
    }
    let [kind, response, answer] =
        ["trial_type", "response_id", "answer"].map(|name| Column::of(table, name));
    for (row, &person) in person_of_row.iter().enumerate() {
        let Some(item) = response.text(row).filter(|item| items.contains(item)) else { continue };
        if matches!(kind.text(row), Some("trial" | "training")) {
            continue;
        }
        let own = found.entry(item.to_owned()).or_insert_with(|| vec![None; people]);
        if own[person].is_none() {
            own[person] = answer.number(row)?;
        }
    }
    Ok(found)
}
