//! `mimique annotate train`: annotated takes in, a model out.

use std::io::Write as _;
use std::path::PathBuf;

use mimique_annotate::{Classifier, LearntLabel, Lesson, Model};
use mimique_locale::counted;
use serde_json::json;

use super::corpus::{Corpus, CorpusOptions};
use super::decoding::DecodeOptions;
use super::method::MethodOptions;
use super::{named, rounded, spinner};
use crate::output;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    corpus: CorpusOptions,
    /// Where the model goes: JSON
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    #[command(flatten)]
    method: MethodOptions,
    #[command(flatten)]
    decode: DecodeOptions,
}

/// Runs the command.
pub fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    let decoding = args.decode.of_all(args.method.as_in)?;
    let progress = spinner();
    progress.set_message("reading");
    let corpus = args.corpus.read()?;
    let lesson = Lesson {
        channel: corpus.channel.clone(),
        method: args.method.method(&corpus.labels, args.decode.stay)?,
        labels: corpus.labels.clone(),
        shapes: corpus.shapes.clone(),
        thinned_to_hz: args.method.thinned_to_hz(),
        decoding,
    };
    let blame = |error| named(error, &corpus.labels).context(corpus.file.display().to_string());
    lesson.check_takes(&corpus.takes).map_err(blame)?;
    progress.set_message(format!("learning from {} takes", corpus.takes.len()));
    let model = lesson.learn_calibrated(&corpus.takes).map_err(blame)?;
    let text = model.to_json().map_err(blame)?;
    output::write(&args.out, text.as_bytes())?;
    progress.finish_and_clear();
    if json { print_json(args, &corpus, &model) } else { print(args, &corpus, &model, text.len()) }
}

/// What a model has learnt, in a few words.
fn learnt(model: &Model) -> String {
    match model.classifier() {
        Classifier::Knn(knn) => format!("{} nearest neighbours", knn.k()),
        Classifier::Svm(svm) => format!("support vector machine of {} pairs", svm.pairs().len()),
        Classifier::Logistic(_) => "logistic regression".to_owned(),
        Classifier::Forest(forest) => {
            let nodes: usize = forest.trees().iter().map(mimique_annotate::Tree::size).sum();
            format!("forest of {} trees, {nodes} nodes", forest.trees().len())
        }
        Classifier::Hmm(joined) => {
            format!("hidden Markov model of {} states", joined.hmm().states().len())
        }
    }
}

fn print(args: &Args, corpus: &Corpus, model: &Model, bytes: usize) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(
        out,
        "{}: {}, {:.1} kB, from {} at {} Hz",
        args.out.display(),
        learnt(model),
        bytes as f64 / 1000.0,
        counted(corpus.takes.len(), "take"),
        rounded(model.rate_hz),
    )?;
    for (label, seconds) in model.labels.iter().zip(&model.learnt_from.seconds) {
        let index = model.labels.iter().position(|own| own == label).unwrap_or(0);
        let takes = corpus.takes.iter().filter(|take| take.shows(index)).count();
        writeln!(out, "{label:<16} {seconds:>8.1} s in {takes} takes")?;
    }
    if let Classifier::Forest(forest) = model.classifier()
        && let Some(share) = forest.out_of_bag()
    {
        writeln!(
            out,
            "out-of-bag accuracy {share:.2}, of frames from takes that were learnt from: what other takes \
             give, annotate evaluate tells"
        )?;
    }
    for own in &model.learnt_from.hmm {
        writeln!(out, "{}", of_hmm(own, &model.labels))?;
    }
    match model.learnt_from.held_out {
        0 => writeln!(out, "temperature 1: no take could be held out")?,
        held_out => writeln!(
            out,
            "temperature {:.3}, from {held_out} takes held out in turn",
            model.temperature.value()
        )?,
    }
    if model.classifier().holds_frames() {
        writeln!(
            out,
            "the model holds frames of the people that it learnt from, as they were: keep it as their data"
        )?;
    }
    corpus.notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))?;
    Ok(())
}

/// How a hidden Markov model was learnt.
fn of_hmm(own: &LearntLabel, labels: &[String]) -> String {
    let of = match own.neutral_of {
        Some(label) => format!("{} in takes of {}", labels[own.label], labels[label]),
        None => labels[own.label].clone(),
    };
    let starved = match own.starved.len() {
        0 => String::new(),
        count => format!(", {count} components without frames"),
    };
    let (first, last) = (own.log_likelihood.first(), own.log_likelihood.last());
    format!(
        "{of}: log likelihood {:.1} to {:.1} in {} steps{starved}",
        first.unwrap_or(&f64::NAN),
        last.unwrap_or(&f64::NAN),
        own.log_likelihood.len().saturating_sub(1),
    )
}

fn print_json(args: &Args, corpus: &Corpus, model: &Model) -> anyhow::Result<()> {
    let told = json!({
        "out": args.out,
        "hash": model.hash()?,
        "channel": model.channel,
        "labels": model.labels,
        "shapes": model.shapes,
        "rate_hz": model.rate_hz,
        "settings": model.settings,
        "temperature": model.temperature,
        "learnt_from": model.learnt_from,
        "holds_frames": model.classifier().holds_frames(),
        "notes": corpus.notes,
    });
    writeln!(std::io::stdout().lock(), "{}", serde_json::to_string_pretty(&told)?)?;
    Ok(())
}
