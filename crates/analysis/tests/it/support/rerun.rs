//! The scripts of a report, run as a reader runs them, and what they find.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use mimique_analysis::Report;
use mimique_stats::Table;

/// Relative difference that two programs may have.
const TOLERANCE: f64 = 1e-8;

/// Writes the files of a report.
pub fn write(report: &Report, name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    for file in &report.files {
        let path = folder.join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.text).unwrap();
    }
    folder
}

/// Key and name of a number, with the number.
pub fn numbers(text: &str) -> HashMap<(String, String), f64> {
    column(text, 2)
}

/// The same with another column; NaN where R has none.
fn column(text: &str, place: usize) -> HashMap<(String, String), f64> {
    let table = Table::parse(text.as_bytes()).unwrap();
    let cell = |row, column| table.cell(row, column).unwrap_or_default().to_owned();
    (0..table.rows())
        .map(|row| ((cell(row, 0), cell(row, 1)), cell(row, place).parse().unwrap_or(f64::NAN)))
        .collect()
}

/// Holds every number of a report against a script's own; how many there are.
pub fn compare(report: &Report, folder: &Path, file: &str) -> usize {
    let own = report.files.iter().find(|file| file.path == "data/numbers.csv").unwrap();
    let (own, allowed) = (numbers(&own.text), column(&own.text, 3));
    let other = numbers(&std::fs::read_to_string(folder.join("data").join(file)).unwrap());
    for (key, value) in &own {
        let again = *other.get(key).unwrap_or_else(|| panic!("{file} has no {key:?}"));
        let size = value.abs().max(again.abs());
        let allowed = (TOLERANCE * size + 1e-12).max(allowed[key]);
        assert!((value - again).abs() <= allowed, "{key:?}: {value} and {again}");
    }
    own.len()
}

/// Runs a script that finds every number again; what it prints.
pub fn run(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}\n{errors}");
    assert!(text.contains(" 0 differ"), "{text}");
    text
}
