//! The log: who did what, when, in which study. Never an answer, never a reason's words.

use mimique_storage::{AuditEntry, Storage, StorageError};

use super::identity::Researcher;
use crate::clock::now_ms;
use crate::error::Error;
use crate::state::App;

/// Writes down what a person or a script did. `study` is empty where it concerns none.
pub(crate) async fn audit(
    app: &App,
    who: &Researcher,
    action: &str,
    study: &str,
    subject: &str,
) -> Result<(), Error> {
    Ok(add(&app.storage, name(who), action, study, subject).await?)
}

/// What the log calls a person, or a script of theirs.
pub(crate) fn name(who: &Researcher) -> String {
    let by = if who.session().is_some() { "" } else { " (token)" };
    format!("{}{by}", who.account.email)
}

/// Writes down what was done on the command line, or by one who has only a link.
pub(crate) async fn command(
    storage: &Storage,
    action: &str,
    subject: &str,
) -> Result<(), StorageError> {
    add(storage, "(server)".to_owned(), action, "", subject).await
}

async fn add(
    storage: &Storage,
    who: String,
    action: &str,
    study: &str,
    subject: &str,
) -> Result<(), StorageError> {
    let entry = AuditEntry {
        key: 0,
        at_ms: now_ms(),
        who,
        action: action.to_owned(),
        study_id: study.to_owned(),
        subject: subject.to_owned(),
    };
    storage.add_audit_entry(&entry).await
}
