//! Every row out of a database.

use std::path::Path;

use futures_util::TryStreamExt as _;
use serde_json::Value;
use sqlx::AssertSqlSafe;

use super::error::BackupError;
use super::file::{BackupFacts, Writer};
use super::tables::{Kind, tables};
use crate::database::{Row, query};
use crate::error::StorageError;
use crate::handle::Storage;
use crate::schema;

impl Storage {
    /// Writes a backup: every row as it stands at one instant, while everybody goes on.
    pub async fn backup(&self, path: &Path, now_ms: i64) -> Result<BackupFacts, BackupError> {
        let mut snapshot = self.readers.begin_snapshot().await?;
        let tables = tables(&mut snapshot).await?;
        let schema = query(schema::VERSION).fetch_one(&mut snapshot).await?.get("version")?;
        let mut writer = Writer::create(path, schema, now_ms)?;
        for table in &tables {
            writer.table(&table.name, &table.columns)?;
            let order = if table.columns.len() > 1 { "1, 2" } else { "1" };
            let statement =
                format!("SELECT {} FROM {} ORDER BY {order}", table.columns.join(", "), table.name);
            let mut rows = query(AssertSqlSafe(statement)).stream(&mut snapshot);
            while let Some(row) = rows.try_next().await? {
                let cells = table.kinds.iter().enumerate().map(|(at, kind)| value(&row, at, *kind));
                writer.row(cells.collect::<Result<_, _>>()?)?;
            }
        }
        let rows = writer.finish()?;
        Ok(BackupFacts { schema, made_ms: now_ms, rows })
    }
}

fn value(row: &Row, at: usize, kind: Kind) -> Result<Value, StorageError> {
    Ok(match kind {
        Kind::Integer => row.get::<Option<i64>>(at)?.into(),
        Kind::Real => row.get::<Option<f64>>(at)?.into(),
        Kind::Text => row.get::<Option<String>>(at)?.into(),
    })
}
