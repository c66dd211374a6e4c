//! Which muscles make which emotion.
//!
//! Combinations of action units after Ekman & Friesen, *Facial Action Coding System* (1978) and the
//! EMFACS table (Friesen & Ekman 1983); lips part in the strong forms as in Du, Tao & Martinez,
//! "Compound facial expressions of emotion", PNAS 111 (2014).

use serde::{Deserialize, Serialize};

/// The six basic emotions (Ekman 1992).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Emotion {
    /// AU 4 + 5 + 7 + 23 + 24.
    Anger,
    /// AU 9 + 10 + 15 + 16 + 17.
    Disgust,
    /// AU 1 + 2 + 4 + 5 + 20 + 25.
    Fear,
    /// AU 6 + 12.
    Joy,
    /// AU 1 + 4 + 15.
    Sadness,
    /// AU 1 + 2 + 5 + 26.
    Surprise,
}

/// A muscle's part in an emotion: blendshape without its side, and weight at the strongest.
pub(super) type Part = (&'static str, f64);

impl Emotion {
    /// All six, in alphabetical order.
    pub const ALL: [Emotion; 6] = [
        Emotion::Anger,
        Emotion::Disgust,
        Emotion::Fear,
        Emotion::Joy,
        Emotion::Sadness,
        Emotion::Surprise,
    ];

    /// The word used in files: `anger`, `disgust`, `fear`, `joy`, `sadness`, `surprise`.
    pub fn name(self) -> &'static str {
        match self {
            Emotion::Anger => "anger",
            Emotion::Disgust => "disgust",
            Emotion::Fear => "fear",
            Emotion::Joy => "joy",
            Emotion::Sadness => "sadness",
            Emotion::Surprise => "surprise",
        }
    }

    /// Weights at the apex of intensity 3.
    pub(super) fn recipe(self) -> &'static [Part] {
        match self {
            // AU 4, 5, 7, 23 and 24, with 10 and 17 and a thrust jaw.
            Emotion::Anger => &[
                ("browDown", 1.0),
                ("eyeWide", 0.55),
                ("eyeSquint", 0.65),
                ("mouthPress", 1.0),
                ("mouthRollUpper", 0.35),
                ("mouthRollLower", 0.25),
                ("mouthFrown", 0.25),
                ("mouthShrugLower", 0.30),
                ("noseSneer", 0.35),
                ("jawForward", 0.40),
            ],
            // AU 9, 10, 15, 16 and 17, and cheeks that the wrinkled nose lifts; the brows come down no
            // further than the nose draws them: any frown makes a snarl of it.
            Emotion::Disgust => &[
                ("noseSneer", 1.0),
                ("mouthUpperUp", 0.30),
                ("mouthFrown", 0.40),
                ("mouthLowerDown", 0.12),
                ("mouthShrugLower", 1.0),
                ("eyeSquint", 0.65),
                ("cheekSquint", 0.90),
            ],
            // AU 1, 2, 4, 5, 20 and 25: brows raised and drawn together, upper lids up over tense lower
            // ones, lips stretched flat and parted. The jaw hardly drops: that is surprise.
            Emotion::Fear => &[
                ("browInnerUp", 1.0),
                ("browOuterUp", 0.55),
                ("browDown", 0.60),
                ("eyeWide", 1.0),
                ("eyeSquint", 0.30),
                ("mouthStretch", 1.0),
                ("mouthLowerDown", 0.35),
                ("jawOpen", 0.14),
            ],
            // AU 6, 12, and 25 when strong.
            Emotion::Joy => &[
                ("mouthSmile", 0.95),
                ("cheekSquint", 0.90),
                ("eyeSquint", 0.60),
                ("mouthUpperUp", 0.22),
                ("jawOpen", 0.16),
            ],
            // AU 1, 4, 15, with 17 and lowered lids.
            Emotion::Sadness => &[
                ("browInnerUp", 1.0),
                ("browDown", 0.30),
                ("mouthFrown", 0.90),
                ("mouthShrugLower", 0.45),
                ("eyeBlink", 0.20),
                ("eyeLookDown", 0.30),
            ],
            // AU 1, 2, 5, 26.
            Emotion::Surprise => &[
                ("browInnerUp", 1.0),
                ("browOuterUp", 0.90),
                ("eyeWide", 0.90),
                ("jawOpen", 0.72),
                ("mouthFunnel", 0.15),
            ],
        }
    }

    /// Seconds from rest to apex and from apex to rest; surprise is quick, sadness slow.
    pub(super) fn attack_release_s(self) -> (f64, f64) {
        match self {
            Emotion::Anger => (0.55, 0.85),
            Emotion::Disgust => (0.50, 0.80),
            Emotion::Fear => (0.35, 0.80),
            Emotion::Joy => (0.60, 1.00),
            Emotion::Sadness => (0.80, 1.00),
            Emotion::Surprise => (0.28, 0.75),
        }
    }

    /// Head turn at the apex of intensity 3, degrees: nod (down positive), turn (to the person's
    /// left positive), tilt; and lean forward, mm.
    pub(super) fn head(self) -> ([f64; 3], f64) {
        match self {
            Emotion::Anger => ([3.0, 0.0, 0.0], 6.0),
            Emotion::Disgust => ([-2.0, 5.0, 1.5], -5.0),
            Emotion::Fear => ([-2.5, 0.0, 0.0], -8.0),
            Emotion::Joy => ([-2.5, 0.0, 2.0], 2.0),
            Emotion::Sadness => ([6.0, 0.0, 1.5], 0.0),
            Emotion::Surprise => ([-3.0, 0.0, 0.0], -4.0),
        }
    }
}
