//! `mimique analyze EXPORT.csv --study STUDY.json --out DIR`: every table and figure of a study.
//!
//! `DIR` holds a whole report or is left as it was.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;
use mimique_analysis::{Language, analyze};
use mimique_stats::Table;
use mimique_study::Study;

use crate::report_folder;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Tidy export, as `mimique export --format csv` writes it
    export: PathBuf,
    /// Study file that the answers belong to
    #[arg(long)]
    study: PathBuf,
    /// Folder for the report; an earlier report in it is replaced
    #[arg(long)]
    out: PathBuf,
    /// Language of the report: en or fr
    #[arg(long, default_value = "en", value_parser = language)]
    language: Language,
}

/// A language that reports are written in.
pub fn language(code: &str) -> Result<Language, String> {
    Language::from_code(code).ok_or_else(|| "reports are written in en or fr".to_owned())
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let place = |path: &Path| path.display().to_string();
    let text = std::fs::read_to_string(&args.study)
        .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))
        .with_context(|| place(&args.study))?;
    let study = Study::from_text(&text).with_context(|| place(&args.study))?;
    let report = std::fs::read(&args.export)
        .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))
        .and_then(|bytes| Ok(Table::parse(bytes)?))
        .and_then(|table| Ok(analyze(&table, &study, args.language)?))
        .with_context(|| place(&args.export))?;
    report_folder::write(&report.files, &args.out).with_context(|| place(&args.out))?;

    let mut out = std::io::stdout().lock();
    let page = args.out.join("report.html");
    if json {
        let summary = serde_json::json!({
            "status": "ok",
            "report": page,
            "people_used": report.people.0,
            "people": report.people.1,
            "trials_used": report.trials,
            "files": report.files.iter().map(|file| &file.path).collect::<Vec<_>>(),
            "readings": report.readings.iter().map(|(id, reading)| {
                serde_json::json!({"hypothesis": id, "reading": reading})
            }).collect::<Vec<_>>(),
        });
        writeln!(out, "{summary:#}")?;
        return Ok(());
    }
    let (used, all) = report.people;
    writeln!(out, "{used} of {all} people, {} trials", report.trials)?;
    for (id, reading) in &report.readings {
        writeln!(out, "{id}. {reading}")?;
    }
    writeln!(out, "{} files, report: {}", report.files.len(), page.display())?;
    Ok(())
}
