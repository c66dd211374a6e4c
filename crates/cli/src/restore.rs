//! `mimique restore`: an empty database filled from a backup, all or nothing; then everything is
//! deleted again that participants had deleted after the backup was made.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Context as _;
use mimique_storage::{RestoreOptions, Storage, read_deletions};

use crate::backup::DELETIONS;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Backup that `mimique backup` wrote
    backup: PathBuf,
    /// Database to fill, of either kind: sqlite:FILE (not there yet) or postgres://USER@HOST/NAME
    /// (empty)
    #[arg(long)]
    database: String,
    /// List of deletions to carry out again [default: deletions.jsonl beside the backup]
    #[arg(long)]
    deletions: Option<PathBuf>,
    /// Nothing was written after the backup (the database moves to another place): participant
    /// numbers go on without a gap
    #[arg(long)]
    nothing_since: bool,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let deletions = match &args.deletions {
        Some(file) => read_deletions(file)?,
        None => {
            let beside = args.backup.with_file_name(DELETIONS);
            if beside.exists() { read_deletions(&beside)? } else { Vec::new() }
        }
    };
    let runtime = tokio::runtime::Runtime::new().context("the restoring threads")?;
    let place = Storage::without_password(&args.database);
    let options = RestoreOptions { skip_numbers: !args.nothing_since, deletions: &deletions };
    let restored = runtime.block_on(Storage::restore(&args.database, &args.backup, options))?;
    let (rows, deleted) = (restored.rows, restored.deleted_again);
    let mut out = std::io::stdout().lock();
    if json {
        writeln!(out, "{}", serde_json::json!({"rows": rows, "deleted_again": deleted}))?;
        return Ok(());
    }
    writeln!(out, "{place}: {rows} rows")?;
    if deleted > 0 {
        writeln!(out, "{deleted} deletions were carried out again")?;
    }
    if !args.nothing_since {
        writeln!(
            out,
            "participant numbers go on in the next thousand: those given after the backup stay theirs"
        )?;
    }
    Ok(())
}
