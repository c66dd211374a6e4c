//! Why nothing can be learnt, as codes with values.

use mimique_exertion::ExertionError;

/// Why a model cannot be trained.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrainingError {
    /// A number of the chain is wrong.
    #[error(transparent)]
    Exertion(#[from] ExertionError),
    /// Rows and targets do not fit together.
    #[error("{what}: {found} where {expected} are needed; give as many")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// There are too few or too many rows.
    #[error(
        "rows: {found}; give {least} to {most} (--every sets how many seconds lie between two)"
    )]
    Rows {
        /// How many there are.
        found: usize,
        /// The least that is learnt from.
        least: usize,
        /// The most.
        most: usize,
    },
    /// A number is none.
    #[error("row {row}: no number; leave it out")]
    NotANumber {
        /// The row, from 0.
        row: usize,
    },
    /// A setting is out of its range.
    #[error("{setting} {value}: give a number {range}")]
    Setting {
        /// Its name.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// The solver stopped before the optimality conditions held.
    #[error(
        "C {c:e}, gamma {gamma:e}: the optimality conditions are missed by {violation:.2e} after ten million \
         steps; take a smaller C"
    )]
    NotConverged {
        /// C.
        c: f64,
        /// Gamma.
        gamma: f64,
        /// How far the conditions are missed.
        violation: f64,
    },
    /// A curve never moves in the takes of a person.
    #[error(
        "{person}: {curve} never moves in the weights; give a take in which it does, or leave the person out"
    )]
    Still {
        /// Who.
        person: String,
        /// The curve.
        curve: &'static str,
    },
    /// No pair of the grid could be computed.
    #[error("{curve}: no pair of C and gamma could be computed; give a grid with smaller C")]
    NoPair {
        /// The curve.
        curve: &'static str,
    },
}
