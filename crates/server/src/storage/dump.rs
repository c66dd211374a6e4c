//! Every row out of a database and into another; compiled once for each kind (see `storage/mod.rs`).
//!
//! Tables and columns are read from the database itself, so that a table of a later schema is part
//! of backups without a word here.

use std::path::Path;

use futures_util::TryStreamExt as _;
use serde_json::Value;
use sqlx::{AssertSqlSafe, Pool, Row};

use super::super::super::StorageError;
use super::super::super::backup::{
    BackupError, BackupFacts, Line, Reader, RestoreOptions, Restored, Writer,
};
use super::super::super::migrations::{LATEST, MIGRATIONS};
use super::super::{
    BEGIN_SNAPSHOT, BEGIN_WRITE, COLUMNS, Connection, Db, IDENTITIES, LOCK_SCHEMA, OVERRIDING,
};
use super::erase::repeat_deletions;
use super::{Store, migrate_step};

/// Values in one statement at most; both databases take more.
const MOST_BOUND: usize = 900;

struct Table {
    name: String,
    columns: Vec<String>,
    kinds: Vec<Kind>,
}

#[derive(Clone, Copy)]
enum Kind {
    Integer,
    Real,
    Text,
}

impl Store {
    /// Writes every row as it stands at one instant, while others go on writing.
    pub async fn backup(&self, path: &Path, now_ms: i64) -> Result<BackupFacts, BackupError> {
        let mut snapshot = self.readers.begin_with(BEGIN_SNAPSHOT).await.map_err(storage)?;
        let tables = tables(&mut snapshot).await?;
        let schema = sqlx::query("SELECT MAX(version) AS version FROM schema_migrations")
            .fetch_one(&mut *snapshot)
            .await
            .and_then(|row| row.try_get("version"))
            .map_err(storage)?;
        let mut writer = Writer::create(path, schema, now_ms)?;
        for table in &tables {
            writer.table(&table.name, &table.columns)?;
            let order = if table.columns.len() > 1 { "1, 2" } else { "1" };
            let statement =
                format!("SELECT {} FROM {} ORDER BY {order}", table.columns.join(", "), table.name);
            let mut rows = sqlx::query(AssertSqlSafe(statement)).fetch(&mut *snapshot);
            while let Some(row) = rows.try_next().await.map_err(storage)? {
                let cells = table.kinds.iter().enumerate().map(|(at, kind)| value(&row, at, *kind));
                writer.row(cells.collect::<Result<_, _>>().map_err(storage)?)?;
            }
        }
        let rows = writer.finish()?;
        Ok(BackupFacts { schema, made_ms: now_ms, rows })
    }
}

/// Fills an empty database, all or nothing.
pub async fn restore(
    pool: &Pool<Db>,
    place: &str,
    reader: &mut Reader,
    options: RestoreOptions<'_>,
) -> Result<Restored, BackupError> {
    let schema = reader.facts.schema;
    if schema > LATEST {
        return Err(StorageError::SchemaTooNew { found: schema, known: LATEST }.into());
    }
    let mut transaction = pool.begin_with(BEGIN_WRITE).await.map_err(storage)?;
    if let Some(lock) = LOCK_SCHEMA {
        sqlx::query(lock).execute(&mut *transaction).await.map_err(storage)?;
    }
    if !tables(&mut transaction).await?.is_empty() {
        return Err(BackupError::NotEmpty { place: place.to_owned() });
    }
    sqlx::query("CREATE TABLE IF NOT EXISTS schema_migrations (version BIGINT PRIMARY KEY)")
        .execute(&mut *transaction)
        .await
        .map_err(storage)?;
    for step in MIGRATIONS.iter().filter(|step| step.version <= schema) {
        migrate_step(&mut transaction, step).await?;
    }
    let tables = tables(&mut transaction).await?;
    let mut into: Option<Insert> = None;
    let mut rows = 0;
    while let Some(line) = reader.next()? {
        match line {
            Line::Table { table, columns } => {
                if let Some(mut insert) = into.take() {
                    insert.flush(&mut transaction).await?;
                }
                let known = tables.iter().find(|known| known.name == table);
                let known = known.ok_or_else(|| reader.damaged(format!("no table {table}")))?;
                let kinds: Option<Vec<Kind>> = columns
                    .iter()
                    .map(|name| Some(known.kinds[known.columns.iter().position(|c| c == name)?]))
                    .collect();
                let kinds = kinds.ok_or_else(|| reader.damaged("an unknown column"))?;
                into = Some(Insert { table, columns, kinds, rows: Vec::new() });
            }
            Line::Row(row) => {
                let Some(insert) = into.as_mut().filter(|i| i.columns.len() == row.len()) else {
                    return Err(reader.damaged("a row that does not fit its table"));
                };
                let fits = |(cell, kind): (&Value, &Kind)| match kind {
                    _ if cell.is_null() => true,
                    Kind::Integer => cell.is_i64(),
                    Kind::Real => cell.is_number(),
                    Kind::Text => cell.is_string(),
                };
                if !row.iter().zip(&insert.kinds).all(fits) {
                    return Err(reader.damaged("a value that does not fit its column"));
                }
                rows += 1;
                insert.rows.push(row);
                if insert.rows.len() * insert.columns.len() >= MOST_BOUND {
                    insert.flush(&mut transaction).await?;
                }
            }
            _ => {}
        }
    }
    if let Some(mut insert) = into.take() {
        insert.flush(&mut transaction).await?;
    }
    for step in MIGRATIONS.iter().filter(|step| step.version > schema) {
        migrate_step(&mut transaction, step).await?;
    }
    let deleted_again = repeat_deletions(&mut transaction, options.deletions).await?;
    if options.skip_numbers {
        sqlx::query(
            "UPDATE studies SET next_participant = (next_participant / 1000 + 1) * 1000 + 1 \
             WHERE next_participant > 1",
        )
        .execute(&mut *transaction)
        .await
        .map_err(storage)?;
    }
    go_on_counting(&mut transaction).await?;
    transaction.commit().await.map_err(storage)?;
    Ok(Restored { rows, deleted_again })
}

/// Rows that wait for one statement.
struct Insert {
    table: String,
    columns: Vec<String>,
    kinds: Vec<Kind>,
    rows: Vec<Vec<Value>>,
}

impl Insert {
    async fn flush(&mut self, connection: &mut Connection) -> Result<(), BackupError> {
        if self.rows.is_empty() {
            return Ok(());
        }
        let width = self.columns.len();
        let groups: Vec<String> = (0..self.rows.len())
            .map(|row| {
                let cells: Vec<String> =
                    (1..=width).map(|at| format!("${}", row * width + at)).collect();
                format!("({})", cells.join(", "))
            })
            .collect();
        let statement = format!(
            "INSERT INTO {} ({}){OVERRIDING} VALUES {}",
            self.table,
            self.columns.join(", "),
            groups.join(", ")
        );
        let mut query = sqlx::query(AssertSqlSafe(statement)).persistent(false);
        for row in &self.rows {
            for (cell, kind) in row.iter().zip(&self.kinds) {
                query = match kind {
                    Kind::Integer => query.bind(cell.as_i64()),
                    Kind::Real => query.bind(cell.as_f64()),
                    Kind::Text => query.bind(cell.as_str()),
                };
            }
        }
        query.execute(connection).await.map_err(storage)?;
        self.rows.clear();
        Ok(())
    }
}

/// Tables and their columns, in the order of their making; not the schema's own version.
async fn tables(connection: &mut Connection) -> Result<Vec<Table>, BackupError> {
    let rows = sqlx::query(COLUMNS).fetch_all(connection).await.map_err(storage)?;
    let mut tables: Vec<Table> = Vec::new();
    for row in rows {
        let name: String = row.try_get("table_name").map_err(storage)?;
        let column: String = row.try_get("column_name").map_err(storage)?;
        let kind: String = row.try_get("kind").map_err(storage)?;
        if name == "schema_migrations" {
            continue;
        }
        let kind = match kind.to_ascii_lowercase().as_str() {
            "integer" | "bigint" => Kind::Integer,
            "real" | "double precision" => Kind::Real,
            "text" => Kind::Text,
            other => {
                let problem = format!("{name}.{column}: backups do not know the type {other}");
                return Err(StorageError::Damaged { table: "schema", problem }.into());
            }
        };
        if tables.last().is_none_or(|table| table.name != name) {
            tables.push(Table { name, columns: Vec::new(), kinds: Vec::new() });
        }
        if let Some(table) = tables.last_mut() {
            table.columns.push(column);
            table.kinds.push(kind);
        }
    }
    Ok(tables)
}

fn value(row: &<Db as sqlx::Database>::Row, at: usize, kind: Kind) -> Result<Value, sqlx::Error> {
    Ok(match kind {
        Kind::Integer => row.try_get::<Option<i64>, _>(at)?.into(),
        Kind::Real => row.try_get::<Option<f64>, _>(at)?.into(),
        Kind::Text => row.try_get::<Option<String>, _>(at)?.into(),
    })
}

/// Keys that the database makes itself go on after the highest one restored.
async fn go_on_counting(connection: &mut Connection) -> Result<(), BackupError> {
    let Some(identities) = IDENTITIES else { return Ok(()) };
    for row in sqlx::query(identities).fetch_all(&mut *connection).await.map_err(storage)? {
        let table: String = row.try_get("table_name").map_err(storage)?;
        let column: String = row.try_get("column_name").map_err(storage)?;
        sqlx::query(AssertSqlSafe(format!(
            "SELECT setval(pg_get_serial_sequence('{table}', '{column}'), \
             (SELECT COALESCE(MAX({column}), 0) + 1 FROM {table}), false)"
        )))
        .execute(&mut *connection)
        .await
        .map_err(storage)?;
    }
    Ok(())
}

fn storage(error: sqlx::Error) -> BackupError {
    BackupError::Storage(error.into())
}
