//! What blocks of pairs and panels have in common: what they compare, within what, and which clips they can show.

use std::collections::{BTreeMap, BTreeSet};

use super::Subject;
use super::issue::{Issues, below};
use super::problem::Problem;
use super::values::Nearest;
use crate::columns::ColumnKind;
use crate::study_file::{Clip, ClipSelection, NoCells};

/// What is compared, and what its clips are alike in.
pub(super) fn factors(
    (compare, levels, within): (&str, &[String], &[String]),
    factors: &BTreeMap<String, BTreeSet<String>>,
    pointer: &str,
    issues: &mut Issues,
) {
    let unknown = |name: &str| Problem::unknown("factor", name, factors.keys());
    let list = below(pointer, "levels");
    match factors.get(compare) {
        None => issues.error(below(pointer, "compare"), unknown(compare)),
        Some(known) => {
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            for (index, level) in levels.iter().enumerate() {
                let place = below(&list, index);
                if !known.contains(&level.as_str()) {
                    let factor = compare.to_owned();
                    let nearest = Nearest::to(level, &known);
                    let level = level.clone();
                    issues.error(place, Problem::NoClipWith { factor, level, known: nearest });
                } else if levels[..index].contains(level) {
                    issues.error(place, Problem::NamedTwice { name: level.clone() });
                }
            }
        }
    }
    for (index, name) in within.iter().enumerate() {
        let place = below(&below(pointer, "within"), index);
        if name == compare {
            issues.error(place, Problem::ComparedWithin { factor: name.clone() });
        } else if !factors.contains_key(name) {
            issues.error(place, unknown(name));
        } else if within[..index].contains(name) {
            issues.error(place, Problem::NamedTwice { name: name.clone() });
        }
    }
}

/// Nothing of the study is called like a column that exports of such blocks have.
pub(super) fn columns(
    subject: &Subject<'_>,
    columns: &[(&str, ColumnKind, &str, &str)],
    pointer: &str,
    issues: &mut Issues,
) {
    let factors = subject.study.factor_names();
    let about = subject.study.demographics.iter().flat_map(|page| &page.questions);
    for name in factors.iter().chain(about.map(|question| &question.id)) {
        if columns.iter().any(|(column, ..)| column == name) {
            issues.error(pointer, Problem::BlockColumn { name: name.clone() });
        }
    }
}

/// The clips have neither sound nor a clock of their own.
pub(super) fn drawn_and_silent(
    subject: &Subject<'_>,
    clips: &ClipSelection,
    place: &str,
    issues: &mut Issues,
) {
    let stimuli = &subject.study.stimuli;
    if !stimuli.sounds.is_empty() {
        issues.error(place, Problem::SeveralWithSound);
    }
    let is_video = |clip: &&Clip| {
        let avatar = stimuli.avatars.get(&clip.avatar);
        clips.takes(clip) && avatar.is_some_and(|avatar| !avatar.videos.is_empty())
    };
    if subject.clips.iter().any(|clip| is_video(&clip)) {
        issues.error(place, Problem::SeveralWithVideo);
    }
}

/// Clips make no cells.
pub(super) fn no_cells(why: NoCells, pointer: &str, issues: &mut Issues) {
    match why {
        NoCells::LevelMissing { .. } => issues.error(pointer, Problem::CellIncomplete { why }),
        NoCells::LevelTwice { .. } => {
            issues.error(below(pointer, "within"), Problem::CellAmbiguous { why });
        }
    }
}
