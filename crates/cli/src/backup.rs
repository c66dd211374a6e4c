//! `mimique backup`: the database at one instant, while the server goes on.
//!
//! With `--folder` the deletions of participants reach the backups made before: they are rewritten
//! without what was deleted, and the list of deletions is kept beside them for `mimique restore`.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::Context as _;
use mimique_storage::{Storage, scrub_backup, write_deletions};

/// End of a backup's name.
const SUFFIX: &str = ".backup.gz";
/// Deletions beside the backups.
pub const DELETIONS: &str = "deletions.jsonl";

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Where the answers are: sqlite:FILE or postgres://USER@HOST/NAME
    #[arg(long, default_value = "sqlite:mimique-data/answers.sqlite")]
    database: String,
    /// Folder of backups: adds one named by the time, and takes out of the others what participants
    /// have had deleted since
    #[arg(long, required_unless_present = "out", conflicts_with = "out")]
    folder: Option<PathBuf>,
    /// File to write instead
    #[arg(long)]
    out: Option<PathBuf>,
    /// With --folder: how many backups to keep; older ones are removed
    #[arg(long, requires = "folder")]
    keep: Option<usize>,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    anyhow::ensure!(args.keep != Some(0), "--keep: 0 would keep no backup; keep at least 1");
    let now_ms =
        SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_millis() as i64;
    let path = match (&args.folder, &args.out) {
        (Some(folder), _) => {
            std::fs::create_dir_all(folder).with_context(|| {
                format!("{}: cannot be made; choose another folder", folder.display())
            })?;
            folder.join(format!("{now_ms}{SUFFIX}"))
        }
        (None, Some(file)) => file.clone(),
        (None, None) => anyhow::bail!("say where to by --folder or --out"),
    };
    let runtime = tokio::runtime::Runtime::new().context("the backup's threads")?;
    let (facts, deletions) = runtime
        .block_on(async {
            let storage = Storage::open_existing(&args.database).await?;
            let facts = storage.backup(&path, now_ms).await?;
            let deletions = storage.deletions().await?;
            storage.close().await;
            anyhow::Ok((facts, deletions))
        })
        .with_context(|| Storage::without_password(&args.database))?;
    let (mut scrubbed, mut removed) = (0, 0);
    if let Some(folder) = &args.folder {
        write_deletions(&folder.join(DELETIONS), &deletions)?;
        let mut earlier = backups(folder)?;
        earlier.retain(|backup| *backup != path);
        let superfluous = args.keep.map_or(0, |keep| (earlier.len() + 1).saturating_sub(keep));
        for old in earlier.drain(..superfluous) {
            std::fs::remove_file(&old).with_context(|| old.display().to_string())?;
            removed += 1;
        }
        for backup in earlier {
            scrubbed += scrub_backup(&backup, &deletions)?;
        }
    }
    let mut out = std::io::stdout().lock();
    if json {
        let line = serde_json::json!({
            "file": path, "rows": facts.rows, "schema": facts.schema, "scrubbed": scrubbed,
            "removed": removed,
        });
        writeln!(out, "{line}")?;
    } else {
        writeln!(out, "{}: {} rows (schema {})", path.display(), facts.rows, facts.schema)?;
        if scrubbed > 0 {
            writeln!(out, "{scrubbed} deletions were carried into earlier backups")?;
        }
        if removed > 0 {
            writeln!(out, "{removed} old backups were removed")?;
        }
    }
    Ok(())
}

/// The backups of a folder, oldest first.
fn backups(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let mut found = Vec::new();
    for entry in entries {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let made = name.strip_suffix(SUFFIX).and_then(|made| made.parse::<i64>().ok());
        found.extend(made.map(|made| (made, path)));
    }
    found.sort();
    Ok(found.into_iter().map(|(_, path)| path).collect())
}
