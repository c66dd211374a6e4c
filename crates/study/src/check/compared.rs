//! What blocks of pairs and panels have in common: what they compare, within what, and which clips they can show.

use super::Subject;
use super::issue::{Issues, below};
use super::problem::Problem;
use super::sequence::{all_factors, selection};
use super::values::Nearest;
use crate::columns::ColumnKind;
use crate::study_file::{Compared, NoCells};

/// Which clips are compared, by what, and what they are alike in.
pub(super) fn clips(
    subject: &Subject<'_>,
    Compared { compare, levels, within, clips }: Compared<'_>,
    pointer: &str,
    issues: &mut Issues,
) {
    let factors = all_factors(subject);
    selection(subject, clips, &factors, pointer, issues);
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

/// The clips of each cell that are shown in step have one sound, or none: of several nobody could tell which is whose.
pub(super) fn one_sound<'c>(
    subject: &Subject<'_>,
    cells: impl IntoIterator<Item = &'c [String]>,
    place: &str,
    issues: &mut Issues,
) {
    let clip = |id: &String| subject.clips.iter().find(|clip| clip.id == *id);
    let heard = |id: &String| {
        let heard = subject.study.heard(clip(id)?)?;
        Some((heard.file, heard.from_s, heard.segment.id.as_str(), heard.delay_ms))
    };
    for cell in cells {
        let Some((first, others)) = cell.split_first() else { continue };
        if let Some(other) = others.iter().find(|other| heard(other) != heard(first)) {
            let (clip, other) = (first.clone(), (*other).clone());
            issues.error(place, Problem::TwoSounds { clip, other });
            return;
        }
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
