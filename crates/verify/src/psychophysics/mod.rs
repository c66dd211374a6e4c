//! Cases of paired comparisons and psychophysics: each `NAME.expected.json` names its kind, its tables, what the
//! analysis is told, what it must find, and how nearly.

mod comparisons;
mod levels;
mod mixed_model;
mod motion;
mod ratings;
mod tolerance;

use std::fmt::Display;
use std::path::{Path, PathBuf};

use mimique_stats::{Outcome, Table};
use serde::Serialize;
use serde_json::{Value, json};

use crate::document::{Document, Part};
use crate::{Case, Family, VerifyError};
use tolerance::Tolerances;

/// How the name of a case's file ends.
const ENDING: &str = ".expected.json";

/// Computes what a case expects, under the same names.
type Compute = fn(&Given<'_>) -> Result<Value, Stop>;

/// The kinds of cases and what computes them.
const KINDS: [(&str, Compute); 16] = [
    ("bradley_terry", comparisons::bradley_terry),
    ("thurstone_v", comparisons::thurstone),
    ("consistency", comparisons::consistency),
    ("active_pairs", comparisons::active_pairs),
    ("questplus", levels::quest_plus),
    ("staircase", levels::staircase),
    ("psychometric", levels::psychometric),
    ("mlds", levels::difference_scale),
    ("signal_detection", ratings::detection),
    ("equivalence", ratings::equivalence),
    ("icc", ratings::intraclass_correlation),
    ("cronbach_alpha", ratings::cronbach),
    ("krippendorff_alpha", ratings::krippendorff),
    ("multi_stimulus", ratings::panel),
    ("motion_measures", motion::motion),
    ("clmm", mixed_model::clmm),
];

/// What the computation of a case is given.
struct Given<'a> {
    folder: &'a Path,
    /// The names of its tables.
    input: Vec<&'a str>,
    options: Part<'a>,
    expected: Part<'a>,
}

/// Why a case goes no further.
enum Stop {
    /// The computation was refused, or has no result, which makes the case wrong.
    Refused(String),
    /// The case cannot be read.
    Unread(VerifyError),
}

impl Stop {
    /// What the library says of the data.
    fn refused(why: &dyn Display) -> Self {
        Self::Refused(why.to_string())
    }
}

impl From<VerifyError> for Stop {
    fn from(error: VerifyError) -> Self {
        Self::Unread(error)
    }
}

impl From<mimique_stats::Refusal> for Stop {
    fn from(why: mimique_stats::Refusal) -> Self {
        Self::refused(&why)
    }
}

/// The numbers of an outcome; what is undefined makes the case wrong, with its reason.
fn defined<T>(outcome: Outcome<T>) -> Result<T, Stop> {
    match outcome {
        Outcome::Ok(found) => Ok(found),
        Outcome::Undefined { reason } => Err(Stop::refused(&reason)),
    }
}

/// As cases write it: what is undefined is null.
fn or_null<T: Serialize>(outcome: &Outcome<T>) -> Value {
    match outcome {
        Outcome::Ok(found) => json!(found),
        Outcome::Undefined { .. } => Value::Null,
    }
}

impl Given<'_> {
    /// One of the tables.
    fn table(&self, place: usize) -> Result<Table, Stop> {
        let name = self.input.get(place).ok_or_else(|| self.options.wrong("more tables"))?;
        let file = self.folder.join(name);
        let bytes = std::fs::read(&file).map_err(|error| VerifyError::read(&file, &error))?;
        Ok(Table::parse(bytes).map_err(|error| VerifyError::file(&file, &error))?)
    }

    /// Texts of the options; none where there are none.
    fn texts(&self, option: &str) -> Result<Vec<String>, Stop> {
        let Some(part) = self.options.find(option) else { return Ok(Vec::new()) };
        Ok(part.texts()?.into_iter().map(str::to_owned).collect())
    }

    /// Whether an option is set; not where it is absent.
    fn flag(&self, option: &str) -> Option<bool> {
        self.options.find(option)?.value().as_bool()
    }
}

/// The family.
pub(crate) struct Psychophysics;

impl Family for Psychophysics {
    fn name(&self) -> &'static str {
        "psychophysics"
    }

    fn holds(&self, folder: &Path) -> bool {
        files(folder).is_ok_and(|files| !files.is_empty())
    }

    fn run(&self, folder: &Path, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
        for file in files(folder)? {
            each(case(folder, &file)?);
        }
        Ok(())
    }
}

/// The files of cases, by name.
fn files(folder: &Path) -> Result<Vec<PathBuf>, VerifyError> {
    let unread = |error: std::io::Error| VerifyError::read(folder, &error);
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        if path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(ENDING)) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn case(folder: &Path, file: &Path) -> Result<Case, VerifyError> {
    let document = Document::read(file)?;
    let root = document.root();
    let name = root.get("case")?.text()?;
    let kind = root.get("kind")?.text()?;
    let mut case = Case::new(name);
    let Some((_, compute)) = KINDS.iter().find(|(known, _)| *known == kind) else {
        case.refused("kind", &format!("{kind} is no kind that is known"));
        return Ok(case);
    };
    let expected = root.get("expected")?;
    let mut tolerances = Tolerances::read(&root.get("tolerance")?)?;
    if kind == "clmm" {
        // z is an estimate by its error, neither of which R gives to the digits that hold without a name.
        tolerances.name_as("z", "statistic");
    }
    let given = Given {
        folder,
        input: root.get("input")?.texts()?,
        options: root.get("options")?,
        expected: expected.clone(),
    };
    match compute(&given) {
        Ok(got) => tolerances.compare(&mut case, expected.value(), &got),
        Err(Stop::Refused(why)) => case.refused("computed", &why),
        Err(Stop::Unread(error)) => return Err(error),
    }
    Ok(case)
}
