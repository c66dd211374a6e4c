//! A family whose cases stand in files of known names: each file has a function that computes what it holds.

use std::path::Path;

use crate::document::Document;
use crate::{Case, Family, VerifyError};

/// What reads the cases of one file.
pub(crate) type Read = fn(&Source<'_>, &mut dyn FnMut(Case)) -> Result<(), VerifyError>;

/// A file of cases.
pub(crate) struct Source<'a> {
    pub folder: &'a Path,
    pub document: Document,
    /// Its name without ending: `hmm/given`.
    pub name: &'a str,
}

impl Source<'_> {
    /// A case of the file.
    pub fn case(&self, own: impl std::fmt::Display) -> Case {
        Case::new(format!("{}/{own}", self.name))
    }
}

/// A family of such files.
pub(crate) struct FileFamily {
    pub name: &'static str,
    /// The files, and what computes their cases.
    pub files: &'static [(&'static str, Read)],
}

impl Family for FileFamily {
    fn name(&self) -> &'static str {
        self.name
    }

    fn holds(&self, folder: &Path) -> bool {
        self.files.iter().any(|(file, _)| folder.join(file).is_file())
    }

    fn run(&self, folder: &Path, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
        for (file, read) in self.files {
            let path = folder.join(file);
            if path.is_file() {
                let document = Document::read(&path)?;
                let name = file.trim_end_matches(".json");
                read(&Source { folder, document, name }, each)?;
            }
        }
        Ok(())
    }
}
