//! The numbered steps that bring a database from any earlier schema to today's.
//!
//! A step is never changed once it has been released; a change of schema is a new step.

use crate::database::{Pool, Transaction, query};
use crate::error::StorageError;

/// One step, as SQL text for each database.
pub(crate) struct Migration {
    pub version: i64,
    pub sqlite: &'static str,
    pub postgres: &'static str,
}

/// Every step, in order.
pub(crate) const MIGRATIONS: &[Migration] = &[
    Migration {
        version: 1,
        sqlite: include_str!("migrations/sqlite/0001_answers.sql"),
        postgres: include_str!("migrations/postgres/0001_answers.sql"),
    },
    Migration {
        version: 2,
        sqlite: include_str!("migrations/sqlite/0002_accounts.sql"),
        postgres: include_str!("migrations/postgres/0002_accounts.sql"),
    },
    Migration {
        version: 3,
        sqlite: include_str!("migrations/sqlite/0003_slots.sql"),
        postgres: include_str!("migrations/postgres/0003_slots.sql"),
    },
    Migration {
        version: 4,
        sqlite: include_str!("migrations/sqlite/0004_conditions.sql"),
        postgres: include_str!("migrations/postgres/0004_conditions.sql"),
    },
    Migration {
        version: 5,
        sqlite: include_str!("migrations/sqlite/0005_standing.sql"),
        postgres: include_str!("migrations/postgres/0005_standing.sql"),
    },
    Migration {
        version: 6,
        sqlite: include_str!("migrations/sqlite/0006_keeping.sql"),
        postgres: include_str!("migrations/postgres/0006_keeping.sql"),
    },
    Migration {
        version: 7,
        sqlite: include_str!("migrations/sqlite/0007_sums_and_roles.sql"),
        postgres: include_str!("migrations/postgres/0007_sums_and_roles.sql"),
    },
];

/// The version of today's schema.
pub(crate) const LATEST: i64 = MIGRATIONS[MIGRATIONS.len() - 1].version;

/// The version of a database's schema; `None` where there is none yet.
pub(crate) const VERSION: &str = "SELECT MAX(version) AS version FROM schema_migrations";

/// Makes the table that holds the version, which no step makes.
pub(crate) async fn make_version_table(transaction: &mut Transaction) -> Result<(), StorageError> {
    query("CREATE TABLE IF NOT EXISTS schema_migrations (version BIGINT PRIMARY KEY)")
        .execute(transaction)
        .await?;
    Ok(())
}

/// Lets one server after the other change the schema.
pub(crate) async fn lock(transaction: &mut Transaction) -> Result<(), StorageError> {
    if let Some(lock) = transaction.dialect().schema_lock {
        query(lock).execute(transaction).await?;
    }
    Ok(())
}

/// Runs every step that the database has not seen, in one transaction.
pub(crate) async fn migrate(pool: &Pool) -> Result<(), StorageError> {
    // A database that is up to date is not locked. Without the table there is nothing in it.
    if let Ok(row) = query(VERSION).fetch_one(pool).await
        && row.get::<Option<i64>>("version")? == Some(LATEST)
    {
        return Ok(());
    }
    let mut transaction = pool.begin_write().await?;
    lock(&mut transaction).await?;
    make_version_table(&mut transaction).await?;
    let row = query(VERSION).fetch_one(&mut transaction).await?;
    let found = row.get::<Option<i64>>("version")?.unwrap_or(0);
    if found > LATEST {
        return Err(StorageError::SchemaTooNew { found, known: LATEST });
    }
    for step in MIGRATIONS.iter().filter(|step| step.version > found) {
        migrate_step(&mut transaction, step).await?;
    }
    transaction.commit().await
}

/// Runs one step.
pub(crate) async fn migrate_step(
    transaction: &mut Transaction,
    step: &Migration,
) -> Result<(), StorageError> {
    let text = match transaction {
        Transaction::Sqlite(_) => step.sqlite,
        Transaction::Postgres(_) => step.postgres,
    };
    transaction.run_script(text).await?;
    query("INSERT INTO schema_migrations (version) VALUES ($1)")
        .bind(step.version)
        .execute(transaction)
        .await?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_numbered_from_one_without_gaps() {
        for (index, step) in MIGRATIONS.iter().enumerate() {
            assert_eq!(step.version, index as i64 + 1);
        }
        assert_eq!(LATEST, MIGRATIONS.len() as i64);
    }
}
