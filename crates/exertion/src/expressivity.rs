//! How strongly a person's expressions show.

use serde_json::Value;

use crate::error::{ExertionError, finite};
use crate::json::{Object, number};

/// How strongly each of the five expressions shows: factors of the curves (table 3.2 of the thesis).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expressivity {
    /// The opening of the mouth.
    pub mouth_open: f64,
    /// The mouth of a strong exhalation.
    pub mouth_exhale: f64,
    /// The stretching of the mouth.
    pub mouth_stretch: f64,
    /// The narrowing of the eyes.
    pub eyes: f64,
    /// The brows.
    pub brows: f64,
}

impl Default for Expressivity {
    fn default() -> Self {
        Self { mouth_open: 1.0, mouth_exhale: 1.0, mouth_stretch: 1.0, eyes: 1.0, brows: 1.0 }
    }
}

impl Expressivity {
    /// The five of table 3.2 of Boukhalfi 2012 by their letters in its figure 3.7: from the calmest face to the
    /// strongest.
    pub const OF_THE_THESIS: [(&'static str, Self); 5] = [
        ("a", Self::new([0.86, 0.95, 0.72, 0.96, 0.73])),
        ("b", Self::new([0.94, 0.95, 0.93, 0.94, 0.95])),
        ("c", Self::new([1.0, 1.0, 1.0, 1.0, 1.0])),
        ("d", Self::new([1.05, 1.08, 1.08, 1.10, 1.05])),
        ("e", Self::new([1.14, 1.02, 1.16, 1.15, 1.06])),
    ];

    /// Of factors in the order of [`Self::NAMES`].
    pub const fn new([mouth_open, mouth_exhale, mouth_stretch, eyes, brows]: [f64; 5]) -> Self {
        Self { mouth_open, mouth_exhale, mouth_stretch, eyes, brows }
    }

    /// Names of the factors, in JSON and on the command line.
    pub const NAMES: [&'static str; 5] =
        ["mouthOpen", "mouthExhale", "mouthStretch", "eyes", "brows"];

    /// The factor of a name.
    pub fn by_name(&mut self, name: &str) -> Option<&mut f64> {
        Some(match name {
            "mouthOpen" => &mut self.mouth_open,
            "mouthExhale" => &mut self.mouth_exhale,
            "mouthStretch" => &mut self.mouth_stretch,
            "eyes" => &mut self.eyes,
            "brows" => &mut self.brows,
            _ => return None,
        })
    }

    /// The factors in the order of [`Self::NAMES`].
    pub fn factors(&self) -> [f64; 5] {
        [self.mouth_open, self.mouth_exhale, self.mouth_stretch, self.eyes, self.brows]
    }
}

impl Expressivity {
    /// Takes over the factors that a JSON object names.
    pub(crate) fn read(&mut self, at: &str, value: &Value) -> Result<(), ExertionError> {
        for (place, key, value) in Object::of(at, value)?.members() {
            let Some(factor) = self.by_name(key) else {
                return Err(ExertionError::Unknown { place, known: Self::NAMES.to_vec() });
            };
            *factor = finite(&place, number(&place, value)?)?;
        }
        Ok(())
    }
}
