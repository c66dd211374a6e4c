//! What is wrong with numbers handed in, as codes with values; words are made at the edge.

use mimique_mocap::FilterError;

/// Why something cannot be learnt, applied or scored.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AnnotateError {
    /// The low-pass does not fit the rate.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// A table's length is no multiple of its width, or its width is 0.
    #[error("table: {values} numbers in rows of {width}; give whole rows of one number at least")]
    Shape {
        /// Numbers.
        values: usize,
        /// Numbers a row.
        width: usize,
    },
    /// A number is missing or infinite.
    #[error("row {row}, column {column}: {value} is no number; bridge or leave out such rows")]
    NotFinite {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The value.
        value: f64,
    },
    /// Two lists that belong together differ in length.
    #[error("{what}: {found} where {expected} are needed; give as many")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// A label's index is not below the number of labels.
    #[error("row {row}: label {label} of {labels}; labels are counted from 0")]
    Label {
        /// Row, from 0.
        row: usize,
        /// Index of the label.
        label: usize,
        /// Labels.
        labels: usize,
    },
    /// Fewer than two labels have rows.
    #[error("labels with rows: {found}; give examples of two labels at least")]
    OneLabel {
        /// Labels with rows.
        found: usize,
    },
    /// A setting is out of range.
    #[error("{setting} {value}: give a number {range}")]
    Setting {
        /// Its name.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// An interval is empty or reaches beyond the take, or begins before its predecessor's end.
    #[error("frames {first}:{end} of {frames}; give intervals in order, apart and inside the take")]
    Interval {
        /// First frame.
        first: usize,
        /// One past the last.
        end: usize,
        /// Frames of the take.
        frames: usize,
    },
    /// No path of the model gives the sequence.
    #[error(
        "sequence {sequence}: the model cannot give it; make it longer than the chain of states"
    )]
    Impossible {
        /// Which sequence, from 0.
        sequence: usize,
    },
    /// More than the limits allow.
    #[error("{what}: {found}, at most {most}; thin the training frames")]
    Limit {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: usize,
    },
    /// An optimiser stopped before it reached its tolerance.
    #[error(
        "{method}: residual {residual} after {steps} steps; lower C or raise the limit of steps"
    )]
    NotConverged {
        /// What was fitted.
        method: &'static str,
        /// Steps taken.
        steps: usize,
        /// How far from the optimality conditions it is.
        residual: f64,
    },
    /// A model's version is not one that is read.
    #[error("model of version {version}: versions up to {known} are read; learn it again")]
    Version {
        /// Version of the model.
        version: u32,
        /// Highest version known.
        known: u32,
    },
    /// A take's rate is not that of the others, or of the model.
    #[error("take of {} Hz among {} Hz; bring all takes to one rate", shown(*found), shown(*expected))]
    Rate {
        /// Its rate, Hz.
        found: f64,
        /// The rate of the others, Hz.
        expected: f64,
    },
    /// A label has no frames to learn from.
    #[error("label {label}: no frames of it; mark some, or leave the label out")]
    NoExamples {
        /// Index of the label.
        label: usize,
    },
    /// A label stands in too few takes to be evaluated.
    #[error("label {label}: in {takes} takes; mark it in two at least, or leave it out")]
    FewTakes {
        /// Index of the label.
        label: usize,
        /// Takes that have it.
        takes: usize,
    },
    /// A label stands in no take that is left to learn from.
    #[error(
        "label {label}: in take {take}, but in none that is not held out with it; mark it in others, \
         or hold out otherwise"
    )]
    HeldOut {
        /// Index of the label.
        label: usize,
        /// Index of the take.
        take: usize,
    },
    /// No take of one expression, which the short paper's way of learning needs.
    #[error(
        "no take shows one expression beside the neutral face; give such takes, or learn from labels"
    )]
    NoneIsolated,
    /// A model was changed since it was written.
    #[error("model: its hash is not that of what it holds; learn it again, or take the file anew")]
    Hash,
    /// A take's shapes are not the model's.
    #[error("shape {shape:?} is missing; give takes with the shapes of the model")]
    Shapes {
        /// A shape of the model that the take lacks.
        shape: String,
    },
    /// Parts of a model contradict each other.
    #[error("model: its {part} do not fit its labels and shapes; learn it again")]
    Unfit {
        /// Which part.
        part: &'static str,
    },
    /// A model's text is not one.
    #[error("model: line {line}, column {column}; learn it again")]
    Json {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
    },
}

/// A rate as people read it: it is told by times that files round.
fn shown(rate_hz: f64) -> f64 {
    (rate_hz * 1e3).round() / 1e3
}

/// Refuses a setting that is not above 0 and finite.
pub(crate) fn above_zero(setting: &'static str, value: f64) -> Result<(), AnnotateError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(AnnotateError::Setting { setting, value, range: "above 0" })
}

/// Refuses a list that has not as many members as another.
pub(crate) fn as_many(
    what: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), AnnotateError> {
    if found == expected { Ok(()) } else { Err(AnnotateError::Count { what, found, expected }) }
}

/// Refuses more than a limit allows.
pub(crate) fn at_most(what: &'static str, found: usize, most: usize) -> Result<(), AnnotateError> {
    if found <= most { Ok(()) } else { Err(AnnotateError::Limit { what, found, most }) }
}

/// Rates are told by the times of frames, which files round: a thousandth of each other is the same.
pub(crate) fn same_rate(found: f64, expected: f64) -> Result<(), AnnotateError> {
    if (found - expected).abs() <= 1e-3 * expected {
        return Ok(());
    }
    Err(AnnotateError::Rate { found, expected })
}
