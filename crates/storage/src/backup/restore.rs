//! Every row of a backup into an empty database, all or nothing.

use std::path::Path;

use serde_json::Value;
use sqlx::AssertSqlSafe;

use super::error::{BackupError, at};
use super::file::{Line, Reader};
use super::tables::{Kind, Table, tables};
use crate::address::{Address, without_password};
use crate::database::{self, Builder, Pool, Transaction, query};
use crate::durable_file;
use crate::error::StorageError;
use crate::handle::Storage;
use crate::records::Deletion;
use crate::schema::{self, LATEST, MIGRATIONS};
use crate::sessions::erase::repeat_deletions;

/// Values in one statement at most; both databases take more.
const MOST_BOUND: usize = 900;

/// How a backup is restored.
#[derive(Debug, Clone, Copy, Default)]
pub struct RestoreOptions<'a> {
    /// Participant numbers go on in the next thousand, so that none is given twice that was given
    /// after the backup was made.
    pub skip_numbers: bool,
    /// What was deleted after the backup was made, to be deleted again.
    pub deletions: &'a [Deletion],
}

/// What was restored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Restored {
    /// Rows of all tables.
    pub rows: u64,
    /// Sessions or identifiers that were deleted again.
    pub deleted_again: u64,
}

impl Storage {
    /// Fills a new SQLite file, or an empty PostgreSQL database, from a backup of either; all or
    /// nothing.
    pub async fn restore(
        url: &str,
        path: &Path,
        options: RestoreOptions<'_>,
    ) -> Result<Restored, BackupError> {
        let mut reader = Reader::open(path)?;
        match Address::read(url)? {
            Address::Postgres(url) => {
                let pool = database::postgres::open_once(url).await?;
                let restored = fill(&pool, &without_password(url), &mut reader, options).await;
                pool.close().await;
                restored
            }
            Address::Sqlite(path) => fill_file(&path, &mut reader, options).await,
        }
    }
}

/// Fills a file that is not there yet; whole or absent.
async fn fill_file(
    path: &Path,
    reader: &mut Reader,
    options: RestoreOptions<'_>,
) -> Result<Restored, BackupError> {
    let place = path.display().to_string();
    if std::fs::metadata(path).is_ok_and(|file| file.len() > 0) {
        return Err(BackupError::NotEmpty { place });
    }
    // SQLite keeps its log beside the file, so the second name is in a folder of its own.
    let folder = durable_file::folder_beside(path).map_err(|error| at(path, error))?;
    let temporary = folder.path().join("answers.sqlite");
    let pool = database::sqlite::open_once(&temporary).await?;
    let restored = fill(&pool, &place, reader, options).await;
    // Closing brings the log into the file.
    pool.close().await;
    let restored = restored?;
    durable_file::rename(&temporary, path).map_err(|error| at(path, error))?;
    Ok(restored)
}

async fn fill(
    pool: &Pool,
    place: &str,
    reader: &mut Reader,
    options: RestoreOptions<'_>,
) -> Result<Restored, BackupError> {
    let schema = reader.facts.schema;
    if schema > LATEST {
        return Err(StorageError::SchemaTooNew { found: schema, known: LATEST }.into());
    }
    let mut transaction = pool.begin_write().await?;
    schema::lock(&mut transaction).await?;
    if !tables(&mut transaction).await?.is_empty() {
        return Err(BackupError::NotEmpty { place: place.to_owned() });
    }
    schema::make_version_table(&mut transaction).await?;
    for step in MIGRATIONS.iter().filter(|step| step.version <= schema) {
        schema::migrate_step(&mut transaction, step).await?;
    }
    let rows = insert_rows(&mut transaction, reader).await?;
    for step in MIGRATIONS.iter().filter(|step| step.version > schema) {
        schema::migrate_step(&mut transaction, step).await?;
    }
    let deleted_again = repeat_deletions(&mut transaction, options.deletions).await?;
    if options.skip_numbers {
        query(
            "UPDATE studies SET next_participant = (next_participant / 1000 + 1) * 1000 + 1 \
             WHERE next_participant > 1",
        )
        .execute(&mut transaction)
        .await?;
    }
    go_on_counting(&mut transaction).await?;
    transaction.commit().await?;
    Ok(Restored { rows, deleted_again })
}

/// Inserts every row of the backup; gives how many there were.
async fn insert_rows(
    transaction: &mut Transaction,
    reader: &mut Reader,
) -> Result<u64, BackupError> {
    let tables = tables(transaction).await?;
    let mut into: Option<Insert> = None;
    let mut rows = 0;
    while let Some(line) = reader.next()? {
        match line {
            Line::Table { table, columns } => {
                if let Some(mut insert) = into.take() {
                    insert.flush(transaction).await?;
                }
                into = Some(Insert::new(&tables, table, columns, reader)?);
            }
            Line::Row(row) => {
                let Some(insert) = into.as_mut().filter(|i| i.columns.len() == row.len()) else {
                    return Err(reader.damaged("a row that does not fit its table"));
                };
                if !insert.fits(&row) {
                    return Err(reader.damaged("a value that does not fit its column"));
                }
                rows += 1;
                insert.rows.push(row);
                if insert.rows.len() * insert.columns.len() >= MOST_BOUND {
                    insert.flush(transaction).await?;
                }
            }
            _ => {}
        }
    }
    if let Some(mut insert) = into.take() {
        insert.flush(transaction).await?;
    }
    Ok(rows)
}

/// Rows that wait for one statement.
struct Insert {
    table: String,
    columns: Vec<String>,
    kinds: Vec<Kind>,
    rows: Vec<Vec<Value>>,
}

impl Insert {
    /// An insert into these columns of a table that the database has.
    fn new(
        tables: &[Table],
        table: String,
        columns: Vec<String>,
        reader: &Reader,
    ) -> Result<Self, BackupError> {
        let known = tables.iter().find(|known| known.name == table);
        let known = known.ok_or_else(|| reader.damaged(format!("no table {table}")))?;
        let kinds: Option<Vec<Kind>> = columns
            .iter()
            .map(|name| Some(known.kinds[known.columns.iter().position(|c| c == name)?]))
            .collect();
        let kinds = kinds.ok_or_else(|| reader.damaged("an unknown column"))?;
        Ok(Self { table, columns, kinds, rows: Vec::new() })
    }

    /// Whether every value has the kind of its column.
    fn fits(&self, row: &[Value]) -> bool {
        row.iter().zip(&self.kinds).all(|(cell, kind)| match kind {
            _ if cell.is_null() => true,
            Kind::Integer => cell.is_i64(),
            Kind::Real => cell.is_number(),
            Kind::Text => cell.is_string(),
        })
    }

    async fn flush(&mut self, transaction: &mut Transaction) -> Result<(), StorageError> {
        if self.rows.is_empty() {
            return Ok(());
        }
        let (table, columns) = (&self.table, self.columns.join(", "));
        let overriding = transaction.dialect().overriding;
        let mut insert =
            Builder::new(format!("INSERT INTO {table} ({columns}){overriding} VALUES "));
        for (index, row) in self.rows.iter().enumerate() {
            insert.push(if index > 0 { ", (" } else { "(" });
            insert.push_list(
                "{}",
                row.iter().zip(&self.kinds).map(|(cell, kind)| bound(cell, *kind)),
            );
            insert.push(")");
        }
        insert.finish().once().execute(transaction).await?;
        self.rows.clear();
        Ok(())
    }
}

fn bound(cell: &Value, kind: Kind) -> database::Value<'_> {
    match kind {
        Kind::Integer => database::Value::Integer(cell.as_i64()),
        Kind::Real => database::Value::Real(cell.as_f64()),
        Kind::Text => database::Value::Text(cell.as_str()),
    }
}

/// Keys that the database makes itself go on after the highest one restored.
async fn go_on_counting(transaction: &mut Transaction) -> Result<(), BackupError> {
    let Some(identities) = transaction.dialect().identities else { return Ok(()) };
    for row in query(identities).fetch_all(&mut *transaction).await? {
        let table: String = row.get("table_name")?;
        let column: String = row.get("column_name")?;
        query(AssertSqlSafe(format!(
            "SELECT setval(pg_get_serial_sequence('{table}', '{column}'), \
             (SELECT COALESCE(MAX({column}), 0) + 1 FROM {table}), false)"
        )))
        .execute(&mut *transaction)
        .await?;
    }
    Ok(())
}
