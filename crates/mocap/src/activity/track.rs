//! Speed and grade of a way: from distances and heights that jitter.

use super::ActivityColumn;
use super::rows::Sample;

/// Half of the time over which a speed is taken, s: satellites place a runner to some metres.
const SPEED_HALF_S: f64 = 5.0;
/// Half of the time over which a grade is taken, s: barometers follow slowly.
const GRADE_HALF_S: f64 = 15.0;
/// A shorter way has no grade, m.
const LEAST_WAY_M: f64 = 10.0;

/// Distances, and heights where there are some, over time.
pub(super) struct Track {
    time: Vec<f64>,
    distance: Vec<f64>,
    altitude: Option<(Vec<f64>, Vec<f64>)>,
}

impl Track {
    /// Of samples, two of which have a distance.
    pub fn of(samples: &[Sample]) -> Option<Self> {
        let with = |value: fn(&Sample) -> f64| -> (Vec<f64>, Vec<f64>) {
            let own = samples.iter().map(|sample| (sample.time_s, value(sample)));
            own.filter(|(_, value)| value.is_finite()).unzip()
        };
        let (time, distance) = with(|sample| sample.distance_m);
        let altitude = with(|sample| sample.altitude_m);
        (time.len() > 1).then_some(Self {
            time,
            distance,
            altitude: Some(altitude).filter(|(times, _)| times.len() > 1),
        })
    }

    /// Gives a speed to samples where none was recorded, and a grade to all; what was done is said.
    pub fn fill(&self, samples: &mut [Sample]) -> Vec<String> {
        let speed = ActivityColumn::Speed as usize;
        let mut notes = Vec::new();
        if samples.iter().all(|sample| sample.columns[speed].is_nan()) {
            for sample in samples.iter_mut() {
                let around = self.around(sample.time_s, SPEED_HALF_S);
                sample.columns[speed] =
                    around.map_or(f64::NAN, |[a, b]| (self.way(a, b) / (b - a)).max(0.0));
            }
            let seconds = 2.0 * SPEED_HALF_S;
            notes.push(format!(
                "speed: not in the file, the way of {seconds} s around every sample"
            ));
        }
        if let Some((times, heights)) = &self.altitude {
            for sample in samples.iter_mut() {
                let Some([a, b]) = self.around(sample.time_s, GRADE_HALF_S) else { continue };
                let (way, rise) =
                    (self.way(a, b), between(times, heights, b) - between(times, heights, a));
                let grade = if way >= LEAST_WAY_M { rise / way } else { 0.0 };
                sample.set(ActivityColumn::Grade, grade.clamp(-1.0, 1.0));
            }
            let seconds = 2.0 * GRADE_HALF_S;
            notes.push(format!("grade: rise over run of {seconds} s around every sample"));
        }
        notes
    }

    /// The way between two times, m.
    fn way(&self, a: f64, b: f64) -> f64 {
        between(&self.time, &self.distance, b) - between(&self.time, &self.distance, a)
    }

    /// The time around an instant, as far as there are distances.
    fn around(&self, time: f64, half: f64) -> Option<[f64; 2]> {
        let (first, last) = (self.time[0], self.time[self.time.len() - 1]);
        let (a, b) = ((time - half).clamp(first, last), (time + half).clamp(first, last));
        (b > a).then_some([a, b])
    }
}

/// The value at a time, straight between neighbours, at the ends the nearest.
fn between(times: &[f64], values: &[f64], time: f64) -> f64 {
    let after = times.partition_point(|own| *own <= time);
    if after == 0 {
        return values[0];
    }
    if after == times.len() {
        return values[after - 1];
    }
    let part = (time - times[after - 1]) / (times[after] - times[after - 1]);
    values[after - 1] + part * (values[after] - values[after - 1])
}
