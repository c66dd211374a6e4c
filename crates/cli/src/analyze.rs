//! `mimique analyze EXPORT.csv --study STUDY.json --out DIR`: every table and figure of a study.
//!
//! Everything is written into a folder beside `DIR` and renamed at the end, so that `DIR` holds a whole
//! report or is left as it was.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use mimique_analysis::{Language, Report, analyze};
use mimique_stats::Table;
use mimique_storage::durable_file;
use mimique_study::Study;

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

fn language(code: &str) -> Result<Language, String> {
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
    write_report(&report, &args.out).with_context(|| place(&args.out))?;

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

/// Writes the files of a report into `out`, in the place of an earlier one.
fn write_report(report: &Report, out: &Path) -> anyhow::Result<()> {
    if out.exists() && !is_replaceable(out)? {
        bail!(
            "the folder holds something else than a report; give an empty or a new folder with --out"
        );
    }
    out.file_name().context("this is no name of a folder; give one with --out")?;
    let parent = out.parent().filter(|parent| !parent.as_os_str().is_empty());
    std::fs::create_dir_all(parent.unwrap_or(Path::new(".")))?;
    durable_file::write_folder(out, |folder| write_files(report, folder))
}

fn write_files(report: &Report, folder: &Path) -> anyhow::Result<()> {
    for file in &report.files {
        let path = folder.join(&file.path);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent)?;
        }
        std::fs::write(&path, &file.text).with_context(|| file.path.clone())?;
    }
    Ok(())
}

/// An empty folder, or one with an earlier report.
fn is_replaceable(out: &Path) -> anyhow::Result<bool> {
    if !out.is_dir() {
        return Ok(false);
    }
    let empty = std::fs::read_dir(out)?.next().is_none();
    Ok(empty || (out.join("report.html").is_file() && out.join("results.json").is_file()))
}
