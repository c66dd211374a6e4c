//! The tables of a database, read from the database itself, so that a table of a later schema is part
//! of backups without a word here.

use super::error::BackupError;
use crate::database::{Transaction, query};
use crate::error::StorageError;

/// A table of the database as it is.
pub(super) struct Table {
    pub name: String,
    pub columns: Vec<String>,
    pub kinds: Vec<Kind>,
}

/// What a column holds.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Integer,
    Real,
    Text,
}

/// Tables and their columns, in the order of their making; not the schema's own version.
pub(super) async fn tables(transaction: &mut Transaction) -> Result<Vec<Table>, BackupError> {
    let rows = query(transaction.dialect().columns).fetch_all(transaction).await?;
    let mut tables: Vec<Table> = Vec::new();
    for row in rows {
        let name: String = row.get("table_name")?;
        let column: String = row.get("column_name")?;
        let kind: String = row.get("kind")?;
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
