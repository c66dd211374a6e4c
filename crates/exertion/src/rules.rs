//! The rules: four curves from work, power, heart and fatigue, written by us (E14).

use crate::heart::HeartLaw;
use crate::metabolism::fatigue;

/// What an expression follows from in one frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Features {
    /// Work of the last second, J/kg.
    pub w: f64,
    /// Power, W/kg.
    pub p: f64,
    /// The share of the heart's reserve.
    pub rcn: f64,
    /// EPOC, ml/kg.
    pub epoc: f64,
}

/// The four curves of an expression in one frame, per cent; brows up are below 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Curves {
    /// The opening of the mouth.
    pub mouth_open: f64,
    /// The stretching of the mouth.
    pub mouth_stretch: f64,
    /// The narrowing of the eyes.
    pub eyes: f64,
    /// Brows down above 0, up below.
    pub brows: f64,
}

impl Curves {
    /// Names of the curves, as model files have them.
    pub const NAMES: [&'static str; 4] = ["mouthOpen", "mouthStretch", "eyes", "brows"];

    /// In the order of [`Self::NAMES`].
    pub fn to_array(self) -> [f64; 4] {
        [self.mouth_open, self.mouth_stretch, self.eyes, self.brows]
    }

    /// In the order of [`Self::NAMES`].
    pub fn of_array([mouth_open, mouth_stretch, eyes, brows]: [f64; 4]) -> Self {
        Self { mouth_open, mouth_stretch, eyes, brows }
    }
}

/// Power of a full effort in thresholds of E6.
const FULL_EFFORT: f64 = 3.0;
/// What is left of narrowed eyes in exhaustion.
const TIRED_EYES: f64 = 0.12;

/// From 0 at `low` to 1 at `high`, with level ends: 3 t^2 - 2 t^3.
fn smooth_step(x: f64, low: f64, high: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// E14, `rules`, of a level of training: effort e = min(1, p/(3 T)); the mouth opens with the heart and more
/// when tired, stretches with effort and fatigue; eyes narrow with effort until fatigue relaxes them; brows
/// go down with effort and up with fatigue.
pub fn rules(features: &Features, level: f64) -> Curves {
    let phi = fatigue(features.epoc);
    let effort = (features.p / (FULL_EFFORT * HeartLaw::of_level(level).threshold)).min(1.0);
    let exhausted = smooth_step(phi, 0.5, 0.8);
    Curves {
        mouth_open: 100.0 * smooth_step(features.rcn, 0.4, 0.9) * (0.4 + 0.6 * phi),
        mouth_stretch: 100.0 * (0.6 * effort + 0.4 * phi),
        eyes: 100.0 * (effort + (TIRED_EYES - effort) * exhausted),
        brows: 100.0 * (0.7 * effort - 0.6 * phi),
    }
}
