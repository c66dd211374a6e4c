//! What differs between the two databases in the text of a statement.

/// The parts of statements that each database says in its own way.
#[derive(Debug)]
pub(crate) struct Dialect {
    /// Its name, for messages.
    pub name: &'static str,
    /// Begins a transaction that writes.
    pub begin_write: &'static str,
    /// Begins a transaction that reads what is committed at its first statement, whatever is written
    /// meanwhile.
    pub begin_snapshot: &'static str,
    /// Lists every table and column, in the order of their making.
    pub columns: &'static str,
    /// Inserts into a table keys that the database would otherwise number itself.
    pub overriding: &'static str,
    /// Lists the columns that the database numbers itself and that have to be told the highest number
    /// after a restoration.
    pub identities: Option<&'static str>,
    /// Ends a query whose rows are locked until the transaction ends.
    pub row_lock: &'static str,
    /// Makes two servers started at once migrate one after the other.
    pub schema_lock: Option<&'static str>,
    /// Connections that write at the same time (see `sessions::writer`).
    pub lanes: usize,
}

pub(super) static SQLITE: Dialect = Dialect {
    name: "SQLite",
    // Takes the write lock at once, so that a transaction never fails half-way for want of it.
    begin_write: "BEGIN IMMEDIATE",
    begin_snapshot: "BEGIN",
    columns: "SELECT m.name AS table_name, p.name AS column_name, p.type AS kind \
         FROM sqlite_schema m JOIN pragma_table_info(m.name) p WHERE m.type = 'table' \
         AND m.name NOT LIKE 'sqlite_%' ORDER BY m.rowid, p.cid",
    overriding: "",
    // SQLite goes on after the highest key by itself.
    identities: None,
    // The write lock is the whole file's: a row needs none, and neither does migrating.
    row_lock: "",
    schema_lock: None,
    // SQLite has one writer, so one lane commits for everybody.
    lanes: 1,
};

pub(super) static POSTGRES: Dialect = Dialect {
    name: "PostgreSQL",
    begin_write: "BEGIN",
    begin_snapshot: "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY",
    columns: "SELECT c.relname::text AS table_name, a.attname::text AS column_name, \
         format_type(a.atttypid, NULL) AS kind FROM pg_class c \
         JOIN pg_attribute a ON a.attrelid = c.oid JOIN pg_namespace n ON n.oid = c.relnamespace \
         WHERE n.nspname = current_schema() AND c.relkind = 'r' AND a.attnum > 0 \
         AND NOT a.attisdropped ORDER BY c.oid, a.attnum",
    overriding: " OVERRIDING SYSTEM VALUE",
    identities: Some(
        "SELECT table_name::text AS table_name, column_name::text AS column_name \
         FROM information_schema.columns WHERE table_schema = current_schema() \
         AND is_identity = 'YES'",
    ),
    // Two requests for one session, on one server or two, wait for each other. No key is changed, so
    // that rows which refer to it need not wait.
    row_lock: " FOR NO KEY UPDATE",
    // The number spells "mimq".
    schema_lock: Some("SELECT pg_advisory_xact_lock(1835625841)"),
    // Sessions are spread over two for their appends, the third makes everything else.
    lanes: 3,
};
