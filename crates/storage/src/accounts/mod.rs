//! Researchers' accounts. These are few and small: they do not go through the group commit.

mod links;
mod logins;
mod people;
pub(crate) mod records;
mod row;
mod study_roles;
mod tokens;

/// "Last seen" is kept to the minute: a page's every request need not write.
const SEEN_STEP_MS: i64 = 60_000;
