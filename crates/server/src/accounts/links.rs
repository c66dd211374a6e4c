//! One-time links: for the first owner, for people invited, for a forgotten password. Only the
//! secret's hash is kept; looking at the link does not use it up.

use mimique_storage::{Account, AccountLink, LinkPurpose, Role, Storage};

use super::email::normal_email;
use super::password;
use crate::clock::now_ms;
use crate::error::Error;
use crate::secret;
use crate::state::App;
use crate::state::start_error::AppError;

/// A link works for two days.
const LINK_LIFETIME_MS: i64 = 2 * 24 * 3600 * 1000;

/// Makes a link; gives its address on the server.
pub(crate) async fn new_link(
    storage: &Storage,
    purpose: LinkPurpose,
    email: &str,
    role: Role,
    study_id: Option<String>,
) -> Result<String, AppError> {
    let secret = secret::random::<16>()?;
    let now = now_ms();
    let expires_ms = now + LINK_LIFETIME_MS;
    let email = email.to_owned();
    let link = AccountLink { purpose, email, role, study_id, expires_ms };
    storage.add_link(&secret::hash(&secret), &link, now).await?;
    Ok(format!("/researcher/link/{secret}"))
}

/// A link for a person to be invited, to all studies or to one.
pub(crate) async fn invite(
    app: &App,
    email: &str,
    role: Role,
    study_id: Option<String>,
) -> Result<String, Error> {
    let email = normal_email(email).ok_or(Error::NotAnEmail)?;
    if app.storage.account_by_email(&email).await?.is_some() {
        return Err(Error::AccountExists);
    }
    Ok(new_link(&app.storage, LinkPurpose::Invitation, &email, role, study_id).await?)
}

/// Uses a link: makes the account that it is for, or sets its password.
pub(crate) async fn use_link(
    app: &App,
    given: &str,
    email: &str,
    password: &str,
) -> Result<Account, Error> {
    let hash = secret::hash(given);
    // Nothing is worked at for one who only guesses.
    let link = app.storage.link(&hash, now_ms()).await?.ok_or(Error::DeadLink)?;
    let email = match link.purpose {
        LinkPurpose::FirstOwner => normal_email(email).ok_or(Error::NotAnEmail)?,
        _ => link.email,
    };
    password::check_length(password)?;
    let password = password::hash(password).await?;
    let used = app.storage.use_link(&hash, &email, &password, now_ms()).await?;
    used.ok_or(Error::DeadLink)
}

/// A one-time link that sets a new password (and enables a disabled account): the way back for one
/// who can reach the database.
///
/// # Errors
/// Nobody has an account by this address, or storage failed.
pub async fn reset_link(storage: &Storage, email: &str) -> Result<String, AppError> {
    let known = normal_email(email).unwrap_or_default();
    let Some(account) = storage.account_by_email(&known).await? else {
        let accounts = storage.accounts().await?;
        let known: Vec<_> = accounts.into_iter().map(|account| account.email).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        return Err(AppError::NoAccount { email: email.to_owned(), known });
    };
    let (purpose, role) = (LinkPurpose::Recovery, account.role);
    let link = new_link(storage, purpose, &account.email, role, None).await?;
    super::audit::command(storage, "reset link", &account.email).await?;
    Ok(link)
}

impl App {
    /// The address `/researcher/link/…` that makes the first account; `None` where there is one.
    pub async fn first_owner_link(&self) -> Result<Option<String>, AppError> {
        if self.storage.has_accounts().await? {
            return Ok(None);
        }
        let purpose = LinkPurpose::FirstOwner;
        new_link(&self.storage, purpose, "", Role::Owner, None).await.map(Some)
    }
}
