//! `mimique export`: what was answered, as files, from the database alone.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Context as _;
use mimique_server::export::{Cells, Export, Format, Options, Part, courses, stimuli};
use mimique_storage::Storage;

use crate::output;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Where the answers are: sqlite:FILE or postgres://USER@HOST/NAME
    #[arg(long, default_value = "sqlite:mimique-data/answers.sqlite")]
    database: String,
    /// csv: one row a participant x trial x response; wide: one row a participant; json: the rows of
    /// csv as JSON lines; events: all that was stored, as JSON lines; tracks: participants' faces as they were measured, a row
    /// per picture, as CSV; psych-ds: a Psych-DS data set
    #[arg(long, default_value = "csv", value_parser = parse_format)]
    format: Format,
    /// Study to export, where the database holds several
    #[arg(long)]
    study: Option<String>,
    /// File to write (for psych-ds a folder, or a file ending in .zip); standard output if not given
    #[arg(long)]
    out: Option<PathBuf>,
    /// Write the table of stimuli here, too: a row per clip, with its factors and what was measured of it
    #[arg(long, value_name = "FILE.csv")]
    stimuli: Option<PathBuf>,
    /// Write the courses of the clips here, too, that participants' faces are held against: a row per frame, as CSV
    #[arg(long, value_name = "FILE.csv")]
    courses: Option<PathBuf>,
    /// Add the identifiers of the recruitment platform
    #[arg(long)]
    with_identifiers: bool,
    /// Put an apostrophe before texts that a spreadsheet would take for formulas (= + - @); scripts
    /// want the texts as they are
    #[arg(long)]
    for_spreadsheet: bool,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    anyhow::ensure!(
        args.out.is_some() || args.format != Format::PsychDs,
        "psych-ds: the data set is a folder; say where by --out"
    );
    anyhow::ensure!(
        args.out.is_some() || !json,
        "--json: the export itself goes to standard output; write it to a file by --out"
    );
    let runtime = tokio::runtime::Runtime::new().context("the export's threads")?;
    runtime.block_on(async {
        let named = || Storage::without_password(&args.database);
        let storage = Storage::open_existing(&args.database).await.with_context(named)?;
        let outcome = write(&args, &storage, json).await;
        storage.close().await;
        outcome
    })
}

/// Writes the export while it is made.
async fn write(args: &Args, storage: &Storage, json: bool) -> anyhow::Result<()> {
    let named = || Storage::without_password(&args.database);
    let cells = if args.for_spreadsheet { Cells::Neutralised } else { Cells::AsTheyAre };
    let options = Options { with_identifiers: args.with_identifiers, cells };
    if let Some(path) = &args.stimuli {
        let table = stimuli(storage, args.study.as_deref()).await.with_context(named)?;
        output::write(path, &table.1)?;
    }
    if let Some(path) = &args.courses {
        let table = courses(storage, args.study.as_deref()).await.with_context(named)?;
        output::write(path, &table.1)?;
    }
    let export = Export::open(storage, args.study.as_deref(), args.format, options).await;
    let mut export = export.with_context(named)?;
    let mut stdout = std::io::stdout().lock();
    let Some(out) = &args.out else {
        while let Some(part) = export.next().await.with_context(named)? {
            if let Part::Bytes(bytes) = part {
                stdout.write_all(&bytes)?;
            }
        }
        return Ok(stdout.flush()?);
    };
    let study_id = export.study_id().to_owned();
    let written = export.write(out).await.with_context(named)?;
    let (participants, rows) = (written.participants, written.rows);
    if json {
        let paths = written.paths.iter().map(|path| path.display().to_string());
        let paths: Vec<String> = paths.collect();
        let line = serde_json::json!({
            "study": study_id, "participants": participants, "rows": rows, "files": paths,
        });
        writeln!(stdout, "{line}")?;
    } else {
        writeln!(stdout, "{study_id}: {participants} participants, {rows} rows")?;
        for path in &written.paths {
            writeln!(stdout, "  {}", path.display())?;
        }
    }
    Ok(())
}

pub fn parse_format(word: &str) -> Result<Format, String> {
    Format::from_word(word).ok_or_else(|| {
        let known = Format::ALL.map(Format::word).join(", ");
        format!("there are {known}")
    })
}
