//! The folder of an arena: `arena.json`, the head, the captures, and a folder for each submission.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::arena_file::{ARENA_FILE, Arena};
use crate::arena_problem::ArenaFileError;
use crate::submission::{Submission, content_hash, sha256};

/// An arena with what was submitted to it.
#[derive(Debug, Clone, PartialEq)]
pub struct ArenaFolder {
    /// The folder.
    pub path: PathBuf,
    /// What `arena.json` says.
    pub arena: Arena,
    /// What was submitted, by name.
    pub submissions: BTreeMap<String, Submission>,
}

/// Why a folder is no arena.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// A file that cannot be read.
    #[error("{}: cannot be read ({error}); give the folder that `mimique arena new` made", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// What the operating system says.
        error: std::io::Error,
    },
    /// An arena file that says what cannot be.
    #[error("{}: {error}", file.display())]
    Arena {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        error: ArenaFileError,
    },
    /// A `submission.json` that is none.
    #[error("{}: {problem}; submit the method again", file.display())]
    Submission {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// A file that was changed after it was submitted.
    #[error("{}: it is not what was submitted (SHA-256 {found}, submitted {wanted}); submit the method again", file.display())]
    Changed {
        /// The file.
        file: PathBuf,
        /// Its hash.
        found: String,
        /// The hash that was written down.
        wanted: String,
    },
}

impl ArenaFolder {
    /// Where a submission lies, as paths of the arena and of its study name it.
    pub fn place_of(name: &str) -> String {
        format!("submissions/{name}")
    }

    /// Reads a folder; every file that was submitted is held against its hash.
    ///
    /// # Errors
    /// [`FolderError`] with the file.
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        let file = path.join(ARENA_FILE);
        let arena = Arena::read(&text_of(&file)?, Some(path))
            .map_err(|error| FolderError::Arena { file, error })?;
        let mut submissions = BTreeMap::new();
        let folder = path.join("submissions");
        if folder.is_dir() {
            let unread = |error| FolderError::Unreadable { file: folder.clone(), error };
            for entry in std::fs::read_dir(&folder).map_err(unread)? {
                let own = entry.map_err(unread)?.path();
                // Files of the operating system or of an editor may lie about.
                let hidden =
                    own.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
                if own.is_dir() && !hidden {
                    let submission = submission_of(&own)?;
                    submissions.insert(submission.details.name.clone(), submission);
                }
            }
        }
        Ok(Self { path: path.to_owned(), arena, submissions })
    }
}

fn text_of(file: &Path) -> Result<String, FolderError> {
    std::fs::read_to_string(file)
        .map_err(|error| FolderError::Unreadable { file: file.to_owned(), error })
}

/// Reads the submission of a folder.
fn submission_of(folder: &Path) -> Result<Submission, FolderError> {
    let file = folder.join("submission.json");
    let submission: Submission = serde_json::from_str(&text_of(&file)?)
        .map_err(|e| FolderError::Submission { file: file.clone(), problem: e.to_string() })?;
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    if submission.details.name != name {
        let problem = format!("it is called {:?}, its folder {name:?}", submission.details.name);
        return Err(FolderError::Submission { file, problem });
    }
    let files = submission.segments.values().map(|own| (&own.file, &own.sha256));
    let avatar = submission.avatar.iter().map(|own| (&own.file, &own.sha256));
    for (name, wanted) in files.chain(avatar) {
        let file = folder.join(name);
        let bytes = std::fs::read(&file)
            .map_err(|error| FolderError::Unreadable { file: file.clone(), error })?;
        let found = sha256(&bytes);
        if found != *wanted {
            return Err(FolderError::Changed { file, found, wanted: wanted.clone() });
        }
    }
    let found = content_hash(submission.kind, &submission.segments, submission.avatar.as_ref());
    if found != submission.hash {
        return Err(FolderError::Changed { file, found, wanted: submission.hash });
    }
    Ok(submission)
}
