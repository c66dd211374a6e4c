//! Columns of the trials' file that say what a block showed: levels, judged levels, courses of action units.

use std::collections::BTreeSet;

use mimique_study::{KindOfQuestion as _, ShownCourse, Study};

use super::trials::Cells;
use crate::trials::export::{Export, Trial};

/// The columns; none where no trial is of such a block. Faces that the seed does not give again have no block.
pub(super) fn of_blocks<'e>(export: &'e Export, study: &Study) -> Vec<(String, Cells<'e>)> {
    let column = |name: &str, cell: fn(&Trial) -> Option<String>| {
        let cells: Vec<Option<String>> = export.trials.iter().map(cell).collect();
        let is_there = cells.iter().any(Option::is_some);
        is_there.then(|| (name.to_owned(), Cells::Written(cells)))
    };
    let columns = [
        column("shown.block", |trial| block(trial).map(str::to_owned)),
        column("shown.level", |trial| Some(trial.level.as_ref()?.level.to_string())),
        column("shown.catch", |trial| Some(u8::from(trial.level.as_ref()?.catch).to_string())),
        column("shown.levels", |trial| {
            let (_, levels) = trial.scaled.as_ref()?;
            Some(spaced(levels.iter().copied()))
        }),
        column("shown.courses", |trial| {
            let courses = trial.face.as_ref()?.courses.iter().map(course);
            Some(courses.collect::<Vec<_>>().join(";"))
        }),
    ];
    let mut columns: Vec<(String, Cells<'e>)> = columns.into_iter().flatten().collect();
    columns.extend(answers(export, study));
    columns
}

/// The block of a trial that chose what is shown.
fn block(trial: &Trial) -> Option<&str> {
    let level = trial.level.as_ref().map(|level| &*level.block);
    let face = trial.face.as_ref().filter(|face| face.replayed).map(|face| &*face.block);
    level.or(face).or(trial.scaled.as_ref().map(|(block, _)| &**block))
}

/// What was answered to the questions of these blocks; where levels follow the answers, whether it was right.
fn answers<'e>(export: &'e Export, study: &Study) -> Vec<(String, Cells<'e>)> {
    let rows = export.trials.len();
    let mut columns = Vec::new();
    let adaptive: BTreeSet<String> = study.adaptive().map(|(_, block)| block.question).collect();
    for question in adaptive {
        let mut right = vec![None; rows];
        for answer in export.answers_to(&question) {
            right[answer.trial] = answer.correct.map(|right| f64::from(u8::from(right)));
        }
        columns.push((format!("{question}.right"), Cells::Numbers(right)));
    }
    let scalings = study.scalings().map(|(_, block)| block.question);
    let faces = study.reverse_correlations().map(|(_, block)| block.question);
    // Of a question about pairs of clips, or with a right answer, the column is there already.
    let is_there = |question: &String| {
        let kind = study.questions.iter().find(|own| own.id == *question).map(|own| &own.kind);
        kind.is_some_and(|kind| kind.compares_clips() || kind.truth().is_some())
    };
    for question in scalings.chain(faces).filter(|own| !is_there(own)).collect::<BTreeSet<_>>() {
        let mut given = vec![""; rows];
        for answer in export.answers_to(&question) {
            given[answer.trial] = &answer.text;
        }
        columns.push((format!("{question}.answer"), Cells::Texts(given)));
    }
    columns
}

/// A unit, and the numbers of its course with spaces between them.
fn course(own: &ShownCourse) -> String {
    let numbers =
        [own.onset_s, own.peak_s, own.offset_s, own.amplitude, own.acceleration, own.deceleration];
    format!("{} {}", own.unit, spaced(numbers))
}

/// Numbers with blanks between them.
pub(super) fn spaced(numbers: impl IntoIterator<Item = f64>) -> String {
    let numbers: Vec<String> = numbers.into_iter().map(|number| number.to_string()).collect();
    numbers.join(" ")
}
