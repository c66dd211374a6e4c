//! Where a path of the study file leads.

use std::path::{Path, PathBuf};

use super::DATA_PREFIX;

/// A path of the study file cannot be followed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{path:?}: {why}; {}", why.remedy())]
pub struct PathError {
    /// The path.
    pub path: String,
    /// Its variable.
    pub why: WrongVariable,
}

/// What is wrong with a variable in a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum WrongVariable {
    /// It is not set.
    #[error("the environment variable MIMIQUE_DATA is not set")]
    Unset,
    /// It is none that is replaced.
    #[error("only ${{MIMIQUE_DATA}}/ at its beginning is replaced")]
    Unknown,
}

impl WrongVariable {
    /// What to do about it.
    pub fn remedy(self) -> &'static str {
        match self {
            Self::Unset => "set it to the folder of the data",
            Self::Unknown => "write a path without other variables",
        }
    }
}

/// The file that a path of the study file means: behind [`DATA_PREFIX`] in `data_folder` (the value
/// of the environment variable `MIMIQUE_DATA`, which the caller reads), else relative to the folder
/// of the study file.
pub fn resolve_path(
    path: &str,
    study_folder: &Path,
    data_folder: Option<&Path>,
) -> Result<PathBuf, PathError> {
    let error = |why| PathError { path: path.to_owned(), why };
    if let Some(rest) = path.strip_prefix(DATA_PREFIX) {
        let folder = data_folder.ok_or_else(|| error(WrongVariable::Unset))?;
        return Ok(folder.join(rest));
    }
    if path.contains("${") {
        return Err(error(WrongVariable::Unknown));
    }
    Ok(study_folder.join(path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_follow_the_variable_or_the_study_file() {
        let (study, data) = (Path::new("/studies"), Path::new("/data"));
        let resolve = |path, data| resolve_path(path, study, data);
        let error = |path: &str, why| Err(PathError { path: path.to_owned(), why });
        assert_eq!(resolve("a.glb", None), Ok(PathBuf::from("/studies/a.glb")));
        let named = "${MIMIQUE_DATA}/heads/a.glb";
        assert_eq!(resolve(named, Some(data)), Ok(PathBuf::from("/data/heads/a.glb")));
        assert_eq!(resolve(named, None), error(named, WrongVariable::Unset));
        let other = "${HOME}/a.glb";
        assert_eq!(resolve(other, Some(data)), error(other, WrongVariable::Unknown));
    }
}
