//! PostgreSQL: any number of servers on one database.

use std::str::FromStr;
use std::time::Duration;

use sqlx::postgres::{PgConnectOptions, PgPoolOptions};

use super::{Opened, Pool, READERS, dialect};
use crate::address::without_password;
use crate::error::StorageError;

/// Connects: a connection for each lane that writes and six that read.
pub(crate) async fn open(url: &str) -> Result<Opened, StorageError> {
    let options = options(url)?;
    let pool = |size| {
        PgPoolOptions::new()
            .max_connections(size)
            .acquire_timeout(Duration::from_secs(10))
            .connect_with(options.clone())
    };
    let lanes = dialect::POSTGRES.lanes as u32;
    let [writers, readers] = [pool(lanes).await?, pool(READERS).await?].map(Pool::Postgres);
    Ok(Opened { writers, readers, wiper: None })
}

/// Connects once, for a restoration.
pub(crate) async fn open_once(url: &str) -> Result<Pool, StorageError> {
    let pool = PgPoolOptions::new().max_connections(1).connect_with(options(url)?);
    Ok(Pool::Postgres(pool.await?))
}

fn options(url: &str) -> Result<PgConnectOptions, StorageError> {
    PgConnectOptions::from_str(url).map_err(|problem| StorageError::Address {
        url: without_password(url),
        problem: problem.to_string(),
    })
}
