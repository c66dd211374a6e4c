//! A gaze over time, from an eye tracker's angles or from recorded weights of the eyes.

use mimique_avatar::{GazeAngles, GazeShapes};
use mimique_mocap::WeightsTable;

/// Names of the columns of an eye tracker's angles, degrees; the last may be left out.
const ANGLES: [&str; 3] = ["azimuth", "elevation", "vergence"];

/// A gaze over time.
#[derive(Debug, Clone, PartialEq)]
pub struct GazeTrack {
    seconds: Vec<f64>,
    angles: Vec<GazeAngles>,
}

/// Why a file gives no gaze.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GazeTrackError {
    /// No column is of a gaze.
    #[error(
        "no column tells a gaze (there are {columns}); give azimuth and elevation in degrees, vergence if it is \
         known, or the weights of eyeLook shapes"
    )]
    NoColumns {
        /// The first columns that there are.
        columns: String,
    },
    /// No row.
    #[error("no row; give one or more times with their gaze")]
    NoRows,
    /// A number that is none.
    #[error("{seconds} s, {column}: {value} is no angle; leave the row out, or correct the cell")]
    NoAngle {
        /// Seconds of the row.
        seconds: f64,
        /// The column.
        column: &'static str,
        /// What stands there.
        value: f64,
    },
    /// The times go backwards.
    #[error("{seconds} s: not after the row before; sort the rows by their time")]
    Backwards {
        /// Seconds of the row.
        seconds: f64,
    },
}

impl GazeTrack {
    /// The gaze that a table gives: by columns `azimuth`, `elevation` and, where there is one, `vergence`, in
    /// degrees, to the person's left, upwards and converging above 0; else by the shapes among its columns that
    /// turn the eyes, as Live Link Face and others record them. `later_s` is how many seconds after the table's
    /// clock the capture's began.
    ///
    /// # Errors
    /// [`GazeTrackError`]: a table without gaze or rows, a value that is no angle, times that go backwards.
    pub fn of(table: &WeightsTable, later_s: f64) -> Result<Self, GazeTrackError> {
        let column = |word: &str| {
            table.shape_names.iter().position(|name| name.trim().eq_ignore_ascii_case(word))
        };
        let shapes = GazeShapes::of(&table.shape_names);
        let angles: Vec<GazeAngles> = match ANGLES.map(column) {
            [Some(azimuth), Some(elevation), vergence] => (0..table.frames.len())
                .map(|row| table.row(row))
                .map(|row| GazeAngles {
                    azimuth: row[azimuth],
                    elevation: row[elevation],
                    vergence: vergence.map_or(0.0, |column| row[column]),
                })
                .collect(),
            _ if !shapes.is_empty() => (0..table.frames.len())
                .filter_map(|row| shapes.eyes(table.row(row)).gaze())
                .collect(),
            _ => {
                let names = table.shape_names.iter().take(6).map(String::as_str);
                let columns = names.collect::<Vec<_>>().join(", ");
                return Err(GazeTrackError::NoColumns { columns });
            }
        };
        let seconds: Vec<f64> = table.times.iter().map(|time| time - later_s).collect();
        Self::new(seconds, angles)
    }

    /// A gaze at some seconds of a take.
    ///
    /// # Errors
    /// [`GazeTrackError`]: no row, a value that is no angle, times that go backwards.
    pub fn new(seconds: Vec<f64>, angles: Vec<GazeAngles>) -> Result<Self, GazeTrackError> {
        if seconds.is_empty() {
            return Err(GazeTrackError::NoRows);
        }
        for (&seconds, gaze) in seconds.iter().zip(&angles) {
            let values = [gaze.azimuth, gaze.elevation, gaze.vergence];
            // No eye turns by more, however it is counted.
            let wrong = values
                .into_iter()
                .zip(ANGLES)
                .find(|(value, _)| !value.is_finite() || value.abs() > 90.0);
            if let Some((value, column)) = wrong {
                return Err(GazeTrackError::NoAngle { seconds, column, value });
            }
        }
        if let Some(pair) = seconds.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(GazeTrackError::Backwards { seconds: pair[1] });
        }
        Ok(Self { seconds, angles })
    }

    /// The gaze at a second of the take: straight between the two nearest rows, held before the first and after
    /// the last.
    pub fn at(&self, second: f64) -> GazeAngles {
        let after = self.seconds.partition_point(|&s| s <= second);
        let last = self.seconds.len() - 1;
        let (low, high) = (after.saturating_sub(1), after.min(last));
        let (a, b) = (self.angles[low], self.angles[high]);
        let length = self.seconds[high] - self.seconds[low];
        let part = if length > 0.0 { (second - self.seconds[low]) / length } else { 0.0 };
        let between = |a: f64, b: f64| a + part * (b - a);
        GazeAngles {
            azimuth: between(a.azimuth, b.azimuth),
            elevation: between(a.elevation, b.elevation),
            vergence: between(a.vergence, b.vergence),
        }
    }

    /// Seconds of the rows.
    pub(super) fn seconds(&self) -> &[f64] {
        &self.seconds
    }

    /// The gaze of each row.
    pub(super) fn angles(&self) -> &[GazeAngles] {
        &self.angles
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(names: &[&str], rows: &[(f64, &[f64])]) -> WeightsTable {
        WeightsTable {
            shape_names: names.iter().map(|&name| name.to_owned()).collect(),
            frames: (0..rows.len() as u64).collect(),
            times: rows.iter().map(|row| row.0).collect(),
            weights: rows.iter().flat_map(|row| row.1.iter().copied()).collect(),
            filled: Vec::new(),
            notes: Vec::new(),
        }
    }

    #[test]
    fn angles_are_read_by_name_and_lie_straight_between_rows() {
        let read = table(&["Elevation", "azimuth"], &[(1.0, &[4.0, -10.0]), (3.0, &[8.0, 10.0])]);
        let track = GazeTrack::of(&read, 1.0).unwrap();
        let at = |second| track.at(second);
        assert_eq!(at(-5.0), GazeAngles { azimuth: -10.0, elevation: 4.0, vergence: 0.0 });
        assert_eq!(at(1.0), GazeAngles { azimuth: 0.0, elevation: 6.0, vergence: 0.0 });
        assert_eq!(at(9.0), GazeAngles { azimuth: 10.0, elevation: 8.0, vergence: 0.0 });
    }

    #[test]
    fn recorded_eyes_are_one_gaze() {
        let names =
            ["jawOpen", "eyeLookOutLeft", "eyeLookInRight", "eyeLookUpLeft", "eyeLookUpRight"];
        let track =
            GazeTrack::of(&table(&names, &[(0.0, &[0.9, 0.5, 0.3, 0.4, 0.4])]), 0.0).unwrap();
        let gaze = track.at(0.0);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(near(gaze.azimuth, 12.0) && near(gaze.elevation, 10.0), "{gaze:?}");
        assert!(near(gaze.vergence, -6.0), "{gaze:?}");
    }

    #[test]
    fn what_is_no_gaze_is_refused() {
        let of = |names: &[&str], rows: &[(f64, &[f64])]| GazeTrack::of(&table(names, rows), 0.0);
        let columns = "jawOpen".to_owned();
        let error = of(&["jawOpen"], &[(0.0, &[1.0])]).unwrap_err();
        assert_eq!(error, GazeTrackError::NoColumns { columns });
        let names = ["azimuth", "elevation"];
        assert_eq!(of(&names, &[]).unwrap_err(), GazeTrackError::NoRows);
        let error = of(&names, &[(0.5, &[1.0, 120.0])]).unwrap_err();
        assert!(error.to_string().starts_with("0.5 s, elevation: 120 is no angle"), "{error}");
        let error = of(&names, &[(0.5, &[1.0, 1.0]), (0.5, &[1.0, 1.0])]).unwrap_err();
        assert_eq!(error, GazeTrackError::Backwards { seconds: 0.5 });
    }
}
