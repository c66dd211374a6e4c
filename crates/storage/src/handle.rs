//! The handle of a database: opened, asked whether it answers, closed.

use crate::address::{Address, without_password};
use crate::database::{self, Opened, Pool, query};
use crate::error::StorageError;
use crate::schema::{self, LATEST};
use crate::sessions::writer::Writer;
use crate::wiper::Wiper;

/// Handle of the database; cheap to clone.
#[derive(Clone)]
pub struct Storage {
    pub(crate) readers: Pool,
    pub(crate) writers: Pool,
    pub(crate) writer: Writer,
    pub(crate) wiper: Wiper,
}

impl Storage {
    /// Opens `sqlite:FILE` (made when absent) or `postgres://…` and brings its schema up to date.
    ///
    /// # Errors
    /// The address cannot be read, the database is not reached, or it cannot be written: a server that
    /// could keep no answer must not start.
    pub async fn open(url: &str) -> Result<Self, StorageError> {
        let storage = Self::connect(url).await?;
        storage.ensure_writable().await?;
        Ok(storage)
    }

    /// Like [`Self::open`], but a SQLite file must be there already, and may be one that can only be
    /// read.
    pub async fn open_existing(url: &str) -> Result<Self, StorageError> {
        if let Address::Sqlite(path) = Address::read(url)?
            && !path.is_file()
        {
            return Err(StorageError::NoDatabase { path: path.display().to_string() });
        }
        Self::connect(url).await
    }

    async fn connect(url: &str) -> Result<Self, StorageError> {
        let Opened { writers, readers, wiper } = match Address::read(url)? {
            Address::Postgres(url) => database::postgres::open(url).await?,
            Address::Sqlite(path) => database::sqlite::open(&path).await?,
        };
        schema::migrate(&writers).await?;
        let writer = Writer::spawn(&writers);
        let wiper = Wiper::new(wiper);
        wiper.go_on().await?;
        Ok(Self { readers, writers, writer, wiper })
    }

    /// A database's address fit for a message.
    pub fn without_password(url: &str) -> String {
        without_password(url)
    }

    /// `SQLite` or `PostgreSQL`, for messages.
    pub fn kind(&self) -> &'static str {
        self.writers.dialect().name
    }

    /// Waits until every change accepted so far is committed, then closes.
    pub async fn close(&self) {
        self.writer.finish().await;
        self.wiper.close().await;
        self.readers.close().await;
        self.writers.close().await;
    }

    /// Makes a statement that would write, and writes nothing: where SQLite has opened a file for
    /// reading only, even `BEGIN IMMEDIATE` succeeds.
    async fn ensure_writable(&self) -> Result<(), StorageError> {
        let mut transaction = self.writers.begin_write().await?;
        query("DELETE FROM schema_migrations WHERE version < 0").execute(&mut transaction).await?;
        transaction.rollback().await
    }

    /// Asks the database whether it answers.
    pub async fn ping(&self) -> Result<(), StorageError> {
        query("SELECT 1").execute(&self.readers).await?;
        Ok(())
    }

    /// Writes the time into the database, as an answer is written: only so is it known that it can be.
    pub async fn try_writing(&self, now_ms: i64) -> Result<(), StorageError> {
        query(
            "INSERT INTO clock_marks (name, at_ms) VALUES ('tried', $1) \
             ON CONFLICT (name) DO UPDATE SET at_ms = excluded.at_ms",
        )
        .bind(now_ms)
        .execute(&self.writers)
        .await?;
        Ok(())
    }

    /// Asks the database whether its schema is the one that this binary knows.
    pub async fn is_current(&self) -> Result<bool, StorageError> {
        let row = query(schema::VERSION).fetch_one(&self.readers).await?;
        Ok(row.get::<Option<i64>>("version")? == Some(LATEST))
    }

    /// The secret kept under this name, made by `make` at the first call.
    pub async fn server_key(
        &self,
        name: &str,
        make: impl FnOnce() -> String,
    ) -> Result<String, StorageError> {
        query("INSERT INTO server_keys (name, secret) VALUES ($1, $2) ON CONFLICT DO NOTHING")
            .bind(name)
            .bind(&make())
            .execute(&self.writers)
            .await?;
        let row = query("SELECT secret FROM server_keys WHERE name = $1")
            .bind(name)
            .fetch_one(&self.writers)
            .await?;
        row.get("secret")
    }
}
