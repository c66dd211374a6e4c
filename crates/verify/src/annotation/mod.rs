//! Cases of the annotation of facial motion, in the files of their README: every field that is
//! expected is computed and compared; the README's table says how near.

mod classify;
mod elan;
mod evaluate;
mod markov;
mod motion;

use mimique_annotate::{AnnotateError, Rows};
use serde_json::Value;

use crate::case::{self, Tolerance};
use crate::document::Part;
use crate::files::{FileFamily, Source};
use crate::{Case, VerifyError};

/// The family.
pub(crate) static ANNOTATION: FileFamily = FileFamily {
    name: "annotation",
    files: &[
        ("segmentation.json", motion::segmentation),
        ("features.json", motion::features),
        ("classify/knn.json", classify::neighbours),
        ("classify/svm.json", classify::support_vectors),
        ("classify/logistic.json", classify::logistic),
        ("classify/forest.json", classify::forest),
        ("hmm/given.json", markov::given),
        ("hmm/baum_welch.json", markov::learnt),
        ("hmm/composite.json", markov::joined),
        ("hmm/label_path.json", markov::label_path),
        ("evaluate/expected.json", evaluate::takes),
        ("evaluate/small.json", evaluate::small),
        ("elan/expected.json", elan::words),
    ],
};

/// What of a case is expected, and what was computed for it.
struct Checking<'a> {
    case: Case,
    expected: Part<'a>,
}

impl Checking<'_> {
    /// Compares a member with what was computed; one that the case does not have is not asked for.
    fn member(&mut self, key: &str, by: Tolerance, got: Value) {
        if let Some(expected) = self.expected.find(key) {
            self.case.compare(key, expected.value(), &got, by);
        }
    }

    /// The same of what may have been refused.
    fn outcome<T>(
        &mut self,
        key: &str,
        by: Tolerance,
        outcome: Result<T, AnnotateError>,
        shown: impl FnOnce(T) -> Value,
    ) {
        if let Some(expected) = self.expected.find(key) {
            self.case.compare_outcome(key, expected.value(), outcome, by, shown);
        }
    }

    /// The case, or one that says why nothing of it was computed.
    fn done(self, computed: Result<(), Stop>) -> Result<Case, VerifyError> {
        let mut case = self.case;
        match computed {
            Ok(()) => {}
            Err(Stop::Refused(why)) => case.refused("computed", &why),
            Err(Stop::Unread(error)) => return Err(error),
        }
        Ok(case)
    }
}

/// Why a case goes no further.
enum Stop {
    /// The computation refused, which makes the case wrong.
    Refused(AnnotateError),
    /// The case cannot be read.
    Unread(VerifyError),
}

impl From<AnnotateError> for Stop {
    fn from(why: AnnotateError) -> Self {
        Self::Refused(why)
    }
}

impl From<VerifyError> for Stop {
    fn from(error: VerifyError) -> Self {
        Self::Unread(error)
    }
}

/// A table of rows as cases write it.
fn shown(rows: &Rows) -> Value {
    case::rows(rows.values(), rows.width())
}

/// Rows of a case.
fn rows(part: &Part<'_>) -> Result<Rows, VerifyError> {
    let width = part.first()?.list()?.len();
    Rows::new(part.numbers()?, width).map_err(|_| part.wrong("rows of numbers, all as long"))
}
