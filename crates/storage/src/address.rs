//! Where a database is: `sqlite:FILE` or `postgres://USER@HOST/NAME`.

use std::path::PathBuf;

use crate::error::StorageError;

/// A database's address, read.
pub(crate) enum Address<'a> {
    Sqlite(PathBuf),
    Postgres(&'a str),
}

impl<'a> Address<'a> {
    pub fn read(url: &'a str) -> Result<Self, StorageError> {
        if url.starts_with("postgres://") || url.starts_with("postgresql://") {
            return Ok(Self::Postgres(url));
        }
        sqlite_path(url).map(Self::Sqlite).ok_or_else(|| StorageError::Address {
            url: without_password(url),
            problem: "unknown kind of database".into(),
        })
    }
}

/// The file of a `sqlite:` address; a plain path is taken as one.
fn sqlite_path(url: &str) -> Option<PathBuf> {
    let path = match url.split_once(':') {
        Some(("sqlite", rest)) => rest.strip_prefix("//").unwrap_or(rest),
        // A drive letter is no scheme.
        Some((scheme, _)) if scheme.len() > 1 => return None,
        _ => url,
    };
    (!path.is_empty()).then(|| PathBuf::from(path))
}

/// An address fit for a message.
pub(crate) fn without_password(url: &str) -> String {
    match (url.find("://"), url.rfind('@')) {
        (Some(scheme), Some(at)) if scheme + 3 <= at => {
            format!("{}…{}", &url[..scheme + 3], &url[at..])
        }
        _ => url.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_name_a_file_or_nothing() {
        assert_eq!(sqlite_path("sqlite:a/b.sqlite"), Some(PathBuf::from("a/b.sqlite")));
        assert_eq!(sqlite_path("sqlite:///tmp/b"), Some(PathBuf::from("/tmp/b")));
        assert_eq!(sqlite_path("answers.sqlite"), Some(PathBuf::from("answers.sqlite")));
        assert_eq!(sqlite_path("mysql://x/y"), None);
        assert_eq!(sqlite_path("sqlite:"), None);
    }

    #[test]
    fn a_password_is_not_repeated_in_messages() {
        assert_eq!(without_password("mysql://me:secret@host/x"), "mysql://…@host/x");
    }
}
