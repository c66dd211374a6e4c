//! What a solve says of itself: per frame, over all frames, in words.

use mimique_solver::{FrameReport, FrameWarning, Kernel, number_text};
#[cfg(feature = "prepare")]
use mimique_solver::{Method, MethodSpec, Operators, Regression};
use serde::Serialize;

#[cfg(feature = "prepare")]
use crate::{HeadMarker, LabelProblem};

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
    /// Frames that did not reach the tolerance; the first of them.
    pub not_converged: Option<(usize, usize)>,
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
            not_converged: with(FrameWarning::NotConverged),
            without_markers: with(FrameWarning::NoMarkers),
            smoothed: with(FrameWarning::Smoothed).map_or(0, |(count, _)| count),
            far_from_training: with(FrameWarning::FarFromTraining),
            deviation_worst: reports.iter().filter_map(|r| r.deviation).reduce(f64::max),
        }
    }

    /// What should be said of the frames, counted from `first_frame`.
    pub fn warnings(&self, first_frame: u64) -> Vec<String> {
        let mut out = Vec::new();
        let frames =
            |count: usize| if count == 1 { "1 frame".into() } else { format!("{count} frames") };
        if let Some((count, first)) = self.not_converged {
            out.push(format!(
                "{} did not reach the tolerance (the first is {}; KKT error up to {})",
                frames(count),
                first as u64 + first_frame,
                scientific(self.kkt_worst)
            ));
        }
        if let Some((count, first)) = self.without_markers {
            out.push(format!(
                "{} without any marker (the first is {}): their weights come from the priors alone",
                frames(count),
                first as u64 + first_frame
            ));
        }
        if let Some((count, first)) = self.far_from_training {
            out.push(format!(
                "{} far from the training data (the first is {}): their weights tend to the \
                 neutral face; record such expressions in the range of motion",
                frames(count),
                first as u64 + first_frame
            ));
        }
        if self.smoothed > 0 {
            out.push(format!(
                "{} met the markers exactly: the norm was smoothed with eps = 1e-4 l",
                frames(self.smoothed)
            ));
        }
        out
    }
}

/// A positive number as `{:.1e}` writes it, without the code that writes any number: the browser's module
/// has none.
fn scientific(number: f64) -> String {
    if !(number.is_finite() && number > 0.0) {
        return number_text(number);
    }
    let (mut digits, mut exponent) = (number, 0);
    while digits >= 10.0 {
        (digits, exponent) = (digits / 10.0, exponent + 1);
    }
    while digits < 1.0 {
        (digits, exponent) = (digits * 10.0, exponent - 1);
    }
    let tenths = (10.0 * digits).round() as u32;
    let (tenths, exponent) = if tenths == 100 { (10, exponent + 1) } else { (tenths, exponent) };
    format!("{}.{}e{exponent}", tenths / 10, tenths % 10)
}

/// The seconds of each stage of a solve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct StageSeconds {
    /// Reading the files (filled in by the caller).
    pub read: f64,
    /// Welding, Laplacian, D and H, factorisations.
    pub set_up: f64,
    /// Head, alignment, adaptation.
    pub front_end: f64,
    /// The weights.
    pub solve: f64,
    /// Looking for swapped labels and head markers that move.
    pub check: f64,
    /// Writing the files (filled in by the caller).
    pub write: f64,
}

/// One frame of a report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrameRow {
    /// The frame's number, as in the capture.
    pub frame: u64,
    /// Root mean square distance of the markers, millimetres.
    pub residual_mm: f64,
    /// Iterations.
    pub iterations: u32,
    /// KKT error, in units of weight.
    pub kkt_error: f64,
    /// Thin-shell energy of a surface, square millimetres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy_mm2: Option<f64>,
    /// Predictive standard deviation of a regression's weights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation: Option<f64>,
    /// Markers not seen.
    pub missing_markers: u32,
    /// What is to be said of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub warning: Option<String>,
}

/// What a regression has learnt.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RegressionSummary {
    /// Frames learnt from.
    pub training_frames: usize,
    /// Basis vectors kept.
    pub basis_vectors: usize,
    /// Length scale, signal and noise.
    pub kernel: Kernel,
    /// Logarithm of the marginal likelihood of the frames that these were found on.
    pub log_likelihood: f64,
}

#[cfg(feature = "prepare")]
impl RegressionSummary {
    pub(crate) fn of(model: &Regression) -> Self {
        Self {
            training_frames: model.training_frames,
            basis_vectors: model.basis_count(),
            kernel: model.kernel,
            log_likelihood: model.log_likelihood,
        }
    }
}

#[cfg(feature = "prepare")]
/// What a solve says of itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SolveReport {
    /// The avatar.
    pub avatar: String,
    /// Vertices of its welded skin.
    pub vertices: usize,
    /// Its shapes.
    pub shapes: usize,
    /// The face markers.
    pub markers: Vec<String>,
    /// The markers that stabilise the head.
    pub head: Vec<String>,
    /// Frames of the neutral, counted from 0, the end not included.
    pub neutral: [usize; 2],
    /// Frames a second.
    pub rate_hz: f64,
    /// The method with every parameter that it used.
    pub method: MethodSpec,
    /// l = sqrt(tr(D^T D) / N), millimetres.
    pub data_scale_mm: f64,
    /// tau = tr(H) / N, square metres.
    pub shell_scale_m2: f64,
    /// What a regression has learnt from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regression: Option<RegressionSummary>,
    /// Over all frames.
    pub summary: FrameStatistics,
    /// The seconds of each stage.
    pub seconds: StageSeconds,
    /// What should be said, a sentence each.
    pub warnings: Vec<String>,
    /// How still the head markers are on the head.
    pub head_markers: Vec<HeadMarker>,
    /// Labels that are swapped or stand at one place.
    pub label_problems: Vec<LabelProblem>,
    /// SHA-256 of the weights.
    pub weights_hash: String,
    /// SHA-256 of all that the weights come from, and of the weights.
    pub provenance: String,
    /// A row a frame.
    pub frames: Vec<FrameRow>,
}

/// Shapes that move no marker by a millimetre at weight 1, and are not locked.
#[cfg(feature = "prepare")]
pub(crate) fn unseen_shapes(operators: &Operators, spec: &MethodSpec) -> Option<String> {
    // A surface has no shapes; what a regression knows of a shape it knows from its training.
    if matches!(spec.method, Method::ThinShellSurface | Method::Regression) {
        return None;
    }
    let names: Vec<&str> = operators
        .parts()
        .shape_names
        .iter()
        .zip(operators.marker_reach())
        .filter(|(name, reach)| *reach < 1e-3 && !spec.locked.contains(name))
        .map(|(name, _)| name.as_str())
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "{} shapes move no marker by 1 mm, so the markers hardly tell their weights: {}; \
             lock them to 0 or place markers where they move",
            names.len(),
            names.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_others_write_them() {
        let many = (-300..300).map(|k| 10f64.powf(f64::from(k) / 17.0));
        for number in many.chain([0.25, 0.99, 0.9949, 0.996, 1e-10, 5e-324, f64::MAX]) {
            assert_eq!(scientific(number), format!("{number:.1e}"));
        }
        assert_eq!((scientific(0.0), scientific(f64::NAN)), ("0".to_owned(), "NaN".to_owned()));
    }

    #[test]
    fn frames_that_fail_are_counted_and_named() {
        let mut reports = vec![FrameReport::default(); 12];
        assert_eq!(FrameStatistics::of(&reports).warnings(700), Vec::<String>::new());
        for frame in [4, 9] {
            reports[frame].warning = Some(FrameWarning::NotConverged);
            reports[frame].kkt_error = 0.25;
        }
        reports[2].warning = Some(FrameWarning::NoMarkers);
        let statistics = FrameStatistics::of(&reports);
        assert_eq!(statistics.not_converged, Some((2, 4)));
        let said = statistics.warnings(700);
        assert_eq!(said.len(), 2, "{said:?}");
        assert_eq!(
            said[0],
            "2 frames did not reach the tolerance (the first is 704; KKT error up to 2.5e-1)"
        );
        assert!(said[1].starts_with("1 frame without any marker (the first is 702)"), "{said:?}");
    }
}
