//! The solve of one clip from its two packs: the same function natively and in the browser, so
//! that the server knows the weights that every browser will compute.

use mimique_avatar::HEAD_POSE_SHAPES;
use mimique_avatar::pack::PackError;
use mimique_solver::{FitError, FrontEndError, MethodSpec, Operators};

use crate::frame_statistics::{FrameStatistics, FramesWarning};
use crate::packs::{
    SegmentMarkers, TakeContent, TakePack, decode_inflated_operators, decode_operators, decode_take,
};
use crate::pipeline::{MarkerTake, PipelineError, solve_markers};
use crate::weight_timing::time_weights;
use mimique_solver::weights_hash;

/// The weights of a clip.
#[derive(Debug, Clone, PartialEq)]
pub struct SolvedTake {
    /// The N shapes, in the avatar's order; behind those of the face perhaps those that turn the head.
    pub shape_names: Vec<String>,
    /// Frames per second.
    pub rate_hz: f64,
    /// Frame-major: frames x N.
    pub weights: Vec<f64>,
    /// SHA-256 of the weights (f64, little-endian, frame-major), hexadecimal.
    pub weights_hash: String,
    /// Cut-off of the head's low-pass, Hz; `None` where the head was not filtered.
    pub head_lowpass_hz: Option<f64>,
    /// The shapes that turn the eyes and rest, since no gaze is given.
    pub gaze_at_rest: Vec<String>,
    /// Residual, iterations and convergence over all frames; `None` for recorded weights.
    pub statistics: Option<FrameStatistics>,
    /// What should be said of its frames.
    pub warnings: Vec<FramesWarning>,
}

/// Why a clip cannot be solved.
#[derive(Debug, thiserror::Error)]
pub enum SolvePacksError {
    /// A pack is damaged or of another kind.
    #[error(transparent)]
    Pack(#[from] PackError),
    /// The packs do not belong together, or the method does not solve with them.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
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
        TakeContent::Markers(_) => Ok(solve_segment(&operators()?, &take, spec)?),
        TakeContent::Weights { shape_names, weights } => {
            let n = shape_names.len();
            let mut weights = weights[take.played.start * n..take.played.end * n].to_vec();
            time_weights(&mut weights, n, take.rate_hz, spec)
                .map_err(|error| PipelineError::from(FrontEndError::Lowpass(error)))?;
            Ok(SolvedTake {
                shape_names: shape_names.clone(),
                rate_hz: take.rate_hz,
                weights_hash: weights_hash(&weights),
                weights,
                head_lowpass_hz: None,
                gaze_at_rest: vec![],
                statistics: None,
                warnings: vec![],
            })
        }
    }
}

/// Solves the markers of a take that is open already.
///
/// # Errors
/// [`PipelineError`]; a take of recorded weights has nothing to solve.
pub fn solve_segment(
    operators: &Operators,
    take: &TakePack,
    spec: &MethodSpec,
) -> Result<SolvedTake, PipelineError> {
    let TakeContent::Markers(markers) = &take.content else {
        return Err(FitError::Recorded.into());
    };
    let marker_take = MarkerTake { markers, rate_hz: take.rate_hz, played: take.played.clone() };
    let solution = solve_markers(operators, &marker_take, spec, &mut || 0.0)?;
    let statistics = FrameStatistics::of(&solution.reports);
    let (shape_names, weights) =
        with_head_pose(&operators.parts().shape_names, solution.weights, &marker_take, spec)?;
    Ok(SolvedTake {
        shape_names,
        rate_hz: take.rate_hz,
        weights_hash: weights_hash(&weights),
        weights,
        head_lowpass_hz: solution.motion.head_lowpass_hz,
        gaze_at_rest: solution.gaze_at_rest,
        warnings: statistics.warnings(take.first_frame),
        statistics: Some(statistics),
    })
}

/// Weights with those of the shapes that turn the head behind them, where the take carries any: avatars have these
/// shapes right behind those of the face, and no method solves for them.
fn with_head_pose(
    shape_names: &[String],
    weights: Vec<f64>,
    take: &MarkerTake<'_>,
    spec: &MethodSpec,
) -> Result<(Vec<String>, Vec<f64>), PipelineError> {
    let SegmentMarkers { driven_shapes, driven_weights, .. } = take.markers;
    let place = |name: &&str| driven_shapes.iter().position(|driven| driven == name);
    let places: Vec<usize> = HEAD_POSE_SHAPES.iter().filter_map(place).collect();
    let known = shape_names.iter().any(|name| HEAD_POSE_SHAPES.contains(&name.as_str()));
    if places.len() < HEAD_POSE_SHAPES.len() || known {
        return Ok((shape_names.to_vec(), weights));
    }
    let rows = weights.chunks_exact(shape_names.len());
    let frames = driven_weights.chunks_exact(driven_shapes.len()).skip(take.played.start);
    let mut head: Vec<f64> = frames
        .take(take.played.len())
        .flat_map(|driven| places.iter().map(|&k| driven[k]))
        .collect();
    time_weights(&mut head, places.len(), take.rate_hz, spec).map_err(FrontEndError::Lowpass)?;
    let beside =
        |(row, head): (&[f64], &[f64])| row.iter().chain(head).copied().collect::<Vec<f64>>();
    let weights = rows.zip(head.chunks_exact(places.len())).flat_map(beside).collect();
    let names = shape_names.iter().cloned().chain(HEAD_POSE_SHAPES.map(str::to_owned));
    Ok((names.collect(), weights))
}
