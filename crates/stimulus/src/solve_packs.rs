//! The solve of one clip from its two packs: the same function natively and in the browser, so
//! that the server knows the weights that every browser will compute.

use mimique_face::pack::PackError;
use mimique_solver::{
    Fit, FitError, FrontEnd, FrontEndError, Lowpass, MarkerColumns, MarkerFrames, MethodSpec,
    Operators,
};

use crate::operators_pack::decode_operators;
use crate::provenance::weights_hash;
use crate::report::FrameStatistics;
use crate::take_pack::{SegmentMarkers, TakeContent, TakePack, decode_take};

/// The weights of a clip.
#[derive(Debug, Clone, PartialEq)]
pub struct SolvedTake {
    /// The N shapes, in the avatar's order.
    pub shape_names: Vec<String>,
    /// Frames a second.
    pub rate_hz: f64,
    /// Frame-major: frames x N.
    pub weights: Vec<f64>,
    /// SHA-256 of the weights (f64, little-endian, frame-major), hexadecimal.
    pub weights_hash: String,
    /// Residual, iterations and convergence over all frames; `None` for recorded weights.
    pub statistics: Option<FrameStatistics>,
    /// What should be said, a sentence each.
    pub warnings: Vec<String>,
}

/// Why a clip cannot be solved.
#[derive(Debug, thiserror::Error)]
pub enum SolvePacksError {
    /// A pack is damaged or of another kind.
    #[error(transparent)]
    Pack(#[from] PackError),
    /// The take has no marker that the operators ask for.
    #[error(
        "marker {0}: the operators have it, the take has not; prepare both from one marker map"
    )]
    NoMarker(String),
    /// Head, neutral or alignment fail.
    #[error(transparent)]
    FrontEnd(#[from] FrontEndError),
    /// The method and the operators do not fit.
    #[error(transparent)]
    Fit(#[from] FitError),
}

impl SolvedTake {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.weights.len() / self.shape_names.len().max(1)
    }
}

/// Solves a take pack with an operators pack by a method.
///
/// # Errors
/// [`SolvePacksError`]: a damaged pack, packs that do not belong together, a method that does not
/// solve with these operators.
pub fn solve_packs(
    operators: &[u8],
    take: &[u8],
    spec: &MethodSpec,
) -> Result<SolvedTake, SolvePacksError> {
    solve_unpacked(&decode_operators(operators)?, &decode_take(take)?, spec)
}

/// The same with packs that are open already.
///
/// # Errors
/// As [`solve_packs`].
pub fn solve_unpacked(
    operators: &Operators,
    take: &TakePack,
    spec: &MethodSpec,
) -> Result<SolvedTake, SolvePacksError> {
    let shape_names = operators.parts().shape_names.clone();
    let mut warnings = Vec::new();
    let (weights, statistics) = match &take.content {
        TakeContent::Weights { shape_names: columns, weights } => {
            (recorded(&shape_names, columns, weights, take, &mut warnings), None)
        }
        TakeContent::Markers(markers) => {
            let (weights, statistics) = solve_markers(operators, take, markers, spec)?;
            warnings.extend(statistics.warnings(take.first_frame));
            (weights, Some(statistics))
        }
    };
    let weights_hash = weights_hash(&weights);
    let rate_hz = take.rate_hz;
    Ok(SolvedTake { shape_names, rate_hz, weights, weights_hash, statistics, warnings })
}

fn solve_markers(
    operators: &Operators,
    take: &TakePack,
    markers: &SegmentMarkers,
    spec: &MethodSpec,
) -> Result<(Vec<f64>, FrameStatistics), SolvePacksError> {
    let parts = operators.parts();
    // The operators' order of markers, whatever the take's.
    let mut face = Vec::new();
    let mut neutral = Vec::new();
    for label in &parts.marker_labels {
        let found = markers.face.iter().position(|&column| markers.labels[column] == *label);
        let found = found.ok_or_else(|| SolvePacksError::NoMarker(label.clone()))?;
        face.push(markers.face[found]);
        neutral.push(markers.neutral[found]);
    }
    let front_end = FrontEnd::from_neutral(
        MarkerColumns { face, head: markers.head.clone() },
        markers.head_reference.clone(),
        neutral,
        parts.marker_positions.clone(),
    )?;
    let lowpass = lowpass(spec, take.rate_hz)?;
    let frames = MarkerFrames { positions: &markers.positions, columns: markers.labels.len() };
    let poses = front_end.segment_poses(frames, lowpass.as_ref())?;
    let displacements = front_end.take_displacements(frames, &poses)?;
    let width = 3 * parts.marker_labels.len();
    let played = &displacements[take.played.start * width..take.played.end * width];
    let solution = Fit::new(operators, spec)?.solve_take(played)?;
    Ok((solution.weights, FrameStatistics::of(&solution.reports)))
}

/// The head's low-pass that a method asks for.
pub(crate) fn lowpass(spec: &MethodSpec, rate_hz: f64) -> Result<Option<Lowpass>, FrontEndError> {
    match spec.head_lowpass_hz {
        None | Some(0.0) => Ok(None),
        Some(cutoff) => Ok(Some(Lowpass::new(cutoff, rate_hz)?)),
    }
}

/// Recorded weights in the avatar's order; what the avatar lacks is said, what the recording lacks
/// stays 0.
fn recorded(
    shape_names: &[String],
    columns: &[String],
    weights: &[f64],
    take: &TakePack,
    warnings: &mut Vec<String>,
) -> Vec<f64> {
    let lost: Vec<&str> =
        columns.iter().filter(|c| !shape_names.contains(c)).map(String::as_str).collect();
    if !lost.is_empty() {
        warnings.push(format!("the avatar has no shape {}: left out", lost.join(", ")));
    }
    let source: Vec<Option<usize>> =
        shape_names.iter().map(|n| columns.iter().position(|c| c == n)).collect();
    take.played
        .clone()
        .flat_map(|frame| {
            let row = &weights[frame * columns.len()..(frame + 1) * columns.len()];
            source.iter().map(|s| s.map_or(0.0, |column| row[column])).collect::<Vec<_>>()
        })
        .collect()
}
