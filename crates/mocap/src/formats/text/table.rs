//! Rows of a text format on their way to a capture: rate from times, dropped frames made good.

use crate::capture::unit::decide_unit;
use crate::formats::plausibility::{unique_labels, whole_or_missing, zeros_to_missing};
use crate::{Capture, Format, LengthUnit, ReadError, ReadOptions, Recording};
use mimique_geometry::Point;

/// Missing points that a file may make beyond as many as it has.
const SPARE_POINTS: u64 = 4096;

/// What a reader of a text format collects.
#[derive(Debug, Default)]
pub(crate) struct Table {
    /// Labels as in the file.
    pub(crate) labels: Vec<String>,
    /// Frame-major positions, a row of the file per frame.
    pub(crate) positions: Vec<Point>,
    /// Frame number of each row, when the file has them.
    pub(crate) frame_numbers: Vec<u64>,
    /// Seconds of each row, when the file has them.
    pub(crate) times: Vec<f64>,
    /// Line of each row.
    pub(crate) lines: Vec<usize>,
    /// Rate in the file's header.
    pub(crate) declared_rate: Option<f64>,
    /// Unit in the file's header.
    pub(crate) declared_unit: Option<LengthUnit>,
    /// The recording system.
    pub(crate) system: Option<String>,
    /// What was worth saying.
    pub(crate) notes: Vec<String>,
    /// Whether the format has no missing positions, so that 0, 0, 0 is a place like any other.
    pub(crate) never_missing: bool,
}

impl Table {
    /// Note where as many frames as a file says to have are not there.
    pub(crate) fn count_frames(&mut self, key: &str, declared: Option<usize>) {
        if let Some(declared) = declared.filter(|&n| n != self.lines.len()) {
            self.notes.push(format!("{key} is {declared}, the rows are {}", self.lines.len()));
        }
    }

    /// Decide rate and unit, make dropped frames good, and hand over the recording.
    pub(crate) fn finish(
        mut self,
        format: &'static Format,
        options: &ReadOptions,
    ) -> Result<Recording, ReadError> {
        let header = self.lines.first().map_or(1, |l| l.saturating_sub(1)).max(1);
        if self.labels.is_empty() {
            return Err(ReadError::at_line(
                header,
                "header",
                "no marker",
                "export the take again with its markers and their labels",
            ));
        }
        if self.lines.is_empty() {
            return Err(ReadError::at_line(
                header,
                "data",
                "no frame after the header",
                "export the take again with its frames",
            ));
        }
        self.frames_in_order()?;
        let rate_hz = self.rate(header, options)?;
        let first_frame = self.make_dropped_frames_good(rate_hz)?;
        whole_or_missing(&mut self.positions, &mut self.notes);
        let unit = decide_unit(
            options.unit,
            self.declared_unit,
            &self.positions,
            self.labels.len(),
            &mut self.notes,
        );
        let labels = unique_labels(self.labels, &mut self.notes);
        if !self.never_missing {
            zeros_to_missing(&mut self.positions, &labels, unit, &mut self.notes);
        }
        let capture = Capture {
            labels,
            rate_hz,
            first_frame,
            unit,
            positions: self.positions,
            notes: self.notes,
        };
        Ok(Recording {
            capture,
            format,
            system: self.system,
            analog_channels: 0,
            events: Vec::new(),
        })
    }

    /// Refuse frame numbers that stand still or go back.
    fn frames_in_order(&self) -> Result<(), ReadError> {
        match self.frame_numbers.windows(2).position(|pair| pair[1] <= pair[0]) {
            None => Ok(()),
            Some(row) => Err(ReadError::at_line(
                self.lines[row + 1],
                "frame",
                format!(
                    "frame {} after frame {}",
                    self.frame_numbers[row + 1],
                    self.frame_numbers[row]
                ),
                "give one take a file, frames in order",
            )),
        }
    }

    /// The rate: the caller's, the header's, else from the times.
    fn rate(&mut self, header: usize, options: &ReadOptions) -> Result<f64, ReadError> {
        if let Some(rate) = options.rate_hz.or(self.declared_rate) {
            if rate.is_finite() && rate > 0.0 {
                if options.rate_hz.is_none() {
                    self.hold_against_times(rate);
                }
                return Ok(rate);
            }
            return Err(ReadError::at_line(
                header,
                "rate",
                format!("{rate} frames per second"),
                "give the rate of the recording (--mocap-rate)",
            ));
        }
        rate_of_times(&self.times, &self.frame_numbers).ok_or_else(|| {
            let what = if self.times.is_empty() {
                "no rate and no time column"
            } else {
                "no rate, and the times do not grow"
            };
            ReadError::at_line(
                header,
                "header",
                what,
                "give the rate of the recording (--mocap-rate)",
            )
        })
    }

    /// Note where the times tell of another rate than the header. Printed times are rounded: two rows may
    /// be off by a millisecond.
    fn hold_against_times(&mut self, declared: f64) {
        let Some(timed) = rate_of_times(&self.times, &self.frame_numbers) else { return };
        let span = self.times.last().zip(self.times.first()).map_or(0.0, |(b, a)| (b - a).abs());
        let tolerance = 0.01 + 2e-3 / span.max(1e-9);
        if (timed / declared - 1.0).abs() > tolerance {
            self.notes.push(format!(
                "the header says {declared} frames per second, the times {timed:.3}: the header's is taken"
            ));
        }
    }

    /// Insert missing rows where frame numbers (or, without them, times) jump. Returns the first
    /// frame's number.
    fn make_dropped_frames_good(&mut self, rate_hz: f64) -> Result<u64, ReadError> {
        let rows = self.lines.len();
        let numbered = self.frame_numbers.len() == rows;
        let timed = self.times.len() == rows && self.times.iter().all(|t| t.is_finite());
        let first = if numbered { self.frame_numbers[0] } else { 0 };
        let index: Vec<u64> = if numbered {
            let step = frame_step(&self.frame_numbers);
            if step > 1 {
                self.notes.push(format!("frame numbers count in steps of {step}: taken as 1"));
            }
            self.frame_numbers.iter().map(|n| n.wrapping_sub(first) / step).collect()
        } else if timed {
            // `as` saturates: a time far off becomes a jump too long, which is refused below.
            self.times.iter().map(|t| ((t - self.times[0]) * rate_hz).round() as u64).collect()
        } else {
            return Ok(first);
        };
        if let Some(row) = index.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(ReadError::at_line(
                self.lines[row + 1],
                "time",
                format!(
                    "{} s after {} s at {rate_hz} frames per second",
                    self.times[row + 1],
                    self.times[row]
                ),
                "give one take a file, frames in order, and its rate (--mocap-rate)",
            ));
        }
        let total = index.last().map_or(0, |last| last.saturating_add(1));
        if total == rows as u64 {
            return Ok(first);
        }
        // Bounded by the file: a wrong number must not ask for more memory than the rows did. What is
        // spared to short takes is counted in points: a thousand frames of many markers are too many.
        let markers = self.labels.len();
        let spare = (SPARE_POINTS / markers.max(1) as u64).min(1000);
        if total > 2 * rows as u64 + spare {
            return Err(ReadError::at_line(
                self.lines[rows - 1],
                "frame",
                format!("{rows} rows for {total} frames, more than half of them not in the file"),
                "check the frame or time column and the rate, or give one take a file",
            ));
        }
        let mut whole = vec![Point::UNSEEN; total as usize * markers];
        for (row, &frame) in index.iter().enumerate() {
            let to = frame as usize * markers;
            whole[to..to + markers]
                .copy_from_slice(&self.positions[row * markers..(row + 1) * markers]);
        }
        self.positions = whole;
        self.notes.push(format!("{} dropped frames filled in as missing", total - rows as u64));
        Ok(first)
    }
}

/// A whole, not negative frame number.
pub(crate) fn frame_number(value: f64, field: &str, line: usize) -> Result<u64, ReadError> {
    // 2^53: beyond it a float no longer counts frames.
    if value >= 0.0 && value.fract() == 0.0 && value < 9_007_199_254_740_992.0 {
        return Ok(value as u64);
    }
    Err(ReadError::at_line(
        line,
        "frame",
        format!("\"{field}\" is not a frame number"),
        "number the frames with whole numbers from 0 up",
    ))
}

/// The step in which frame numbers count: 1, or what the smallest step is in a take exported with
/// every second, third... frame (up to a hundredth; beyond that a number is wrong).
fn frame_step(frame_numbers: &[u64]) -> u64 {
    let smallest = frame_numbers.windows(2).map(|w| w[1].saturating_sub(w[0])).min();
    smallest.filter(|step| (1..=100).contains(step)).unwrap_or(1)
}

/// Frames per second from times in seconds (and frame numbers, when rows are missing), snapped to a
/// whole or NTSC rate within the rounding of printed times.
fn rate_of_times(times: &[f64], frame_numbers: &[u64]) -> Option<f64> {
    let (first, last) = (*times.first()?, *times.last()?);
    let steps = if frame_numbers.len() == times.len() {
        let numbers = frame_numbers.last()?.checked_sub(*frame_numbers.first()?)?;
        (numbers / frame_step(frame_numbers)) as f64
    } else {
        // Rows may be missing: count intervals by the median one.
        let mut intervals: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
        intervals.sort_by(f64::total_cmp);
        let median = *intervals.get(intervals.len() / 2)?;
        if median <= 0.0 {
            return None;
        }
        ((last - first) / median).round()
    };
    let raw = steps / (last - first);
    (raw.is_finite() && raw > 0.0).then(|| snapped_rate(raw, (last - first).abs()))
}

/// A rate within the uncertainty of the times (a millisecond over the whole duration, at most
/// 0.1 %) of a whole number or of a whole number times 1000/1001 is that number.
pub(crate) fn snapped_rate(raw: f64, duration_s: f64) -> f64 {
    let tolerance = raw * (1e-3 / duration_s).clamp(1e-6, 1e-3);
    let whole = raw.round();
    let ntsc = (raw * 1.001).round() / 1.001;
    if whole >= 1.0 && (raw - whole).abs() <= tolerance {
        whole
    } else if (raw - ntsc).abs() <= tolerance
        && [24.0, 30.0, 60.0, 120.0, 240.0].contains(&(ntsc * 1.001).round())
    {
        ntsc
    } else {
        raw
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_survive_the_rounding_of_printed_times() {
        for rate in [25.0, 30.0 / 1.001, 60.0, 60.0 / 1.001, 100.0, 119.88 / 1.0, 200.0, 240.0] {
            let times: Vec<f64> =
                (0..2000).map(|i| (f64::from(i) / rate * 1e3).round() / 1e3).collect();
            let numbers: Vec<u64> = (0..2000).collect();
            let got = rate_of_times(&times, &numbers).unwrap();
            assert!((got - rate).abs() < 1e-3 * rate / 10.0, "{got} for {rate}");
            if rate.fract() == 0.0 {
                assert_eq!(got, rate);
            }
        }
    }
}
