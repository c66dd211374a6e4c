//! `mimique import`: sessions of a study that was hosted as files -> the same exports as from a
//! database.
//!
//! One session may come in several files (posted and downloaded, posted in parts, or downloaded twice): it is one
//! session all the same. Two files that disagree are an error, and so is a file that was cut off, and a part that is
//! missing before another one.

mod sessions;

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use mimique_server::export::{Format, Unstored};
use mimique_study::ClipSource;
use serde_json::Value;

use crate::export::parse_format;
use crate::import::sessions::Sessions;
use crate::study_file::load;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Study file, as it was when the site was written
    study: PathBuf,
    /// Session files, folders of them (*.jsonl), or what JATOS exports: data or archive
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Folder of the site (`mimique export-site`), for the provenance of its clips
    #[arg(long)]
    site: Option<PathBuf>,
    /// As of `mimique export`: csv, wide, json, events, tracks or psych-ds
    #[arg(long, default_value = "csv", value_parser = parse_format)]
    format: Format,
    /// File to write (for psych-ds a folder, or a file ending in .zip); standard output if not given
    #[arg(long)]
    out: Option<PathBuf>,
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
    let (file, study) = load(&args.study)?;
    let clips = match &args.site {
        Some(folder) => clips_of(&folder.join("site.json"))?,
        None => BTreeMap::new(),
    };
    let place = || args.study.display().to_string();
    let writer = Unstored::new(file, clips, args.format).with_context(place)?;
    let sessions = Sessions::read(&args.files, &study.id, &args.study, writer.config_hash())?;
    let read = sessions.read;
    let written = sessions
        .in_order_of_time()
        .into_iter()
        .map(|session| writer.write(&session.started, &session.events))
        .collect::<Result<Vec<_>, _>>()?;
    let count = written.len();
    let exported = writer.join(written)?;
    let mut stdout = std::io::stdout().lock();
    let Some(out) = args.out else {
        for (_, bytes) in &exported.files {
            stdout.write_all(bytes)?;
        }
        return Ok(());
    };
    let (rows, participants) = (exported.rows, exported.participants);
    let paths = exported.write(&out)?;
    if json {
        let paths: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
        let line = serde_json::json!({
            "study": study.id, "files_read": read, "sessions": count,
            "participants": participants, "rows": rows, "files": paths,
        });
        writeln!(stdout, "{line}")?;
        return Ok(());
    }
    writeln!(stdout, "{}: {count} sessions of {read} files, {rows} rows", study.id)?;
    for path in &paths {
        writeln!(stdout, "  {}", path.display())?;
    }
    Ok(())
}

/// The clips of a site, for their provenance.
fn clips_of(path: &Path) -> anyhow::Result<BTreeMap<String, ClipSource>> {
    let place = || path.display().to_string();
    let text = std::fs::read_to_string(path)
        .map_err(|error| {
            anyhow::anyhow!("cannot be read ({error}); name the site's folder by --site")
        })
        .with_context(place)?;
    let mut site: Value = serde_json::from_str(&text).with_context(place)?;
    serde_json::from_value(site["bundle"]["clips"].take()).with_context(place)
}
