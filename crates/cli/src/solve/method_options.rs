//! The method and its parameters, from the options or from a file of settings.

use std::path::Path;
use std::str::FromStr as _;

use anyhow::{Context as _, anyhow};
use mimique_solver::{Method, MethodSpec};
use serde_json::json;

use super::args::Args;
use super::values::unique;

/// The method that the options name, checked.
pub(super) fn method_spec(args: &Args) -> anyhow::Result<MethodSpec> {
    if let Some(file) = &args.settings {
        return settings(file);
    }
    let option =
        |e: mimique_solver::SpecError| anyhow!("--{}: {}", option_name(&e.field), e.message);
    let method = Method::from_str(&args.method).map_err(option)?;
    let mut spec = MethodSpec {
        alpha: args.alpha,
        kappa: args.kappa,
        k_s: args.k_s,
        k_b: args.k_b,
        laplacian: None,
        association: None,
        soft_bounds: args.soft_bounds.map(|p| p.0),
        s: args.s,
        eps: args.eps,
        sigma: args.sigma.map(|l| l.0),
        bounds_weight: args.bounds_weight,
        unit: None,
        stiffness: args.stiffness,
        basis_vectors: args.basis_vectors,
        length_scale: args.length_scale,
        signal: args.signal,
        noise: args.noise,
        locked: args.lock.clone(),
        importance: unique("--importance", &args.importance)?,
        bounds: unique("--bounds", &args.bounds)?.into_iter().map(|(k, p)| (k, p.0)).collect(),
        head_lowpass_hz: args.head_lowpass,
        ..MethodSpec::new(method)
    };
    if let Some(word) = &args.laplacian {
        spec.laplacian = Some(serde_json::from_value(json!(word)).map_err(|_| {
            anyhow!("--laplacian: {word:?}; use uniform, umbrella, cotan-clamped or cotan-literal")
        })?);
    }
    if let Some(word) = &args.hold {
        spec.hold = Some(
            serde_json::from_value(json!(word))
                .map_err(|_| anyhow!("--hold: {word:?}; use unmoved or nothing"))?,
        );
    }
    if let Some(word) = &args.inference {
        spec.inference = Some(
            serde_json::from_value(json!(word))
                .map_err(|_| anyhow!("--inference: {word:?}; use sparse or exact"))?,
        );
    }
    if let Some(word) = &args.association {
        spec.association = Some(
            serde_json::from_value(json!(word))
                .map_err(|_| anyhow!("--association: {word:?}; use points, zones or triangles"))?,
        );
    }
    if let Some(word) = &args.unit {
        spec.unit = Some(
            serde_json::from_value(json!(word))
                .map_err(|_| anyhow!("--unit: {word:?}; use m, cm or mm"))?,
        );
    }
    spec.validate().map_err(option)?;
    Ok(spec)
}

/// The method of a file of settings, checked.
fn settings(file: &Path) -> anyhow::Result<MethodSpec> {
    let text = std::fs::read_to_string(file)
        .with_context(|| format!("{}: cannot be read; check the path", file.display()))?;
    let spec: MethodSpec = serde_json::from_str(&text)
        .map_err(|e| anyhow!("{}: {e}; save the settings again in the studio", file.display()))?;
    spec.validate().map_err(|e| anyhow!("{}: {e}", file.display()))?;
    Ok(spec)
}

/// The command line's name of a field of the method: `headLowpassHz` is `head-lowpass`.
fn option_name(field: &str) -> String {
    let field = field.split('.').next().unwrap_or(field);
    match field {
        "headLowpassHz" => "head-lowpass".to_owned(),
        "locked" => "lock".to_owned(),
        _ => field
            .chars()
            .flat_map(|c| {
                let dash = c.is_ascii_uppercase().then_some('-');
                dash.into_iter().chain(c.to_lowercase())
            })
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use mimique_solver::Hold;

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
            (r#"{"method": "box", "lock": []}"#, "a.json: unknown field `lock`"),
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
}
