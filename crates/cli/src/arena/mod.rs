//! `mimique arena`: a standing comparison of methods: made, submitted to, voted on, pooled, ranked. A file per command.

mod data;
mod inputs;
mod merge;
mod new;
mod rank;
mod study;
mod submit;

use clap::Subcommand;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Make an arena: a head, a capture, the segments that are compared
    New(new::Args),
    /// Submit a method: its weights or vertices for every segment, checked and written into the arena
    Submit(submit::Args),
    /// Write the study in which people choose between the methods
    Study(study::Args),
    /// Pool the votes of several laboratories; what they were shown is proved by its hashes
    Merge(merge::Args),
    /// Rank the methods: a page, tables, JSON
    Rank(rank::Args),
    /// Write votes and stimuli for learning a measure of what people see
    Export(data::Args),
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    match args.command {
        Command::New(args) => new::run(args, json),
        Command::Submit(args) => submit::run(args, json),
        Command::Study(args) => study::run(&args, json),
        Command::Merge(args) => merge::run(&args, json),
        Command::Rank(args) => rank::run(&args, json),
        Command::Export(args) => data::run(&args, json),
    }
}
