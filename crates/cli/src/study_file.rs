//! A study file read and checked, for commands that need no stimuli.

use std::path::Path;

use anyhow::Context as _;
use mimique_study::{Severity, Study};
use serde_json::Value;

use crate::check::check_file;

/// Reads a study file and refuses one with errors, naming the first. Missing stimuli do no harm here.
pub fn load(path: &Path) -> anyhow::Result<(Value, Study)> {
    let file = path.display();
    let report = check_file(path)?;
    let blocking = report
        .issues
        .iter()
        .find(|issue| issue.severity == Severity::Error && issue.code() != "missing-file");
    if let Some(issue) = blocking {
        anyhow::bail!(
            "{file}: {}: {}; {} (`mimique check` lists every problem)",
            issue.place(),
            issue.message(),
            issue.remedy()
        );
    }
    let text = std::fs::read_to_string(path).with_context(|| format!("{file}"))?;
    let value = mimique_study::parse(&text).with_context(|| format!("{file}"))?;
    let study = Study::from_value(&value).with_context(|| format!("{file}"))?;
    Ok((value, study))
}
