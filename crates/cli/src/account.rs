//! `mimique account`: the way back to an account for one who can reach the database.

use std::collections::BTreeMap;
use std::io::Write as _;

use anyhow::Context as _;
use mimique_server::reset_link;
use mimique_storage::{Role, Storage};

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    /// Print a one-time link that sets a new password (and enables a disabled account)
    Reset {
        /// Address of the account
        email: String,
        #[command(flatten)]
        place: Place,
        /// Address of the server as people type it
        #[arg(long, default_value = "http://127.0.0.1:8080")]
        url: String,
    },
    /// List the accounts
    List {
        #[command(flatten)]
        place: Place,
    },
}

#[derive(clap::Args)]
struct Place {
    /// Where the answers are: sqlite:FILE or postgres://USER@HOST/NAME
    #[arg(long, default_value = "sqlite:mimique-data/answers.sqlite")]
    database: String,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let runtime = tokio::runtime::Runtime::new().context("the database's threads")?;
    runtime.block_on(async {
        let (What::Reset { place, .. } | What::List { place }) = &args.what;
        let named = || Storage::without_password(&place.database);
        let storage = Storage::open_existing(&place.database).await.with_context(named)?;
        let outcome = print(&args.what, &storage, json).await.with_context(named);
        storage.close().await;
        outcome
    })
}

async fn print(what: &What, storage: &Storage, json: bool) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    match what {
        What::Reset { email, url, .. } => {
            let link =
                format!("{}{}", url.trim_end_matches('/'), reset_link(storage, email).await?);
            if json {
                writeln!(out, "{}", serde_json::json!({"email": email, "link": link}))?;
            } else {
                writeln!(out, "{link}")?;
                writeln!(out, "It works once, for two days, and sets a new password.")?;
            }
        }
        What::List { .. } => {
            for account in storage.accounts().await? {
                let (email, role) = (&account.email, Role::word(account.role));
                let disabled = account.disabled_ms.is_some();
                let studies = storage.study_roles_of(account.key).await?;
                let studies: BTreeMap<String, &str> =
                    studies.into_iter().map(|(study, role)| (study, role.word())).collect();
                if json {
                    let line = serde_json::json!({
                        "email": email, "role": role, "studies": studies, "disabled": disabled,
                    });
                    writeln!(out, "{line}")?;
                } else {
                    let studies = studies.iter().map(|(study, role)| format!("  {study}: {role}"));
                    let studies: String = studies.collect();
                    let disabled = if disabled { "  disabled" } else { "" };
                    writeln!(out, "{email}  {role}{studies}{disabled}")?;
                }
            }
        }
    }
    Ok(())
}
