//! `mimique import`: sessions of a study that was hosted as files -> the same exports as from a
//! database.
//!
//! One session may come in several files (posted and downloaded, or downloaded twice): it is one
//! session all the same. Two files that disagree are an error, and so is a file that was cut off.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use mimique_server::export::{Format, Unstored};
use mimique_session::SessionFile;
use mimique_study::ClipSource;
use serde_json::Value;

use crate::export::parse_format;
use crate::study_file::load;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Study file, as it was when the site was written
    study: PathBuf,
    /// Session files, or folders of them (*.jsonl)
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
    let sessions = read_sessions(&args, &study.id, writer.config_hash())?;
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

/// The sessions of the files named, all of one version of the study.
fn read_sessions(args: &Args, study: &str, config_hash: &str) -> anyhow::Result<Sessions> {
    let mut sessions = Sessions::default();
    for path in session_files(&args.files)? {
        let session = read_session(&path)?;
        let at = path.display();
        anyhow::ensure!(
            session.study == study,
            "{at}: line 1: a session of study {}, not of {study}; leave it out, or name its study file",
            session.study
        );
        let there = &session.started.config_hash;
        anyhow::ensure!(
            there == config_hash,
            "{at}: line 1: a session of version {}, and {} is version {}; give the file that the site was made from",
            short(there),
            args.study.display(),
            short(config_hash)
        );
        sessions.add(path, session)?;
    }
    Ok(sessions)
}

/// Sessions by their identifier, each with the file that it was first read from.
#[derive(Default)]
struct Sessions {
    known: BTreeMap<String, (PathBuf, SessionFile)>,
    /// Files read.
    read: usize,
}

impl Sessions {
    /// Adds what a file holds: a session, or more or less of one that is known.
    fn add(&mut self, path: PathBuf, session: SessionFile) -> anyhow::Result<()> {
        self.read += 1;
        let id = &session.started.session;
        let Some((first, known)) = self.known.get_mut(id) else {
            self.known.insert(id.clone(), (path, session));
            return Ok(());
        };
        let is_longer = session.events.len() > known.events.len();
        let (long, short) = match is_longer {
            true => (&session.events, &known.events),
            false => (&known.events, &session.events),
        };
        anyhow::ensure!(
            long.starts_with(short),
            "{}: the same session as {}, with other answers; leave one of them out",
            path.display(),
            first.display()
        );
        if is_longer {
            *known = session;
        }
        Ok(())
    }

    /// The sessions, the first to begin first.
    fn in_order_of_time(&self) -> Vec<&SessionFile> {
        let begun = |session: &SessionFile| session.events.first().map_or(0.0, |event| event.at_ms);
        let mut sessions: Vec<_> = self.known.values().map(|(_, session)| session).collect();
        sessions.sort_by(|left, right| begun(left).total_cmp(&begun(right)));
        sessions
    }
}

fn read_session(path: &Path) -> anyhow::Result<SessionFile> {
    let at = || path.display().to_string();
    let text = std::fs::read_to_string(path)
        .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))
        .with_context(at)?;
    SessionFile::read(&text).with_context(at)
}

fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

/// The files named, and those of folders that end in `.jsonl`.
fn session_files(named: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for path in named {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let entries = std::fs::read_dir(path).with_context(|| path.display().to_string())?;
        let mut found: Vec<PathBuf> = entries
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|end| end == "jsonl"))
            .collect();
        anyhow::ensure!(
            !found.is_empty(),
            "{}: no file ends in .jsonl; name the files",
            path.display()
        );
        found.sort();
        files.extend(found);
    }
    Ok(files)
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
