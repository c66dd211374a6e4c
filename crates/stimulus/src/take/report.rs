//! The report of a solve: per frame, over all frames, in words.

use mimique_clip::FrameStatistics;
use mimique_solver::{
    Combination, Fit, FrameReport, Kernel, Method, MethodSpec, Operators, Regression, bank_columns,
    is_told,
};
use serde::Serialize;

use super::ShapeRow;
use crate::TakeWarning;
use crate::checks::{GazeStatistics, HeadMarker, LabelProblem, SmoothingAdvice};
use crate::warning::as_sentences;

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

impl FrameRow {
    /// The rows of consecutive frames, counted from `first_frame`.
    pub(crate) fn of(reports: &[FrameReport], first_frame: u64) -> Vec<Self> {
        let row = |(r, frame): (&FrameReport, u64)| Self {
            frame,
            residual_mm: 1e3 * r.residual,
            iterations: r.iterations,
            kkt_error: r.kkt_error,
            energy_mm2: r.energy.map(|energy| 1e6 * energy),
            deviation: r.deviation,
            missing_markers: r.missing_markers,
            warning: r.warning.map(|w| w.to_string()),
        };
        reports.iter().zip(first_frame..).map(row).collect()
    }
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

/// The report of a solve.
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
    /// Frames per second.
    pub rate_hz: f64,
    /// Cut-off of the head's low-pass, Hz; null where the head was not filtered.
    pub head_lowpass_hz: Option<f64>,
    /// The shapes that turn the eyes and rest, since no gaze is given.
    pub gaze_at_rest: Vec<String>,
    /// Where the eyes look; none of a bank that turns no eye.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gaze: Option<GazeStatistics>,
    /// How each shape of the bank gets its weight, and how well the markers tell it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub shapes_told: Vec<ShapeRow>,
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
    /// What should be said; a sentence each in JSON.
    #[serde(serialize_with = "as_sentences")]
    pub warnings: Vec<TakeWarning>,
    /// How still the head markers are on the head.
    pub head_markers: Vec<HeadMarker>,
    /// Labels that are swapped or stand at one place.
    pub label_problems: Vec<LabelProblem>,
    /// What a smoothed adaptation of shape would gain, where it is advised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<SmoothingAdvice>,
    /// SHA-256 of the weights.
    pub weights_hash: String,
    /// SHA-256 of all that the weights come from, and of the weights.
    pub provenance: String,
    /// A row per frame.
    pub frames: Vec<FrameRow>,
}

/// Shapes that the markers do not tell and that are solved for all the same.
pub(crate) fn untold_shapes(operators: &Operators, spec: &MethodSpec) -> Option<TakeWarning> {
    // A surface has no shapes; what a regression knows of a shape it knows from its training.
    if matches!(spec.method, Method::ThinShellSurface | Method::Regression) {
        return None;
    }
    let parts = operators.parts();
    let squares = operators.marker_squares();
    let shapes: Vec<String> = (parts.shape_names.iter().zip(squares))
        .filter(|(name, square)| !is_told(*square) && !spec.locked.contains(name))
        .map(|(name, _)| name.clone())
        .collect();
    (!shapes.is_empty()).then_some(TakeWarning::ShapesUntold { shapes })
}

/// That the least of many weights was chosen, and between which shapes.
pub(crate) fn dependent_shapes(
    operators: &Operators,
    spec: &MethodSpec,
    fit: &Fit,
) -> Option<TakeWarning> {
    if !fit.chooses_least_norm() {
        return None;
    }
    let parts = operators.parts();
    let free: Vec<usize> = (0..parts.shape_names.len())
        .filter(|&k| !spec.locked.contains(&parts.shape_names[k]))
        .collect();
    let rows = parts.marker_deltas.chunks_exact(parts.shape_names.len());
    let bank: Vec<f64> = rows.flat_map(|row| free.iter().map(|&k| row[k])).collect();
    let name = |k: usize| parts.shape_names[free[k]].clone();
    let mut dependent = bank_columns(&bank, free.len(), 0.0).dependent;
    // Of two opposite shapes the least weights leave one at rest: the same face, and nothing to say.
    let opposites = dependent.extract_if(.., |c| c.of.iter().all(|&(_, weight)| weight < 0.0));
    if opposites.count() > 0 && dependent.is_empty() {
        return None;
    }
    let combination = |combination: Combination| {
        let of = combination.of.iter().map(|&(k, _)| name(k)).collect();
        (name(combination.shape), of)
    };
    let combinations = dependent.into_iter().map(combination).collect();
    Some(TakeWarning::ShapesDependent { combinations })
}
