//! The solve of one clip from its two packs: the same function natively and in the browser, so
//! that the server knows the weights that every browser will compute.

use mimique_face::pack::PackError;
use mimique_solver::{
    Fit, FitError, FrontEnd, FrontEndError, Lowpass, MarkerColumns, MarkerFrames, MarkerScales,
    MethodSpec, Operators, SurfaceDepth,
};

use crate::operators_pack::{decode_inflated_operators, decode_operators};
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

/// Solves a take pack with an operators pack by a method. A take of recorded weights is unpacked as
/// it is; its operators are not looked at.
///
/// # Errors
/// [`SolvePacksError`]: a damaged pack, packs that do not belong together, a method that does not
/// solve with these operators.
pub fn solve_packs(
    operators: &[u8],
    take: &[u8],
    spec: &MethodSpec,
) -> Result<SolvedTake, SolvePacksError> {
    solve_with(|| decode_operators(operators), take, spec)
}

/// The same with an operators pack whose body is inflated already, as browsers do it.
///
/// # Errors
/// As [`solve_packs`].
pub fn solve_inflated(
    operators: &[u8],
    take: &[u8],
    spec: &MethodSpec,
) -> Result<SolvedTake, SolvePacksError> {
    solve_with(|| decode_inflated_operators(operators), take, spec)
}

fn solve_with(
    operators: impl FnOnce() -> Result<Operators, PackError>,
    take: &[u8],
    spec: &MethodSpec,
) -> Result<SolvedTake, SolvePacksError> {
    let take = decode_take(take)?;
    match &take.content {
        TakeContent::Markers(markers) => solve_markers(&operators()?, &take, markers, spec),
        TakeContent::Weights { shape_names, weights } => {
            let n = shape_names.len();
            let weights = weights[take.played.start * n..take.played.end * n].to_vec();
            Ok(SolvedTake {
                shape_names: shape_names.clone(),
                rate_hz: take.rate_hz,
                weights_hash: weights_hash(&weights),
                weights,
                statistics: None,
                warnings: vec![],
            })
        }
    }
}

/// Solves the markers of a take that is open already.
///
/// # Errors
/// As [`solve_packs`].
pub fn solve_segment(
    operators: &Operators,
    take: &TakePack,
    spec: &MethodSpec,
) -> Result<SolvedTake, SolvePacksError> {
    match &take.content {
        TakeContent::Markers(markers) => solve_markers(operators, take, markers, spec),
        TakeContent::Weights { .. } => Err(FitError::Recorded.into()),
    }
}

fn solve_markers(
    operators: &Operators,
    take: &TakePack,
    markers: &SegmentMarkers,
    spec: &MethodSpec,
) -> Result<SolvedTake, SolvePacksError> {
    let parts = operators.parts();
    // The operators' order of markers, whatever the take's.
    let mut order = Vec::new();
    for label in &parts.marker_labels {
        let found = markers.face.iter().position(|&column| markers.labels[column] == *label);
        let found = found.ok_or_else(|| SolvePacksError::NoMarker(label.clone()))?;
        order.push(found);
    }
    let face = order.iter().map(|&i| markers.face[i]).collect();
    let in_order = |points: &[[f64; 3]]| order.iter().map(|&i| points[i]).collect();
    let scales = markers
        .scales
        .as_ref()
        .map(|s| MarkerScales { positive: in_order(&s.positive), negative: in_order(&s.negative) });
    let depth = markers
        .depth
        .as_ref()
        .map(|d| SurfaceDepth { fans: order.iter().map(|&i| d.fans[i].clone()).collect() });
    let front_end = FrontEnd::from_parts(
        MarkerColumns { face, head: markers.head.clone() },
        markers.head_reference.clone(),
        in_order(&markers.neutral),
        parts.marker_positions.clone(),
        depth,
    )?
    .with_scales(scales)?;
    let lowpass = lowpass(spec, take.rate_hz)?;
    let frames = MarkerFrames { positions: &markers.positions, columns: markers.labels.len() };
    let poses = front_end.segment_poses(frames, lowpass.as_ref())?;
    let displacements = front_end.take_displacements(frames, &poses)?;
    let width = 3 * parts.marker_labels.len();
    let played = &displacements[take.played.start * width..take.played.end * width];
    let mut solution = Fit::new(operators, spec)?.solve_take(played)?;
    let shapes = markers.driven_shapes.len();
    let driven = &markers.driven_weights[take.played.start * shapes..take.played.end * shapes];
    put_driven(&mut solution.weights, &parts.shape_names, &markers.driven_shapes, driven);
    let statistics = FrameStatistics::of(&solution.reports);
    Ok(SolvedTake {
        shape_names: parts.shape_names.clone(),
        rate_hz: take.rate_hz,
        weights_hash: weights_hash(&solution.weights),
        weights: solution.weights,
        warnings: statistics.warnings(take.first_frame),
        statistics: Some(statistics),
    })
}

/// Puts weights that do not come from the solve in the place of the solved ones.
pub(crate) fn put_driven(
    weights: &mut [f64],
    shape_names: &[String],
    driven_shapes: &[String],
    driven: &[f64],
) {
    for (column, name) in driven_shapes.iter().enumerate() {
        let Some(shape) = shape_names.iter().position(|n| n == name) else { continue };
        let rows = weights.chunks_exact_mut(shape_names.len());
        for (row, from) in rows.zip(driven.chunks_exact(driven_shapes.len())) {
            row[shape] = from[column];
        }
    }
}

/// The head's low-pass that a method asks for.
pub(crate) fn lowpass(spec: &MethodSpec, rate_hz: f64) -> Result<Option<Lowpass>, FrontEndError> {
    match spec.head_lowpass_hz {
        None | Some(0.0) => Ok(None),
        Some(cutoff) => Ok(Some(Lowpass::new(cutoff, rate_hz)?)),
    }
}
