//! `mimique verify DIR`: cases with answers, what they expect beside what this installation computes.

use std::io::Write as _;
use std::path::PathBuf;

use mimique_locale::counted;
use mimique_verify::{Case, Checked, verify};

/// Wrong values of a case that the text shows; `--json` has all.
const SHOWN: usize = 10;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Folder of cases, or a folder of such folders
    folder: PathBuf,
}

/// Some values are wrong: everything was said, and the exit code is 1.
#[derive(Debug, thiserror::Error)]
#[error("")]
pub struct Wrong;

/// What `--json` prints.
#[derive(serde::Serialize)]
struct Told {
    cases: Vec<Case>,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let mut cases = Vec::new();
    let (mut wrong, mut values, mut wrong_values) = (0, 0, 0);
    let mut unwritten = None;
    let total = verify(&args.folder, &mut |case| {
        wrong += usize::from(!case.right);
        values += case.values.len();
        wrong_values += case.wrong().count();
        if json {
            cases.push(case);
        } else if unwritten.is_none() {
            unwritten = out.write_all(lines(&case).as_bytes()).err();
        }
    })?;
    if let Some(error) = unwritten {
        return Err(error.into());
    }
    if json {
        serde_json::to_writer(&mut out, &Told { cases })?;
        writeln!(out)?;
    } else if wrong == 0 {
        writeln!(out, "{}, {}: all right", counted(total, "case"), counted(values, "value"))?;
    } else {
        let (cases, values) = (counted(total, "case"), counted(values, "value"));
        writeln!(out, "{cases}, {wrong} wrong; {values}, {wrong_values} wrong")?;
    }
    if wrong > 0 { Err(Wrong.into()) } else { Ok(()) }
}

/// A case's line, and those of its wrong values.
fn lines(case: &Case) -> String {
    let count = case.values.len();
    if case.right {
        return format!("right  {}  {}\n", case.case, counted(count, "value"));
    }
    let wrong: Vec<&Checked> = case.wrong().collect();
    let mut text =
        format!("wrong  {}  {} of {}\n", case.case, wrong.len(), counted(count, "value"));
    for value in wrong.iter().take(SHOWN) {
        text += &format!(
            "         {}: {} where {} is expected, within {:.1e}\n",
            value.field, value.got, value.expected, value.tolerance
        );
    }
    if wrong.len() > SHOWN {
        text += &format!("         and {} more; --json lists all\n", wrong.len() - SHOWN);
    }
    text
}
