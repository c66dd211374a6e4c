//! The server: pages, packs, answers kept in SQLite or PostgreSQL, export.
