//! One command for each thing that people do with the repository:
//!
//! - `cargo xtask demo`: install what is missing, build everything, start the built-in study;
//! - `cargo xtask test`: install what tests need, then every check and test there is;
//! - `cargo xtask bench`: the solver (or with `--stats` the statistics) and its peers, and their ratios; with
//!   `--server` the server with a study of a million events;
//! - `cargo xtask package`: archives, wheel, npm package, container image, Debian package and manifests of package
//!   managers; with `--check` each of them is installed and run;
//! - `cargo xtask web`: build the wasm modules and the pages alone.

mod bench;
mod bench_annotate;
mod bench_figures;
mod bench_layout;
mod bench_partner;
mod bench_peers;
mod bench_plot;
mod bench_server;
mod bench_stats;
mod bench_verdicts;
mod budget;
mod demo;
mod install;
mod package;
mod packed;
mod process;
mod server;
mod tally;
mod test;
mod web;

use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Install what is missing, build all, and start the built-in study
    Demo(demo::Args),
    /// Install what tests need, then run every check and test
    Test(test::Args),
    /// Measure the solver, or the statistics, beside their peers and print the ratios; or the server
    Bench(bench::Args),
    /// Make everything that people install, into target/package
    Package(package::Args),
    /// Build the wasm modules and the pages into target/web-dist
    Web(web::Args),
}

fn main() -> anyhow::Result<()> {
    match Cli::parse().command {
        Command::Demo(args) => demo::run(&args),
        Command::Test(args) => test::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Package(args) => package::run(&args),
        Command::Web(args) => web::run(&args),
    }
}
