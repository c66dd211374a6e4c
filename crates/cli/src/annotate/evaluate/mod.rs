//! `mimique annotate evaluate`: what is learnt of some takes, held against others.

mod given_model;
mod lessons;

use std::path::PathBuf;
use std::str::FromStr;

use anyhow::Context as _;
use mimique_annotate::evaluate::{Judged, Summary};
use mimique_annotate::{Decoding, Lesson, Method};
use mimique_locale::Language;

use super::corpus::{Corpus, CorpusOptions};
use super::decoding::DecodeOptions;
use super::method::MethodOptions;
use super::{apply, report, spinner};
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

/// Runs the command.
pub fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    if let Some(out) = &args.out {
        report_folder::check(out).with_context(|| out.display().to_string())?;
    }
    let progress = spinner();
    progress.set_message("reading");
    let corpus = args.corpus.read()?;
    let evaluation = match &args.model {
        Some(file) => given_model::evaluated(args, corpus, &apply::model(file)?)?,
        None => lessons::evaluated(args, corpus, &progress)?,
    };
    progress.finish_and_clear();
    let files = report::files(&evaluation, args.language);
    if let Some(out) = &args.out {
        report_folder::write(&files, out).with_context(|| out.display().to_string())?;
    }
    report::print(&evaluation, args.out.as_deref(), json)
}

impl Corpus {
    /// What is learnt of it by a method, all else as it is where nothing is asked for.
    fn lesson(&self, method: Method) -> Lesson {
        Lesson {
            channel: self.channel.clone(),
            labels: self.labels.clone(),
            shapes: self.shapes.clone(),
            method,
            thinned_to_hz: None,
            decoding: Decoding::default(),
        }
    }
}
