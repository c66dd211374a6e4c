//! What should be said of a take: each warning as a value, and its sentence in English.

use std::fmt;
use std::ops::Range;

use mimique_clip::FramesWarning;
use mimique_locale::counted;
use mimique_solver::HEAD_LOWPASS_HZ;
use serde::{Serialize, Serializer};

use crate::checks::{GazeFault, HeadMarker, LabelProblem, SmoothingAdvice};

/// What should be said of a take.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "code", rename_all = "kebab-case", rename_all_fields = "camelCase")]
pub enum TakeWarning {
    /// Face markers of the map that the capture does not have.
    MarkersAbsent {
        /// Their labels.
        labels: Vec<String>,
    },
    /// No head marker is named.
    NoHeadMarkers,
    /// The head's own motion is asked for, and no head marker is named.
    HeadShownStill,
    /// No neutral is named: the stillest frames are taken.
    NeutralFound {
        /// First frame.
        first: usize,
        /// One past the last.
        end: usize,
        /// How far its markers deviate, millimetres rms.
        deviation_mm: f64,
        /// Whether the head was held still to look for them.
        head_held: bool,
    },
    /// No neutral is named, and no marker is seen: the first frames are taken.
    NeutralUnseen,
    /// The neutral is the mean of few frames.
    FewNeutralFrames {
        /// How many.
        frames: usize,
        /// How many are steadier.
        better: usize,
    },
    /// A lid marker that the capture does not have.
    LidMarkerAbsent {
        /// Its label.
        marker: String,
    },
    /// A lid marker whose shape the avatar does not have.
    LidShapeAbsent {
        /// Its label.
        marker: String,
        /// The shape that should close the lid.
        shape: String,
    },
    /// A given gaze that the avatar's eyes do not reach.
    GazeBeyondAvatar {
        /// In how many frames.
        frames: usize,
        /// Of how many.
        of: usize,
    },
    /// A gaze that no eyes have.
    GazeBeyondEyes {
        /// In how many frames.
        frames: usize,
        /// The worst of them, as the capture numbers it.
        worst: u64,
        /// What is wrong with it.
        why: GazeFault,
    },
    /// The rate leaves no room for the low-pass of the head.
    HeadUnfiltered {
        /// Frames per second.
        rate_hz: f64,
        /// The cut-off that was wanted, Hz.
        lowpass_hz: f64,
        /// The frames per second that it takes.
        least_rate_hz: f64,
    },
    /// Head markers that move on the head, those that move most first.
    HeadMarkersMove {
        /// The markers.
        markers: Vec<HeadMarker>,
    },
    /// Labels that are swapped or stand at one place.
    Labels(LabelProblem),
    /// A smoothed adaptation of shape would lower the residual.
    Smoothing(SmoothingAdvice),
    /// Shapes that stay at 0 since the markers do not tell their weights.
    ShapesHeld {
        /// Their names.
        shapes: Vec<String>,
    },
    /// Shapes that the markers do not tell and that are solved for all the same.
    ShapesUntold {
        /// Their names.
        shapes: Vec<String>,
    },
    /// Shapes that the markers cannot tell from combinations of others.
    ShapesDependent {
        /// The combinations that are known: a shape and those that give the same.
        combinations: Vec<(String, Vec<String>)>,
    },
    /// Vertices in pieces of a surface that no marker moves.
    VerticesAdrift {
        /// How many.
        vertices: usize,
    },
    /// Shapes of the training weights that the avatar does not have.
    TrainingUnused {
        /// Their names.
        shapes: Vec<String>,
    },
    /// Shapes of the avatar that the training weights do not have.
    TrainingUnlearnt {
        /// Their names.
        shapes: Vec<String>,
    },
    /// Recorded weights of which no column is a shape of the avatar.
    NoColumnIsAShape,
    /// Columns of recorded weights that are no shape of the avatar.
    ColumnsUnused {
        /// Their names.
        columns: Vec<String>,
    },
    /// Shapes that no column of recorded weights drives.
    ShapesNotDriven {
        /// Their names.
        shapes: Vec<String>,
    },
    /// What is said of the frames of the solve.
    #[serde(untagged)]
    Frames(FramesWarning),
}

impl TakeWarning {
    /// That no neutral is named and these frames are taken.
    pub(crate) fn neutral_found(frames: &Range<usize>, deviation_mm: f64, head_held: bool) -> Self {
        Self::NeutralFound { first: frames.start, end: frames.end, deviation_mm, head_held }
    }

    /// That a head is not filtered at this rate.
    pub(crate) fn head_unfiltered(rate_hz: f64) -> Self {
        let least_rate_hz = HEAD_LOWPASS_HZ / mimique_solver::MOST_HEAD_LOWPASS_OF_RATE;
        Self::HeadUnfiltered { rate_hz, lowpass_hz: HEAD_LOWPASS_HZ, least_rate_hz }
    }

    /// The sentence for somebody who reads of a study file, where advice names keys instead of options.
    pub(crate) fn in_a_study(&self) -> String {
        match self {
            Self::Smoothing(advice) => advice.in_a_study(),
            other => other.to_string(),
        }
    }
}

impl From<FramesWarning> for TakeWarning {
    fn from(warning: FramesWarning) -> Self {
        Self::Frames(warning)
    }
}

/// Warnings as their sentences, for a report that people read.
pub(crate) fn as_sentences<S: Serializer>(
    warnings: &[TakeWarning],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(warnings.iter().map(ToString::to_string))
}

/// The first few of some labels.
pub(crate) fn some<'l>(labels: impl Iterator<Item = &'l str>) -> String {
    let labels: Vec<&str> = labels.collect();
    let named = labels.iter().take(6).copied().collect::<Vec<_>>().join(", ");
    match labels.len() {
        0 => "none".to_owned(),
        1..=6 => named,
        more => format!("{named} and {} more", more - 6),
    }
}

/// The warning as a sentence, in English.
impl fmt::Display for TakeWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MarkersAbsent { labels } => write!(
                f,
                "{} of the map {} not in the capture: {}",
                counted(labels.len(), "marker"),
                if labels.len() == 1 { "is" } else { "are" },
                some(labels.iter().map(String::as_str))
            ),
            Self::NoHeadMarkers => f.write_str(
                "no head markers are named: the capture is taken to be free of head motion",
            ),
            Self::HeadShownStill => {
                f.write_str("no head markers are named: the head is shown still")
            }
            Self::NeutralFound { first, end, deviation_mm, head_held } => write!(
                f,
                "no neutral is named: frames {first}:{end} are taken, the stillest second \
                 ({deviation_mm:.2} mm rms{}); see whether the face is neutral there, or name it",
                if *head_held { "" } else { ", the head not held still" }
            ),
            Self::NeutralUnseen => {
                f.write_str("no neutral is named and no marker is seen: the first frames are taken")
            }
            Self::FewNeutralFrames { frames, better } => write!(
                f,
                "the neutral is the mean of {frames} frames: {better} or more are steadier"
            ),
            Self::LidMarkerAbsent { marker } => {
                write!(f, "lid marker {marker} is not in the capture")
            }
            Self::LidShapeAbsent { marker, shape } => write!(
                f,
                "lid marker {marker}: the avatar has no shape {shape}; name the shape that closes the lid"
            ),
            Self::GazeBeyondAvatar { frames, of } => write!(
                f,
                "the given gaze goes beyond what the avatar's eyes turn by in {frames} of {of} frames: it is held at \
                 their limit there; look at the angles, which are degrees to the person's left and upwards"
            ),
            Self::GazeBeyondEyes { frames, worst, why } => write!(
                f,
                "{} with a gaze that eyes do not have; at worst, in frame {worst}, {why}; let the eyes rest, give \
                 their gaze, or correct the eyeLook weights",
                counted(*frames, "frame")
            ),
            Self::HeadUnfiltered { rate_hz, lowpass_hz, least_rate_hz } => write!(
                f,
                "the head is not filtered: {rate_hz} frames per second leave no room for a low-pass of {lowpass_hz} \
                 Hz, which takes {least_rate_hz}; give headLowpassHz to choose another cut-off, 0 for none"
            ),
            Self::HeadMarkersMove { markers } => {
                let named: Vec<String> = (markers.iter())
                    .map(|HeadMarker { label, residual_mm, worst_mm }| {
                        format!("{label} ({residual_mm:.1} mm rms, {worst_mm:.1} at worst)")
                    })
                    .collect();
                write!(
                    f,
                    "head markers move on the head: {}; they seem to sit on skin, and the face is \
                     stabilised wrongly by as much: name markers on the skull, or the stillest ones, as head",
                    named.join(", ")
                )
            }
            Self::Labels(problem) => f.write_str(&problem.sentence()),
            Self::Smoothing(advice) => f.write_str(&advice.sentence()),
            Self::ShapesHeld { shapes } => {
                let one = shapes.len() == 1;
                write!(
                    f,
                    "{} {} at 0, since the markers do not tell {}: {}; place markers where they move, drive lids \
                     by lid markers, or take --untold solve (\"untold\": \"solve\")",
                    counted(shapes.len(), "shape"),
                    if one { "stays" } else { "stay" },
                    if one { "its weight" } else { "their weights" },
                    shapes.join(", ")
                )
            }
            Self::ShapesUntold { shapes } => write!(
                f,
                "the markers do not tell the weights of {}, which noise of 1 mm moves over their whole range: {}; \
                 what they get is the method's prior: lock them, or place markers where they move",
                counted(shapes.len(), "shape"),
                shapes.join(", ")
            ),
            Self::ShapesDependent { combinations } => {
                let told: Vec<String> = (combinations.iter())
                    .map(|(shape, of)| format!("{shape} (of {})", of.join(", ")))
                    .collect();
                let which = match told.is_empty() {
                    true => "shapes that nearly depend on each other".to_owned(),
                    false => told.join("; "),
                };
                write!(
                    f,
                    "the markers cannot tell these shapes from combinations of others: {which}; of the weights \
                     that fit equally well the least are taken; lock the shapes that the take does not need"
                )
            }
            Self::VerticesAdrift { vertices } => write!(
                f,
                "{vertices} vertices are in pieces of the skin without a marker: they rest"
            ),
            Self::TrainingUnused { shapes } => {
                write!(f, "training: the avatar has no shape {}: left out", shapes.join(", "))
            }
            Self::TrainingUnlearnt { shapes } => {
                write!(f, "training: no weights of {}: they are learnt to be 0", shapes.join(", "))
            }
            Self::NoColumnIsAShape => f.write_str(
                "no column of the file is a shape of the avatar: the face stays neutral",
            ),
            Self::ColumnsUnused { columns } => {
                write!(f, "the avatar has no shape {}: left out", columns.join(", "))
            }
            Self::ShapesNotDriven { shapes } => {
                write!(f, "no column drives {}: held at 0", shapes.join(", "))
            }
            Self::Frames(warning) => warning.fmt(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_warning_is_a_code_with_its_values_and_a_sentence() {
        let absent = TakeWarning::MarkersAbsent { labels: vec!["LLID".to_owned()] };
        assert_eq!(json!(absent), json!({"code": "markers-absent", "labels": ["LLID"]}));
        assert_eq!(absent.to_string(), "1 marker of the map is not in the capture: LLID");
        let frames = TakeWarning::from(FramesWarning::Held { frames: 2, first: 704 });
        assert_eq!(json!(frames), json!({"code": "held", "frames": 2, "first": 704}));
        assert!(frames.to_string().starts_with("2 frames not solved (the first is 704)"));
        let gaze =
            TakeWarning::GazeBeyondEyes { frames: 1, worst: 3, why: GazeFault::Crosses(31.04) };
        assert_eq!(
            json!(gaze),
            json!({"code": "gaze-beyond-eyes", "frames": 1, "worst": 3, "why": {"what": "crosses", "degrees": 31.04}})
        );
        assert!(gaze.to_string().starts_with(
            "1 frame with a gaze that eyes do not have; at worst, in frame 3, the eyes converge by 31.0 degrees"
        ));
    }
}
