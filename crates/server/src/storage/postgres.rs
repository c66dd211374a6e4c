//! PostgreSQL: any number of servers on one database.

use std::str::FromStr;
use std::time::Duration;

use sqlx::postgres::{PgConnectOptions, PgPoolOptions};

use super::migrations::Migration;
use super::{StorageError, without_password};

// The same source is compiled for the other database.
#[allow(clippy::duplicate_mod)]
#[path = "store.rs"]
mod store;

pub(super) use store::Store;

type Db = sqlx::Postgres;
type Connection = sqlx::PgConnection;

const BEGIN_WRITE: &str = "BEGIN";
/// Two requests for one session, on one server or two, wait for each other.
const FOR_UPDATE: &str = " FOR UPDATE";
/// Two servers started at once migrate one after the other. The number spells "mimq".
const LOCK_SCHEMA: Option<&str> = Some("SELECT pg_advisory_xact_lock(1835625841)");
/// Sessions are spread over this many lanes, each committing on its own connection.
const LANES: usize = 4;

fn migration_text(step: &Migration) -> &'static str {
    step.postgres
}

/// Connects and migrates.
pub(super) async fn open(url: &str) -> Result<Store, StorageError> {
    let options = PgConnectOptions::from_str(url).map_err(|problem| StorageError::Address {
        url: without_password(url),
        problem: problem.to_string(),
    })?;
    let pool = |size| {
        PgPoolOptions::new()
            .max_connections(size)
            .acquire_timeout(Duration::from_secs(10))
            .connect_with(options.clone())
    };
    let writers = pool(LANES as u32).await?;
    let readers = pool(4).await?;
    Store::open(writers, readers).await
}
