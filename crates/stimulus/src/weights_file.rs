//! Weights as CSV: `frame,time,` then the avatar's shapes, a row a frame.

use std::fmt::Write as _;

#[cfg(feature = "prepare")]
use mimique_mocap::{CaptureFile, Format, ReadError};

/// Blendshape weights over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WeightsTable {
    /// The N shapes, in the avatar's order.
    pub shape_names: Vec<String>,
    /// Number of each frame, as in the capture.
    pub frames: Vec<u64>,
    /// Seconds of each frame.
    pub times: Vec<f64>,
    /// Frame-major: `weights[frame * N + shape]`.
    pub weights: Vec<f64>,
}

/// A weight file that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}; {remedy}")]
pub struct WeightsFileError {
    /// Line, 1 = the header.
    pub line: usize,
    /// What is wrong, with the value.
    pub what: String,
    /// What to do.
    pub remedy: &'static str,
}

/// The weights of a Live Link Face export; `None` for another file.
#[cfg(feature = "prepare")]
fn recorded(mut file: CaptureFile<'_>) -> Result<Option<WeightsTable>, ReadError> {
    if file.format() != Some(Format::LiveLinkCsv) {
        return Ok(None);
    }
    let take = file.weights()?;
    Ok(Some(WeightsTable::at_rate(take.names, take.weights, 0, take.rate_hz)))
}

impl WeightsTable {
    /// The rows of a solved take: frames numbered from `first_frame`, at a rate.
    pub fn at_rate(
        shape_names: Vec<String>,
        weights: Vec<f64>,
        first_frame: u64,
        rate_hz: f64,
    ) -> Self {
        let count = weights.len() / shape_names.len().max(1);
        Self {
            shape_names,
            frames: (0..count as u64).map(|f| first_frame + f).collect(),
            times: (0..count).map(|f| f as f64 / rate_hz).collect(),
            weights,
        }
    }

    /// The same at another rate: straight between the two nearest rows, as the stage shows them.
    /// Frames are numbered at the new rate. A table of fewer than two rows stays as it is.
    #[cfg(feature = "prepare")]
    pub(crate) fn at(&self, rate_hz: f64) -> Self {
        let Some(recorded_hz) = self.rate_hz() else { return self.clone() };
        let (step, last) = (recorded_hz / rate_hz, self.frames.len() - 1);
        // The last new row is not after the last old one, but for rounding.
        let rows = (last as f64 / step + 1e-9).floor() as usize + 1;
        let weights = (0..rows).flat_map(|row| {
            let at = (row as f64 * step).min(last as f64);
            let (low, part) = (at.floor() as usize, at.fract());
            let pair = self.row(low).iter().zip(self.row((low + 1).min(last)));
            pair.map(move |(a, b)| a + part * (b - a)).collect::<Vec<_>>()
        });
        let first = (self.frames[0] as f64 / step).round() as u64;
        Self::at_rate(self.shape_names.clone(), weights.collect(), first, rate_hz)
    }

    /// The N weights of row `row`.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, row: usize) -> &[f64] {
        let n = self.shape_names.len();
        &self.weights[row * n..(row + 1) * n]
    }

    /// Frames a second, from the times; `None` below two frames.
    pub fn rate_hz(&self) -> Option<f64> {
        let (first, last) = (self.times.first()?, self.times.last()?);
        let rate = (self.times.len() - 1) as f64 / (last - first);
        (rate.is_finite() && rate > 0.0).then_some(rate)
    }

    /// The CSV text. Numbers are the shortest that read back as the same f64.
    pub fn to_csv(&self) -> String {
        let mut out = String::from("frame,time");
        for name in &self.shape_names {
            out.push(',');
            out.push_str(&quoted(name));
        }
        out.push('\n');
        for (row, (frame, time)) in self.frames.iter().zip(&self.times).enumerate() {
            let _ = write!(out, "{frame},{time}");
            for w in self.row(row) {
                // Negative zero would read as a change.
                let _ = write!(out, ",{}", if *w == 0.0 { 0.0 } else { *w });
            }
            out.push('\n');
        }
        out
    }

    /// Weights from a Live Link Face export or from Mimique's own CSV.
    ///
    /// # Errors
    /// What is wrong, with its line.
    #[cfg(feature = "prepare")]
    pub fn from_recording(bytes: &[u8]) -> Result<Self, String> {
        match CaptureFile::of_bytes(bytes).and_then(recorded).map_err(|e| e.to_string())? {
            Some(table) => Ok(table),
            None => {
                Self::from_csv(&String::from_utf8_lossy(bytes), None).map_err(|e| e.to_string())
            }
        }
    }

    /// Weights from a file as [`WeightsTable::from_recording`] takes it.
    ///
    /// # Errors
    /// What is wrong, with its line.
    #[cfg(feature = "prepare")]
    pub fn from_file(path: &std::path::Path) -> Result<Self, String> {
        match CaptureFile::open(path).and_then(recorded).map_err(|e| e.to_string())? {
            Some(table) => Ok(table),
            None => {
                let bytes =
                    std::fs::read(path).map_err(|e| format!("open: {e}; check the path"))?;
                Self::from_csv(&String::from_utf8_lossy(&bytes), None).map_err(|e| e.to_string())
            }
        }
    }

    /// Reads the CSV text. A file without the column `time` gets times from `rate_hz`.
    ///
    /// # Errors
    /// [`WeightsFileError`] with the line.
    pub fn from_csv(text: &str, rate_hz: Option<f64>) -> Result<Self, WeightsFileError> {
        let wrong = |line: usize, what: String, remedy| WeightsFileError { line, what, remedy };
        let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
        let header = fields(lines.next().map_or("", |(_, l)| l));
        if header.first().map(String::as_str) != Some("frame") {
            let found = header.first().cloned().unwrap_or_default();
            return Err(wrong(1, format!("first column {found:?}"), "open with frame,time,SHAPES"));
        }
        let timed = header.get(1).map(String::as_str) == Some("time");
        let shape_names = header[if timed { 2 } else { 1 }..].to_vec();
        if shape_names.is_empty() {
            return Err(wrong(1, "no shapes".to_owned(), "name the shapes after frame,time"));
        }
        if let Some(k) =
            (0..shape_names.len()).find(|&k| shape_names[..k].contains(&shape_names[k]))
        {
            let what = format!("shape {:?} twice", shape_names[k]);
            return Err(wrong(1, what, "give every shape one column"));
        }
        let mut table = Self { shape_names, ..Self::default() };
        for (index, line) in lines {
            if line.trim().is_empty() {
                continue;
            }
            let row = fields(line);
            if row.len() != header.len() {
                let what = format!("{} fields, the header has {}", row.len(), header.len());
                return Err(wrong(index + 1, what, "write every column in every row"));
            }
            let number = |column: usize| -> Result<f64, WeightsFileError> {
                let value = row[column].trim().parse::<f64>().ok().filter(|x| x.is_finite());
                value.ok_or_else(|| {
                    let what =
                        format!("column {:?}: {:?} is no number", header[column], row[column]);
                    wrong(index + 1, what, "write a decimal number")
                })
            };
            let frame = row[0].trim().parse::<u64>().map_err(|_| {
                wrong(index + 1, format!("frame {:?}", row[0]), "write the frame's number")
            })?;
            let time = match (timed, rate_hz) {
                (true, _) => number(1)?,
                (false, Some(rate)) => table.frames.len() as f64 / rate,
                (false, None) => table.frames.len() as f64,
            };
            table.frames.push(frame);
            table.times.push(time);
            for column in header.len() - table.shape_names.len()..header.len() {
                table.weights.push(number(column)?);
            }
        }
        Ok(table)
    }
}

/// The fields of a CSV line; a quoted one may hold commas and doubled quotes.
fn fields(line: &str) -> Vec<String> {
    let mut out = vec![String::new()];
    let mut inside = false;
    let mut characters = line.trim_end_matches(['\r', '\n']).chars().peekable();
    while let Some(c) = characters.next() {
        match c {
            '"' if inside && characters.peek() == Some(&'"') => {
                characters.next();
                out.last_mut().unwrap_or(&mut String::new()).push('"');
            }
            '"' => inside = !inside,
            ',' if !inside => out.push(String::new()),
            c => {
                if let Some(field) = out.last_mut() {
                    field.push(c);
                }
            }
        }
    }
    out
}

fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> WeightsTable {
        let names = vec!["jawOpen".to_owned(), "odd, \"name\"".to_owned()];
        WeightsTable::at_rate(names, vec![0.1, -0.0, 1.0 / 3.0, 2e-17], 705, 200.0)
    }

    #[test]
    fn csv_reads_back_as_it_was_written() {
        let back = WeightsTable::from_csv(&table().to_csv(), None).unwrap();
        assert_eq!(back, table());
        assert_eq!(back.frames, [705, 706]);
        assert_eq!(back.rate_hz(), Some(200.0));
        assert_eq!(back.row(1), [1.0 / 3.0, 2e-17]);
    }

    #[test]
    fn csv_without_times_takes_the_rate() {
        let table = WeightsTable::from_csv("frame,a\n0,0.5\n1,1\n", Some(50.0)).unwrap();
        assert_eq!(table.times, [0.0, 0.02]);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, line) in [
            ("", 1),
            ("time,a\n", 1),
            ("frame,time\n", 1),
            ("frame,time,a,a\n", 1),
            ("frame,time,a\n0,0\n", 2),
            ("frame,time,a\n0,0,0\n1,0,x\n", 3),
            ("frame,time,a\n0,0,NaN\n", 2),
            ("frame,time,a\n-1,0,0\n", 2),
        ] {
            let error = WeightsTable::from_csv(text, None).unwrap_err();
            assert_eq!(error.line, line, "{text}: {error}");
        }
    }
}
