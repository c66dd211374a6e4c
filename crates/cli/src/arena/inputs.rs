//! What the commands of an arena have in common: its folder, its clips, the pooled votes, the day.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, bail};
use mimique_arena::{ArenaFolder, ArenaStimuli, Laboratory, Vote, arena_study, read_votes};
use mimique_storage::durable_file;
use mimique_study::iso_time;
use serde::{Deserialize, Serialize};

use crate::output;

/// The file of a folder of pooled votes that says what was pooled.
pub const POOLED_FILE: &str = "pooled.json";
/// Its votes.
pub const VOTES_FILE: &str = "votes.csv";

/// What was pooled, besides the votes.
#[derive(Debug, Serialize, Deserialize)]
pub struct PooledFile {
    /// The arena.
    pub arena: String,
    /// The laboratories.
    pub laboratories: Vec<Laboratory>,
}

/// An arena.
pub fn open(folder: &Path) -> anyhow::Result<ArenaFolder> {
    ArenaFolder::open(folder).map_err(|error| anyhow!("{}", each(&error.to_string())))
}

/// Several lines of errors, each named as one.
pub fn each(text: &str) -> String {
    text.replace('\n', "\nerror: ")
}

/// Everything that is wrong, each on a line of its own; `nothing` says what was not done.
pub fn all_of<P: std::fmt::Display>(problems: &[P], nothing: &str) -> anyhow::Error {
    let said: Vec<String> = problems.iter().map(ToString::to_string).collect();
    anyhow!("{}\nerror: {nothing}", said.join("\nerror: "))
}

/// The clips of an arena with their hashes, as a server prepares them.
pub fn stimuli(folder: &ArenaFolder) -> anyhow::Result<ArenaStimuli> {
    let made = arena_study(folder).with_context(|| folder.path.display().to_string())?;
    let packs = tempfile::tempdir().context("a folder for the packs")?;
    ArenaStimuli::prepare(&made.study, &folder.path, packs.path(), &mut |_| ()).map_err(|faults| {
        let said: Vec<String> =
            faults.iter().map(|fault| format!("{}: {fault}", folder.path.display())).collect();
        anyhow!("{}", said.join("\nerror: "))
    })
}

/// The votes that `mimique arena merge` wrote.
pub fn pooled(folder: &Path) -> anyhow::Result<(Vec<Vote>, PooledFile)> {
    let read = |name: &str| {
        let path = folder.join(name);
        let bytes = std::fs::read(&path).map_err(|error| {
            anyhow!(
                "{}: cannot be read ({error}); give the folder that `mimique arena merge` wrote",
                path.display()
            )
        });
        bytes.map(|bytes| (path, bytes))
    };
    let (path, bytes) = read(VOTES_FILE)?;
    let votes = read_votes(&bytes).map_err(|e| anyhow!("{}: {e}", path.display()))?;
    let (path, bytes) = read(POOLED_FILE)?;
    let pooled = serde_json::from_slice(&bytes)
        .map_err(|e| anyhow!("{}: {e}; write it anew by `mimique arena merge`", path.display()))?;
    Ok((votes, pooled))
}

/// The day, by the machine's clock, in UTC.
pub fn today() -> String {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).ok();
    iso_time(since.map_or(0.0, |since| since.as_secs() as f64 * 1000.0)).chars().take(10).collect()
}

/// Writes files into a folder: whole, in the place of an earlier one that holds `mark`, or not at all.
pub fn write_folder(
    folder: &Path,
    mark: &str,
    files: &[(String, Vec<u8>)],
    copies: &[(PathBuf, String)],
) -> anyhow::Result<()> {
    if folder.symlink_metadata().is_ok() && !is_replaceable(folder, mark)? {
        bail!("{}: it holds something else; name an empty or a new folder", folder.display());
    }
    if let Some(parent) = folder.parent().filter(|parent| !parent.as_os_str().is_empty()) {
        output::make_folder(parent)?;
    }
    durable_file::write_folder(folder, |fresh| {
        let there = |name: &str| -> anyhow::Result<PathBuf> {
            let path = fresh.join(name);
            output::make_folder(path.parent().unwrap_or(fresh))?;
            Ok(path)
        };
        for (name, bytes) in files {
            std::fs::write(there(name)?, bytes)
                .with_context(|| folder.join(name).display().to_string())?;
        }
        for (from, name) in copies {
            std::fs::copy(from, there(name)?).map_err(|e| {
                anyhow!("{}: cannot be copied ({e}); check the file", from.display())
            })?;
        }
        anyhow::Ok(())
    })
}

/// An empty folder, or one of the same kind.
fn is_replaceable(folder: &Path, mark: &str) -> anyhow::Result<bool> {
    if !folder.is_dir() {
        return Ok(false);
    }
    let empty = std::fs::read_dir(folder)?.next().is_none();
    Ok(empty || (!mark.is_empty() && folder.join(mark).is_file()))
}
