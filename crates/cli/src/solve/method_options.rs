//! The method and its parameters, from the options or from a file of settings.

use std::path::Path;

use anyhow::{Context as _, anyhow};
use mimique_solver::{MethodSpec, Parameter, SpecError};
use serde_json::{Value, json};

use super::args::Args;

/// The method that the options name, checked.
pub(super) fn method_spec(args: &Args) -> anyhow::Result<MethodSpec> {
    if let Some(file) = &args.settings {
        return settings(file);
    }
    let mut method = args.parameters.to_json()?;
    method.insert("method".to_owned(), json!(args.method));
    checked(&Value::Object(method), |problem| {
        let option = Parameter::of(&problem.field).map_or(problem.field.clone(), Parameter::option);
        let entry = problem.entry.as_ref().map_or(String::new(), |entry| format!(" {entry}:"));
        format!("--{option}:{entry} {}; {}", problem.message(), problem.remedy())
    })
}

/// The method of a file of settings, checked.
fn settings(file: &Path) -> anyhow::Result<MethodSpec> {
    let text = std::fs::read_to_string(file)
        .with_context(|| format!("{}: cannot be read; check the path", file.display()))?;
    let value: Value = serde_json::from_str(&text)
        .map_err(|e| anyhow!("{}: {e}; save the settings again in the studio", file.display()))?;
    checked(&value, |problem| format!("{}: {problem}", file.display()))
}

/// A method without problems, or all of them, a line each.
fn checked(value: &Value, words: impl Fn(&SpecError) -> String) -> anyhow::Result<MethodSpec> {
    MethodSpec::checked(value).map_err(|problems| {
        let lines: Vec<String> = problems.iter().map(words).collect();
        anyhow!(lines.join("\nerror: "))
    })
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory as _, Parser};
    use mimique_solver::{Hold, Method, PARAMETERS};

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: Args,
    }

    fn spec(words: &[&str]) -> anyhow::Result<MethodSpec> {
        let files = ["mimique", "--avatar", "a", "--mocap", "m", "--markers", "k", "--out", "w"];
        let line = Line::try_parse_from(files.iter().chain(words).copied())?;
        method_spec(&line.args)
    }

    #[test]
    fn options_become_the_method_s_parameters() {
        let spec = spec(&[
            "--method",
            "kouadio",
            "--sigma",
            "12mm",
            "--lock",
            "jawOpen,jawLeft",
            "--bounds",
            "jawRight=-1:1",
            "--importance",
            "M03=0.5",
            "--head-lowpass",
            "10",
        ])
        .unwrap();
        assert_eq!(spec.sigma, Some(0.012));
        assert_eq!(spec.locked, ["jawOpen", "jawLeft"]);
        assert_eq!(spec.bounds.get("jawRight"), Some(&[-1.0, 1.0]));
        assert_eq!(spec.importance.get("M03"), Some(&0.5));
        assert_eq!(spec.head_lowpass_hz, Some(10.0));
    }

    #[test]
    fn surface_and_regression_have_their_options() {
        let surface = spec(&[
            "--method",
            "thin-shell-surface",
            "--stiffness",
            "0.1",
            "--hold",
            "nothing",
            "--importance",
            "M03=2",
            "--laplacian",
            "umbrella",
        ])
        .unwrap();
        assert_eq!((surface.stiffness, surface.hold), (Some(0.1), Some(Hold::Nothing)));
        let words = ["--method", "regression", "--basis-vectors", "50", "--noise", "0.02"];
        let learnt = spec(&words).unwrap();
        assert_eq!((learnt.basis_vectors, learnt.noise), (Some(50), Some(0.02)));
    }

    #[test]
    fn settings_of_a_file_are_the_whole_method() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.json");
        let path = file.to_str().unwrap();
        let of = |text: &str, more: &[&str]| {
            std::fs::write(&file, text).unwrap();
            spec(&[&["--settings", path], more].concat())
        };
        let text = r#"{"method": "box", "locked": ["a, b"], "bounds": {"jawOpen": [0.1, 0.5]}}"#;
        let found = of(text, &[]).unwrap();
        assert_eq!(
            (found.method, found.locked.as_slice()),
            (Method::Box, &["a, b".to_owned()][..])
        );
        assert_eq!(found.bounds.get("jawOpen"), Some(&[0.1, 0.5]));
        for (text, part) in [
            (r#"{"method": "box", "alpha": 0.3}"#, "a.json: alpha: 'box' does not use it"),
            (r#"{"method": "box", "lock": []}"#, "a.json: lock: unknown parameter"),
            (
                r#"{"method": "box", "locked": [], "bounds": 1}"#,
                "a.json: bounds: is 1; give an object",
            ),
            (r#"{"method": "box", "bounds": {"a": [1, 0]}}"#, "a.json: bounds.a: is [1, 0]"),
        ] {
            let error = of(text, &[]).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
        let error = of(text, &["--alpha", "0.3"]).unwrap_err().to_string();
        assert!(error.contains("--settings"), "{error}");
        std::fs::remove_file(&file).unwrap();
        let error = spec(&["--settings", path]).unwrap_err().to_string();
        assert!(error.contains("a.json: cannot be read"), "{error}");
    }

    #[test]
    fn what_a_method_does_not_use_is_refused_by_its_option() {
        for (words, option) in [
            (vec!["--method", "box", "--bounds-weight", "1"], "--bounds-weight: "),
            (vec!["--method", "lasso"], "--method: "),
            (vec!["--method", "recorded", "--head-lowpass", "5"], "--head-lowpass: "),
            (vec!["--alpha", "2"], "--alpha: "),
            (vec!["--laplacian", "cotan"], "--laplacian: "),
            (vec!["--importance", "A=1", "--importance", "A=2"], "--importance: "),
            (vec!["--hold", "neck"], "--hold: "),
            (vec!["--inference", "dense"], "--inference: "),
            (vec!["--stiffness", "1"], "--stiffness: "),
            (vec!["--method", "regression", "--basis-vectors", "3"], "--basis-vectors: "),
        ] {
            let error = spec(&words).unwrap_err().to_string();
            assert!(error.starts_with(option), "{words:?}: {error}");
        }
        for words in [["--sigma", "12"], ["--neutral", "60:0"], ["--bounds", "jawOpen"]] {
            assert!(spec(&words).is_err(), "{words:?}");
        }
    }

    #[test]
    fn every_parameter_of_the_table_has_its_option_under_its_heading() {
        let command = Line::command();
        for row in PARAMETERS {
            let option = command.get_arguments().find(|arg| arg.get_long() == Some(&row.option()));
            let option = option.unwrap_or_else(|| panic!("--{}", row.option()));
            assert_eq!(option.get_help_heading(), Some(row.about.group.heading()), "{}", row.key);
            let help = option.get_help().map(ToString::to_string).unwrap_or_default();
            assert!(help.contains(row.help.trim_end_matches('.')), "{help}");
        }
        let options = PARAMETERS.iter().map(Parameter::option);
        // The names that commands of papers and of README have.
        let known = [
            "alpha",
            "kappa",
            "k-s",
            "k-b",
            "laplacian",
            "soft-bounds",
            "s",
            "eps",
            "association",
            "sigma",
            "bounds-weight",
            "unit",
            "stiffness",
            "hold",
            "inference",
            "basis-vectors",
            "length-scale",
            "signal",
            "noise",
            "lock",
            "importance",
            "bounds",
            "head-lowpass",
        ];
        assert!(known.iter().all(|name| options.clone().any(|option| option == *name)));
    }

    #[test]
    fn every_problem_of_the_options_is_said_at_once() {
        let words = ["--alpha", "2", "--kappa", "much", "--sigma", "12mm", "--lock", "a,a"];
        let error = spec(&words).unwrap_err().to_string();
        for part in [
            "--alpha: is 2; give a number between 0 and 1",
            "--kappa: is \"much\"; give a number",
            "--sigma: 'lsts' does not use it",
            "--lock: 1: 'a' is named twice",
        ] {
            assert!(error.contains(part), "{part}: {error}");
        }
        let off = spec(&["--head-lowpass", "none"]).unwrap();
        assert_eq!(off.head_lowpass_hz, Some(0.0));
    }

    #[test]
    fn every_method_has_its_row_in_the_documentation() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut text = std::fs::read_to_string(root.join("README.md")).unwrap();
        for page in std::fs::read_dir(root.join("docs/guide")).unwrap() {
            let page = page.unwrap().path();
            if page.extension().is_some_and(|extension| extension == "md") {
                text += &std::fs::read_to_string(page).unwrap();
            }
        }
        for method in Method::ALL {
            let name = format!("`{method}`");
            let row = text.lines().find(|line| line.starts_with("| `") && line.contains(&name));
            assert!(row.is_some(), "{method}: add its row to the table of methods");
        }
    }
}
