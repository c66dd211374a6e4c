//! Breathing, frame by frame: in and out, strong exhalations when tired, swallowing.

use std::f64::consts::PI;

use chacha20::ChaCha20Rng;
use chacha20::rand_core::{Rng, SeedableRng};

use crate::error::{ExertionError, as_many, finite, from_zero, within};

/// Share of a breath that is taken in, at rest, and how much more at the heart's maximum.
const INHALING: f64 = 0.40;
const INHALING_MORE: f64 = 0.10;
/// A strong exhalation each 2/fatigue breaths.
const DEEP_PER_FATIGUE: f64 = 0.5;
/// A swallow each 1/(0.04 + 0.06 fatigue) breaths, of 0.6 s.
const SWALLOWS: f64 = 0.04;
const SWALLOWS_PER_FATIGUE: f64 = 0.06;
const SWALLOW_S: f64 = 0.6;
/// Strength of a strong exhalation, fresh, and how much more when exhausted.
const EXHALE: f64 = 0.4;
const EXHALE_PER_FATIGUE: f64 = 0.6;
/// How much one breath is faster or slower than the next, as a standard deviation of the logarithm: ours.
const IRREGULARITY: f64 = 0.15;
/// Deviations beyond so many standard deviations are cut.
const MOST_DEVIATIONS: f64 = 2.5;
const SECONDS_OF_A_MINUTE: f64 = 60.0;

/// What breathing follows from, frame by frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BreathingInput<'a> {
    /// Frames per second.
    pub rate_hz: f64,
    /// Breaths at the first frame; a fraction is within a breath.
    pub phase0: f64,
    /// Breaths per minute.
    pub breaths: &'a [f64],
    /// The share of the heart's reserve.
    pub rcn: &'a [f64],
    /// Fatigue, 0 to 1.
    pub fatigue: &'a [f64],
    /// A seed where breaths are to be irregular: each faster or slower by a draw of its own.
    pub seed: Option<u64>,
}

/// Breathing, a value a frame each.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Breathing {
    /// Breaths since the beginning.
    pub phase: Vec<f64>,
    /// What is in the lungs of a breath, 0 to 1.
    pub volume: Vec<f64>,
    /// In above 0, out below, -1 to 1.
    pub flow: Vec<f64>,
    /// The strong exhalation, 0 to 1.
    pub exhale: Vec<f64>,
    /// The swallow, 0 to 1.
    pub swallow: Vec<f64>,
    /// Frames in which a strong exhalation begins.
    pub deep_starts: Vec<usize>,
    /// Frames in which a swallow begins.
    pub swallow_starts: Vec<usize>,
}

impl Breathing {
    /// Integrates the breaths and counts what comes of them.
    ///
    /// # Errors
    /// [`ExertionError`]: lists of different lengths; numbers that are none, breaths below 0, rcn and fatigue
    /// outside 0 to 1, at `breaths/i`, `rcn/i`, `fatigue/i`.
    pub fn of(input: &BreathingInput<'_>) -> Result<Self, ExertionError> {
        check(input)?;
        let mut all = Self { phase: phases(input), ..Self::default() };
        let mut events = Events::default();
        for frame in 0..all.phase.len() {
            let fatigue = input.fatigue[frame];
            let fraction = all.phase[frame] - all.phase[frame].floor();
            let inhaling = INHALING + INHALING_MORE * input.rcn[frame];
            let (volume, flow, exhale) = if fraction < inhaling {
                (events.inhaled, events.strong) = (true, false);
                let (sine, cosine) = libm::sincos(PI * fraction / inhaling);
                ((1.0 - cosine) / 2.0, sine, 0.0)
            } else {
                if events.inhaled {
                    events.breathe_out(fatigue, frame, &mut all);
                }
                let (sine, cosine) = libm::sincos(PI * (fraction - inhaling) / (1.0 - inhaling));
                let strength =
                    if events.strong { EXHALE + EXHALE_PER_FATIGUE * fatigue } else { 0.0 };
                ((1.0 + cosine) / 2.0, -sine, strength * sine)
            };
            let since =
                all.swallow_starts.last().map(|start| (frame - start) as f64 / input.rate_hz);
            let swallow = since.filter(|since| *since < SWALLOW_S).map_or(0.0, |since| {
                let sine = libm::sin(PI * since / SWALLOW_S);
                sine * sine
            });
            all.volume.push(volume);
            all.flow.push(flow);
            all.exhale.push(exhale);
            all.swallow.push(swallow);
        }
        Ok(all)
    }
}

/// What breaths add up to.
#[derive(Default)]
struct Events {
    /// Parts of the next strong exhalation that have gathered.
    deep: f64,
    /// Parts of the next swallow.
    swallow: f64,
    /// Whether the frame before was within an inhalation.
    inhaled: bool,
    /// Whether the exhalation is a strong one.
    strong: bool,
}

impl Events {
    /// An exhalation begins in a frame.
    fn breathe_out(&mut self, fatigue: f64, frame: usize, all: &mut Breathing) {
        self.inhaled = false;
        self.deep += DEEP_PER_FATIGUE * fatigue;
        self.strong = self.deep >= 1.0;
        if self.strong {
            self.deep -= 1.0;
            all.deep_starts.push(frame);
        }
        self.swallow += SWALLOWS + SWALLOWS_PER_FATIGUE * fatigue;
        // Nobody swallows while blowing: it waits for the next breath.
        if self.swallow >= 1.0 && !self.strong {
            self.swallow -= 1.0;
            all.swallow_starts.push(frame);
        }
    }
}

fn check(input: &BreathingInput<'_>) -> Result<(), ExertionError> {
    within("rateHz", input.rate_hz, [1.0, 1e5], Some("frames per second"))?;
    from_zero("phase0", finite("phase0", input.phase0)?)?;
    as_many("rcn", input.rcn.len(), input.breaths.len())?;
    as_many("fatigue", input.fatigue.len(), input.breaths.len())?;
    for (i, breaths) in input.breaths.iter().enumerate() {
        from_zero(&format!("breaths/{i}"), *breaths)?;
    }
    for (name, values) in [("rcn", input.rcn), ("fatigue", input.fatigue)] {
        for (i, value) in values.iter().enumerate() {
            within(&format!("{name}/{i}"), *value, [0.0, 1.0], None)?;
        }
    }
    Ok(())
}

/// Breaths since the beginning: the trapezium rule over breaths per minute. Of irregular breaths each takes
/// its own time.
fn phases(input: &BreathingInput<'_>) -> Vec<f64> {
    let per_frame = 1.0 / (2.0 * SECONDS_OF_A_MINUTE * input.rate_hz);
    let mut phase = input.phase0;
    let mut breath = Breath::default();
    let mut phases = Vec::with_capacity(input.breaths.len());
    for (frame, breaths) in input.breaths.iter().enumerate() {
        if frame > 0 {
            let faster = input.seed.map_or(1.0, |seed| breath.faster(seed, phase));
            phase += (input.breaths[frame - 1] + breaths) * faster * per_frame;
        }
        phases.push(phase);
    }
    phases
}

/// The breath that is being breathed, and how fast it is.
#[derive(Default)]
struct Breath {
    of: Option<(u64, f64)>,
}

impl Breath {
    /// How much faster than the mean the breath at a phase is: drawn from the seed and its number alone, so
    /// that a window of a longer recording has the breaths of the whole.
    fn faster(&mut self, seed: u64, phase: f64) -> f64 {
        let number = phase.max(0.0) as u64;
        match self.of {
            Some((own, faster)) if own == number => faster,
            _ => {
                let faster = libm::exp(IRREGULARITY * deviation(seed, number));
                self.of = Some((number, faster));
                faster
            }
        }
    }
}

/// A standard normal draw (Box and Muller), cut, from the ChaCha20 stream of a seed and a breath's number.
fn deviation(seed: u64, number: u64) -> f64 {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    let mut stream = ChaCha20Rng::from_seed(key);
    stream.set_stream(number);
    let mut uniform = || (stream.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let (u, v) = (1.0 - uniform(), uniform());
    let normal = (-2.0 * libm::log(u)).sqrt() * libm::cos(2.0 * PI * v);
    normal.clamp(-MOST_DEVIATIONS, MOST_DEVIATIONS)
}
