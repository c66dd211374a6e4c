//! A folder with a report: whole, or left as it was. Beside each figure's SVG stands its PDF.
//!
//! Everything is written into a folder beside it and renamed at the end.

use std::path::Path;

use anyhow::{Context, bail};
use mimique_report::ReportFile;
use mimique_storage::durable_file;

/// Writes the files of a report into `out`, in the place of an earlier one, and gives their paths. A figure that
/// cannot be a PDF is named on standard error.
///
/// # Errors
/// A folder that holds something else than a report, and what the operating system says.
pub fn write(files: &[ReportFile], out: &Path) -> anyhow::Result<Vec<String>> {
    check(out)?;
    let all = with_pdfs(files);
    let parent = out.parent().filter(|parent| !parent.as_os_str().is_empty());
    std::fs::create_dir_all(parent.unwrap_or(Path::new(".")))?;
    durable_file::write_folder(out, |folder| write_files(&all, folder))?;
    Ok(all.into_iter().map(|(path, _)| path).collect())
}

/// The files of a report by their paths, the PDF of each figure behind them.
pub fn with_pdfs(files: &[ReportFile]) -> Vec<(String, Vec<u8>)> {
    mimique_figure_pdf::with_pdfs(files, |told| eprintln!("warning: {told}"))
}

/// Refuses a folder that holds something else than a report.
///
/// # Errors
/// As [`write()`].
pub fn check(out: &Path) -> anyhow::Result<()> {
    if out.exists() && !is_replaceable(out)? {
        bail!("the folder holds something else than a report; give an empty or a new folder");
    }
    out.file_name().context("this is no name of a folder; give one")?;
    Ok(())
}

/// A remark as a sentence of a report.
pub fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}

fn write_files(files: &[(String, Vec<u8>)], folder: &Path) -> anyhow::Result<()> {
    for (name, bytes) in files {
        let path = folder.join(name);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent)?;
        }
        std::fs::write(&path, bytes).with_context(|| name.clone())?;
    }
    Ok(())
}

/// An empty folder, or one with an earlier report.
fn is_replaceable(out: &Path) -> anyhow::Result<bool> {
    if !out.is_dir() {
        return Ok(false);
    }
    let empty = std::fs::read_dir(out)?.next().is_none();
    Ok(empty || (out.join("report.html").is_file() && out.join("results.json").is_file()))
}
