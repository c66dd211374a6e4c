//! `mimique annotate train | apply | evaluate`: labels of facial motion, learnt from annotated takes,
//! suggested for others, held against takes that were not learnt from.

mod apply;
mod corpus;
mod decoding;
mod evaluate;
mod intervals;
mod method;
mod report;
mod takes_table;
mod train;

use std::time::Duration;

use anyhow::anyhow;
use indicatif::ProgressBar;
use mimique_annotate::AnnotateError;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand)]
enum Command {
    /// Learn a model from annotated takes
    Train(Box<train::Args>),
    /// Suggest the labels of a take
    Apply(Box<apply::Args>),
    /// Hold what is learnt against takes that it has not learnt from, and write a report
    Evaluate(Box<evaluate::Args>),
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    match args.command {
        Command::Train(args) => train::run(&args, json),
        Command::Apply(args) => apply::run(&args, json),
        Command::Evaluate(args) => evaluate::run(&args, json),
    }
}

/// An error with the names of the labels in the place of their indices.
fn named(error: AnnotateError, labels: &[String]) -> anyhow::Error {
    let name = |label: usize| labels.get(label).map_or("?", String::as_str);
    match error {
        AnnotateError::FewTakes { label, takes } => anyhow!(
            "label {}: in {takes} of the takes; mark it in two at least, or leave it out with --words",
            name(label)
        ),
        AnnotateError::NoExamples { label } => anyhow!(
            "label {}: no stretch is as long as the chain of states; mark longer ones, or use fewer --states",
            name(label)
        ),
        AnnotateError::OneLabel { found } => {
            anyhow!("{found} label with frames to learn from; mark two labels at least")
        }
        AnnotateError::Limit { what: "training rows", found, most } => anyhow!(
            "{found} training frames, at most {most}; thin them with --thin, or give fewer takes"
        ),
        other => anyhow!("{other}"),
    }
}

/// A rate as people read it: times of frames are rounded, and rates that are told by them are, too.
fn rounded(rate_hz: f64) -> f64 {
    (rate_hz * 1e3).round() / 1e3
}

/// Something that turns while people wait.
fn spinner() -> ProgressBar {
    let progress = ProgressBar::new_spinner();
    progress.enable_steady_tick(Duration::from_millis(100));
    progress
}
