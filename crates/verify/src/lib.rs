//! Cases with answers: what they expect beside what this installation computes.
//!
//! A family of cases is a file or a folder here and a line of [`FAMILIES`]: it recognises a folder,
//! reads its cases and computes their values. [`verify`] looks for families in a folder and hands out
//! each case when it is computed.
//!
//! | family | a folder of it holds | computed by |
//! |---|---|---|
//! | statistics | `expected.json` with `cases` | `mimique-stats` |
//! | solver | `toy.json`, `operators.json`, `frames/` | `mimique-solver`, `mimique-stimulus` |
//! | annotation | `segmentation.json`, `features.json`, `classify/`, `hmm/`, `evaluate/`, `elan/` | `mimique-annotate` |
//! | layouts | `kmeans_*.json`, `greedy_*.json`, `avatar_*.json` … | `mimique-solver` |
//! | exertion | `work/`, `heart/`, `metabolism/`, `activity/`, `breathing/`, `svr/`, `train/`, `rules/`, `weights/`, `chain/`, `errors/` | `mimique-exertion`, `mimique-exertion-training` |
//! | psychophysics | `NAME.expected.json` with `kind` | `mimique-stats`, `mimique-adaptive` |
//!
//! A number that is wrong is a wrong [`Case`]; a file that cannot be read is a [`VerifyError`]. Names,
//! values and, where a case has them, tolerances come from the files.
//!
//! # Example
//!
//! ```
//! use std::fs::write;
//!
//! let folder = std::env::temp_dir().join(format!("mimique-verify-{}", std::process::id()));
//! std::fs::create_dir_all(&folder)?;
//! write(folder.join("data.csv"), "y\n1\n2\n3\n")?;
//! write(
//!     folder.join("expected.json"),
//!     r#"{"cases": [{"id": "mean", "test": "descriptives", "file": "data.csv",
//!         "columns": {"response": "y"}, "expected": {"mean": 2}}]}"#,
//! )?;
//!
//! let mut right = Vec::new();
//! let count = mimique_verify::verify(&folder, &mut |case| right.push(case.right))?;
//! assert_eq!((count, right), (1, vec![true]));
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod annotation;
mod case;
mod document;
mod error;
mod exertion;
mod files;
mod layouts;
mod psychophysics;
mod solver;
mod statistics;

use std::path::Path;

pub use case::{Case, Checked};
pub use error::VerifyError;

/// A kind of cases that folders hold.
pub trait Family: Sync {
    /// What it is called.
    fn name(&self) -> &'static str;

    /// Whether a folder is one of its own, told by the files in it.
    fn holds(&self, folder: &Path) -> bool;

    /// Reads the cases of a folder, computes each and hands it out.
    ///
    /// # Errors
    /// [`VerifyError`] for a file that cannot be read or is not what its README says.
    fn run(&self, folder: &Path, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError>;
}

/// Every family.
pub static FAMILIES: [&dyn Family; 6] = [
    &statistics::Statistics,
    &solver::Solver,
    &annotation::ANNOTATION,
    &exertion::Exertion,
    &layouts::LAYOUTS,
    &psychophysics::Psychophysics,
];

/// How many folders below the one that is named are looked into.
const DEPTH: usize = 3;

/// Computes all cases of a folder, or of the folders in it, and hands out each. Gives how many.
///
/// # Errors
/// [`VerifyError`]: files that cannot be read, or [`VerifyError::NoCase`].
pub fn verify(folder: &Path, each: &mut dyn FnMut(Case)) -> Result<usize, VerifyError> {
    if folder.is_file() {
        return Err(VerifyError::NoFolder { file: folder.to_owned() });
    }
    let mut count = 0;
    search(folder, "", DEPTH, &mut |case| {
        count += 1;
        each(case);
    })?;
    if count == 0 {
        let families = FAMILIES.iter().map(|family| family.name()).collect();
        return Err(VerifyError::NoCase { folder: folder.to_owned(), families });
    }
    Ok(count)
}

/// Runs a folder that is a family's, else looks into the folders in it, by name.
fn search(
    folder: &Path,
    name: &str,
    depth: usize,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    if let Some(family) = FAMILIES.iter().find(|family| family.holds(folder)) {
        return family.run(folder, &mut |case| each(case.within(name)));
    }
    let unread = |error: std::io::Error| VerifyError::read(folder, &error);
    let mut below = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        if path.is_dir() {
            below.push(path);
        }
    }
    if depth == 0 {
        return Ok(());
    }
    below.sort();
    for path in below {
        let own = path.file_name().unwrap_or_default().to_string_lossy();
        let name = if name.is_empty() { own.into_owned() } else { format!("{name}/{own}") };
        search(&path, &name, depth - 1, each)?;
    }
    Ok(())
}
