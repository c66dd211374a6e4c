//! How fast a face changes: velocity and acceleration of all weights together (thesis 4.4.2).
//!
//! | thesis | here |
//! |---|---|
//! | w_i(t) | a channel: a blendshape's weight, or a marker's coordinate in a still head |
//! | E_VelBS (4.4) | [`Activity::velocity`], 1/s |
//! | E_AccBS (4.5) | [`Activity::acceleration`], 1/s^2 |
//! | E_VelBS^2 + E_AccBS^2 | [`Activity::energy`], without unit |
//!
//! The sum of the squares depends on the unit of time, which the thesis does not name: of a tenth of a
//! second, about the time in which an expression begins, both terms count alike; of a hundredth the
//! velocity decides. On synthetic takes borders came nearest to the true ones by the velocity, below
//! 4 Hz, without blinks and gaze, which is what stands here where nothing else is asked for.

use mimique_avatar::{blinks, shows_body, turns_eyes};
use mimique_mocap::{FilterError, LowPass};
use serde::{Deserialize, Serialize};

/// Numbers that change over time.
#[derive(Debug, Clone, Copy)]
pub struct Channels<'a> {
    /// Frame-major, `count` a frame; a missing one is NaN.
    pub values: &'a [f64],
    /// Channels per frame.
    pub count: usize,
    /// Frames per second.
    pub rate_hz: f64,
    /// Names of the channels, where they are blendshapes; else none.
    pub names: &'a [String],
}

/// How activity is measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct ActivityOptions {
    /// Cut-off of the low-pass before differentiation, Hz: expressions change more slowly, blinks and
    /// noise faster.
    pub cutoff_hz: f64,
    /// Unit of time in which the two energies are added, seconds.
    pub time_unit_s: f64,
    /// Whether blendshapes that shut or turn the eyes count: eyes move between expressions, too.
    pub blinks_and_gaze: bool,
}

impl Default for ActivityOptions {
    fn default() -> Self {
        Self { cutoff_hz: 4.0, time_unit_s: 0.01, blinks_and_gaze: false }
    }
}

impl ActivityOptions {
    /// All blendshapes, as the thesis sums them (4.4, 4.5); unit and cut-off, which it leaves out, so
    /// that both sums count.
    pub const AS_IN_THE_THESIS: Self =
        Self { cutoff_hz: 6.0, time_unit_s: 0.1, blinks_and_gaze: true };

    /// Which channels count; all of them where no other is left.
    fn counted(&self, take: &Channels<'_>) -> Vec<usize> {
        let is = |channel: usize, of: &dyn Fn(&str) -> bool| {
            take.names.get(channel).is_some_and(|name| of(name))
        };
        let eyes = |channel: usize| is(channel, &|name| blinks(name) || turns_eyes(name));
        // A breath is no expression, whatever is asked for.
        let all = (0..take.count).filter(|&channel| !is(channel, &shows_body));
        let counted: Vec<usize> =
            all.clone().filter(|&channel| self.blinks_and_gaze || !eyes(channel)).collect();
        if counted.is_empty() { all.collect() } else { counted }
    }
}

/// Activity of a take, a number per frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Activity {
    /// Sum over the channels that count of |dw/dt| (eq. 4.4), per second.
    pub velocity: Vec<f64>,
    /// The same of |d2w/dt2| (eq. 4.5), per second squared.
    pub acceleration: Vec<f64>,
    /// Both squared and added, time in units of [`ActivityOptions::time_unit_s`].
    pub energy: Vec<f64>,
    /// The channels that count after the low-pass, channel-major, gaps bridged.
    pub(super) smooth: Vec<f64>,
}

impl Activity {
    /// Measure a take.
    ///
    /// # Errors
    /// [`FilterError`] when the cut-off does not fit the rate.
    pub fn of(take: Channels<'_>, options: &ActivityOptions) -> Result<Self, FilterError> {
        let count = take.count.max(1);
        let frames = take.values.len() / count;
        let low_pass = LowPass::Butterworth { cutoff_hz: options.cutoff_hz };
        low_pass.check(take.rate_hz)?;
        let mut activity = Self {
            velocity: vec![0.0; frames],
            acceleration: vec![0.0; frames],
            energy: vec![0.0; frames],
            smooth: Vec::with_capacity(frames * count),
        };
        for channel in options.counted(&take) {
            let mut track: Vec<f64> =
                (0..frames).map(|f| take.values[f * count + channel]).collect();
            bridge(&mut track);
            low_pass.filter(&mut track, take.rate_hz)?;
            for f in 0..frames {
                let (before, after) = (f.saturating_sub(1), (f + 1).min(frames - 1));
                if after > before {
                    let slope = (track[after] - track[before]) / (after - before) as f64;
                    activity.velocity[f] += (slope * take.rate_hz).abs();
                }
                if after - before == 2 {
                    let bend = track[after] - 2.0 * track[f] + track[before];
                    activity.acceleration[f] += (bend * take.rate_hz * take.rate_hz).abs();
                }
            }
            activity.smooth.extend(track);
        }
        let unit = options.time_unit_s;
        for f in 0..frames {
            let velocity = activity.velocity[f] * unit;
            let acceleration = activity.acceleration[f] * unit * unit;
            activity.energy[f] = velocity * velocity + acceleration * acceleration;
        }
        Ok(activity)
    }

    /// The square root of the energy, a number a frame: what borders are looked for in.
    pub fn root(&self) -> Vec<f64> {
        self.energy.iter().map(|e| e.sqrt()).collect()
    }
}

/// Missing values on the line between their neighbours; at the ends the nearest value; 0 where
/// there is none.
pub fn bridge(track: &mut [f64]) {
    let known: Vec<usize> = (0..track.len()).filter(|&f| track[f].is_finite()).collect();
    let (Some(&first), Some(&last)) = (known.first(), known.last()) else {
        track.fill(0.0);
        return;
    };
    let (start, finish) = (track[first], track[last]);
    track[..first].fill(start);
    track[last + 1..].fill(finish);
    for pair in known.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let (p, q) = (track[a], track[b]);
        for (step, value) in track[a + 1..b].iter_mut().enumerate() {
            *value = p + (q - p) * (step + 1) as f64 / (b - a) as f64;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocity_and_acceleration_of_a_planted_parabola() {
        // w1 = t^2, w2 = -3t: sums of absolute derivatives 2t + 3 and 2.
        let rate_hz = 100.0;
        let values: Vec<f64> =
            (0..300).map(|f| f64::from(f) / rate_hz).flat_map(|t| [t * t, -3.0 * t]).collect();
        let take = Channels { values: &values, count: 2, rate_hz, names: &[] };
        let options =
            ActivityOptions { cutoff_hz: 20.0, time_unit_s: 0.1, ..ActivityOptions::default() };
        let activity = Activity::of(take, &options).unwrap();
        for f in 50..250 {
            let t = f as f64 / rate_hz;
            assert!((activity.velocity[f] - (2.0 * t + 3.0)).abs() < 1e-6, "{f}");
            assert!((activity.acceleration[f] - 2.0).abs() < 1e-4, "{f}");
            let energy = (0.1 * activity.velocity[f]).powi(2) + 0.02_f64.powi(2);
            assert!((activity.energy[f] - energy).abs() < 1e-6, "{f}");
        }
    }

    #[test]
    fn eyes_count_where_they_are_asked_for_or_nothing_else_is_there() {
        let names = ["jawOpen", "eyeBlinkLeft", "eyeLookUpRight"].map(str::to_owned);
        let wave = |f: usize, c: usize| 0.3 * ((f * (c + 1)) as f64 * 0.05).sin();
        let values: Vec<f64> = (0..200).flat_map(|f| [0, 1, 2].map(|c| wave(f, c))).collect();
        let take = Channels { values: &values, count: 3, rate_hz: 100.0, names: &names };
        let with = ActivityOptions { blinks_and_gaze: true, ..ActivityOptions::default() };
        let without = Activity::of(take, &ActivityOptions::default()).unwrap();
        let unnamed = Activity::of(Channels { names: &[], ..take }, &ActivityOptions::default());
        assert_eq!(Activity::of(take, &with), unnamed);
        let jaw: Vec<f64> = values.iter().copied().step_by(3).collect();
        let jaw = Channels { values: &jaw, count: 1, rate_hz: 100.0, names: &names[..1] };
        assert_eq!(Ok(without), Activity::of(jaw, &with));
        let eyes: Vec<f64> = values.iter().copied().skip(1).step_by(3).collect();
        let eyes = Channels { values: &eyes, count: 1, rate_hz: 100.0, names: &names[1..2] };
        let energy = Activity::of(eyes, &ActivityOptions::default()).unwrap().energy;
        assert!(energy.iter().any(|e| *e > 0.0));
    }

    #[test]
    fn gaps_are_bridged_and_frames_few() {
        let take = |values: &[f64]| {
            let channels = Channels { values, count: 1, rate_hz: 50.0, names: &[] };
            Activity::of(channels, &ActivityOptions::AS_IN_THE_THESIS).unwrap()
        };
        let line: Vec<f64> = (0..60).map(|f| 2.0 + 0.1 * f64::from(f)).collect();
        let mut holed = line.clone();
        holed[20..30].fill(f64::NAN);
        holed[..2].fill(f64::NAN);
        let (whole, holed) = (take(&line), take(&holed));
        for f in 15..50 {
            assert!((whole.velocity[f] - holed.velocity[f]).abs() < 1e-2);
        }
        assert_eq!(take(&[]).energy.len(), 0);
        assert_eq!(take(&[1.0]).energy, [0.0]);
        assert_eq!(take(&[f64::NAN, f64::NAN]).energy, [0.0, 0.0]);
    }
}
