//! The numbered steps that bring a database from any earlier schema to today's.
//!
//! A step is never changed once it has been released; a change of schema is a new step.

/// One step, as SQL text for each database.
pub(super) struct Migration {
    pub version: i64,
    pub sqlite: &'static str,
    pub postgres: &'static str,
}

/// Every step, in order.
pub(super) const MIGRATIONS: &[Migration] = &[
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
];

/// The version of today's schema.
pub(super) const LATEST: i64 = MIGRATIONS[MIGRATIONS.len() - 1].version;

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
