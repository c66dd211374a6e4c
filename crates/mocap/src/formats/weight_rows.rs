//! Rows of recorded weights on their way to a table: rate from times, frames without a face made good.

use super::text::snapped_rate;
use crate::{ReadError, WeightOptions, WeightsTable};

/// Frames that a file may make beyond twice as many as it has.
const SPARE_FRAMES: usize = 1000;
/// How far a row may be from its frame of an even rate, in frames, before rows count as uneven.
const EVEN: f64 = 0.3;
/// Rows further apart than this, in frames, have lost some between them.
const LOST: f64 = 1.75;

const NO_RATE: &str = "give the rate of the recording (--mocap-rate), or a time for every frame";
const ORDER: &str = "give one take and one face a file, frames in order";

/// Where a row stands in its file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Place {
    /// A line of a text, from 1.
    Line(usize),
    /// An item of the frames of a JSON document, from 0.
    Item(usize),
}

impl Place {
    /// What is wrong there.
    pub(crate) fn error(
        self,
        section: &str,
        what: impl Into<String>,
        remedy: &'static str,
    ) -> ReadError {
        match self {
            Self::Line(line) => ReadError::at_line(line, section, what, remedy),
            Self::Item(item) => {
                ReadError::in_json(format!("frame {item}, {section}"), what, remedy)
            }
        }
    }
}

/// What a reader collects.
#[derive(Debug)]
pub(crate) struct WeightRows {
    /// Names of the N columns.
    names: Vec<String>,
    /// Where each row stands.
    places: Vec<Place>,
    /// The frame of each row, where the file has them.
    numbers: Vec<u64>,
    /// Seconds of each row, where the file has them.
    times: Vec<f64>,
    /// Whether the face was found in each row.
    seen: Vec<bool>,
    /// Rows in which the face was found x N.
    weights: Vec<f64>,
    /// What is worth saying.
    notes: Vec<String>,
}

/// A row of a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WeightRow<'r> {
    /// Where it stands.
    pub(crate) place: Place,
    /// The frame's number, where the file has one.
    pub(crate) number: Option<u64>,
    /// Seconds, where the file has them.
    pub(crate) time_s: Option<f64>,
    /// The weights; nothing where no face was found.
    pub(crate) weights: Option<&'r [f64]>,
}

impl WeightRows {
    /// No row yet, of these columns.
    ///
    /// # Errors
    /// No name, an empty one, or one twice, at `header`.
    pub(crate) fn new(names: Vec<String>, header: Place) -> Result<Self, ReadError> {
        let wrong = |what: String, remedy| Err(header.error("names", what, remedy));
        if names.is_empty() {
            return wrong("no shape".to_owned(), "export the take again with its weights");
        }
        let sorted = {
            let mut sorted: Vec<&String> = names.iter().collect();
            sorted.sort();
            sorted
        };
        if sorted[0].is_empty() {
            return wrong("a shape without a name".to_owned(), "name every shape");
        }
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            return wrong(format!("shape {:?} twice", pair[0]), "give every shape one column");
        }
        Ok(Self {
            names,
            places: Vec::new(),
            numbers: Vec::new(),
            times: Vec::new(),
            seen: Vec::new(),
            weights: Vec::new(),
            notes: Vec::new(),
        })
    }

    /// Whether there is no row yet.
    pub(crate) fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Names of the columns.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// Takes a row.
    ///
    /// # Errors
    /// A number of weights that is not that of the names.
    pub(crate) fn push(&mut self, row: WeightRow<'_>) -> Result<(), ReadError> {
        if let Some(weights) = row.weights {
            if weights.len() != self.names.len() {
                let what = format!("{} weights of {} shapes", weights.len(), self.names.len());
                return Err(row.place.error("weights", what, "write a weight for every shape"));
            }
            self.weights.extend_from_slice(weights);
        }
        self.seen.push(row.weights.is_some());
        self.places.push(row.place);
        self.numbers.extend(row.number);
        self.times.extend(row.time_s);
        Ok(())
    }

    /// Says something of the file.
    pub(crate) fn note(&mut self, note: impl Into<String>) {
        self.notes.push(note.into());
    }

    /// The table: at an even rate, what is missing on the line between its neighbours.
    ///
    /// # Errors
    /// No face, no rate, rows in disorder, more frames missing than there are.
    pub(crate) fn finish(self, options: &WeightOptions<'_>) -> Result<WeightsTable, ReadError> {
        let seen = self.seen.iter().filter(|seen| **seen).count();
        let Some((&last, &first)) = self.places.last().zip(self.places.first()) else {
            return Err(ReadError::in_json("frames", "no frame", "export the take again"));
        };
        if seen == 0 {
            return Err(first.error("weights", "no face in any frame", "record the take again"));
        }
        let timed = self.times.len() == self.places.len() && self.places.len() > 1;
        let numbered = self.numbers.len() == self.places.len();
        let index = match (numbered, timed) {
            (true, _) => self.index_of_numbers()?,
            (false, true) => self.index_of_times()?,
            (false, false) => (0..self.places.len()).collect(),
        };
        let steps = index[index.len() - 1];
        if steps >= 2 * seen + SPARE_FRAMES {
            let what = format!("{} frames, the face is in {seen} of them", steps + 1);
            return Err(last.error("frame", what, ORDER));
        }
        let rate_hz = if timed {
            let span_s = self.times[self.times.len() - 1] - self.times[0];
            let rate_hz = snapped_rate(steps as f64 / span_s, span_s);
            if !(rate_hz.is_finite() && rate_hz > 0.0) {
                return Err(last.error("time", format!("{span_s} s in all"), ORDER));
            }
            rate_hz
        } else {
            let given = options.rate_hz.filter(|rate| rate.is_finite() && *rate > 0.0);
            given.ok_or_else(|| first.error("frame", "no rate and no times", NO_RATE))?
        };
        let start = self.numbers.first().copied().unwrap_or(0) / self.step();
        let at = if timed { self.exact_or_uneven(&index, rate_hz)? } else { None };
        let Some(at) = at else {
            let at: Vec<f64> = index.iter().map(|&i| i as f64).collect();
            let table = self.on_a_grid(&at, rate_hz);
            let frames = (0..table.frames.len() as u64).map(|f| start + f).collect();
            return Ok(WeightsTable { frames, ..table });
        };
        let mut table = self.on_a_grid(&at, rate_hz);
        table.notes.push(format!(
            "the times are uneven: taken on the line between two rows, at {rate_hz:.3} frames per second"
        ));
        Ok(table)
    }

    /// In which steps the frames are numbered.
    fn step(&self) -> u64 {
        let smallest = self.numbers.windows(2).map(|w| w[1].saturating_sub(w[0])).min();
        smallest.filter(|step| (1..=100).contains(step)).unwrap_or(1)
    }

    /// Frames from 0 by the rows' numbers.
    fn index_of_numbers(&self) -> Result<Vec<usize>, ReadError> {
        if let Some(row) = self.numbers.windows(2).position(|w| w[1] <= w[0]) {
            let what = format!("frame {} after {}", self.numbers[row + 1], self.numbers[row]);
            return Err(self.places[row + 1].error("frame", what, ORDER));
        }
        let (first, step) = (self.numbers[0], self.step());
        let index = |n: &u64| usize::try_from((n - first) / step).unwrap_or(usize::MAX / 2);
        Ok(self.numbers.iter().map(index).collect())
    }

    /// Frames from 0 by the rows' times: intervals in multiples of the median one.
    fn index_of_times(&self) -> Result<Vec<usize>, ReadError> {
        let mut intervals: Vec<f64> = self.times.windows(2).map(|w| w[1] - w[0]).collect();
        if let Some(row) = intervals.iter().position(|d| *d <= 0.0 || d.is_nan()) {
            let what = format!("{} s after {} s", self.times[row + 1], self.times[row]);
            return Err(self.places[row + 1].error("time", what, ORDER));
        }
        intervals.sort_by(f64::total_cmp);
        let median = intervals[intervals.len() / 2];
        let mut index = vec![0_usize];
        for (row, w) in self.times.windows(2).enumerate() {
            // `as` saturates; what is far off is refused by the number of frames.
            let advance = ((w[1] - w[0]) / median).round().max(1.0) as usize;
            index.push(index[row].saturating_add(advance).min(usize::MAX / 2));
        }
        Ok(index)
    }

    /// Where the rows stand in frames if that is not near their whole frames.
    fn exact_or_uneven(
        &self,
        index: &[usize],
        rate_hz: f64,
    ) -> Result<Option<Vec<f64>>, ReadError> {
        let at: Vec<f64> = self.times.iter().map(|t| (t - self.times[0]) * rate_hz).collect();
        let off = at.iter().zip(index).map(|(at, &i)| (at - i as f64).abs());
        if off.fold(0.0, f64::max) <= EVEN {
            return Ok(None);
        }
        match at.windows(2).position(|w| w[1] <= w[0]) {
            None => Ok(Some(at)),
            Some(row) => {
                let what = format!("{} s after {} s", self.times[row + 1], self.times[row]);
                Err(self.places[row + 1].error("time", what, ORDER))
            }
        }
    }

    /// The rows in which the face was seen, at frames `at`, on whole frames: straight between the
    /// two nearest, held before the first and after the last.
    fn on_a_grid(self, at: &[f64], rate_hz: f64) -> WeightsTable {
        let n = self.names.len();
        let frames = at.last().map_or(0.0, |last| last + 1e-6).floor() as usize + 1;
        let known: Vec<f64> =
            at.iter().zip(&self.seen).filter(|(_, seen)| **seen).map(|(at, _)| *at).collect();
        let row = |k: usize| &self.weights[k * n..(k + 1) * n];
        let mut weights = Vec::with_capacity(frames * n);
        let mut lost = Vec::new();
        for frame in 0..frames {
            let here = frame as f64;
            let next = known.partition_point(|at| *at <= here + 1e-9);
            let (low, high) = (next.max(1) - 1, next.min(known.len() - 1));
            let span = known[high] - known[low];
            let on_a_row = (here - known[low]).abs() <= 1e-6;
            if on_a_row || span <= 0.0 {
                weights.extend_from_slice(row(low));
                if !on_a_row && (here - known[low]).abs() > LOST - 1.0 {
                    lost.push(frame);
                }
                continue;
            }
            if span > LOST {
                lost.push(frame);
            }
            let part = (here - known[low]) / span;
            weights.extend(row(low).iter().zip(row(high)).map(|(a, b)| a + part * (b - a)));
        }
        let table = WeightsTable::at_rate(self.names, weights, 0, rate_hz);
        WeightsTable { filled: spans(&lost), notes: self.notes, ..table }
    }
}

/// Frames in a row as spans.
fn spans(frames: &[usize]) -> Vec<(usize, usize)> {
    let mut spans: Vec<(usize, usize)> = Vec::new();
    for &frame in frames {
        match spans.last_mut() {
            Some((_, end)) if *end == frame => *end += 1,
            _ => spans.push((frame, frame + 1)),
        }
    }
    spans
}
