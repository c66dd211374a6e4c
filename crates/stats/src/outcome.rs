//! What a test gives back: a result or a stated impossibility; and values by label.

use serde::{Serialize, Serializer, ser::SerializeMap};

use crate::undefined::Undefined;

/// A test's answer. Serialises as the result's own fields with `status` `ok`, or as `status`
/// `undefined` with `reason`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "status", rename_all = "lowercase")]
pub enum Outcome<T, R = Undefined> {
    /// The numbers.
    Ok(T),
    /// The statistic does not exist for these data, and why.
    Undefined {
        /// Why.
        reason: R,
    },
}

impl<T, R> Outcome<T, R> {
    /// The stated impossibility.
    pub fn undefined(reason: impl Into<R>) -> Self {
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
    pub fn reason(&self) -> Option<&R> {
        match self {
            Self::Ok(_) => None,
            Self::Undefined { reason } => Some(reason),
        }
    }

    /// The same with the numbers changed.
    pub fn map<U>(self, change: impl FnOnce(T) -> U) -> Outcome<U, R> {
        match self {
            Self::Ok(value) => Outcome::Ok(change(value)),
            Self::Undefined { reason } => Outcome::Undefined { reason },
        }
    }

    /// The same with the reason as part of a larger set of reasons.
    pub fn map_reason<S>(self, change: impl FnOnce(R) -> S) -> Outcome<T, S> {
        match self {
            Self::Ok(value) => Outcome::Ok(value),
            Self::Undefined { reason } => Outcome::Undefined { reason: change(reason) },
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
