//! Candidates that learn: as the seeds have it, and as is recommended or chosen.

use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::bail;
use indicatif::ProgressBar;
use mimique_annotate::evaluate::{
    Candidate, Cut, Fold, Judged, Summary, check_folds, folds, held_out, leave_out, summary,
};
use mimique_annotate::{
    AnnotateError, AnnotatedTake, Decoding, ForestOptions, Kernel, Lesson, Mark, Method,
    Segmentation, SvmOptions,
};

use super::{Args, Column, ColumnKind, Evaluation, Split, ThesisRow};
use crate::annotate::corpus::Corpus;
use crate::annotate::method::AsIn;
use crate::annotate::named;

/// Most training frames of a support vector machine.
const SVM_ROWS: usize = 20_000;
/// Training frames a second as is recommended.
const RECOMMENDED_HZ: f64 = 10.0;

/// The folds of a split, and that each can be learnt without.
fn split(args: &Args, corpus: &Corpus) -> anyhow::Result<Vec<Fold>> {
    let Corpus { takes, labels, file, .. } = corpus;
    let blame = |error: AnnotateError| named(error, labels).context(file.display().to_string());
    let found = match args.split {
        Split::Take => leave_out(&(0..takes.len()).collect::<Vec<_>>()),
        Split::Person => {
            corpus.needs("person", |take| &take.person)?;
            leave_out(&takes.iter().map(|take| take.person.as_str()).collect::<Vec<_>>())
        }
        Split::Kind => {
            corpus.needs("kind", |take| &take.kind)?;
            leave_out(&takes.iter().map(|take| take.kind.as_str()).collect::<Vec<_>>())
        }
        Split::Folds(count) => folds(takes.len(), count, args.method.seed),
    };
    let found = found.map_err(blame)?;
    for label in 0..labels.len() {
        let takes = takes.iter().filter(|take| take.shows(label)).count();
        if takes < 2 {
            return Err(blame(AnnotateError::FewTakes { label, takes }));
        }
    }
    match check_folds(labels.len(), takes, &found) {
        Err(AnnotateError::HeldOut { label, take }) => bail!(
            "{}: line {}: label {}: in no take that is not held out together with this one; mark it in \
             others, or hold out otherwise with --split",
            file.display(),
            corpus.lines[take],
            labels[label]
        ),
        other => other.map_err(blame)?,
    }
    Ok(found)
}

/// Everything of a corpus that is learnt from.
pub(super) fn evaluated(
    args: &Args,
    corpus: Corpus,
    progress: &ProgressBar,
) -> anyhow::Result<Evaluation> {
    let folds = split(args, &corpus)?;
    let chosen = Lesson {
        decoding: args.decode.of_all(args.method.as_in)?,
        thinned_to_hz: args.method.thinned_to_hz(),
        ..corpus.lesson(args.method.method(&corpus.labels, args.decode.stay)?)
    };
    let recommended = Lesson {
        thinned_to_hz: Some(RECOMMENDED_HZ),
        ..corpus.lesson(Method::Forest(forest(args.method.seed)))
    };
    let thesis = Lesson {
        decoding: Decoding::Segments(Segmentation::as_in_the_thesis()),
        ..corpus.lesson(Method::Forest(forest(args.method.seed)))
    };
    let pair = match args.method.as_in {
        Some(AsIn::Thesis) => {
            [(ColumnKind::Thesis, chosen), (ColumnKind::Recommended, recommended)]
        }
        Some(AsIn::ShortPaper) => {
            [(ColumnKind::ShortPaper, chosen), (ColumnKind::Recommended, recommended)]
        }
        None if chosen == recommended => {
            [(ColumnKind::Thesis, thesis), (ColumnKind::Recommended, chosen)]
        }
        None => [(ColumnKind::Thesis, thesis), (ColumnKind::Chosen, chosen)],
    };
    let mut evaluation = Evaluation {
        corpus,
        split: args.split,
        columns: Vec::new(),
        thesis: Vec::new(),
        not_alone: false,
        svm_thinned_to_hz: None,
    };
    let judge = Judge { args, folds: &folds, progress };
    for (kind, lesson) in pair {
        judge.column(&mut evaluation, kind, lesson)?;
    }
    if args.method.as_in == Some(AsIn::Thesis) {
        judge.figure_4_4(&mut evaluation)?;
    }
    Ok(evaluation)
}

fn forest(seed: u64) -> ForestOptions {
    ForestOptions { seed, ..ForestOptions::default() }
}

/// What judges candidates.
struct Judge<'a> {
    args: &'a Args,
    folds: &'a [Fold],
    progress: &'a ProgressBar,
}

impl Judge<'_> {
    /// A candidate on the held-out takes, by each of its cuts.
    fn run(&self, corpus: &Corpus, candidate: &Candidate) -> anyhow::Result<Vec<Vec<Judged>>> {
        let learnt = AtomicUsize::new(0);
        let done = |all: usize| {
            let count = learnt.fetch_add(1, Ordering::Relaxed) + 1;
            self.progress.set_message(format!("{count} of {all} models"));
        };
        held_out(candidate, &corpus.takes, self.folds, &done)
            .map_err(|e| named(e, &corpus.labels).context(corpus.file.display().to_string()))
    }

    fn summary(&self, corpus: &Corpus, judged: &[Judged]) -> anyhow::Result<Summary> {
        let by_person = self.args.split == Split::Person;
        let labels = corpus.labels.len();
        Ok(summary(&corpus.takes, judged, labels, by_person, self.args.method.seed)?)
    }

    /// The seeds learn each person alone, where that can be done.
    fn alone(&self, evaluation: &mut Evaluation, mut candidate: Candidate) -> Candidate {
        candidate.own_person = self.args.split != Split::Person;
        if candidate.own_person && !candidate.can_learn(&evaluation.corpus.takes, self.folds) {
            candidate.own_person = false;
        }
        evaluation.not_alone |= !candidate.own_person;
        candidate
    }

    fn column(
        &self,
        evaluation: &mut Evaluation,
        kind: ColumnKind,
        lesson: Lesson,
    ) -> anyhow::Result<()> {
        let of_seed = matches!(kind, ColumnKind::Thesis | ColumnKind::ShortPaper);
        let mut candidate = Candidate {
            cuts: vec![Cut::Found(lesson.decoding.clone())],
            lesson,
            own_person: false,
            calibrated: !of_seed,
        };
        if of_seed {
            candidate = self.alone(evaluation, candidate);
        }
        let judged = self.run(&evaluation.corpus, &candidate)?.remove(0);
        evaluation.columns.push(Column {
            kind,
            summary: self.summary(&evaluation.corpus, &judged)?,
            judged,
            lesson: candidate.lesson,
            own_person: candidate.own_person,
            calibrated: candidate.calibrated,
        });
        Ok(())
    }

    /// Every classifier of the thesis on the annotator's segments and on those found.
    fn figure_4_4(&self, evaluation: &mut Evaluation) -> anyhow::Result<()> {
        let svm = |kernel| Method::Svm(SvmOptions { kernel, ..SvmOptions::default() });
        let methods = [
            Method::Knn { k: 1 },
            Method::Knn { k: 3 },
            svm(Kernel::Linear),
            svm(Kernel::Rbf { gamma: 0.2 }),
            Method::Forest(forest(self.args.method.seed)),
        ];
        let own = evaluation.columns[0].lesson.clone();
        for method in methods {
            let mut lesson = Lesson { method, ..own.clone() };
            if matches!(method, Method::Svm(_)) {
                lesson.thinned_to_hz = svm_thinned(&evaluation.corpus, lesson.thinned_to_hz);
                evaluation.svm_thinned_to_hz =
                    lesson.thinned_to_hz.filter(|_| own.thinned_to_hz.is_none());
            }
            let cuts = vec![Cut::True, Cut::Found(lesson.decoding.clone())];
            let candidate = Candidate { lesson, cuts, own_person: false, calibrated: false };
            let candidate = self.alone(evaluation, candidate);
            let mut judged = self.run(&evaluation.corpus, &candidate)?;
            let (found, of_true) = (judged.remove(1), judged.remove(0));
            evaluation.thesis.push(ThesisRow {
                method,
                of_true: self.summary(&evaluation.corpus, &of_true)?,
                of_found: self.summary(&evaluation.corpus, &found)?,
            });
        }
        Ok(())
    }
}

/// Training frames a second that a support vector machine can learn.
fn svm_thinned(corpus: &Corpus, asked: Option<f64>) -> Option<f64> {
    let stable = |take: &AnnotatedTake| -> usize {
        let own = take.marked.iter().filter(|m| matches!(m.mark, Mark::Stable(_)));
        own.map(|marked| marked.frames.len()).sum()
    };
    let frames: usize = corpus.takes.iter().map(stable).sum();
    if asked.is_some() || frames <= SVM_ROWS {
        return asked;
    }
    // Every n-th frame, n whole.
    let step = frames.div_ceil(SVM_ROWS);
    Some(corpus.takes[0].take.rate_hz / step as f64)
}
