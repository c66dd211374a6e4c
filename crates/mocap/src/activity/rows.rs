//! Samples on their way to an activity: time in order, faults of sensors taken out, columns that follow from
//! others.

use super::track::Track;
use super::{Activity, ActivityColumn, ActivityFormat, Sport};
use crate::ReadError;

/// What one sample has; NaN where it has nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    /// Where it stands in the file, for messages.
    pub place: Place,
    /// s, from any beginning.
    pub time_s: f64,
    /// In the order of [`ActivityColumn::ALL`].
    pub columns: [f64; ActivityColumn::COUNT],
    /// Way since the beginning, m.
    pub distance_m: f64,
    /// Height, m.
    pub altitude_m: f64,
}

/// Where a sample stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Place {
    /// Line of a text, from 1.
    Line(usize),
    /// Byte of a file, from 0, and the part that stands there.
    Byte(u64, &'static str),
}

impl Place {
    pub fn error(self, section: &str, what: String, remedy: &'static str) -> ReadError {
        match self {
            Self::Line(line) => ReadError::at_line(line, section, what, remedy),
            Self::Byte(offset, part) => ReadError::at_byte(offset, part, what, remedy),
        }
    }
}

impl Sample {
    pub fn at(place: Place, time_s: f64) -> Self {
        Self {
            place,
            time_s,
            columns: [f64::NAN; ActivityColumn::COUNT],
            distance_m: f64::NAN,
            altitude_m: f64::NAN,
        }
    }

    pub fn set(&mut self, column: ActivityColumn, value: f64) {
        self.columns[column as usize] = value;
    }

    /// Takes what another sample of the same time has.
    fn fill(&mut self, other: &Self) {
        let own = self.columns.iter_mut().chain([&mut self.distance_m, &mut self.altitude_m]);
        let others = other.columns.iter().chain([&other.distance_m, &other.altitude_m]);
        for (own, other) in own.zip(others) {
            if !other.is_nan() {
                *own = *other;
            }
        }
    }
}

/// What a reader collects.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub samples: Vec<Sample>,
    pub sport: Option<Sport>,
    pub notes: Vec<String>,
    /// Samples that came in the same instant as the one before.
    doubled: usize,
}

impl Rows {
    /// A further sample. Laps repeat the last instant of the lap before: it is joined with it.
    pub fn push(&mut self, sample: Sample) -> Result<(), ReadError> {
        if let Some(before) = self.samples.last_mut() {
            let earlier = before.time_s;
            if sample.time_s == earlier {
                before.fill(&sample);
                self.doubled += 1;
                return Ok(());
            }
            if sample.time_s < earlier {
                let what = format!("{} s before the sample before it", earlier - sample.time_s);
                let remedy = "give one recording, its times increasing";
                return Err(sample.place.error("time", what, remedy));
            }
        }
        self.samples.push(sample);
        Ok(())
    }

    /// The activity of a device: what no person does is a fault of a sensor, and missing.
    pub fn of_device(mut self, format: &'static ActivityFormat) -> Result<Activity, ReadError> {
        let track = Track::of(&self.samples);
        if let Some(track) = track {
            self.notes.extend(track.fill(&mut self.samples));
        }
        for column in ActivityColumn::ALL {
            let [least, most] = column.range();
            let mut faults = 0;
            for sample in &mut self.samples {
                let value = &mut sample.columns[column as usize];
                if !value.is_nan() && !(least..=most).contains(value) {
                    *value = f64::NAN;
                    faults += 1;
                }
            }
            if faults > 0 {
                self.notes.push(format!(
                    "{faults} samples of {} outside {least} to {most} {}: taken as missing",
                    column.name(),
                    column.unit()
                ));
            }
        }
        if self.doubled > 0 {
            self.notes.push(format!(
                "{} samples in the same instant as the one before: joined with it",
                self.doubled
            ));
        }
        self.finish(format)
    }

    /// The activity as it stands.
    pub fn finish(self, format: &'static ActivityFormat) -> Result<Activity, ReadError> {
        let Some(first) = self.samples.first() else {
            return Err(ReadError::at_line(
                1,
                "data",
                "no sample with a time",
                "export the activity again, with its samples",
            ));
        };
        let begin = first.time_s;
        let column = |column: ActivityColumn| {
            let own = self.samples.iter().map(|sample| sample.columns[column as usize]);
            let own: Vec<f64> = own.collect();
            own.iter().any(|value| !value.is_nan()).then_some(own)
        };
        let columns = ActivityColumn::ALL.map(column);
        if columns.iter().all(Option::is_none) {
            return Err(first.place.error(
                "data",
                "no sample has power, work, speed or a heart rate".to_owned(),
                "export the activity again with one of them",
            ));
        }
        Ok(Activity {
            time_s: self.samples.iter().map(|sample| sample.time_s - begin).collect(),
            columns,
            sport: self.sport,
            format,
            notes: self.notes,
        })
    }
}
