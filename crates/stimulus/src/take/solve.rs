//! Avatar, capture, marker map and method in; weights per frame and a report out.

use std::ops::Range;

use mimique_clip::{FrameStatistics, MarkerSolution, solve_markers, weights_hash};
use mimique_mocap::{Capture, WeightsTable};
use mimique_solver::{FitError, MarkerSite, Method, MethodSpec, Operators, SurfaceResponse};

use super::report::{
    FrameRow, RegressionSummary, SolveReport, StageSeconds, dependent_shapes, untold_shapes,
};
use super::{JoinedTake, SetUp, SolveError, Training};
use crate::checks::{HeadMarker, LabelProblem, is_fitted, moving_skin};
use crate::{
    AvatarSkin, Depth, GazeStatistics, GivenGaze, MarkerMap, ScaleRule, SmoothingAdvice,
    TakeWarning,
};

/// What the user decides beside the method.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TakeOptions {
    /// Frames of the neutral face, counted from 0; the map's where not given, else the stillest
    /// second.
    pub neutral: Option<Range<usize>>,
    /// Labels of the markers that stabilise the head; the map's where not given.
    pub head: Option<Vec<String>>,
    /// What the capture's repair is known by: a hash of its record.
    pub repair: Option<String>,
    /// What `regression` learns from.
    pub training: Option<Box<Training>>,
    /// Scale factors of the displacements; what is given here stands before the map's.
    pub scale: ScaleRule,
    /// Where the third coordinate comes from; the map's where not given.
    pub depth: Option<Depth>,
    /// Where the eyes look; they rest where it is not given, but for what the method asks of the markers.
    pub gaze: Option<GivenGaze>,
    /// Share of the head's own motion that packs of segments carry, 0 to 1: 0, a head that is held still, where it is
    /// not given.
    pub head_motion: f64,
}

/// Weights and their report.
#[derive(Debug, Clone, PartialEq)]
pub struct SolvedCapture {
    /// The weights, a row per frame; for `thin-shell-surface` where its markers go, in centimetres.
    pub table: WeightsTable,
    /// The surface that the weights of `thin-shell-surface` move.
    pub surface: Option<SurfaceResponse>,
    /// How it went.
    pub report: SolveReport,
    /// The face markers on the welded skin.
    pub sites: Vec<MarkerSite>,
    /// Where each marker asks the skin to go: frames x 3P, metres, NaN where it is lost.
    pub displacements: Vec<f64>,
}

/// Solves a capture with one method.
///
/// `clock` gives seconds from any origin; it is asked between the stages.
///
/// # Errors
/// [`SolveError`]: map, labels, head, neutral, or a method that does not solve.
pub fn solve_take(
    skin: &AvatarSkin,
    capture: &Capture,
    map: &MarkerMap,
    spec: &MethodSpec,
    options: &TakeOptions,
    clock: &mut dyn FnMut() -> f64,
) -> Result<SolvedCapture, SolveError> {
    if spec.method == Method::Recorded {
        return Err(FitError::Recorded.into());
    }
    spec.validate().map_err(FitError::from)?;
    let start = clock();
    let joined = JoinedTake::new(skin, capture, map, options)?;
    let written = spec;
    let asked = joined.with_shapes_held(spec);
    let spec = &asked.at_rate(joined.rate_hz);
    let SetUp { operators, surface } = joined.set_up(&asked, options.training.as_deref())?;
    let set_up = clock();
    let markers = joined.markers_of(&operators, spec, 0..joined.frame_count())?;
    let fitted = clock();
    let take = joined.whole(&markers);
    let solution = solve_markers(&operators, &take, spec, clock)
        .map_err(|e| SolveError::from(e).counted_from(joined.first_frame))?;
    let solved = clock();
    let checks = Checks::of(&joined, spec, &operators, &solution)?;
    let stages = solution.seconds;
    let seconds = StageSeconds {
        set_up: set_up - start + stages.set_up,
        front_end: fitted - set_up + stages.front_end,
        solve: stages.solve,
        check: clock() - solved,
        ..StageSeconds::default()
    };
    let mut report = report(&joined, spec, &operators, &solution, checks);
    report.seconds = seconds;
    report.shapes_told = joined.shape_rows(written, &asked, &operators);
    report.warnings.extend(joined.unfiltered_head(&asked));
    report.warnings.extend(dependent_shapes(&operators, spec, &solution.fit));
    report.warnings.extend(surface.as_ref().and_then(adrift));
    let mut provenance = joined.provenance(spec).json("weights", report.weights_hash.as_str());
    if let Some(training) = &options.training {
        report.warnings.extend(training.warnings(&skin.shape_names));
        provenance = provenance.json("training", training.key());
    }
    report.provenance = provenance.hash();
    let names = operators.parts().shape_names.clone();
    let table = WeightsTable::at_rate(names, solution.weights, joined.first_frame, joined.rate_hz);
    let displacements = solution.motion.displacements;
    Ok(SolvedCapture { table, surface, report, sites: joined.markers, displacements })
}

/// What looks wrong in a solved take.
struct Checks {
    head_markers: Vec<HeadMarker>,
    label_problems: Vec<LabelProblem>,
    smoothing: Option<SmoothingAdvice>,
}

impl Checks {
    fn of(
        joined: &JoinedTake<'_>,
        spec: &MethodSpec,
        operators: &Operators,
        solution: &MarkerSolution,
    ) -> Result<Self, SolveError> {
        let label_problems =
            if is_fitted(spec) { joined.label_problems(operators, solution) } else { Vec::new() };
        let residual = FrameStatistics::of(&solution.reports).residual_rms_mm;
        let smoothing = joined.smoothing_advice(operators, spec, Some(residual))?;
        Ok(Self { head_markers: joined.head_markers()?, label_problems, smoothing })
    }
}

/// The report of a solve; seconds and provenance are filled in by the caller.
fn report(
    joined: &JoinedTake<'_>,
    spec: &MethodSpec,
    operators: &Operators,
    solution: &MarkerSolution,
    Checks { head_markers, label_problems, smoothing }: Checks,
) -> SolveReport {
    let summary = FrameStatistics::of(&solution.reports);
    let mut warnings = joined.warnings.clone();
    warnings.extend(moving_skin(&head_markers));
    warnings.extend(label_problems.iter().cloned().map(TakeWarning::Labels));
    warnings.extend(smoothing.map(TakeWarning::Smoothing));
    warnings.extend(untold_shapes(operators, spec));
    warnings.extend(summary.warnings(joined.first_frame).into_iter().map(TakeWarning::Frames));
    let gaze = GazeStatistics::of(&operators.parts().shape_names, &solution.weights);
    warnings.extend(gaze.as_ref().and_then(|gaze| gaze.warning(joined.first_frame)));
    SolveReport {
        avatar: joined.skin.name.clone(),
        vertices: joined.skin.mesh.positions.len(),
        shapes: operators.shape_count(),
        markers: joined.markers.iter().map(|site| site.label.clone()).collect(),
        head: joined.head_labels(),
        neutral: [joined.neutral.start, joined.neutral.end],
        rate_hz: joined.rate_hz,
        head_lowpass_hz: solution.motion.head_lowpass_hz,
        gaze_at_rest: solution.gaze_at_rest.clone(),
        gaze,
        shapes_told: Vec::new(),
        method: spec.resolved(),
        data_scale_mm: 1e3 * operators.data_scale().sqrt(),
        shell_scale_m2: operators.shell_scale(),
        summary,
        seconds: StageSeconds::default(),
        warnings,
        regression: operators.parts().regression.as_ref().map(RegressionSummary::of),
        head_markers,
        label_problems,
        smoothing,
        provenance: String::new(),
        weights_hash: weights_hash(&solution.weights),
        frames: FrameRow::of(&solution.reports, joined.first_frame),
    }
}

/// What should be said of pieces of a surface that no marker moves.
fn adrift(surface: &SurfaceResponse) -> Option<TakeWarning> {
    let vertices = surface.without_marker;
    (vertices > 0).then_some(TakeWarning::VerticesAdrift { vertices })
}
