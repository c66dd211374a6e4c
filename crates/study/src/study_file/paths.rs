//! Where a path of the study file leads.

use std::path::{Path, PathBuf};

use super::DATA_PREFIX;

/// A path of the study file cannot be followed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PathError {
    /// The path asks for a variable that is not set.
    #[error(
        "{0:?}: the environment variable MIMIQUE_DATA is not set; set it to the folder of the data"
    )]
    VariableUnset(String),
    /// The path asks for another variable.
    #[error(
        "{0:?}: only ${{MIMIQUE_DATA}}/ at its beginning is replaced; write a path without other variables"
    )]
    UnknownVariable(String),
}

/// The file that a path of the study file means: behind [`DATA_PREFIX`] in `data_folder` (the value
/// of the environment variable `MIMIQUE_DATA`, which the caller reads), else relative to the folder
/// of the study file.
pub fn resolve_path(
    path: &str,
    study_folder: &Path,
    data_folder: Option<&Path>,
) -> Result<PathBuf, PathError> {
    if let Some(rest) = path.strip_prefix(DATA_PREFIX) {
        let folder = data_folder.ok_or_else(|| PathError::VariableUnset(path.to_owned()))?;
        return Ok(folder.join(rest));
    }
    if path.contains("${") {
        return Err(PathError::UnknownVariable(path.to_owned()));
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
        assert_eq!(resolve("a.glb", None), Ok(PathBuf::from("/studies/a.glb")));
        let named = "${MIMIQUE_DATA}/heads/a.glb";
        assert_eq!(resolve(named, Some(data)), Ok(PathBuf::from("/data/heads/a.glb")));
        assert_eq!(resolve(named, None), Err(PathError::VariableUnset(named.into())));
        let other = "${HOME}/a.glb";
        assert_eq!(resolve(other, Some(data)), Err(PathError::UnknownVariable(other.into())));
    }
}
