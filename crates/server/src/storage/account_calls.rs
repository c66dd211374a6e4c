//! Storage's words for researchers' accounts; what they do is in `accounts.rs`.

use super::account_records::{
    Account, AccountLink, ApiToken, AuditEntry, Exclusion, Role, UploadedStudy,
};
use super::{Storage, StorageError, Store};

/// Declares methods that call the same method of whichever database is behind.
macro_rules! forward {
    ($($(#[$doc:meta])* fn $name:ident($($argument:ident: $kind:ty),*) -> $gives:ty;)*) => {
        impl Storage {$(
            $(#[$doc])*
            pub async fn $name(&self, $($argument: $kind),*) -> Result<$gives, StorageError> {
                match &self.store {
                    Store::Sqlite(store) => store.$name($($argument),*).await,
                    Store::Postgres(store) => store.$name($($argument),*).await,
                }
            }
        )*}
    };
}

forward! {
    /// Whether anybody has an account.
    fn has_accounts() -> bool;
    /// Every account, by address.
    fn accounts() -> Vec<Account>;
    /// The account with this address (in lower case).
    fn account_by_email(email: &str) -> Option<Account>;
    /// Remembers a one-time link by its secret's hash; replaces an earlier one to the same person.
    fn add_link(secret_hash: &str, link: &AccountLink, now_ms: i64) -> ();
    /// The link with this hash, unless it was used or has expired.
    fn link(secret_hash: &str, now_ms: i64) -> Option<AccountLink>;
    /// Uses a link once: makes the account or sets its password. `email` is taken where the link
    /// names nobody. None where the link does not work any more or the account exists.
    fn use_link(secret_hash: &str, email: &str, password_hash: &str, now_ms: i64) -> Option<Account>;
    /// Sets a password and ends every other session of the account.
    fn set_password(account_key: i64, password_hash: &str, kept_session: &str) -> ();
    /// Sets a role; false where it would leave nobody to own the server.
    fn set_role(account_key: i64, role: Role) -> bool;
    /// Disables an account and ends its sessions; false where nobody would be left to own the server.
    fn disable_account(account_key: i64, now_ms: i64) -> bool;
    /// Enables an account again.
    fn enable_account(account_key: i64) -> bool;
    /// Remembers a browser's session by its secret's hash.
    fn log_in(secret_hash: &str, account_key: i64, now_ms: i64, expires_ms: i64) -> ();
    /// The account of a browser's session that has not expired, idle or in all.
    fn logged_in(secret_hash: &str, now_ms: i64, longest_idle_ms: i64) -> Option<Account>;
    /// Ends a browser's session.
    fn log_out(secret_hash: &str) -> ();
    /// Ends every session of an account.
    fn log_out_everywhere(account_key: i64) -> ();
    /// Counts an attempt to log in; how many there were within the window, this one included.
    fn count_attempt(subject: &str, now_ms: i64, window_ms: i64) -> u64;
    /// Forgets the attempts of one who has logged in.
    fn forget_attempts(subject: &str) -> ();
    /// Remembers a token for scripts by its hash.
    fn add_token(secret_hash: &str, account_key: i64, name: &str, role: Role, now_ms: i64) -> ();
    /// Every token, revoked ones too, oldest first.
    fn tokens() -> Vec<ApiToken>;
    /// Ends a token.
    fn revoke_token(token_key: i64, now_ms: i64) -> ();
    /// The account of a token that works, and what the token may do.
    fn token_bearer(secret_hash: &str, now_ms: i64) -> Option<(Account, Role)>;
    /// Adds a line to the log; its key is given by the database.
    fn add_audit_entry(entry: &AuditEntry) -> ();
    /// The log's lines with keys below `before`, the newest first.
    fn audit_entries(before: i64, most: u32) -> Vec<AuditEntry>;
    /// Excludes a session, or takes that back.
    fn add_exclusion(exclusion: &Exclusion) -> ();
    /// Every exclusion in a study and every taking back, oldest first.
    fn exclusions(study_id: &str) -> Vec<Exclusion>;
    /// A text for each study with sessions that differs after every change of them.
    fn pulse() -> Vec<(String, String)>;
    /// Remembers an uploaded study, or its new version or stage.
    fn put_upload(study: &UploadedStudy) -> ();
    /// The uploaded studies that are not removed, by identifier.
    fn uploads() -> Vec<UploadedStudy>;
    /// Hosts an uploaded study no more; its answers stay.
    fn remove_upload(study_id: &str, now_ms: i64) -> ();
}
