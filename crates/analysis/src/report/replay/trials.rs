//! The trials of the analysis as a table that other programs read.

use std::borrow::Cow;
use std::sync::Arc;

use mimique_locale::Language;
use mimique_report::document::csv_text;
use mimique_study::KindOfQuestion as _;
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::shown::{of_blocks, spaced};
use crate::report::section::Writer;
use crate::trials::export::{Export, Trial};
use crate::trials::measure::{Measure, MeasureKind};

/// A column of the trials' file.
pub(super) enum Cells<'e> {
    Texts(Vec<&'e str>),
    Written(Vec<Option<String>>),
    Numbers(Vec<Option<f64>>),
    /// Numbers with blanks between them.
    Courses(Vec<Option<Arc<[f32]>>>),
}

impl Cells<'_> {
    /// The text of a cell, in bytes.
    fn bytes(&self, row: usize) -> Cow<'_, [u8]> {
        match self {
            Self::Texts(cells) => Cow::Borrowed(cells[row].as_bytes()),
            Self::Written(cells) => {
                Cow::Borrowed(cells[row].as_deref().unwrap_or_default().as_bytes())
            }
            Self::Numbers(cells) => match cells[row] {
                Some(number) => Cow::Owned(number.to_string().into_bytes()),
                None => Cow::Borrowed(&[]),
            },
            Self::Courses(cells) => {
                // Every number as the report has computed with it.
                let numbers = cells[row].iter().flat_map(|course| course.iter());
                Cow::Owned(spaced(numbers.map(|number| f64::from(*number))).into_bytes())
            }
        }
    }
}

/// One line a trial in the analysis: person, clip, factors, answers about the person, every measure.
pub(super) fn trials(writer: &Writer<'_>) -> String {
    let export: &Export = writer.export;
    let rows = export.trials.len();
    let mut person = vec![0; rows];
    for answer in export.answers.values().flatten() {
        person[answer.trial] = answer.person;
    }
    let ids = person.iter().map(|&person| export.people[person].id.as_str());
    let clips = export.trials.iter().map(|trial| &*trial.stimulus);
    let orders = export.trials.iter().map(|trial| trial.order.map(|order| order as f64));
    let mut columns: Vec<(String, Cells<'_>)> = vec![
        ("participant_id".to_owned(), Cells::Texts(ids.collect())),
        ("stimulus".to_owned(), Cells::Texts(clips.collect())),
        ("trial_order".to_owned(), Cells::Numbers(orders.collect())),
    ];
    for (place, factor) in export.factors.iter().enumerate() {
        let levels = export.trials.iter().map(|trial| trial.levels[place].as_deref());
        columns
            .push((factor.clone(), Cells::Texts(levels.map(Option::unwrap_or_default).collect())));
    }
    if !export.factors.iter().any(|factor| factor == "segment") {
        let segments = export.trials.iter().map(|trial| trial.segment.as_deref());
        let cells = Cells::Texts(segments.map(Option::unwrap_or_default).collect());
        columns.insert(2, ("segment".to_owned(), cells));
    }
    columns.extend(of_companions(export));
    columns.extend(of_blocks(export, writer.study));
    for (name, cells) in &export.about {
        let texts = person.iter().map(|&person| cells[person].as_deref().unwrap_or_default());
        columns.push((name.clone(), Cells::Texts(texts.collect())));
    }
    for (item, cells) in &export.page_answers {
        if !export.about.iter().any(|(name, _)| name == item) {
            let numbers = person.iter().map(|&person| cells[person]);
            columns.push((item.clone(), Cells::Numbers(numbers.collect())));
        }
    }
    let mut measures: Vec<Measure> = Vec::new();
    for asked in export.questions(writer.study) {
        let measure = Measure::of_question(export, &asked, Language::English);
        if measure.as_ref().is_some_and(|measure| measure.kind == MeasureKind::Recognition) {
            let (mut truth, mut given) = (vec![""; rows], vec![""; rows]);
            for answer in export.answers_to(&asked.id) {
                truth[answer.trial] = answer.truth.as_deref().unwrap_or_default();
                given[answer.trial] = &answer.text;
            }
            columns.push((format!("{}.truth", asked.id), Cells::Texts(truth)));
            columns.push((format!("{}.answer", asked.id), Cells::Texts(given)));
        }
        if asked.question.is_some_and(|question| question.kind.compares_clips()) {
            let (mut given, mut chosen) = (vec![""; rows], vec![""; rows]);
            for answer in export.answers_to(&asked.id) {
                let trial = &export.trials[answer.trial];
                given[answer.trial] = &answer.text;
                chosen[answer.trial] = chosen_clip(trial, &answer.text);
            }
            columns.push((format!("{}.answer", asked.id), Cells::Texts(given)));
            columns.push((format!("{}.chosen", asked.id), Cells::Texts(chosen)));
        }
        columns.extend(course_of(export, &asked.id));
        measures.extend(measure);
        measures.extend(Measure::response_time(export, &asked, Language::English));
    }
    for measure in measures {
        let mut cells = vec![None; rows];
        for (value, &trial) in measure.values.iter().zip(&measure.trial) {
            cells[trial] = Some(*value);
        }
        columns.push((measure.id, Cells::Numbers(cells)));
    }
    in_lines(&columns, rows)
}

/// Where the answers to a question that followed the clip stood; nothing of other questions.
fn course_of<'e>(export: &'e Export, question: &str) -> Option<(String, Cells<'e>)> {
    let answers = export.answers_to(question);
    answers.iter().any(|answer| answer.trace.is_some()).then(|| {
        let mut courses = vec![None; export.trials.len()];
        for answer in answers {
            courses[answer.trial].clone_from(&answer.trace);
        }
        (format!("{question}.trace"), Cells::Courses(courses))
    })
}

/// What is played beside each clip: its identifier, its side, its factors. Nothing where no clip has a companion.
fn of_companions(export: &Export) -> Vec<(String, Cells<'_>)> {
    let besides = || export.trials.iter().map(|trial| trial.beside.as_ref());
    if besides().all(|beside| beside.is_none()) {
        return Vec::new();
    }
    let side = |left: bool| if left { "left" } else { "right" };
    let clips = besides().map(|beside| beside.map_or("", |beside| &*beside.clip));
    let sides = besides().map(|beside| beside.map_or("", |beside| side(beside.left)));
    let mut columns = vec![
        ("beside".to_owned(), Cells::Texts(clips.collect())),
        ("beside_side".to_owned(), Cells::Texts(sides.collect())),
    ];
    for (place, factor) in export.factors.iter().enumerate() {
        let levels = besides().map(|beside| beside?.levels[place].as_deref());
        let cells = Cells::Texts(levels.map(Option::unwrap_or_default).collect());
        columns.push((format!("beside.{factor}"), cells));
    }
    columns
}

/// The clip that an answer chooses; nothing where it chooses neither.
fn chosen_clip<'e>(trial: &'e Trial, answer: &str) -> &'e str {
    let Some(beside) = &trial.beside else { return "" };
    match (answer, beside.left) {
        ("left", true) | ("right", false) => &beside.clip,
        ("left", false) | ("right", true) => &trial.stimulus,
        _ => "",
    }
}

/// The columns as CSV, pieces of it at the same time.
fn in_lines(columns: &[(String, Cells<'_>)], rows: usize) -> String {
    let lines = |first: usize| {
        let row = |row: usize| columns.iter().map(move |(_, cells)| cells.bytes(row));
        csv_text((first..(first + ROWS).min(rows)).map(row))
    };
    let starts: Vec<usize> = (0..rows).step_by(ROWS).collect();
    let pieces: Vec<String> = starts.into_par_iter().map(lines).collect();
    csv_text([columns.iter().map(|(name, _)| name)]) + &pieces.concat()
}

/// Lines of the trials' file that are written together.
const ROWS: usize = 4096;
