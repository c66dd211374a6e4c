//! An unpacked upload, checked as `mimique check` does. Its files are its own: no path leads out of it.

use std::fs;
use std::path::{Component, Path};

use mimique_study::{CheckedStudy, Issue, Problem, check};
use serde_json::Value;

/// What the check found, and the study if it can be hosted.
pub(super) struct Checked {
    pub issues: Vec<Issue>,
    pub study: Option<CheckedStudy>,
}

/// Checks the study file and every file that it names.
pub(super) fn check_upload(study_file: &Path) -> Checked {
    let folder = study_file.parent().unwrap_or(Path::new("."));
    let text = match fs::read(study_file).map(String::from_utf8) {
        Ok(Ok(text)) => text,
        Ok(Err(error)) => {
            let place = error.utf8_error().valid_up_to();
            return refused(Problem::NotUtf8 { byte: place });
        }
        Err(error) => return refused(Problem::Unreadable { reason: error.to_string() }),
    };
    let report = check(&text, &|path| look_up(path, folder));
    let mut issues = report.issues;
    if let Some(study) = &report.study
        && let Some(path) = leads_out(study.value(), folder)
    {
        issues.push(Issue::error("", Problem::LeadsOut { path }));
        return Checked { issues, study: None };
    }
    Checked { issues, study: report.study }
}

fn look_up(path: &str, folder: &Path) -> Result<(), Problem> {
    if !is_inside(path) {
        return Err(Problem::OutsideArchive { path: path.to_owned() });
    }
    if mimique_stimulus::is_source(&folder.join(path)) {
        return Ok(());
    }
    Err(Problem::NoFileInArchive { path: path.to_owned() })
}

fn is_inside(path: &str) -> bool {
    let plain = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    !path.contains("${") && !path.contains('\\') && Path::new(path).components().all(plain)
}

/// A text of the file that is the path of something outside: no reader may follow it.
fn leads_out(value: &Value, folder: &Path) -> Option<String> {
    match value {
        Value::String(text) => {
            let leads = !is_inside(text) && folder.join(text).exists();
            leads.then(|| text.clone())
        }
        Value::Array(values) => values.iter().find_map(|value| leads_out(value, folder)),
        Value::Object(object) => object.values().find_map(|value| leads_out(value, folder)),
        _ => None,
    }
}

fn refused(problem: Problem) -> Checked {
    Checked { issues: vec![Issue::error("", problem)], study: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_stay_in_the_archive() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.glb"), "").unwrap();
        assert!(look_up("a.glb", folder.path()).is_ok());
        for path in ["../a.glb", "/etc/passwd", "${MIMIQUE_DATA}/a.glb", "b.glb", "x\\a.glb"] {
            assert!(look_up(path, folder.path()).is_err(), "{path}");
        }
        let value = serde_json::json!({"a": ["and/or", "2/3", {"b": "/etc/passwd"}]});
        assert_eq!(leads_out(&value, folder.path()), Some("/etc/passwd".to_owned()));
        let harmless = serde_json::json!({"title": "Yes / no", "b": "a.glb"});
        assert_eq!(leads_out(&harmless, folder.path()), None);
    }
}
