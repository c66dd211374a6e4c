//! SQLite and PostgreSQL behind one pool, one transaction, one row: every other module is written, and
//! compiled, once.
//!
//! sqlx has a driver of this kind (`Any`), which we do not use: it copies every row, offers neither
//! SQLite's pragmas nor the isolation of a snapshot, and hides the error codes by which a full disk is
//! told from a mistake of ours. Code generic over `sqlx::Database` would repeat eight bounds at each
//! function and be compiled twice.

mod builder;
mod dialect;
pub(crate) mod postgres;
pub(crate) mod sqlite;

use futures_util::stream::{BoxStream, StreamExt as _, TryStreamExt as _};
use sqlx::database::HasStatementCache;
use sqlx::postgres::PgRow;
use sqlx::query::Query;
use sqlx::sqlite::SqliteRow;
use sqlx::{
    ColumnIndex, Database, Decode, Encode, Postgres, Row as _, SqlSafeStr, SqlStr, Sqlite, Type,
};

pub(crate) use self::builder::Builder;
pub(crate) use self::dialect::Dialect;
use crate::error::StorageError;

/// Connections that read: exports and the dashboard read for long, and participants do not wait for them.
const READERS: u32 = 6;

/// Connections to one database; cheap to clone.
#[derive(Clone)]
pub(crate) enum Pool {
    Sqlite(sqlx::Pool<Sqlite>),
    Postgres(sqlx::Pool<Postgres>),
}

/// The connections to one database, by what they do.
pub(crate) struct Opened {
    pub writers: Pool,
    pub readers: Pool,
    /// Brings SQLite's log into the file.
    pub wiper: Option<Pool>,
}

impl Pool {
    pub fn dialect(&self) -> &'static Dialect {
        match self {
            Self::Sqlite(_) => &dialect::SQLITE,
            Self::Postgres(_) => &dialect::POSTGRES,
        }
    }

    /// Begins a transaction that writes.
    pub async fn begin_write(&self) -> Result<Transaction, StorageError> {
        self.begin(self.dialect().begin_write).await
    }

    /// Begins a transaction that reads the database as it is now, whatever is written meanwhile.
    pub async fn begin_snapshot(&self) -> Result<Transaction, StorageError> {
        self.begin(self.dialect().begin_snapshot).await
    }

    async fn begin(&self, statement: &'static str) -> Result<Transaction, StorageError> {
        Ok(match self {
            Self::Sqlite(pool) => Transaction::Sqlite(pool.begin_with(statement).await?),
            Self::Postgres(pool) => Transaction::Postgres(pool.begin_with(statement).await?),
        })
    }

    /// Whether [`Self::close`] was called.
    pub fn is_closed(&self) -> bool {
        match self {
            Self::Sqlite(pool) => pool.is_closed(),
            Self::Postgres(pool) => pool.is_closed(),
        }
    }

    /// Waits until every connection is given back, and closes them.
    pub async fn close(&self) {
        match self {
            Self::Sqlite(pool) => pool.close().await,
            Self::Postgres(pool) => pool.close().await,
        }
    }
}

/// A transaction; what it has changed is undone when it is dropped before [`Self::commit`].
pub(crate) enum Transaction {
    Sqlite(sqlx::Transaction<'static, Sqlite>),
    Postgres(sqlx::Transaction<'static, Postgres>),
}

impl Transaction {
    pub fn dialect(&self) -> &'static Dialect {
        match self {
            Self::Sqlite(_) => &dialect::SQLITE,
            Self::Postgres(_) => &dialect::POSTGRES,
        }
    }

    pub async fn commit(self) -> Result<(), StorageError> {
        match self {
            Self::Sqlite(transaction) => transaction.commit().await?,
            Self::Postgres(transaction) => transaction.commit().await?,
        }
        Ok(())
    }

    pub async fn rollback(self) -> Result<(), StorageError> {
        match self {
            Self::Sqlite(transaction) => transaction.rollback().await?,
            Self::Postgres(transaction) => transaction.rollback().await?,
        }
        Ok(())
    }

    /// Runs several statements without values.
    pub async fn run_script(&mut self, text: &'static str) -> Result<(), StorageError> {
        use sqlx::raw_sql;
        match self {
            Self::Sqlite(transaction) => {
                raw_sql(text).execute(&mut **transaction).await?;
            }
            Self::Postgres(transaction) => {
                raw_sql(text).execute(&mut **transaction).await?;
            }
        }
        Ok(())
    }
}

/// Where a statement is run.
pub(crate) enum Place<'p> {
    Pool(&'p Pool),
    Transaction(&'p mut Transaction),
}

impl<'p> From<&'p Pool> for Place<'p> {
    fn from(pool: &'p Pool) -> Self {
        Self::Pool(pool)
    }
}

impl<'p> From<&'p mut Transaction> for Place<'p> {
    fn from(transaction: &'p mut Transaction) -> Self {
        Self::Transaction(transaction)
    }
}

/// A value bound to a statement: what columns of the schema hold.
#[derive(Clone, Copy)]
pub(crate) enum Value<'v> {
    Integer(Option<i64>),
    Real(Option<f64>),
    Text(Option<&'v str>),
}

impl From<i64> for Value<'_> {
    fn from(value: i64) -> Self {
        Self::Integer(Some(value))
    }
}

impl From<Option<i64>> for Value<'_> {
    fn from(value: Option<i64>) -> Self {
        Self::Integer(value)
    }
}

impl From<f64> for Value<'_> {
    fn from(value: f64) -> Self {
        Self::Real(Some(value))
    }
}

impl<'v> From<&'v str> for Value<'v> {
    fn from(value: &'v str) -> Self {
        Self::Text(Some(value))
    }
}

impl<'v> From<&'v String> for Value<'v> {
    fn from(value: &'v String) -> Self {
        Self::Text(Some(value))
    }
}

impl<'v> From<&'v Option<String>> for Value<'v> {
    fn from(value: &'v Option<String>) -> Self {
        Self::Text(value.as_deref())
    }
}

/// A statement and its values.
pub(crate) struct Statement<'v> {
    text: SqlStr,
    values: Vec<Value<'v>>,
    is_kept: bool,
}

/// A statement with `$1`, `$2`… in the places of its values; it is prepared once for each connection.
pub(crate) fn query<'v>(text: impl SqlSafeStr) -> Statement<'v> {
    Statement { text: text.into_sql_str(), values: Vec::new(), is_kept: true }
}

impl<'v> Statement<'v> {
    /// Gives the next value.
    pub fn bind(mut self, value: impl Into<Value<'v>>) -> Self {
        self.values.push(value.into());
        self
    }

    /// The same statement, prepared for this time only.
    pub fn once(self) -> Self {
        Self { is_kept: false, ..self }
    }

    /// Runs the statement; gives how many rows it has changed.
    pub async fn execute(self, place: impl Into<Place<'_>>) -> Result<u64, StorageError> {
        Ok(match place.into() {
            Place::Pool(Pool::Sqlite(pool)) => self.bound().execute(pool).await?.rows_affected(),
            Place::Pool(Pool::Postgres(pool)) => self.bound().execute(pool).await?.rows_affected(),
            Place::Transaction(Transaction::Sqlite(transaction)) => {
                self.bound().execute(&mut **transaction).await?.rows_affected()
            }
            Place::Transaction(Transaction::Postgres(transaction)) => {
                self.bound().execute(&mut **transaction).await?.rows_affected()
            }
        })
    }

    /// Every row.
    pub async fn fetch_all(self, place: impl Into<Place<'_>>) -> Result<Vec<Row>, StorageError> {
        fn sqlite(rows: Vec<SqliteRow>) -> Vec<Row> {
            rows.into_iter().map(Row::Sqlite).collect()
        }
        fn postgres(rows: Vec<PgRow>) -> Vec<Row> {
            rows.into_iter().map(Row::Postgres).collect()
        }
        Ok(match place.into() {
            Place::Pool(Pool::Sqlite(pool)) => sqlite(self.bound().fetch_all(pool).await?),
            Place::Pool(Pool::Postgres(pool)) => postgres(self.bound().fetch_all(pool).await?),
            Place::Transaction(Transaction::Sqlite(transaction)) => {
                sqlite(self.bound().fetch_all(&mut **transaction).await?)
            }
            Place::Transaction(Transaction::Postgres(transaction)) => {
                postgres(self.bound().fetch_all(&mut **transaction).await?)
            }
        })
    }

    /// The row of a statement that gives one or none.
    pub async fn fetch_optional(
        self,
        place: impl Into<Place<'_>>,
    ) -> Result<Option<Row>, StorageError> {
        Ok(self.fetch_all(place).await?.into_iter().next())
    }

    /// The row of a statement that always gives one.
    pub async fn fetch_one(self, place: impl Into<Place<'_>>) -> Result<Row, StorageError> {
        let row = self.fetch_optional(place).await?;
        row.ok_or(StorageError::Database(sqlx::Error::RowNotFound))
    }

    /// Every row, one after the other.
    pub fn stream(self, transaction: &mut Transaction) -> BoxStream<'_, Result<Row, StorageError>> {
        match transaction {
            Transaction::Sqlite(transaction) => self
                .bound()
                .fetch(&mut **transaction)
                .map_ok(Row::Sqlite)
                .map_err(StorageError::from)
                .boxed(),
            Transaction::Postgres(transaction) => self
                .bound()
                .fetch(&mut **transaction)
                .map_ok(Row::Postgres)
                .map_err(StorageError::from)
                .boxed(),
        }
    }

    /// Every row, one after the other, on a connection of its own.
    pub fn stream_from(self, pool: &Pool) -> BoxStream<'_, Result<Row, StorageError>> {
        match pool {
            Pool::Sqlite(pool) => {
                self.bound().fetch(pool).map_ok(Row::Sqlite).map_err(StorageError::from).boxed()
            }
            Pool::Postgres(pool) => {
                self.bound().fetch(pool).map_ok(Row::Postgres).map_err(StorageError::from).boxed()
            }
        }
    }

    /// The statement as one of the two databases takes it. Values are copied into it.
    fn bound<D: Database + HasStatementCache>(self) -> Query<'static, D, D::Arguments>
    where
        Option<i64>: for<'e> Encode<'e, D> + Type<D>,
        Option<f64>: for<'e> Encode<'e, D> + Type<D>,
        for<'e> Option<&'e str>: Encode<'e, D> + Type<D>,
    {
        let mut query = sqlx::query(self.text).persistent(self.is_kept);
        for value in self.values {
            query = match value {
                Value::Integer(value) => query.bind(value),
                Value::Real(value) => query.bind(value),
                Value::Text(value) => query.bind(value),
            };
        }
        query
    }
}

/// A row of an answer.
pub(crate) enum Row {
    Sqlite(SqliteRow),
    Postgres(PgRow),
}

/// What a cell of a row can be read as.
pub(crate) trait Cell:
    for<'r> Decode<'r, Sqlite> + Type<Sqlite> + for<'r> Decode<'r, Postgres> + Type<Postgres>
{
}

impl<T> Cell for T where
    T: for<'r> Decode<'r, Sqlite> + Type<Sqlite> + for<'r> Decode<'r, Postgres> + Type<Postgres>
{
}

impl Row {
    /// A cell by its column's name or place.
    pub fn get<T: Cell>(
        &self,
        column: impl ColumnIndex<SqliteRow> + ColumnIndex<PgRow>,
    ) -> Result<T, StorageError> {
        Ok(match self {
            Self::Sqlite(row) => row.try_get(column)?,
            Self::Postgres(row) => row.try_get(column)?,
        })
    }

    /// A number that is never below 0; `table` is named where it is.
    pub fn unsigned(&self, table: &'static str, column: &str) -> Result<u64, StorageError> {
        unsigned(table, self.get(column)?)
    }
}

/// A stored number that is never below 0; `table` is named where it is.
pub(crate) fn unsigned(table: &'static str, value: i64) -> Result<u64, StorageError> {
    u64::try_from(value)
        .map_err(|_| StorageError::Damaged { table, problem: format!("negative number {value}") })
}

/// A number of ours as the databases keep it; ours never reach the sign.
pub(crate) fn signed(value: u64) -> i64 {
    i64::try_from(value).unwrap_or(i64::MAX)
}
