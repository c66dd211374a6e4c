//! What values a parameter may have.

use std::fmt;

use serde::Serialize;

/// The numbers that a parameter may be; both ends of an interval obey it, too.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Range {
    /// The least number, or what the number lies above.
    pub low: f64,
    /// Whether it may be `low` itself.
    pub low_included: bool,
    /// The largest number, included.
    pub high: f64,
}

/// What a parameter is in JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", content = "words", rename_all = "kebab-case")]
pub enum Kind {
    /// A number.
    Number,
    /// A whole number of 0 or more.
    WholeNumber,
    /// Two numbers, the lower one first.
    Interval,
    /// One of these words.
    Word(&'static [&'static str]),
    /// A list of names.
    Names,
    /// An object with a number for each name.
    NumberByName,
    /// An object with two numbers for each name, the lower one first.
    IntervalByName,
}

/// In what a number is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A number without a unit.
    Ratio,
    /// Metres.
    Metres,
    /// Hertz.
    Hertz,
    /// Milliseconds.
    Milliseconds,
}

/// Whose names a list or an object has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum NamesOf {
    /// Blendshapes of the avatar.
    Shapes,
    /// Markers on the face.
    Markers,
}

impl Range {
    /// Every finite number.
    pub const ANY: Range =
        Range { low: f64::NEG_INFINITY, low_included: false, high: f64::INFINITY };

    /// From `low` to `high`, both included.
    pub const fn between(low: f64, high: f64) -> Range {
        Range { low, low_included: true, high }
    }

    /// `low` or more.
    pub const fn at_least(low: f64) -> Range {
        Range { low, low_included: true, high: f64::INFINITY }
    }

    /// More than `low`.
    pub const fn above(low: f64) -> Range {
        Range { low, low_included: false, high: f64::INFINITY }
    }

    /// More than `low` and at most `high`.
    pub const fn above_up_to(low: f64, high: f64) -> Range {
        Range { low, low_included: false, high }
    }

    /// Whether a number is finite and in the range.
    pub fn contains(&self, number: f64) -> bool {
        let above = if self.low_included { number >= self.low } else { number > self.low };
        number.is_finite() && above && number <= self.high
    }
}

/// `between 0 and 1`, `above 0 and at most 3`, `0 or more`; nothing for every number.
impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Range { low, low_included, high } = *self;
        match (low.is_finite(), high.is_finite()) {
            (true, true) if low_included => write!(f, "between {low} and {high}"),
            (true, true) => write!(f, "above {low} and at most {high}"),
            (true, false) if low_included => write!(f, "{low} or more"),
            (true, false) => write!(f, "above {low}"),
            (false, true) => write!(f, "at most {high}"),
            (false, false) => Ok(()),
        }
    }
}

impl Quantity {
    /// The unit's symbol; empty for what has none.
    pub fn symbol(self) -> &'static str {
        match self {
            Quantity::Ratio => "",
            Quantity::Metres => "m",
            Quantity::Hertz => "Hz",
            Quantity::Milliseconds => "ms",
        }
    }
}

impl NamesOf {
    /// One of them, in words.
    pub fn one(self) -> &'static str {
        match self {
            NamesOf::Shapes => "shape",
            NamesOf::Markers => "marker",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_hold_what_their_words_say() {
        for (range, words, inside, outside) in [
            (Range::between(0.0, 1.0), "between 0 and 1", vec![0.0, 1.0], vec![-0.1, 1.1]),
            (Range::above(0.0), "above 0", vec![1e-9, 1e9], vec![0.0, f64::INFINITY]),
            (Range::at_least(0.0), "0 or more", vec![0.0], vec![-1e-9, f64::NAN]),
            (Range::above_up_to(0.0, 3.0), "above 0 and at most 3", vec![3.0], vec![0.0, 3.1]),
            (Range::ANY, "", vec![-1e300], vec![f64::NEG_INFINITY]),
        ] {
            assert_eq!(range.to_string(), words);
            assert!(inside.iter().all(|x| range.contains(*x)), "{words}");
            assert!(!outside.iter().any(|x| range.contains(*x)), "{words}");
        }
    }
}
