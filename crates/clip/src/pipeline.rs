//! The one way from the markers of a take to weights: head, adaptation of shape, displacements, the
//! method, the lids. Command line, studio, server and browser all come through here; what differs is
//! only where the [`MarkerTake`] comes from.

use std::ops::Range;

use mimique_geometry::RigidMotion;
use mimique_solver::{
    Adaptation, Fit, FitError, FrameReport, FrontEnd, FrontEndError, FrontEndScratch, Gaze, Group,
    MarkerColumns, MarkerFrames, MarkerScales, MethodSpec, Operators, SurfaceDepth,
};

use crate::gaze::{bring_eyes_together, gaze_at_rest, with_gaze_at_rest};
use crate::packs::SegmentMarkers;
use crate::unsolved::{UnsolvedFrames, settle};
use crate::weight_timing::time_weights;

/// The markers that are solved: stored frames, and which of them are played.
#[derive(Debug, Clone)]
pub struct MarkerTake<'a> {
    /// Markers, and what head, neutral and scale were fitted to.
    pub markers: &'a SegmentMarkers,
    /// Frames per second.
    pub rate_hz: f64,
    /// Which of the stored frames are solved; the others are margins of the head's low-pass.
    pub played: Range<usize>,
}

/// What the front end makes of a take.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkerMotion {
    /// Alignment and adaptation of shape, the face markers in the order of the operators.
    pub front_end: FrontEnd,
    /// The head's motion back to its reference, for each played frame.
    pub poses: Vec<RigidMotion>,
    /// Cut-off of the head's low-pass, Hz; `None` where the head is not filtered.
    pub head_lowpass_hz: Option<f64>,
    /// Played frames x 3P, metres, NaN for markers that are not seen.
    pub displacements: Vec<f64>,
}

/// The answer of the pipeline.
#[derive(Debug, Clone)]
pub struct MarkerSolution {
    /// What was solved for.
    pub motion: MarkerMotion,
    /// The method as it was set up.
    pub fit: Fit,
    /// The shapes that turn the eyes and rest, since no gaze is given.
    pub gaze_at_rest: Vec<String>,
    /// Played frames x N, in the avatar's order of shapes, the driven lids in their places.
    pub weights: Vec<f64>,
    /// One for each played frame.
    pub reports: Vec<FrameReport>,
    /// Seconds of each stage.
    pub seconds: PipelineSeconds,
}

/// The seconds of the pipeline's stages.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PipelineSeconds {
    /// Factorisations of the method.
    pub set_up: f64,
    /// Head, alignment, adaptation.
    pub front_end: f64,
    /// The weights.
    pub solve: f64,
}

/// Why markers cannot be solved.
#[derive(Debug, thiserror::Error)]
pub enum PipelineError {
    /// The take has no marker that the operators ask for.
    #[error(
        "marker {0}: the operators have it, the take has not; prepare both from one marker map"
    )]
    NoMarker(String),
    /// Head, neutral or alignment fail.
    #[error(transparent)]
    FrontEnd(#[from] FrontEndError),
    /// Frames are not solved.
    #[error("{}", .0.sentence(0))]
    Unsolved(UnsolvedFrames),
    /// The method and the operators do not fit.
    #[error(transparent)]
    Fit(#[from] FitError),
}

/// Solves the played frames of a take by a method. Shapes that turn the eyes rest
/// ([`with_gaze_at_rest`]).
///
/// `clock` gives seconds from any origin; it is asked between the stages.
///
/// # Errors
/// [`PipelineError`]: operators of other markers or another method, a head or neutral that cannot be
/// found, frames that are not solved where the method does not say to hold them.
pub fn solve_markers(
    operators: &Operators,
    take: &MarkerTake<'_>,
    spec: &MethodSpec,
    clock: &mut dyn FnMut() -> f64,
) -> Result<MarkerSolution, PipelineError> {
    let start = clock();
    let shape_names = &operators.parts().shape_names;
    let spec = with_gaze_at_rest(spec, shape_names);
    let fit = Fit::new(operators, &spec)?;
    let set_up = clock();
    let motion = marker_motion(operators, take, &spec)?;
    let front_end = clock();
    let mut solution = fit.solve_take(&motion.displacements)?;
    let width = 3 * fit.marker_count();
    let residual = |frame: usize, weights: &[f64]| {
        fit.residual(&motion.displacements[frame * width..(frame + 1) * width], weights)
    };
    settle(&mut solution, spec.unsolved.unwrap_or_default(), residual)
        .map_err(PipelineError::Unsolved)?;
    if spec.gaze() == Gaze::Together && spec.method.uses(Group::Shapes) {
        bring_eyes_together(&mut solution.weights, shape_names);
        let rows = solution.weights.chunks_exact(shape_names.len());
        for (frame, (report, row)) in solution.reports.iter_mut().zip(rows).enumerate() {
            report.residual = residual(frame, row);
        }
    }
    put_driven(&mut solution.weights, shape_names, take);
    time_weights(&mut solution.weights, shape_names.len(), take.rate_hz, &spec)
        .map_err(FrontEndError::Lowpass)?;
    let seconds = PipelineSeconds {
        set_up: set_up - start,
        front_end: front_end - set_up,
        solve: clock() - front_end,
    };
    Ok(MarkerSolution {
        motion,
        fit,
        gaze_at_rest: gaze_at_rest(&spec, shape_names, &take.markers.driven_shapes),
        weights: solution.weights,
        reports: solution.reports,
        seconds,
    })
}

/// Where the markers of the played frames ask the avatar's skin to go: everything before the method.
///
/// # Errors
/// [`PipelineError`]: operators of other markers, a head or neutral that cannot be found.
pub fn marker_motion(
    operators: &Operators,
    take: &MarkerTake<'_>,
    spec: &MethodSpec,
) -> Result<MarkerMotion, PipelineError> {
    let MarkerTake { markers, rate_hz, played } = take;
    let front_end = front_end(operators, markers, spec)?;
    let lowpass = spec.head_lowpass(*rate_hz).map_err(FrontEndError::Lowpass)?;
    let frames = MarkerFrames { positions: &markers.positions, columns: markers.labels.len() };
    let mut poses = front_end.segment_poses(frames, lowpass.as_ref())?;
    poses.truncate(played.end);
    poses.drain(..played.start);
    let width = 3 * operators.marker_count();
    let mut displacements = vec![0.0; played.len() * width];
    let mut scratch = FrontEndScratch::default();
    for ((frame, pose), out) in
        played.clone().zip(&poses).zip(displacements.chunks_exact_mut(width))
    {
        front_end.displacements(pose, frames.frame(frame), out, &mut scratch);
    }
    let filtered = markers.head.is_some() && lowpass.is_some();
    let head_lowpass_hz = spec.head_lowpass_hz(*rate_hz).filter(|_| filtered);
    Ok(MarkerMotion { front_end, poses, head_lowpass_hz, displacements })
}

/// The front end that the take was fitted with, its face markers in the order of the operators.
fn front_end(
    operators: &Operators,
    markers: &SegmentMarkers,
    spec: &MethodSpec,
) -> Result<FrontEnd, PipelineError> {
    let parts = operators.parts();
    let mut order = Vec::new();
    for label in &parts.marker_labels {
        let found = markers.face.iter().position(|&column| markers.labels[column] == *label);
        order.push(found.ok_or_else(|| PipelineError::NoMarker(label.clone()))?);
    }
    let face = order.iter().map(|&i| markers.face[i]).collect();
    let scales = markers.scales.as_ref().map(|s| MarkerScales {
        positive: order.iter().map(|&i| s.positive[i]).collect(),
        negative: order.iter().map(|&i| s.negative[i]).collect(),
    });
    let depth = (markers.depth.as_ref())
        .map(|d| SurfaceDepth { fans: order.iter().map(|&i| d.fans[i].clone()).collect() });
    let front_end = FrontEnd::from_parts(
        MarkerColumns { face, head: markers.head.clone() },
        markers.head_reference.clone(),
        order.iter().map(|&i| markers.neutral[i]).collect(),
        parts.marker_positions.clone(),
        Adaptation { depth, smoothing: spec.rbf_smoothing() },
    )?;
    Ok(front_end.with_scales(scales)?)
}

/// Puts weights that do not come from the method in the place of the solved ones.
fn put_driven(weights: &mut [f64], shape_names: &[String], take: &MarkerTake<'_>) {
    let SegmentMarkers { driven_shapes, driven_weights, .. } = take.markers;
    let count = driven_shapes.len();
    let driven = &driven_weights[take.played.start * count..take.played.end * count];
    for (column, name) in driven_shapes.iter().enumerate() {
        let Some(shape) = shape_names.iter().position(|n| n == name) else { continue };
        let rows = weights.chunks_exact_mut(shape_names.len());
        for (row, from) in rows.zip(driven.chunks_exact(count)) {
            row[shape] = from[column];
        }
    }
}
