//! Avatar, capture, marker map and method in; weights a frame and a report out.

use std::ops::Range;

use mimique_mocap::Capture;
use mimique_solver::{Fit, FitError, MarkerSite, Method, MethodSpec, SurfaceResponse};

use crate::head_check::moving_skin;
use crate::report::{
    FrameRow, FrameStatistics, RegressionSummary, SolveReport, StageSeconds, unseen_shapes,
};
use crate::solve_packs::put_driven;
use crate::take_checks::is_fitted;
use crate::training::Training;
use crate::{
    AvatarSkin, Depth, JoinedTake, LabelProblem, MarkerMap, ScaleRule, SetUp, SolveError,
    WeightsTable, weights_hash,
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
}

/// Weights and what is said of them.
#[derive(Debug, Clone, PartialEq)]
pub struct SolvedCapture {
    /// The weights, a row a frame; for `thin-shell-surface` where its markers go, in centimetres.
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
    let mut seconds = StageSeconds::default();
    let start = clock();
    let joined = JoinedTake::new(skin, capture, map, options)?;
    let spec = &joined.with_lids_locked(spec);
    let SetUp { operators, surface } = joined.set_up(spec, options.training.as_deref())?;
    let fit = Fit::new(&operators, spec)?;
    let set_up = clock();
    seconds.set_up = set_up - start;
    let take = joined.frames();
    let (front_end, poses) = joined.front_end(&operators, spec)?;
    let displacements = front_end.take_displacements(take, &poses)?;
    let front = clock();
    seconds.front_end = front - set_up;
    let mut solution = fit.solve_take(&displacements)?;
    let (driven_shapes, driven) = joined.lid_tracks(&front_end, &poses, 0..take.len());
    let shape_names = &operators.parts().shape_names;
    put_driven(&mut solution.weights, shape_names, &driven_shapes, &driven);
    let solve = clock();
    seconds.solve = solve - front;

    let mut warnings = joined.warnings.clone();
    let head_markers = joined.head_markers()?;
    warnings.extend(moving_skin(&head_markers));
    let label_problems = if is_fitted(spec) {
        let front = (&front_end, poses.as_slice());
        joined.label_problems(&operators, &fit, front, &displacements, &solution.weights)
    } else {
        Vec::new()
    };
    warnings.extend(label_problems.iter().map(LabelProblem::sentence));
    seconds.check = clock() - solve;
    warnings.extend(unseen_shapes(&operators, spec));
    if let Some(training) = &options.training {
        warnings.extend(training.warnings(&skin.shape_names));
    }
    let adrift = surface.as_ref().map_or(0, |surface| surface.without_marker);
    if adrift > 0 {
        warnings.push(format!(
            "{adrift} vertices are in pieces of the skin without a marker: they rest"
        ));
    }
    let summary = FrameStatistics::of(&solution.reports);
    warnings.extend(summary.warnings(joined.first_frame));
    let frames = (solution.reports.iter().zip(joined.first_frame..))
        .map(|(r, frame)| FrameRow {
            frame,
            residual_mm: 1e3 * r.residual,
            iterations: r.iterations,
            kkt_error: r.kkt_error,
            energy_mm2: r.energy.map(|energy| 1e6 * energy),
            deviation: r.deviation,
            missing_markers: r.missing_markers,
            warning: r.warning.map(|w| w.to_string()),
        })
        .collect();
    let weights_hash = weights_hash(&solution.weights);
    let report = SolveReport {
        avatar: skin.name.clone(),
        vertices: skin.mesh.positions.len(),
        shapes: operators.shape_count(),
        markers: joined.markers.iter().map(|site| site.label.clone()).collect(),
        head: joined.head_labels(),
        neutral: [joined.neutral.start, joined.neutral.end],
        rate_hz: joined.rate_hz,
        method: spec.resolved(),
        data_scale_mm: 1e3 * operators.data_scale().sqrt(),
        shell_scale_m2: operators.shell_scale(),
        summary,
        seconds,
        warnings,
        regression: operators.parts().regression.as_ref().map(RegressionSummary::of),
        head_markers,
        label_problems,
        provenance: match &options.training {
            Some(training) => joined.provenance(spec).text("training", &training.key()),
            None => joined.provenance(spec),
        }
        .text("weights", &weights_hash)
        .hash(),
        weights_hash,
        frames,
    };
    let names = operators.parts().shape_names.clone();
    let table = WeightsTable::at_rate(names, solution.weights, joined.first_frame, joined.rate_hz);
    Ok(SolvedCapture { table, surface, report, sites: joined.markers, displacements })
}
