//! Cases of exertion, a JSON document each with `input`, `expected` and `tolerance`: a body's work, heart,
//! metabolism, breath, and the face that follows; what is learnt; and inputs that must be refused.

mod body;
mod face;
mod refusals;
mod state;
mod training;

use std::path::{Path, PathBuf};

use mimique_exertion::{ExertionError, Person, PersonSpec};
use mimique_exertion_training::TrainingError;
use serde_json::Value;

use crate::case::Tolerance;
use crate::document::{Document, Part};
use crate::{Case, Family, VerifyError};

/// What computes the values of one document.
type Compute = fn(&Asked<'_>, &mut Answers) -> Result<(), Stop>;

/// The folders of the family and what computes their documents.
const FOLDERS: [(&str, Compute); 10] = [
    ("work", body::work),
    ("heart", state::heart),
    ("metabolism", state::metabolism),
    ("activity", state::activity),
    ("breathing", state::breathing),
    ("svr", face::support_vectors),
    ("train", training::train),
    ("rules", face::rules),
    ("weights", face::weights),
    ("chain", face::chain),
];
/// The folder of inputs that must be refused.
const REFUSALS: &str = "errors";

/// The family.
pub(crate) struct Exertion;

impl Family for Exertion {
    fn name(&self) -> &'static str {
        "exertion"
    }

    fn holds(&self, folder: &Path) -> bool {
        let names = FOLDERS.iter().map(|(name, _)| *name).chain([REFUSALS]);
        names.into_iter().any(|name| folder.join(name).is_dir())
            && !documents(folder).unwrap_or_default().is_empty()
    }

    fn run(&self, folder: &Path, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
        for (name, file) in documents(folder)? {
            let document = Document::read(&file)?;
            let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let Some((_, compute)) = FOLDERS.iter().find(|(own, _)| *own == name) else {
                refusals::refused(&document, folder, &file, &format!("{name}/{stem}"), each)?;
                continue;
            };
            let root = document.root();
            let tolerance = root.get("tolerance")?.number()?;
            let mut answers = Answers {
                case: Case::new(format!("{name}/{stem}")),
                expected: root.get("expected")?,
                by: Tolerance::Relative { share: tolerance, floor: 1.0 },
            };
            let asked = Asked { folder, file: &file, input: root.get("input")? };
            match compute(&asked, &mut answers) {
                Ok(()) => {}
                Err(Stop::Refused(why)) => answers.case.refused("computed", &why),
                Err(Stop::Unread(error)) => return Err(error),
            }
            each(answers.case);
        }
        Ok(())
    }
}

/// The documents of the family's folders, each with its folder's name, in order of their names.
fn documents(folder: &Path) -> Result<Vec<(&'static str, PathBuf)>, VerifyError> {
    let mut all = Vec::new();
    for name in FOLDERS.iter().map(|(name, _)| *name).chain([REFUSALS]) {
        let own = folder.join(name);
        if !own.is_dir() {
            continue;
        }
        let unread = |error: std::io::Error| VerifyError::read(&own, &error);
        let mut files = Vec::new();
        for entry in std::fs::read_dir(&own).map_err(unread)? {
            let path = entry.map_err(unread)?.path();
            if path.extension().is_some_and(|ending| ending == "json") {
                files.push(path);
            }
        }
        files.sort();
        all.extend(files.into_iter().map(|file| (name, file)));
    }
    Ok(all)
}

/// What a document asks.
struct Asked<'a> {
    /// The folder of the family.
    folder: &'a Path,
    /// The document's file.
    file: &'a Path,
    input: Part<'a>,
}

impl Asked<'_> {
    /// The person of a case: nobody in particular where it names none.
    fn person(&self) -> Result<Person, Stop> {
        let none = Value::Object(serde_json::Map::new());
        let given = self.input.find("person").map_or(&none, |part| part.value());
        Ok(Person::new(PersonSpec::of_json(given)?)?)
    }

    /// Numbers of a member.
    fn numbers(&self, key: &str) -> Result<Vec<f64>, VerifyError> {
        self.input.get(key)?.numbers()
    }

    /// A number of a member.
    fn number(&self, key: &str) -> Result<f64, VerifyError> {
        self.input.get(key)?.number()
    }
}

/// What a document expects, and what was computed.
struct Answers<'a> {
    case: Case,
    expected: Part<'a>,
    by: Tolerance,
}

impl Answers<'_> {
    /// Compares a member with what was computed; one that the case does not have is not asked for.
    fn member(&mut self, key: &str, got: &Value) {
        if let Some(expected) = self.expected.find(key) {
            self.case.compare(key, expected.value(), got, self.by);
        }
    }

    /// The same of numbers.
    fn numbers(&mut self, key: &str, got: &[f64]) {
        self.member(key, &crate::case::numbers(got));
    }

    /// The same of one number.
    fn number(&mut self, key: &str, got: f64) {
        self.member(key, &crate::case::number(got));
    }
}

/// Why a case goes no further.
enum Stop {
    /// The computation refused, which makes the case wrong.
    Refused(TrainingError),
    /// The case cannot be read.
    Unread(VerifyError),
}

impl From<ExertionError> for Stop {
    fn from(why: ExertionError) -> Self {
        Self::Refused(why.into())
    }
}

impl From<TrainingError> for Stop {
    fn from(why: TrainingError) -> Self {
        Self::Refused(why)
    }
}

impl From<VerifyError> for Stop {
    fn from(error: VerifyError) -> Self {
        Self::Unread(error)
    }
}

/// Rows of numbers.
fn rows(part: &Part<'_>) -> Result<Vec<Vec<f64>>, VerifyError> {
    part.list()?.iter().map(Part::numbers).collect()
}
