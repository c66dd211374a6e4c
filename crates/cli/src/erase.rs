//! `mimique erase`: deletes answers or identifiers, on request or since their time is over.

use std::io::Write as _;
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::Context as _;
use mimique_server::erase_overdue;
use mimique_storage::Storage;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Where the answers are: sqlite:FILE or postgres://USER@HOST/NAME
    #[arg(long, default_value = "sqlite:mimique-data/answers.sqlite")]
    database: String,
    /// Study
    #[arg(long, required_unless_present = "overdue")]
    study: Option<String>,
    /// Participant number: delete everything of this participant, as if they had withdrawn
    #[arg(long, short = 'k', requires = "study", required_unless_present_any = ["overdue", "identifiers"])]
    participant: Option<u64>,
    /// Delete the recruitment identifiers alone (of all participants if no number is given); repeats
    /// by them are then not recognised any more
    #[arg(long, requires = "study")]
    identifiers: bool,
    /// Delete what is older than its study's retentionDays; the server does so every hour
    #[arg(long, conflicts_with_all = ["study", "participant", "identifiers"])]
    overdue: bool,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let now_ms =
        SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_millis() as i64;
    let runtime = tokio::runtime::Runtime::new().context("the erasing threads")?;
    let (what, number) = runtime
        .block_on(async {
            let storage = Storage::open_existing(&args.database).await?;
            let outcome = match (&args.study, args.participant) {
                (Some(study), participant) if args.identifiers => {
                    let number = storage.erase_identifiers(study, participant, now_ms).await?;
                    ("identifiers and marks", number)
                }
                (Some(study), Some(participant)) => {
                    let number = storage.erase_participant(study, participant, now_ms).await;
                    ("events", number.with_context(|| format!("{study}: {participant}"))?)
                }
                _ => {
                    let erased = erase_overdue(&storage, now_ms).await?;
                    ("sessions' answers", erased.iter().map(|(_, sessions)| sessions).sum())
                }
            };
            storage.close().await;
            anyhow::Ok(outcome)
        })
        .with_context(|| Storage::without_password(&args.database))?;
    let mut out = std::io::stdout().lock();
    if json {
        writeln!(out, "{}", serde_json::json!({"deleted": number, "what": what}))?;
    } else {
        writeln!(
            out,
            "{number} {what} deleted; the next `mimique backup --folder` carries it into the backups"
        )?;
    }
    Ok(())
}
