//! What is said of the frames of a solve together.

use std::fmt;

use mimique_solver::{FrameReport, FrameWarning};
use serde::Serialize;

/// Residual, iterations and convergence over the frames of a take.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct FrameStatistics {
    /// Frames.
    pub frames: usize,
    /// Root mean square of the frames' residuals, millimetres.
    pub residual_rms_mm: f64,
    /// Largest residual of a frame, millimetres.
    pub residual_worst_mm: f64,
    /// Mean number of iterations.
    pub iterations_mean: f64,
    /// Largest number of iterations.
    pub iterations_most: u32,
    /// Largest KKT error, in units of weight.
    pub kkt_worst: f64,
    /// Markers not seen, over all frames.
    pub missing_markers: u64,
    /// Frames that were not solved and are held from those around them; the first of them.
    pub held: Option<(usize, usize)>,
    /// Frames whose residual stands out of the take's; the worst of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub residual_outliers: Option<(usize, usize)>,
    /// Frames in which no marker is seen; the first of them.
    pub without_markers: Option<(usize, usize)>,
    /// Frames whose norm had to be smoothed.
    pub smoothed: usize,
    /// Frames far from what a regression has learnt from; the first of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub far_from_training: Option<(usize, usize)>,
    /// Largest predictive standard deviation of a regression.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation_worst: Option<f64>,
}

/// How many times the median of a take a residual is that stands out.
const OUTLIER_RATIO: f64 = 5.0;

/// Below this residual none stands out, metres: a clean take has frames of almost none.
const OUTLIER_LEAST: f64 = 5e-3;

/// How many frames' residuals stand out of the take's, and the worst of them.
fn residual_outliers(reports: &[FrameReport]) -> Option<(usize, usize)> {
    let mut sorted: Vec<f64> = reports.iter().map(|r| r.residual).collect();
    sorted.sort_by(f64::total_cmp);
    let most = (OUTLIER_RATIO * sorted.get(sorted.len() / 2)?).max(OUTLIER_LEAST);
    let count = sorted.iter().filter(|residual| **residual > most).count();
    let worst =
        (0..reports.len()).max_by(|&a, &b| reports[a].residual.total_cmp(&reports[b].residual))?;
    (count > 0).then_some((count, worst))
}

impl FrameStatistics {
    /// Sums up the reports of consecutive frames.
    pub fn of(reports: &[FrameReport]) -> Self {
        let count = reports.len().max(1) as f64;
        let with = |warning: FrameWarning| {
            let mut frames =
                (0..reports.len()).filter(|&i| reports[i].warning == Some(warning)).peekable();
            let first = *frames.peek()?;
            Some((frames.count(), first))
        };
        let most = |of: fn(&FrameReport) -> f64| reports.iter().map(of).fold(0.0, f64::max);
        Self {
            frames: reports.len(),
            residual_rms_mm: 1e3
                * (reports.iter().map(|r| r.residual * r.residual).sum::<f64>() / count).sqrt(),
            residual_worst_mm: 1e3 * most(|r| r.residual),
            iterations_mean: reports.iter().map(|r| f64::from(r.iterations)).sum::<f64>() / count,
            iterations_most: reports.iter().map(|r| r.iterations).max().unwrap_or(0),
            kkt_worst: most(|r| r.kkt_error),
            missing_markers: reports.iter().map(|r| u64::from(r.missing_markers)).sum(),
            held: with(FrameWarning::Held),
            residual_outliers: residual_outliers(reports),
            without_markers: with(FrameWarning::NoMarkers),
            smoothed: with(FrameWarning::Smoothed).map_or(0, |(count, _)| count),
            far_from_training: with(FrameWarning::FarFromTraining),
            deviation_worst: reports.iter().filter_map(|r| r.deviation).reduce(f64::max),
        }
    }

    /// What should be said of the frames, counted from `first_frame`.
    pub fn warnings(&self, first_frame: u64) -> Vec<FramesWarning> {
        let number = |frame: usize| frame as u64 + first_frame;
        let told = [
            self.held.map(|(frames, first)| FramesWarning::Held { frames, first: number(first) }),
            self.residual_outliers.map(|(frames, worst)| FramesWarning::ResidualOutliers {
                frames,
                worst: number(worst),
                worst_mm: self.residual_worst_mm,
            }),
            self.without_markers.map(|(frames, first)| FramesWarning::WithoutMarkers {
                frames,
                first: number(first),
            }),
            self.far_from_training.map(|(frames, first)| FramesWarning::FarFromTraining {
                frames,
                first: number(first),
            }),
            (self.smoothed > 0).then_some(FramesWarning::Smoothed { frames: self.smoothed }),
        ];
        told.into_iter().flatten().collect()
    }
}

/// What should be said of some frames of a solve; frames are numbered as in the capture.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "code", rename_all = "kebab-case", rename_all_fields = "camelCase")]
pub enum FramesWarning {
    /// Frames that were not solved.
    Held {
        /// How many.
        frames: usize,
        /// The first of them.
        first: u64,
    },
    /// Frames whose residual stands out of the take's.
    ResidualOutliers {
        /// How many.
        frames: usize,
        /// The worst of them.
        worst: u64,
        /// Its residual, millimetres.
        worst_mm: f64,
    },
    /// Frames in which no marker is seen.
    WithoutMarkers {
        /// How many.
        frames: usize,
        /// The first of them.
        first: u64,
    },
    /// Frames far from what a regression has learnt from.
    FarFromTraining {
        /// How many.
        frames: usize,
        /// The first of them.
        first: u64,
    },
    /// Frames whose norm had to be smoothed.
    Smoothed {
        /// How many.
        frames: usize,
    },
}

/// The warning as a sentence, in English.
impl fmt::Display for FramesWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counted =
            |count: usize| if count == 1 { "1 frame".into() } else { format!("{count} frames") };
        match *self {
            Self::Held { frames, first } => write!(
                f,
                "{} not solved (the first is {first}): held from the solved frames around",
                counted(frames)
            ),
            Self::ResidualOutliers { frames, worst, worst_mm } => write!(
                f,
                "{} with a residual over {OUTLIER_RATIO} times the take's median (the worst is {worst}, \
                 {worst_mm:.1} mm): a marker may jump or change its label there; look at it, or repair the capture",
                counted(frames)
            ),
            Self::WithoutMarkers { frames, first } => write!(
                f,
                "{} without any marker (the first is {first}): their weights come from the priors alone",
                counted(frames)
            ),
            Self::FarFromTraining { frames, first } => write!(
                f,
                "{} far from the training data (the first is {first}): their weights tend to the \
                 neutral face; record such expressions in the range of motion",
                counted(frames)
            ),
            Self::Smoothed { frames } => write!(
                f,
                "{} met the markers exactly: the norm was smoothed with eps = 1e-4 l",
                counted(frames)
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_residual_that_stands_out_is_told_with_its_frame() {
        let mut reports = vec![FrameReport { residual: 0.002, ..FrameReport::default() }; 20];
        reports[7].residual = 0.0049;
        assert_eq!(FrameStatistics::of(&reports).residual_outliers, None, "less than 5 mm");
        reports[7].residual = 0.011;
        reports[9].residual = 0.7375;
        let statistics = FrameStatistics::of(&reports);
        assert_eq!(statistics.residual_outliers, Some((2, 9)));
        let said: Vec<String> = statistics.warnings(100).iter().map(ToString::to_string).collect();
        assert!(said[0].starts_with("2 frames with a residual over 5 times"), "{said:?}");
        assert!(said[0].contains("the worst is 109, 737.5 mm"), "{said:?}");
        assert_eq!(FrameStatistics::of(&[]).residual_outliers, None);
    }

    #[test]
    fn frames_that_fail_are_counted_and_named() {
        let mut reports = vec![FrameReport::default(); 12];
        assert_eq!(FrameStatistics::of(&reports).warnings(700), Vec::<FramesWarning>::new());
        for frame in [4, 9] {
            reports[frame].warning = Some(FrameWarning::Held);
        }
        reports[2].warning = Some(FrameWarning::NoMarkers);
        let statistics = FrameStatistics::of(&reports);
        assert_eq!(statistics.held, Some((2, 4)));
        let said: Vec<String> = statistics.warnings(700).iter().map(ToString::to_string).collect();
        assert_eq!(said.len(), 2, "{said:?}");
        assert_eq!(
            said[0],
            "2 frames not solved (the first is 704): held from the solved frames around"
        );
        assert!(said[1].starts_with("1 frame without any marker (the first is 702)"), "{said:?}");
    }
}
