//! `mimique erase`: deletes answers or identifiers, on request or since their time is over.

use std::io::Write as _;
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::Context as _;
use mimique_server::{ClockDoubt, Sweep, confirm_clock, sweep_overdue, withdrawal_hash};
use mimique_storage::Storage;
use mimique_study::iso_time;

/// Whoever types commands, in the server's log.
const COMMAND: &str = "(server)";

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Where the answers are: sqlite:FILE or postgres://USER@HOST/NAME
    #[arg(long, default_value = "sqlite:mimique-data/answers.sqlite")]
    database: String,
    /// Study
    #[arg(long, required_unless_present_any = ["overdue", "code"])]
    study: Option<String>,
    /// Participant number: delete everything of this participant, as if they had withdrawn
    #[arg(long, short = 'k', requires = "study", required_unless_present_any = ["overdue", "identifiers", "code"])]
    participant: Option<u64>,
    /// Withdrawal code that a participant has sent: delete everything of theirs, in whatever study or in
    /// --study
    #[arg(long, conflicts_with_all = ["participant", "identifiers", "overdue"])]
    code: Option<String>,
    /// Delete the recruitment identifiers alone (of all participants if no number is given); repeats
    /// by them are then not recognised any more
    #[arg(long, requires = "study")]
    identifiers: bool,
    /// Mark what is older than its study's retentionDays, and delete what has been marked for a week; the
    /// server does so every hour
    #[arg(long, conflicts_with_all = ["study", "participant", "identifiers"])]
    overdue: bool,
    /// With --overdue: the clock is right, though it has gone on by days since it was last seen
    #[arg(long, requires = "overdue")]
    clock_is_right: bool,
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
                (study, _) if let Some(code) = &args.code => {
                    let hash = withdrawal_hash(code);
                    let done = storage
                        .withdraw_by_code(study.as_deref(), &hash, COMMAND, now_ms)
                        .await
                        .with_context(|| format!("--code: {code}"))?;
                    ("events", done.deleted)
                }
                (Some(study), participant) if args.identifiers => {
                    let number =
                        storage.erase_identifiers(study, participant, COMMAND, now_ms).await?;
                    ("identifiers and marks", number)
                }
                (Some(study), Some(participant)) => {
                    let number =
                        storage.erase_participant(study, participant, COMMAND, now_ms).await;
                    ("events", number.with_context(|| format!("{study}: {participant}"))?)
                }
                _ => ("sessions' answers", overdue(&storage, args.clock_is_right, now_ms).await?),
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

/// Deletes what has been marked for long enough; says what waits.
async fn overdue(storage: &Storage, clock_is_right: bool, now_ms: i64) -> anyhow::Result<u64> {
    if clock_is_right {
        confirm_clock(storage, now_ms).await?;
    }
    let swept = match sweep_overdue(storage, now_ms).await? {
        Sweep::Done(swept) => swept,
        Sweep::Doubted(ClockDoubt { seen_ms, now_ms }) => anyhow::bail!(
            "the clock shows {}, and {} was seen before; nothing is deleted: set the clock, or say \
             --clock-is-right",
            iso_time(now_ms as f64),
            iso_time(seen_ms as f64),
        ),
    };
    let marked: u64 = swept.iter().map(|study| study.marked).sum();
    if marked > 0 {
        eprintln!("{marked} sessions are over their time: their answers are deleted in a week");
    }
    Ok(swept.iter().map(|study| study.erased).sum())
}
