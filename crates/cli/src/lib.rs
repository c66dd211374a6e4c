//! The `mimique` command: one file a command; this one reads the command line and reports errors.
//!
//! Errors go to stderr as `error: FILE: PLACE: what, value, remedy` with exit code 2; results go to
//! stdout, as text or, with `--json`, as JSON. `verify` alone ends with 1, where a value is wrong.

mod account;
mod analyze;
mod annotate;
mod arena;
mod asker;
mod backup;
mod border_options;
mod capsule;
mod capture_options;
mod check;
mod compare;
mod deposit;
mod eaf_file;
mod erase;
mod exertion;
mod export;
mod export_site;
mod import;
mod inspect;
mod layout;
mod motion;
mod new;
mod order;
mod output;
mod pages;
mod power;
mod preview;
mod repair;
mod report_folder;
mod restore;
mod sample;
mod segment;
mod serve;
mod simulate;
mod solve;
mod study_file;
mod test_command;
mod trajectories;
mod verify;
mod vertices;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
pub use mimique_server::EmbeddedFile;

/// What do people see in an avatar's face? Solve, show, ask, keep, compute.
#[derive(Parser)]
#[command(name = "mimique", version, max_term_width = 100)]
struct Cli {
    /// Print results as JSON
    #[arg(long, global = true)]
    json: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Host a study: questionnaire, preview and researcher's pages
    Serve(serve::Args),
    /// Open the studio: an avatar and a capture, the match, methods side by side, exports
    Preview(preview::Args),
    /// Make the folder of a new study: a design, instruments, your avatar and capture
    New(Box<new::Args>),
    /// List every problem of a study file
    Check(check::Args),
    /// Print the exact trial order that a participant gets
    Order(order::Args),
    /// Tell what an avatar, a capture, a weight file, a pack or a study holds
    Inspect(inspect::Args),
    /// Write an avatar, a capture, a marker map and motions of a body to try the commands on
    Sample(sample::Args),
    /// Turn marker trajectories into blendshape weights
    Solve(Box<solve::Args>),
    /// Hold weights of one performance against each other: in millimetres, in smoothness, in what the markers did
    Compare(compare::Args),
    /// Choose how many markers a face needs, and where; or check a map
    Layout(Box<layout::Args>),
    /// Turn a sequence of vertices into an avatar and the weights that play it
    Vertices(vertices::Args),
    /// Repair a capture: swaps, spikes, gaps; filter, resample, hold the head still
    Repair(Box<repair::Args>),
    /// Suggest the expressions in a long take; convert between CSV and ELAN
    Segment(Box<segment::Args>),
    /// Learn the labels of facial motion from annotated takes, suggest and evaluate them
    Annotate(annotate::Args),
    /// Turn a body's motion, or what a watch recorded, into weights of a face that shows it
    Exertion(Box<exertion::Args>),
    /// Draw random courses of action units, for dynamic reverse correlation
    Trajectories(trajectories::Args),
    /// Compare methods without end: submissions, votes pooled across laboratories, a ranking
    Arena(Box<arena::Args>),
    /// Recover a researcher's account; list the accounts
    Account(account::Args),
    /// Write the responses of a study to a file
    Export(export::Args),
    /// Write a study as plain files that any web host can serve, without the server
    ExportSite(export_site::Args),
    /// Write a study with its answers, report and stimuli as one file that opens in any browser
    Capsule(capsule::Args),
    /// Export the sessions of a study that was hosted as files
    Import(import::Args),
    /// Save the database while the server runs
    Backup(backup::Args),
    /// Fill an empty database from a backup
    Restore(restore::Args),
    /// Delete answers or identifiers
    Erase(erase::Args),
    /// Write an export of simulated participants
    Simulate(simulate::Args),
    /// Find the power of a study by simulation, and write its preregistration
    Power(power::Args),
    /// Run one statistical test on a data file
    Test(test_command::Args),
    /// Compute every table and figure of a study
    Analyze(analyze::Args),
    /// Put together what a repository of research data takes of a study, and upload it to Zenodo or Dataverse
    Deposit(Box<deposit::Args>),
    /// Show that this installation computes what cases with answers expect
    Verify(verify::Args),
}

/// Runs the command of the process's arguments and reports its errors. `pages` are the web pages that the program embeds;
/// commands that serve or export pages use them unless they are given a folder (`--web-dir`).
pub fn run(pages: &[EmbeddedFile]) -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(usage) => {
            let _ = usage.print();
            return ExitCode::from(if usage.use_stderr() { 2 } else { 0 });
        }
    };
    let json = cli.json;
    let outcome = match cli.command {
        Command::Serve(args) => serve::run(args, pages, json),
        Command::Preview(args) => preview::run(args, pages, json),
        Command::New(args) => new::run(*args, json),
        Command::Check(args) => check::run(args, json),
        Command::Order(args) => order::run(args, json),
        Command::Inspect(args) => inspect::run(args, json),
        Command::Sample(args) => sample::run(args, json),
        Command::Solve(args) => solve::run(*args, json),
        Command::Compare(args) => compare::run(&args, json),
        Command::Layout(args) => layout::run(*args, json),
        Command::Vertices(args) => vertices::run(&args, json),
        Command::Repair(args) => repair::run(*args, json),
        Command::Segment(args) => segment::run(*args, json),
        Command::Annotate(args) => annotate::run(args, json),
        Command::Exertion(args) => exertion::run(*args, json),
        Command::Trajectories(args) => trajectories::run(args, json),
        Command::Arena(args) => arena::run(*args, json),
        Command::Account(args) => account::run(args, json),
        Command::Export(args) => export::run(args, json),
        Command::ExportSite(args) => export_site::run(args, pages, json),
        Command::Capsule(args) => capsule::run(&args, pages, json),
        Command::Import(args) => import::run(args, json),
        Command::Backup(args) => backup::run(args, json),
        Command::Restore(args) => restore::run(args, json),
        Command::Erase(args) => erase::run(args, json),
        Command::Simulate(args) => simulate::run(args, json),
        Command::Power(args) => power::run(args, json),
        Command::Test(args) => test_command::run(args, json),
        Command::Analyze(args) => analyze::run(args, json),
        Command::Deposit(args) => deposit::run(*args, json),
        Command::Verify(args) => verify::run(args, json),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            let code = if error.is::<verify::Wrong>() { 1 } else { 2 };
            // An empty message means that the command has already said everything.
            let text = format!("{error:#}");
            if !text.is_empty() {
                eprintln!("error: {text}");
            }
            ExitCode::from(code)
        }
    }
}

/// The reader of our output has gone (`mimique … | head`): that is no mistake of anybody's.
fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause
            .downcast_ref::<std::io::Error>()
            .is_some_and(|io| io.kind() == std::io::ErrorKind::BrokenPipe)
    })
}
