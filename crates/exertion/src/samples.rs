//! Samples at uneven times, brought to whole seconds.

use crate::error::{ExertionError, as_many, finite};

/// The longest time without a sample that a straight line bridges, s.
pub const LONGEST_GAP_S: f64 = 5.0;
/// Seconds of a day: what is longer is no recording.
const MOST_SECONDS: usize = 86_400;
/// What of a second the end may lie before a whole one and count as it.
const ROUNDING: f64 = 1e-9;

/// Whole seconds after the first sample, up to the last: how many values [`at_whole_seconds`] gives.
///
/// # Errors
/// As [`at_whole_seconds`], as far as it concerns times.
pub fn whole_seconds(time: &[f64]) -> Result<usize, ExertionError> {
    if time.len() < 2 {
        return Err(ExertionError::Few { place: "time".to_owned(), found: time.len(), least: 2 });
    }
    for (i, t) in time.iter().enumerate() {
        finite(&format!("time/{i}"), *t)?;
    }
    for (i, pair) in time.windows(2).enumerate() {
        let place = || format!("time/{}", i + 1);
        if pair[1] <= pair[0] {
            return Err(ExertionError::TimeOrder {
                place: place(),
                time: pair[1],
                before: pair[0],
            });
        }
        let gap = pair[1] - pair[0];
        if gap > LONGEST_GAP_S {
            return Err(ExertionError::Gap {
                place: place(),
                time: pair[1],
                gap,
                most: LONGEST_GAP_S,
            });
        }
    }
    let span = time[time.len() - 1] - time[0];
    let seconds = (span + ROUNDING).floor();
    if seconds > MOST_SECONDS as f64 {
        let place = "time".to_owned();
        return Err(ExertionError::Many { place, found: seconds as usize, most: MOST_SECONDS });
    }
    Ok(seconds as usize + 1)
}

/// Values at whole seconds after the first sample, straight between samples.
///
/// # Errors
/// [`ExertionError`]: fewer than two samples, a number that is none (`NAME/i`), times that do not increase or
/// leave a gap of more than 5 s (`time/i`).
pub fn at_whole_seconds(
    time: &[f64],
    values: &[f64],
    name: &str,
) -> Result<Vec<f64>, ExertionError> {
    let count = whole_seconds(time)?;
    as_many(name, values.len(), time.len())?;
    for (i, value) in values.iter().enumerate() {
        finite(&format!("{name}/{i}"), *value)?;
    }
    let mut low = 0;
    Ok((0..count)
        .map(|second| {
            let t = time[0] + second as f64;
            while low + 2 < time.len() && time[low + 1] <= t {
                low += 1;
            }
            // The last second may lie behind the last sample by a rounding.
            let part = ((t - time[low]) / (time[low + 1] - time[low])).min(1.0);
            values[low] + part * (values[low + 1] - values[low])
        })
        .collect())
}

/// The same of a column that lacks values here and there (NaN): straight over what is missing, as long as the
/// gap is bridged; before the first and after the last value, the nearest.
///
/// # Errors
/// As [`at_whole_seconds`]; a column without a value (`NAME`).
pub fn with_gaps_at_whole_seconds(
    time: &[f64],
    values: &[f64],
    name: &str,
) -> Result<Vec<f64>, ExertionError> {
    whole_seconds(time)?;
    as_many(name, values.len(), time.len())?;
    let seen: Vec<usize> = (0..values.len()).filter(|&i| !values[i].is_nan()).collect();
    let (Some(&first), Some(&last)) = (seen.first(), seen.last()) else {
        return Err(ExertionError::Few { place: name.to_owned(), found: 0, least: 1 });
    };
    let ends = [0, values.len() - 1];
    let known: Vec<usize> = std::iter::once(ends[0]).chain(seen).chain([ends[1]]).collect();
    for pair in known.windows(2) {
        let gap = time[pair[1]] - time[pair[0]];
        if gap > LONGEST_GAP_S {
            let place = format!("time/{}", pair[1]);
            return Err(ExertionError::Gap {
                place,
                time: time[pair[1]],
                gap,
                most: LONGEST_GAP_S,
            });
        }
    }
    let mut filled = values.to_vec();
    (filled[ends[0]], filled[ends[1]]) = (values[first], values[last]);
    let kept: Vec<usize> = (0..filled.len()).filter(|&i| !filled[i].is_nan()).collect();
    let of = |from: &[f64]| -> Vec<f64> { kept.iter().map(|&i| from[i]).collect() };
    at_whole_seconds(&of(time), &of(&filled), name)
}

/// The value at a place between whole seconds, straight between them; at the ends the nearest.
pub(crate) fn between_seconds(values: &[f64], t: f64) -> f64 {
    let last = values.len() - 1;
    let place = t.clamp(0.0, last as f64);
    let low = place.floor() as usize;
    let part = place - low as f64;
    if low >= last { values[last] } else { values[low] + part * (values[low + 1] - values[low]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_lines_up_to_the_last_whole_second() {
        let (time, values) = ([10.5, 11.0, 12.75, 13.5], [0.0, 1.0, 8.0, 2.0]);
        let got = at_whole_seconds(&time, &values, "v").unwrap();
        assert_eq!(got, [0.0, 3.0, 7.0 - 0.0, 2.0].map(|v: f64| v));
        // A last time that rounding puts before its second is that second.
        let time = [0.1, 0.1 + 0.7, 0.1 + 0.7 + 0.3 - 2e-16];
        assert_eq!(at_whole_seconds(&time, &[1.0, 1.0, 1.0], "v").unwrap(), [1.0, 1.0]);
    }

    #[test]
    fn what_is_wrong_has_its_place() {
        let place = |time: &[f64], values: &[f64]| {
            at_whole_seconds(time, values, "v").unwrap_err().place().to_owned()
        };
        assert_eq!(place(&[0.0], &[1.0]), "time");
        assert_eq!(place(&[0.0, 1.0, 1.0], &[1.0; 3]), "time/2");
        assert_eq!(place(&[0.0, 5.1], &[1.0; 2]), "time/1");
        assert_eq!(place(&[0.0, f64::NAN], &[1.0; 2]), "time/1");
        assert_eq!(place(&[0.0, 1.0], &[1.0]), "v");
        assert_eq!(place(&[0.0, 1.0], &[1.0, f64::INFINITY]), "v/1");
        assert!(at_whole_seconds(&[0.0, 5.0], &[1.0, 2.0], "v").is_ok(), "just bridged");
    }
}
