//! What is wrong with numbers handed in, as codes with values; words are made at the edge.

/// Why something cannot be computed. Each has the place of what is wrong: keys and numbers from 0, joined
/// by `/` (`loads/back`, `w/2`).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExertionError {
    /// A number is missing, infinite, or something else.
    #[error("{place}: no number; give one")]
    NotANumber {
        /// Where.
        place: String,
    },
    /// A number is out of its range.
    #[error("{place}: {value}; give {least} to {most}{}", .unit.map(|unit| format!(" {unit}")).unwrap_or_default())]
    Range {
        /// Where.
        place: String,
        /// What stands there.
        value: f64,
        /// The least that is allowed.
        least: f64,
        /// The most that is allowed.
        most: f64,
        /// The unit, where there is one.
        unit: Option<&'static str>,
    },
    /// A number that may be anything from 0 is below it.
    #[error("{place}: {value} is below 0; give 0 or more")]
    Negative {
        /// Where.
        place: String,
        /// What stands there.
        value: f64,
    },
    /// A number does not lie between two others.
    #[error("{place}: {value}; give a number above {above}{}{}", .below.map(|below| format!(" and below {below}")).unwrap_or_default(), .unit.map(|unit| format!(" {unit}")).unwrap_or_default())]
    NotBetween {
        /// Where.
        place: String,
        /// What stands there.
        value: f64,
        /// What it must be above.
        above: f64,
        /// What it must be below, where that is bounded.
        below: Option<f64>,
        /// The unit, where there is one.
        unit: Option<&'static str>,
    },
    /// A key or a name that is not known.
    #[error("{place}: not known; use one of {}", known.join(", "))]
    Unknown {
        /// Where, ending in the name.
        place: String,
        /// The names that are known.
        known: Vec<&'static str>,
    },
    /// Something else stands where an object, a list or a text is needed.
    #[error("{place}: {needed} is needed here")]
    Shape {
        /// Where.
        place: String,
        /// What is needed.
        needed: &'static str,
    },
    /// The heart's maximum is not far enough above its rest.
    #[error(
        "{place}: {max} beats a minute, {rest} at rest; give at least {least} more than at rest"
    )]
    HeartReserve {
        /// Where.
        place: String,
        /// The maximum, beats per minute.
        max: f64,
        /// At rest, beats per minute.
        rest: f64,
        /// The least difference.
        least: f64,
    },
    /// Two lists that belong together differ in length.
    #[error("{place}: {found} where {expected} are needed; give as many")]
    Count {
        /// Where.
        place: String,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// There are fewer than can be computed with.
    #[error("{place}: {found}, at least {least} are needed; give more")]
    Few {
        /// What is counted.
        place: String,
        /// How many there are.
        found: usize,
        /// How many there must be.
        least: usize,
    },
    /// There are more than can be computed with.
    #[error("{place}: {found}, at most {most} are computed; give fewer")]
    Many {
        /// What is counted.
        place: String,
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: usize,
    },
    /// A time is not after the one before.
    #[error("{place}: {time} s after {before} s; give one recording, its times increasing")]
    TimeOrder {
        /// Where.
        place: String,
        /// The time, s.
        time: f64,
        /// The time before, s.
        before: f64,
    },
    /// Nothing was recorded for too long.
    #[error(
        "{place}: nothing for {gap:.1} s before {time} s, at most {most} s are bridged; cut the recording \
         there, and give both parts"
    )]
    Gap {
        /// Where the recording goes on.
        place: String,
        /// When it goes on, s.
        time: f64,
        /// How long it is, s.
        gap: f64,
        /// How long it may be, s.
        most: f64,
    },
    /// A joint that every body needs is missing.
    #[error("{place}: no {joint}; name its marker, or give a capture that has it")]
    MissingJoint {
        /// Where.
        place: String,
        /// The joint.
        joint: &'static str,
    },
    /// A joint was not seen in a frame.
    #[error(
        "{place}: not seen in frame {frame}; bridge the gap with `mimique repair` or cut the capture"
    )]
    UnseenJoint {
        /// Where, ending in the joint.
        place: String,
        /// The frame, from 0.
        frame: usize,
    },
    /// Both ends of a segment lie in one place.
    #[error(
        "{place}: has no length, both of its ends lie in one place; name other markers (--joints)"
    )]
    NoLength {
        /// Where, ending in the segment.
        place: String,
    },
    /// A window is empty or reaches beyond what is computed.
    #[error(
        "{place}: {first} to {last} s of {span} s; give a window inside, its end after its beginning"
    )]
    Window {
        /// Where.
        place: String,
        /// Where it begins, s.
        first: f64,
        /// Where it ends, s.
        last: f64,
        /// How long all of it is, s.
        span: f64,
    },
    /// A recorded heart rate is asked for, and a part has none.
    #[error(
        "{place}: no heart rate in seconds {first} to {last}; give it, or take another model of the heart"
    )]
    NoHeartRate {
        /// Where.
        place: String,
        /// First second without, s.
        first: f64,
        /// Last second without, s.
        last: f64,
    },
    /// A model's version is not one that is read.
    #[error("{place}: {found}; versions up to {known} are read; train it again")]
    Version {
        /// Where.
        place: String,
        /// The version.
        found: u64,
        /// The highest that is known.
        known: u64,
    },
    /// A text is no JSON.
    #[error("line {line}, column {column}: no JSON; correct it")]
    Json {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
    },
}

impl ExertionError {
    /// Where it is wrong: keys and numbers from 0, joined by `/`; nothing of a text that is no JSON.
    pub fn place(&self) -> &str {
        match self {
            Self::NotANumber { place }
            | Self::Range { place, .. }
            | Self::Negative { place, .. }
            | Self::NotBetween { place, .. }
            | Self::Unknown { place, .. }
            | Self::Shape { place, .. }
            | Self::HeartReserve { place, .. }
            | Self::Count { place, .. }
            | Self::Few { place, .. }
            | Self::Many { place, .. }
            | Self::TimeOrder { place, .. }
            | Self::Gap { place, .. }
            | Self::MissingJoint { place, .. }
            | Self::UnseenJoint { place, .. }
            | Self::NoLength { place }
            | Self::Window { place, .. }
            | Self::NoHeartRate { place, .. }
            | Self::Version { place, .. } => place,
            Self::Json { .. } => "",
        }
    }
}

/// A number that is one.
pub(crate) fn finite(place: &str, value: f64) -> Result<f64, ExertionError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ExertionError::NotANumber { place: place.into() })
    }
}

/// A number in a range, its ends included.
pub(crate) fn within(
    place: &str,
    value: f64,
    [least, most]: [f64; 2],
    unit: Option<&'static str>,
) -> Result<f64, ExertionError> {
    finite(place, value)?;
    if (least..=most).contains(&value) {
        return Ok(value);
    }
    Err(ExertionError::Range { place: place.into(), value, least, most, unit })
}

/// A number from 0 on.
pub(crate) fn from_zero(place: &str, value: f64) -> Result<f64, ExertionError> {
    finite(place, value)?;
    if value >= 0.0 {
        Ok(value)
    } else {
        Err(ExertionError::Negative { place: place.into(), value })
    }
}

/// A list as long as another.
pub(crate) fn as_many(place: &str, found: usize, expected: usize) -> Result<(), ExertionError> {
    if found == expected {
        return Ok(());
    }
    Err(ExertionError::Count { place: place.into(), found, expected })
}
