//! Borders of a take and what lies between them (thesis 4.4.2).

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::peaks::peaks;
use super::{Activity, Literal};

/// Which peaks of the energy are borders.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BorderRule {
    /// Peaks of its root that stand out and fall on both sides: one border a change of the face.
    #[default]
    Peaks,
    /// The thesis' wording: several borders a change.
    Literal(Literal),
}

impl BorderRule {
    /// The borders, frames in ascending order.
    pub fn borders(&self, activity: &Activity, rate_hz: f64) -> Vec<usize> {
        match self {
            Self::Peaks => peaks(&activity.root(), rate_hz),
            Self::Literal(literal) => literal.borders(&activity.energy, rate_hz),
        }
    }
}

/// What lies between 0, the borders and the end; empty ones left out.
pub fn stretches(borders: &[usize], frames: usize) -> Vec<Range<usize>> {
    let mut start = 0;
    let mut found = Vec::with_capacity(borders.len() + 1);
    for end in borders.iter().copied().filter(|&b| b < frames).chain([frames]) {
        if end > start {
            found.push(start..end);
            start = end;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_cover_the_take_once() {
        assert_eq!(stretches(&[3, 3, 7, 12], 10), [0..3, 3..7, 7..10]);
        assert_eq!(stretches(&[], 4), [Range { start: 0, end: 4 }]);
        assert!(stretches(&[], 0).is_empty());
    }
}
