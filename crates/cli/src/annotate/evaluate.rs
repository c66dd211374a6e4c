//! `mimique annotate evaluate`: what is learnt of some takes, held against others.

use std::path::PathBuf;
use std::str::FromStr;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context as _, anyhow, bail};
use indicatif::ProgressBar;
use mimique_analysis::Language;
use mimique_annotate::evaluate::{
    Candidate, Cut, Fold, Judged, Summary, check_folds, folds, held_out, judged, leave_out, summary,
};
use mimique_annotate::{
    AnnotateError, AnnotatedTake, ForestOptions, Kernel, Lesson, Method, Model, SvmOptions,
};

use super::corpus::{Corpus, CorpusOptions};
use super::decoding::DecodeOptions;
use super::method::{AsIn, MethodOptions};
use super::{apply, named, report, spinner};
use crate::report_folder;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    corpus: CorpusOptions,
    /// What is held out together: take, person, kind, or fold=K for K folds of takes
    #[arg(long, value_name = "take|person|kind|fold=K", default_value = "take")]
    split: Split,
    /// Folder for the report; an earlier report in it is replaced
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Language of the report: en or fr
    #[arg(long, default_value = "en", value_parser = crate::analyze::language)]
    language: Language,
    /// Hold this model against the takes instead of learning; of what --split names it must have learnt
    /// none
    #[arg(long, value_name = "FILE", conflicts_with_all = ["as_in", "method"])]
    model: Option<PathBuf>,
    #[command(flatten)]
    method: MethodOptions,
    #[command(flatten)]
    decode: DecodeOptions,
}

/// What is held out together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Split {
    Take,
    Person,
    Kind,
    Folds(usize),
}

impl FromStr for Split {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let folds = |text: &str| text.strip_prefix("fold=")?.parse().ok().filter(|k| *k > 1);
        match text {
            "take" => Ok(Self::Take),
            "person" => Ok(Self::Person),
            "kind" => Ok(Self::Kind),
            _ => folds(text).map(Self::Folds).ok_or_else(|| {
                "give take, person, kind, or fold=K with 2 folds or more".to_owned()
            }),
        }
    }
}

/// What a column of the report is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnKind {
    Thesis,
    ShortPaper,
    Recommended,
    Chosen,
    Model,
}

/// A candidate, judged.
pub struct Column {
    pub kind: ColumnKind,
    /// What was learnt; of a model that was given, how it was.
    pub lesson: Lesson,
    /// Whether each person was learnt alone.
    pub own_person: bool,
    /// Whether probabilities have a temperature.
    pub calibrated: bool,
    pub judged: Vec<Judged>,
    pub summary: Summary,
}

/// A row of figure 4.4 of the thesis: a classifier on the annotator's segments and on those found.
pub struct ThesisRow {
    pub method: Method,
    pub of_true: Summary,
    pub of_found: Summary,
}

/// Everything that was evaluated.
pub struct Evaluation {
    pub corpus: Corpus,
    pub split: Split,
    pub columns: Vec<Column>,
    pub thesis: Vec<ThesisRow>,
    /// That persons could not be learnt alone.
    pub not_alone: bool,
    /// Training frames a second of support vector machines, where all were too many.
    pub svm_thinned_to_hz: Option<f64>,
}

/// Most training frames of a support vector machine.
const SVM_ROWS: usize = 20_000;

/// Runs the command.
pub fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    if let Some(out) = &args.out {
        report_folder::check(out).with_context(|| out.display().to_string())?;
    }
    let progress = spinner();
    progress.set_message("reading");
    let corpus = args.corpus.read()?;
    let evaluation = match &args.model {
        Some(file) => of_model(args, corpus, apply::model(file)?)?,
        None => of_lessons(args, corpus, &progress)?,
    };
    progress.finish_and_clear();
    let files = report::files(&evaluation, args.language);
    if let Some(out) = &args.out {
        report_folder::write(&files, out).with_context(|| out.display().to_string())?;
    }
    report::print(&evaluation, args.out.as_deref(), json)
}

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

impl Corpus {
    fn lesson(&self, method: Method) -> Lesson {
        Lesson {
            channel: self.channel.clone(),
            labels: self.labels.clone(),
            shapes: self.shapes.clone(),
            method,
            thinned_to_hz: None,
            decoding: mimique_annotate::Decoding::default(),
        }
    }
}

fn of_lessons(args: &Args, corpus: Corpus, progress: &ProgressBar) -> anyhow::Result<Evaluation> {
    let folds = split(args, &corpus)?;
    let chosen = Lesson {
        decoding: args.decode.of_all(args.method.as_in)?,
        thinned_to_hz: args.method.thinned_to_hz(),
        ..corpus.lesson(args.method.method(&corpus.labels, args.decode.stay)?)
    };
    let recommended = Lesson {
        thinned_to_hz: Some(10.0),
        ..corpus.lesson(Method::Forest(forest(args.method.seed)))
    };
    let thesis = Lesson {
        decoding: mimique_annotate::Decoding::Segments(
            mimique_annotate::Segmentation::as_in_the_thesis(),
        ),
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
        let own =
            take.marked.iter().filter(|m| matches!(m.mark, mimique_annotate::Mark::Stable(_)));
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

/// A model that is given, on takes of which it has learnt nothing.
fn of_model(args: &Args, corpus: Corpus, model: Model) -> anyhow::Result<Evaluation> {
    let file = corpus.file.display();
    if corpus.labels.iter().any(|label| !model.labels.contains(label)) {
        bail!(
            "{file}: labels {}, the model's are {}; name them with --words",
            corpus.labels.join(", "),
            model.labels.join(", ")
        );
    }
    refuse_learnt(args.split, &corpus, &model)?;
    let corpus = relabelled(corpus, &model)?;
    let decoding = match args.decode.is_default() {
        true => model.decoding.clone(),
        false => args.decode.of_all(None)?,
    };
    let cut = Cut::Found(decoding.clone());
    let judge = |(number, take): (usize, &AnnotatedTake)| judged(&model, &cut, take, number);
    let judged = corpus.takes.iter().enumerate().map(judge).collect::<Result<Vec<Judged>, _>>();
    let judged =
        judged.map_err(|e| named(e, &corpus.labels).context(corpus.file.display().to_string()))?;
    let by_person = args.split == Split::Person;
    let labels = corpus.labels.len();
    let summary = summary(&corpus.takes, &judged, labels, by_person, args.method.seed)?;
    let lesson =
        Lesson { thinned_to_hz: model.thinned_to_hz, decoding, ..corpus.lesson(model.settings) };
    let column = Column {
        kind: ColumnKind::Model,
        lesson,
        own_person: false,
        calibrated: model.learnt_from.held_out > 0,
        judged,
        summary,
    };
    Ok(Evaluation {
        corpus,
        split: args.split,
        columns: vec![column],
        thesis: Vec::new(),
        not_alone: false,
        svm_thinned_to_hz: None,
    })
}

/// Refuses takes, persons or kinds that the model has learnt from.
fn refuse_learnt(split: Split, corpus: &Corpus, model: &Model) -> anyhow::Result<()> {
    let kept = model.columns(&corpus.shapes);
    let kept = kept.map_err(|e| anyhow!("{}: {e}", corpus.file.display()))?;
    for (own, line) in corpus.takes.iter().zip(&corpus.lines) {
        let same = AnnotatedTake { take: own.take.columns(&kept)?, ..own.clone() }.learnt();
        for learnt in &model.learnt_from.takes {
            let (what, value) = match split {
                _ if learnt.weights == same.weights => ("take", &own.name),
                Split::Person if learnt.person == own.person => ("person", &own.person),
                Split::Kind if learnt.kind == own.kind => ("kind", &own.kind),
                _ => continue,
            };
            bail!(
                "{}: line {line}: {what} {value}: the model has learnt from it ({}); leave the line out{}",
                corpus.file.display(),
                learnt.name,
                if what == "take" { "" } else { ", or use --split take" }
            );
        }
    }
    Ok(())
}

/// The takes with the model's columns and labels.
fn relabelled(corpus: Corpus, model: &Model) -> anyhow::Result<Corpus> {
    use mimique_annotate::Mark;
    let place: Vec<usize> = corpus
        .labels
        .iter()
        .filter_map(|label| model.labels.iter().position(|own| own == label))
        .collect();
    let kept = model.columns(&corpus.shapes)?;
    let mut takes = corpus.takes;
    for own in &mut takes {
        own.take = own.take.columns(&kept)?;
        for marked in &mut own.marked {
            marked.mark = match marked.mark {
                Mark::Stable(label) => Mark::Stable(place[label]),
                Mark::Transition(from, to) => Mark::Transition(place[from], place[to]),
            };
        }
    }
    let (labels, shapes) = (model.labels.clone(), model.shapes.clone());
    Ok(Corpus { takes, labels, shapes, ..corpus })
}
