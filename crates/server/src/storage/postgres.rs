//! PostgreSQL: any number of servers on one database.

use std::str::FromStr;
use std::time::Duration;

use sqlx::postgres::{PgConnectOptions, PgPoolOptions};

use super::backup::{BackupError, Reader, RestoreOptions, Restored};
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
/// Reads what is committed at its first statement, whatever is written meanwhile.
const BEGIN_SNAPSHOT: &str = "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY";
/// Every table and column, in the order of their making.
const COLUMNS: &str = "SELECT c.relname::text AS table_name, a.attname::text AS column_name, \
     format_type(a.atttypid, NULL) AS kind FROM pg_class c \
     JOIN pg_attribute a ON a.attrelid = c.oid JOIN pg_namespace n ON n.oid = c.relnamespace \
     WHERE n.nspname = current_schema() AND c.relkind = 'r' AND a.attnum > 0 \
     AND NOT a.attisdropped ORDER BY c.oid, a.attnum";
/// Keys are given as they are.
const OVERRIDING: &str = " OVERRIDING SYSTEM VALUE";
/// Columns that the database numbers itself.
const IDENTITIES: Option<&str> = Some(
    "SELECT table_name::text AS table_name, column_name::text AS column_name \
     FROM information_schema.columns WHERE table_schema = current_schema() \
     AND is_identity = 'YES'",
);
/// Two requests for one session, on one server or two, wait for each other. No key is changed, so that
/// rows which refer to it need not wait.
const FOR_UPDATE: &str = " FOR NO KEY UPDATE";
/// Two servers started at once migrate one after the other. The number spells "mimq".
const LOCK_SCHEMA: Option<&str> = Some("SELECT pg_advisory_xact_lock(1835625841)");
/// Lanes, each committing on its own connection: sessions are spread over two for their appends, the
/// third makes everything else.
const LANES: usize = 3;

fn migration_text(step: &Migration) -> &'static str {
    step.postgres
}

/// Connects and migrates.
pub(super) async fn open(url: &str) -> Result<Store, StorageError> {
    let options = options(url)?;
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

/// Fills an empty database, all or nothing.
pub(super) async fn restore(
    url: &str,
    reader: &mut Reader,
    choice: RestoreOptions<'_>,
) -> Result<Restored, BackupError> {
    let pool = PgPoolOptions::new().max_connections(1).connect_with(options(url)?);
    let pool = pool.await.map_err(StorageError::from)?;
    let rows = store::restore(&pool, &without_password(url), reader, choice).await;
    pool.close().await;
    rows
}

fn options(url: &str) -> Result<PgConnectOptions, StorageError> {
    PgConnectOptions::from_str(url).map_err(|problem| StorageError::Address {
        url: without_password(url),
        problem: problem.to_string(),
    })
}
