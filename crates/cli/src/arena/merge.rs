//! `mimique arena merge`: the votes of several laboratories in one table.

use std::collections::BTreeSet;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use mimique_arena::{ExportedVotes, Laboratory, pool, read_export, votes_csv};
use mimique_locale::counted;
use mimique_new_study::study_id;

use super::inputs::{POOLED_FILE, PooledFile, VOTES_FILE, open, stimuli, write_folder};

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Folder of the arena
    folder: PathBuf,
    /// Tidy exports: [LABORATORY=]FILE; without it the laboratory is called as the file. A laboratory may have several
    #[arg(required = true, value_name = "EXPORT")]
    exports: Vec<String>,
    /// Folder of the pooled votes, in the place of an earlier one
    #[arg(long, value_name = "FOLDER")]
    out: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    let folder = open(&args.folder)?;
    let stimuli = stimuli(&folder)?;
    let mut exports: Vec<ExportedVotes> = Vec::new();
    let mut problems = Vec::new();
    for given in &args.exports {
        let (laboratory, path) = laboratory_of(given)?;
        let read = std::fs::read(path)
            .map_err(|e| anyhow!("cannot be read ({e}); check the path"))
            .and_then(|bytes| Ok(read_export(&laboratory, bytes, &stimuli)?));
        match read {
            Ok(own) => exports.push(own),
            Err(error) => problems.push(format!("{}: {error}", path.display())),
        }
    }
    if !problems.is_empty() {
        bail!("{}", problems.join("\nerror: "));
    }
    let pooled = pool(&exports);
    let file = PooledFile { arena: folder.arena.id.clone(), laboratories: pooled.laboratories };
    let text = serde_json::to_string_pretty(&file)? + "\n";
    let files = [
        (VOTES_FILE.to_owned(), votes_csv(&pooled.votes)?),
        (POOLED_FILE.to_owned(), text.clone().into_bytes()),
    ];
    write_folder(&args.out, POOLED_FILE, &files, &[])?;
    let mut out = std::io::stdout().lock();
    if json {
        out.write_all(text.as_bytes())?;
        return Ok(());
    }
    let methods: BTreeSet<&String> =
        pooled.votes.iter().flat_map(|vote| [&vote.left, &vote.right]).collect();
    let sessions: usize = file.laboratories.iter().map(|own| own.sessions).sum();
    writeln!(
        out,
        "{}: {} of {} between {}",
        args.out.display(),
        counted(pooled.votes.len(), "vote"),
        counted(sessions, "session"),
        counted(methods.len(), "method")
    )?;
    file.laboratories.iter().try_for_each(|own| tell(&mut out, own))
}

/// The laboratory of an export, and its file.
fn laboratory_of(given: &str) -> anyhow::Result<(String, &Path)> {
    let (name, path) = match given.split_once('=') {
        Some((name, path)) if !name.is_empty() && !name.contains(['/', '\\', '.']) => {
            (name.to_owned(), Path::new(path))
        }
        _ => {
            let path = Path::new(given);
            (path.file_stem().unwrap_or_default().to_string_lossy().into_owned(), path)
        }
    };
    match study_id(&name) {
        Some(name) => Ok((name, path)),
        None => bail!("{given}: no name for a laboratory; write NAME={}", path.display()),
    }
}

fn tell(out: &mut impl std::io::Write, own: &Laboratory) -> anyhow::Result<()> {
    writeln!(
        out,
        "  {}: {} of {}",
        own.name,
        counted(own.votes, "vote"),
        counted(own.sessions, "session")
    )?;
    for left in &own.left_out {
        writeln!(out, "    left out: {}: {}", counted(left.votes, "vote"), left.reason)?;
    }
    Ok(())
}
