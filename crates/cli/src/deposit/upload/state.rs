//! What has been begun at a repository, in a file beside the deposit's folder: a command that was stopped goes on with it.
//! It holds no token.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use serde::{Deserialize, Serialize};

use crate::output;

/// What has been begun.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Begun {
    repository: String,
    host: String,
    /// What the repository calls it.
    id: String,
}

/// The file of it.
pub(super) struct State {
    path: PathBuf,
    repository: &'static str,
    host: String,
    begun: Option<Begun>,
}

impl State {
    /// What has been begun of this folder at this host; none where nothing has.
    pub fn open(folder: &Path, repository: &'static str, host: &str) -> anyhow::Result<Self> {
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        let path = folder.with_file_name(format!("{name}.upload.json"));
        let at = || path.display().to_string();
        let begun: Option<Begun> = match std::fs::read(&path) {
            Ok(bytes) => Some(serde_json::from_slice(&bytes).with_context(at)?),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
            Err(error) => return Err(error).with_context(at),
        };
        if let Some(other) = &begun
            && (other.repository != repository || other.host != host)
        {
            bail!(
                "{}: an upload to {} ({}) was begun from this folder; go on with it, or remove the file to begin another",
                at(),
                other.host,
                other.id
            );
        }
        Ok(Self { path, repository, host: host.to_owned(), begun })
    }

    /// What the repository calls it.
    pub fn id(&self) -> Option<&str> {
        self.begun.as_ref().map(|begun| begun.id.as_str())
    }

    /// Where that is kept.
    pub fn place(&self) -> String {
        self.path.display().to_string()
    }

    /// Keeps what has been begun.
    pub fn keep(&mut self, id: &str) -> anyhow::Result<()> {
        let begun = Begun {
            repository: self.repository.to_owned(),
            host: self.host.clone(),
            id: id.to_owned(),
        };
        let mut text = serde_json::to_vec_pretty(&begun)?;
        text.push(b'\n');
        output::write(&self.path, &text)?;
        self.begun = Some(begun);
        Ok(())
    }
}
