//! Controls of a face: curves times expressivity, moved by the breath (E15).

use crate::breathing::Breathing;
use crate::expressivity::Expressivity;
use crate::rules::Curves;

/// How far an open jaw follows the breath.
const JAW_DEPTH: f64 = 0.35;

/// A control of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Control {
    /// The opening of the mouth.
    MouthOpen,
    /// The mouth of a strong exhalation.
    MouthExhale,
    /// The stretching of the mouth.
    MouthStretch,
    /// The narrowing of the eyes.
    Eyes,
    /// Brows down.
    BrowsDown,
    /// Brows up.
    BrowsUp,
    /// A swallow.
    Swallow,
    /// The widening of the nostrils.
    Nostrils,
}

impl Control {
    /// How many there are.
    pub const COUNT: usize = 8;

    /// All of them with their names.
    pub const ALL: [(Self, &'static str); Self::COUNT] = [
        (Self::MouthOpen, "mouthOpen"),
        (Self::MouthExhale, "mouthExhale"),
        (Self::MouthStretch, "mouthStretch"),
        (Self::Eyes, "eyes"),
        (Self::BrowsDown, "browsDown"),
        (Self::BrowsUp, "browsUp"),
        (Self::Swallow, "swallow"),
        (Self::Nostrils, "nostrils"),
    ];

    /// The name.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// The control of a name.
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, own)| *own == name).map(|(control, _)| *control)
    }
}

/// The controls of a face in every frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Controls {
    /// In the order of [`Control::ALL`], a value a frame each, 0 to 1.
    pub values: [Vec<f64>; Control::COUNT],
    /// Frames in which one of the four curves was cut at an end of its range.
    pub cut_frames: usize,
}

impl Controls {
    /// E15: every curve times its expressivity, cut to 0 to 1 (brows to -1 to 1). With a breath and rcn of
    /// every frame the mouth moves by it: open (1 - 0.35 (1 - |flow|)) (1 - swallow), the strong exhalation,
    /// the swallow, and the nostrils by rcn times what flows in.
    pub fn of(
        curves: &[Curves],
        expressivity: &Expressivity,
        breath: Option<(&Breathing, &[f64])>,
    ) -> Self {
        let mut values: [Vec<f64>; Control::COUNT] = Default::default();
        values.iter_mut().for_each(|own| own.reserve(curves.len()));
        let mut cut_frames = 0;
        for (frame, curve) in curves.iter().enumerate() {
            let mut was_cut = false;
            let mut cut = |factor: f64, percent: f64, least: f64| {
                let value = factor * percent / 100.0;
                was_cut |= value < least || value > 1.0;
                value.clamp(least, 1.0)
            };
            let mut open = cut(expressivity.mouth_open, curve.mouth_open, 0.0);
            let stretch = cut(expressivity.mouth_stretch, curve.mouth_stretch, 0.0);
            let eyes = cut(expressivity.eyes, curve.eyes, 0.0);
            let brows = cut(expressivity.brows, curve.brows, -1.0);
            cut_frames += usize::from(was_cut);
            let (mut exhale, mut swallow, mut nostrils) = (0.0, 0.0, 0.0);
            if let Some((breathing, rcn)) = breath {
                let flow = breathing.flow[frame];
                swallow = breathing.swallow[frame];
                open = open * (1.0 - JAW_DEPTH * (1.0 - flow.abs())) * (1.0 - swallow);
                exhale = (expressivity.mouth_exhale * breathing.exhale[frame]).clamp(0.0, 1.0);
                nostrils = rcn[frame] * flow.max(0.0);
            }
            for (control, value) in [
                (Control::MouthOpen, open),
                (Control::MouthExhale, exhale),
                (Control::MouthStretch, stretch),
                (Control::Eyes, eyes),
                (Control::BrowsDown, brows.max(0.0)),
                (Control::BrowsUp, (-brows).max(0.0)),
                (Control::Swallow, swallow),
                (Control::Nostrils, nostrils),
            ] {
                values[control as usize].push(value);
            }
        }
        Self { values, cut_frames }
    }

    /// A control in all frames.
    pub fn of_control(&self, control: Control) -> &[f64] {
        &self.values[control as usize]
    }

    /// Frames.
    pub fn frames(&self) -> usize {
        self.values[0].len()
    }
}
