//! An unpacked upload, checked as `mimique check` does. Its files are its own: no path leads out of it.

use std::fs;
use std::path::{Component, Path};

use mimique_study::{CheckedStudy, Issue, Severity, check};
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
            return refused(format!("byte {place}: not UTF-8"), "save the file as UTF-8");
        }
        Err(error) => return refused(format!("it cannot be read ({error})"), "pack it anew"),
    };
    let report = check(&text, &|path| look_up(path, folder));
    let mut issues = report.issues;
    if let Some(study) = &report.study
        && let Some(path) = leads_out(study.value(), folder)
    {
        let message = format!("{path:?} leads out of the archive");
        issues.push(error(message, "put the file into the archive and mend the path"));
        return Checked { issues, study: None };
    }
    Checked { issues, study: report.study }
}

fn look_up(path: &str, folder: &Path) -> Result<(), (String, String)> {
    let remedy = "put the file into the archive and name it from the study file's folder";
    if !is_inside(path) {
        return Err((format!("{path:?} is not in the archive"), remedy.to_owned()));
    }
    if folder.join(path).is_file() {
        return Ok(());
    }
    Err((format!("no file {path:?} in the archive"), remedy.to_owned()))
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

fn refused(message: String, hint: &str) -> Checked {
    Checked { issues: vec![error(message, hint)], study: None }
}

fn error(message: String, hint: &str) -> Issue {
    Issue {
        pointer: String::new(),
        severity: Severity::Error,
        code: "upload",
        message,
        hint: hint.to_owned(),
    }
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
