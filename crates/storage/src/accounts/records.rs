//! The rows of researchers' accounts.

/// What a person may do, in all studies or in one; each role may do what those before it may.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// Nothing: of an account that has roles in some studies alone.
    Nothing,
    /// Sees the dashboard, without free text and without export.
    Viewer,
    /// Exports, reads every answer, excludes participants.
    Analyst,
    /// Accounts, studies, deletion, the log.
    Owner,
}

impl Role {
    /// Every role that may do something.
    pub const ALL: [Self; 3] = [Self::Viewer, Self::Analyst, Self::Owner];

    /// The word in the database, in forms and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::Nothing => "none",
            Self::Viewer => "viewer",
            Self::Analyst => "analyst",
            Self::Owner => "owner",
        }
    }

    /// The role with this word.
    pub fn from_word(word: &str) -> Option<Self> {
        [Self::Nothing].into_iter().chain(Self::ALL).find(|role| role.word() == word)
    }
}

/// A role in one study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudyRole {
    /// Key of the account inside the database.
    pub account_key: i64,
    /// The study.
    pub study_id: String,
    /// What the person may do in it, where they may not do more in all.
    pub role: Role,
}

/// A person's account.
#[derive(Debug, Clone, PartialEq)]
pub struct Account {
    /// Key inside the database.
    pub key: i64,
    /// Address, in lower case: the name to log in with.
    pub email: String,
    /// What the person may do in every study, and on the server.
    pub role: Role,
    /// PHC string of the password.
    pub password_hash: String,
    /// When it was made.
    pub created_ms: i64,
    /// Since when it cannot be used.
    pub disabled_ms: Option<i64>,
}

/// What a one-time link is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkPurpose {
    /// Makes the first account, an owner's.
    FirstOwner,
    /// Makes a further account.
    Invitation,
    /// Sets a new password of an account that can be used.
    Reset,
    /// Sets a new password and enables the account: for one who can reach the database.
    Recovery,
}

impl LinkPurpose {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::FirstOwner => "first-owner",
            Self::Invitation => "invitation",
            Self::Reset => "reset",
            Self::Recovery => "recovery",
        }
    }

    pub(super) fn from_word(word: &str) -> Option<Self> {
        let every = [Self::FirstOwner, Self::Invitation, Self::Reset, Self::Recovery];
        every.into_iter().find(|purpose| purpose.word() == word)
    }
}

/// A one-time link.
#[derive(Debug, Clone, PartialEq)]
pub struct AccountLink {
    /// What it is for.
    pub purpose: LinkPurpose,
    /// Whom it is for; empty for the first owner, who says so when using it.
    pub email: String,
    /// The role of the account it makes.
    pub role: Role,
    /// The study in which it has that role; none: in all.
    pub study_id: Option<String>,
    /// Until when it works.
    pub expires_ms: i64,
}

/// A key for scripts.
#[derive(Debug, Clone, PartialEq)]
pub struct ApiToken {
    /// Key inside the database.
    pub key: i64,
    /// Its name.
    pub name: String,
    /// What it may do, at most what its owner may.
    pub role: Role,
    /// Address of the account it belongs to.
    pub email: String,
    /// When it was made.
    pub created_ms: i64,
    /// When it was last used, to the minute.
    pub used_ms: Option<i64>,
    /// Since when it cannot be used.
    pub revoked_ms: Option<i64>,
}

/// A line of the log: who did what, when, in which study, to whom.
#[derive(Debug, Clone, PartialEq)]
pub struct AuditEntry {
    /// Key inside the database, ascending.
    pub key: i64,
    /// When.
    pub at_ms: i64,
    /// Address of the account, or the command.
    pub who: String,
    /// What was done, e.g. `export`.
    pub action: String,
    /// In which study; empty where it concerns none.
    pub study_id: String,
    /// To whom or what, e.g. `p0007` or the name of a format.
    pub subject: String,
}

/// An exclusion, or the taking back of one.
#[derive(Debug, Clone, PartialEq)]
pub struct Exclusion {
    /// Key of the session inside the database.
    pub session_key: i64,
    /// Why; none where it was taken back.
    pub reason: Option<String>,
    /// Who did it.
    pub who: String,
    /// When.
    pub at_ms: i64,
}

/// A study that came through the page.
#[derive(Debug, Clone, PartialEq)]
pub struct UploadedStudy {
    /// Identifier used in addresses.
    pub study_id: String,
    /// Its version.
    pub config_hash: String,
    /// SHA-256 of what was uploaded.
    pub archive_hash: String,
    /// `pilot` or `live`.
    pub stage: String,
    /// When it was last changed.
    pub changed_ms: i64,
}
