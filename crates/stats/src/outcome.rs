//! What a test gives back: a result, a stated impossibility, or a refusal of its input.

use serde::{Serialize, Serializer, ser::SerializeMap};

/// Why an input cannot be tested at all. Names the column and what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// A column has too few levels to compare.
    #[error(
        "column \"{column}\": {found} among the {rows} rows used, at least {needed} are needed; {remedy}"
    )]
    TooFewLevels {
        /// The column.
        column: String,
        /// What was found, e.g. `only one level ("a")`.
        found: String,
        /// Rows left after dropping missing values.
        rows: usize,
        /// Levels needed.
        needed: usize,
        /// What to do.
        remedy: String,
    },
    /// No row has a value in every used column.
    #[error(
        "column \"{column}\": no row is left after dropping {dropped} with missing values; check the column's name and its cells"
    )]
    NoRows {
        /// The first used column.
        column: String,
        /// Rows dropped.
        dropped: usize,
    },
    /// Anything else that a column can have wrong.
    #[error("column \"{column}\": {problem}; {remedy}")]
    Column {
        /// The column.
        column: String,
        /// What is wrong, with the value.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// Options that do not go together.
    #[error("{problem}; {remedy}")]
    Options {
        /// What is wrong.
        problem: String,
        /// What to do.
        remedy: String,
    },
}

impl Refusal {
    /// A problem of one column.
    pub fn column(
        column: impl Into<String>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::Column { column: column.into(), problem: problem.into(), remedy: remedy.into() }
    }
}

/// A test's answer. Serialises as the result's own fields with `status` `ok`, or as `status`
/// `undefined` with `reason`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "status", rename_all = "lowercase")]
pub enum Outcome<T> {
    /// The numbers.
    Ok(T),
    /// The statistic does not exist for these data, and why.
    Undefined {
        /// Why.
        reason: String,
    },
}

impl<T> Outcome<T> {
    /// The stated impossibility.
    pub fn undefined(reason: impl Into<String>) -> Self {
        Self::Undefined { reason: reason.into() }
    }

    /// The numbers, if there are any.
    pub fn ok(self) -> Option<T> {
        match self {
            Self::Ok(value) => Some(value),
            Self::Undefined { .. } => None,
        }
    }

    /// Why there are none.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Ok(_) => None,
            Self::Undefined { reason } => Some(reason),
        }
    }

    /// The same with the numbers changed.
    pub fn map<U>(self, change: impl FnOnce(T) -> U) -> Outcome<U> {
        match self {
            Self::Ok(value) => Outcome::Ok(change(value)),
            Self::Undefined { reason } => Outcome::Undefined { reason },
        }
    }
}

/// Values by label, in a stated order; serialises as an object in that order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Labelled<T>(pub Vec<(String, T)>);

impl<T> Labelled<T> {
    /// Joins labels and values of equal number.
    pub fn zip(labels: &[String], values: impl IntoIterator<Item = T>) -> Self {
        Self(labels.iter().cloned().zip(values).collect())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The value of a label.
    pub fn get(&self, label: &str) -> Option<&T> {
        self.0.iter().find(|(name, _)| name == label).map(|(_, value)| value)
    }

    /// Labels and values in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &T)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value))
    }
}

impl<T: Serialize> Serialize for Labelled<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (label, value) in &self.0 {
            map.serialize_entry(label, value)?;
        }
        map.end()
    }
}
