//! Figures of rounds, printed and written into their documents.

use anyhow::{Context, Result};

use crate::process::{root, say};

/// The least and the greatest of positive figures.
pub fn extremes(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::MAX, 0.0], |[least, most], &value| [least.min(value), most.max(value)])
}

/// Median.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) }
}

/// Prints a table.
#[expect(clippy::print_stdout, reason = "xtask talks to the person at the terminal")]
pub fn print(table: &str) {
    println!("{table}");
}

/// Writes the figures between the marks of a document.
pub fn record(document: &str, figures: &str) -> Result<()> {
    let file = root().join(document);
    let (start, end) = ("<!-- figures -->\n", "<!-- end of figures -->");
    let text = std::fs::read_to_string(&file).with_context(|| file.display().to_string())?;
    let parts =
        text.split_once(start).and_then(|(head, rest)| Some((head, rest.split_once(end)?.1)));
    let (head, tail) = parts.with_context(|| format!("{document} has lost its marks"))?;
    std::fs::write(&file, format!("{head}{start}{figures}{end}{tail}"))?;
    say(&format!("recorded: {}", file.display()));
    Ok(())
}
