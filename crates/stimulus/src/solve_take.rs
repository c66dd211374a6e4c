//! Avatar, capture, marker map and method in; weights a frame and a report out.

use std::ops::Range;

use mimique_mocap::{Capture, stabilise, stillest};
use mimique_solver::{
    Fit, FitError, FrontEnd, FrontEndError, Hold, MarkerColumns, MarkerFrames, MarkerSite,
    MeshError, Method, MethodSpec, OperatorError, OperatorOptions, Operators, RbfError,
    RigidMotion, SurfaceDepth, SurfaceError, SurfaceResponse, TrainingError,
};

use crate::head_check::moving_skin;
use crate::lids::{LidEdge, LidRange, actor_range, lid_weights};
use crate::provenance::{Provenance, weights_hash};
use crate::report::{
    FrameRow, FrameStatistics, RegressionSummary, SolveReport, StageSeconds, unseen_shapes,
};
use crate::solve_packs::{lowpass, put_driven};
use crate::take_adjustments::{refuse_flat, scale_rule};
use crate::take_pack::{SegmentMarkers, TakeContent, TakePack};
use crate::training::Training;
use crate::{AvatarSkin, Depth, LabelProblem, MapError, MarkerMap, ScaleRule, WeightsTable};

/// Frames that a neutral should be the mean of.
const NEUTRAL_FRAMES: usize = 60;
/// A vertex that no shape moves by more is at rest, metres.
const UNMOVED_M: f64 = 1e-4;
/// Seconds of margin on both sides of a segment, for the head's low-pass to settle.
const MARGIN_SECONDS: f64 = 0.25;

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

/// Why a take cannot be solved.
#[derive(Debug, thiserror::Error)]
pub enum SolveError {
    /// The map does not fit the avatar.
    #[error("marker map, {0}")]
    Map(#[from] MapError),
    /// The capture and the map have no label in common.
    #[error(
        "markers: the capture has none of the map's labels (the map names {map}, the capture \
         {capture}); write the map with the capture's labels"
    )]
    NoCommonLabel {
        /// Some labels of the map.
        map: String,
        /// Some labels of the capture.
        capture: String,
    },
    /// A head marker that the capture does not have.
    #[error(
        "head marker {label}: not in the capture, which has {capture}; name markers of the capture"
    )]
    NoHeadMarker {
        /// The label.
        label: String,
        /// Some labels of the capture.
        capture: String,
    },
    /// A marker that is to be scaled is not on the face.
    #[error("scale of marker {label}: not a face marker of map and capture, which have {markers}")]
    NoScaledMarker {
        /// The label.
        label: String,
        /// Some face markers.
        markers: String,
    },
    /// The frames of the range of motion are not in the capture.
    #[error(
        "automatic scale, frames {first}:{end} of {frames}; give the frames of the range of motion"
    )]
    ScaleFrames {
        /// First frame.
        first: usize,
        /// One past the last.
        end: usize,
        /// Frames there are.
        frames: usize,
    },
    /// All markers lie in a plane of constant z.
    #[error(
        "capture: two-dimensional (z is {z_mm} mm throughout); take the depth from the surface \
         (--depth surface, or \"depth\": \"surface\" in the marker map)"
    )]
    Flat {
        /// The one depth, millimetres.
        z_mm: f64,
    },
    /// Two labels at one place, on the neutral face.
    #[error(
        "markers {first} and {second}: at one place on the neutral face; one of the two labels is wrong"
    )]
    OnePlace {
        /// One label.
        first: String,
        /// The other.
        second: String,
    },
    /// A marker that is never seen while the face is neutral.
    #[error(
        "face marker {0} is not seen in any neutral frame; give other neutral frames or leave the \
         marker out of the map"
    )]
    NeutralUnseen(String),
    /// The capture is empty.
    #[error("capture: no frames; record or export the take again")]
    NoFrames,
    /// A segment is not inside the capture.
    #[error("frames {first}:{end} of {frames}; give a range inside the capture")]
    Segment {
        /// First frame.
        first: usize,
        /// One past the last.
        end: usize,
        /// Frames there are.
        frames: usize,
    },
    /// The skin cannot be used.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// D and H cannot be built.
    #[error(transparent)]
    Operators(#[from] OperatorError),
    /// Head, neutral, alignment or adaptation fail.
    #[error(transparent)]
    FrontEnd(#[from] FrontEndError),
    /// The method does not solve.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The surface has no response to its markers.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Nothing can be learnt.
    #[error(transparent)]
    Training(#[from] TrainingError),
    /// The training take has other markers.
    #[error(
        "training: the take has no marker {missing}, which the take to be solved has; train with \
         the same markers, or leave them out of the map"
    )]
    TrainingMarkers {
        /// The labels.
        missing: String,
    },
    /// The training weights are of other shapes.
    #[error(
        "training: none of the weights' shapes ({weights}) is one of the avatar's ({avatar}); give \
         weights under the avatar's names, or ARKit's"
    )]
    TrainingShapes {
        /// Some names of the weights.
        weights: String,
        /// Some names of the avatar.
        avatar: String,
    },
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

/// What a method is set up with.
#[derive(Debug, Clone, PartialEq)]
pub struct SetUp {
    /// What its frames need.
    pub operators: Operators,
    /// The surface of `thin-shell-surface`.
    pub surface: Option<SurfaceResponse>,
}

/// Avatar, marker map and capture brought together; solves any method and any segment.
#[derive(Debug, Clone)]
pub struct JoinedTake<'a> {
    pub(crate) skin: &'a AvatarSkin,
    /// Face markers that the capture has, on the welded skin.
    pub(crate) markers: Vec<MarkerSite>,
    /// Labels of the columns of `positions`.
    pub(crate) labels: Vec<String>,
    pub(crate) columns: MarkerColumns,
    /// Frames x 3 columns, metres.
    pub(crate) positions: Vec<f64>,
    pub(crate) neutral: Range<usize>,
    pub(crate) scale: ScaleRule,
    pub(crate) depth: Depth,
    pub(crate) rate_hz: f64,
    pub(crate) first_frame: u64,
    repair: Option<String>,
    lids: Vec<JoinedLid>,
    pub(crate) warnings: Vec<String>,
}

/// A lid marker of the capture and the shapes of the avatar that it drives.
#[derive(Debug, Clone)]
struct JoinedLid {
    label: String,
    column: usize,
    edge: LidEdge,
    closed: String,
    wide: Option<String>,
    /// Vertical travel of the marker's vertex from closed to wide, metres.
    travel: LidRange,
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
    // Only what is fitted to the markers leaves a residual that tells of labels.
    let fitted = !matches!(spec.method, Method::ThinShellSurface | Method::Regression);
    let label_problems = if fitted {
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

/// The face markers of a take, and how their displacements are read.
struct TakeMarkers {
    markers: Vec<MarkerSite>,
    scale: ScaleRule,
    depth: Depth,
}

impl<'a> JoinedTake<'a> {
    /// Finds the map's markers on the skin and in the capture.
    ///
    /// # Errors
    /// [`SolveError`]: the map does not fit the avatar or the capture, no frames, no head marker.
    pub fn new(
        skin: &'a AvatarSkin,
        capture: &Capture,
        map: &MarkerMap,
        options: &TakeOptions,
    ) -> Result<Self, SolveError> {
        if capture.frames() == 0 {
            return Err(SolveError::NoFrames);
        }
        let mut warnings = Vec::new();
        let (lid_places, resolved): (Vec<_>, Vec<_>) = (map.resolve(skin)?.into_iter())
            .partition(|site| map.lids.iter().any(|lid| lid.marker == site.label));
        let (markers, absent): (Vec<_>, Vec<_>) =
            resolved.into_iter().partition(|site| capture.marker_index(&site.label).is_some());
        if markers.is_empty() {
            return Err(SolveError::NoCommonLabel {
                map: some(map.face_labels()),
                capture: some(capture.labels.iter().map(String::as_str)),
            });
        }
        if !absent.is_empty() {
            warnings.push(format!(
                "{} markers of the map are not in the capture: {}",
                absent.len(),
                some(absent.iter().map(|site| site.label.as_str()))
            ));
        }
        let head = options.head.as_ref().unwrap_or(&map.head);
        let neutral = options.neutral.clone().or_else(|| map.neutral.clone());
        let from = TakeMarkers {
            markers,
            scale: scale_rule(options, map),
            depth: options.depth.unwrap_or(map.depth),
        };
        let mut joined = Self::of_markers(skin, capture, from, head, neutral, warnings)?;
        joined.repair = options.repair.clone();
        joined.add_lids(capture, map, &lid_places);
        Ok(joined)
    }

    /// The lid markers as columns after the others.
    fn add_lids(&mut self, capture: &Capture, map: &MarkerMap, lid_places: &[MarkerSite]) {
        for lid in &map.lids {
            let place = lid_places.iter().find(|site| site.label == lid.marker);
            let (Some(place), true) = (place, capture.marker_index(&lid.marker).is_some()) else {
                self.warnings.push(format!("lid marker {} is not in the capture", lid.marker));
                continue;
            };
            let vertex = place.vertex();
            let Some(closed) = travel_of(self.skin, &lid.closed, vertex) else {
                self.warnings.push(format!(
                    "lid marker {}: the avatar has no shape {}; name the shape that closes the lid",
                    lid.marker, lid.closed
                ));
                continue;
            };
            let wide = lid.wide.as_ref().and_then(|name| travel_of(self.skin, name, vertex));
            let ends = [closed, wide.unwrap_or(0.0), 0.0];
            let travel = [ends[0].min(ends[1]).min(0.0), ends[0].max(ends[1]).max(0.0)];
            let labels = &mut self.labels;
            let column = labels.iter().position(|l| *l == lid.marker).unwrap_or_else(|| {
                labels.push(lid.marker.clone());
                labels.len() - 1
            });
            self.lids.push(JoinedLid {
                label: lid.marker.clone(),
                column,
                edge: lid.edge,
                closed: lid.closed.clone(),
                wide: lid.wide.clone().filter(|_| wide.is_some()),
                travel,
            });
        }
        if !self.lids.is_empty() {
            self.positions = metres(capture, &self.labels);
        }
    }

    /// Another take of the same markers on the same skin, such as the one that is learnt from.
    ///
    /// # Errors
    /// [`SolveError`]: a face or head marker that it does not have, no frames.
    pub(crate) fn of_other_capture(
        &self,
        capture: &Capture,
        head: Option<&[String]>,
        neutral: Option<Range<usize>>,
    ) -> Result<Self, SolveError> {
        let absent: Vec<&str> = (self.markers.iter())
            .map(|site| site.label.as_str())
            .filter(|label| capture.marker_index(label).is_none())
            .collect();
        if !absent.is_empty() {
            return Err(SolveError::TrainingMarkers { missing: some(absent.into_iter()) });
        }
        let head = head.map_or_else(|| self.head_labels(), <[String]>::to_vec);
        // Its own range of motion scales it.
        let automatic = self.scale.automatic.as_ref().map(|_| 0..capture.frames());
        let from = TakeMarkers {
            markers: self.markers.clone(),
            scale: ScaleRule { automatic, ..self.scale.clone() },
            depth: self.depth,
        };
        Self::of_markers(self.skin, capture, from, &head, neutral, Vec::new())
    }

    fn of_markers(
        skin: &'a AvatarSkin,
        capture: &Capture,
        TakeMarkers { markers, scale, depth }: TakeMarkers,
        head: &[String],
        neutral: Option<Range<usize>>,
        mut warnings: Vec<String>,
    ) -> Result<Self, SolveError> {
        let frames = capture.frames();
        if frames == 0 {
            return Err(SolveError::NoFrames);
        }
        // Columns: face markers, then the head markers that are none.
        let mut labels: Vec<String> = markers.iter().map(|site| site.label.clone()).collect();
        let face = (0..labels.len()).collect();
        let mut head_columns = Vec::new();
        for label in head {
            if capture.marker_index(label).is_none() {
                return Err(SolveError::NoHeadMarker {
                    label: label.clone(),
                    capture: some(capture.labels.iter().map(String::as_str)),
                });
            }
            let column = labels.iter().position(|l| l == label).unwrap_or_else(|| {
                labels.push(label.clone());
                labels.len() - 1
            });
            head_columns.push(column);
        }
        if head_columns.is_empty() {
            warnings.push(
                "no head markers are named: the capture is taken to be free of head motion"
                    .to_owned(),
            );
        }
        let neutral = neutral.unwrap_or_else(|| {
            let head: Vec<String> = head_columns.iter().map(|&c| labels[c].clone()).collect();
            let (found, said) = found_neutral(capture, &labels, markers.len(), &head);
            warnings.push(said);
            found
        });
        if neutral.start < neutral.end && neutral.len() < NEUTRAL_FRAMES {
            warnings.push(format!(
                "the neutral is the mean of {} frames: {NEUTRAL_FRAMES} or more are steadier",
                neutral.len()
            ));
        }
        let positions = metres(capture, &labels);
        if depth == Depth::Measured {
            refuse_flat(&positions)?;
        }
        if let Some(label) = scale.markers.keys().find(|l| !labels[..markers.len()].contains(l)) {
            let markers = some(labels[..markers.len()].iter().map(String::as_str));
            return Err(SolveError::NoScaledMarker { label: label.clone(), markers });
        }
        if let Some(Range { start: first, end }) = scale.automatic
            && (first >= end || end > frames)
        {
            return Err(SolveError::ScaleFrames { first, end, frames });
        }
        Ok(Self {
            skin,
            markers,
            positions,
            labels,
            columns: MarkerColumns {
                face,
                head: (!head_columns.is_empty()).then_some(head_columns),
            },
            neutral,
            scale,
            depth,
            rate_hz: capture.rate_hz,
            first_frame: capture.first_frame,
            repair: None,
            lids: Vec::new(),
            warnings,
        })
    }

    /// The method with the lids' shapes locked, so that no other marker moves them.
    pub fn with_lids_locked(&self, spec: &MethodSpec) -> MethodSpec {
        let mut spec = spec.clone();
        if !spec.method.parameters().contains(&"locked") {
            return spec;
        }
        for name in self.lids.iter().flat_map(|l| [Some(&l.closed), l.wide.as_ref()]).flatten() {
            let bounded = spec.bounds.contains_key(name);
            if !bounded && !spec.locked.contains(name) {
                spec.locked.push(name.clone());
            }
        }
        spec
    }

    /// The shapes that lid markers drive and their weights in some frames. The lids' travel and
    /// neutral are those of the whole take.
    fn lid_tracks(
        &self,
        front_end: &FrontEnd,
        poses: &[RigidMotion],
        frames: Range<usize>,
    ) -> (Vec<String>, Vec<f64>) {
        let mut tracks: Vec<(String, Vec<f64>)> = Vec::new();
        for lid in &self.lids {
            let places: Vec<[f64; 3]> = (poses.iter().enumerate())
                .map(|(frame, pose)| {
                    let at = 3 * (frame * self.labels.len() + lid.column);
                    let p = &self.positions[at..at + 3];
                    front_end.avatar_from_actor().rotate(pose.apply([p[0], p[1], p[2]]))
                })
                .collect();
            let rest: Vec<f64> =
                places[self.neutral.clone()].iter().map(|p| p[1]).filter(|y| !y.is_nan()).collect();
            let rest = rest.iter().sum::<f64>() / rest.len() as f64;
            let heights: Vec<f64> = places.iter().map(|p| p[1] - rest).collect();
            let actor = actor_range(&heights, lid.travel, lid.edge);
            // A lid that is not seen stays where it was last.
            let mut last = 0.0;
            let weights: Vec<(f64, f64)> = heights
                .into_iter()
                .map(|y| {
                    last = if y.is_finite() { y } else { last };
                    lid_weights(last, actor, lid.travel, lid.edge)
                })
                .collect();
            let shapes = [Some((&lid.closed, true)), lid.wide.as_ref().map(|w| (w, false))];
            for (name, closes) in shapes.into_iter().flatten() {
                let own = weights[frames.clone()].iter().map(|w| if closes { w.0 } else { w.1 });
                match tracks.iter_mut().find(|(n, _)| n == name) {
                    // Of two markers that drive one shape the stronger counts.
                    Some((_, track)) => {
                        track.iter_mut().zip(own).for_each(|(a, b)| *a = a.max(b));
                    }
                    None => tracks.push((name.clone(), own.collect())),
                }
            }
        }
        let (names, tracks): (Vec<String>, Vec<Vec<f64>>) = tracks.into_iter().unzip();
        let rows = (0..frames.len()).flat_map(|f| tracks.iter().map(move |t| t[f]));
        let weights = rows.collect();
        (names, weights)
    }

    /// What should be said of map, capture and avatar together.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Whether scale factors come from the bank's range of motion.
    #[cfg(feature = "prepare")]
    pub(crate) fn scales_by_bank(&self) -> bool {
        self.scale.automatic.is_some()
    }

    /// Number of frames.
    pub fn frame_count(&self) -> usize {
        self.frames().len()
    }

    /// A hash of the face markers and their vertices.
    #[cfg(feature = "prepare")]
    pub(crate) fn marker_key(&self) -> String {
        let labels: Vec<&str> = self.markers.iter().map(|site| site.label.as_str()).collect();
        Provenance::default()
            .text("labels", &labels.join("\n"))
            .numbers("vertices", &self.site_numbers())
            .hash()
    }

    /// Everything that a method is set up with: a bank's operators, a surface, a regression that
    /// has learnt from `training`.
    ///
    /// # Errors
    /// [`SolveError`] for a skin, markers or training that cannot be used.
    pub fn set_up(
        &self,
        spec: &MethodSpec,
        training: Option<&Training>,
    ) -> Result<SetUp, SolveError> {
        match spec.method {
            Method::ThinShellSurface => {
                let (mesh, options) = (&self.skin.mesh, OperatorOptions::of(spec));
                let held = match spec.hold() {
                    Hold::Unmoved => mesh.unmoved(UNMOVED_M),
                    Hold::Nothing => vec![false; mesh.positions.len()],
                };
                let vertices: Vec<usize> = self.markers.iter().map(MarkerSite::vertex).collect();
                let surface = SurfaceResponse::build(mesh, &vertices, &held, &options)?;
                let operators = surface.operators(mesh, &self.markers, &options)?;
                Ok(SetUp { operators, surface: Some(surface) })
            }
            Method::Regression => {
                let bank = self.operators(spec)?;
                let training = training.ok_or(FitError::NotTrained)?;
                let model = training.learn(self, &bank, spec)?;
                Ok(SetUp { operators: bank.with_regression(model)?, surface: None })
            }
            _ => Ok(SetUp { operators: self.operators(spec)?, surface: None }),
        }
    }

    /// d of every frame: frames x 3P, metres.
    ///
    /// # Errors
    /// [`SolveError`] of the front end.
    pub(crate) fn displacements(
        &self,
        bank: &Operators,
        spec: &MethodSpec,
    ) -> Result<Vec<f64>, SolveError> {
        let (front_end, poses) = self.front_end(bank, spec)?;
        Ok(front_end.take_displacements(self.frames(), &poses)?)
    }

    /// D, H and l of the avatar's shapes for a method.
    ///
    /// # Errors
    /// [`OperatorError`] for a skin or markers that cannot be used.
    pub fn operators(&self, spec: &MethodSpec) -> Result<Operators, OperatorError> {
        let options = OperatorOptions::of(spec);
        Operators::build_at(&self.skin.mesh, &self.skin.shape_names, &self.markers, &options)
    }

    /// The pack of frames `first..end` (counted from 0), with a margin for the head's low-pass.
    ///
    /// # Errors
    /// [`SolveError`]: a segment outside, or a head or neutral that cannot be found.
    pub fn segment(
        &self,
        operators: &Operators,
        spec: &MethodSpec,
        segment: Range<usize>,
    ) -> Result<TakePack, SolveError> {
        let frames = self.frame_count();
        let Range { start: first, end } = segment;
        if first >= end || end > frames {
            return Err(SolveError::Segment { first, end, frames });
        }
        let (front_end, poses) = self.front_end(operators, spec)?;
        let margin = (MARGIN_SECONDS * self.rate_hz).ceil() as usize;
        let stored = first.saturating_sub(margin)..(end + margin).min(frames);
        let width = 3 * self.labels.len();
        let (driven_shapes, driven_weights) = self.lid_tracks(&front_end, &poses, stored.clone());
        let markers = SegmentMarkers {
            driven_shapes,
            driven_weights,
            labels: self.labels.clone(),
            face: self.columns.face.clone(),
            head: self.columns.head.clone(),
            head_reference: front_end.head_reference().to_vec(),
            neutral: front_end.neutral().to_vec(),
            scales: front_end.scales().cloned(),
            depth: front_end.depth().cloned(),
            positions: self.positions[stored.start * width..stored.end * width].to_vec(),
        };
        Ok(TakePack {
            rate_hz: self.rate_hz,
            first_frame: self.first_frame + first as u64,
            played: first - stored.start..end - stored.start,
            content: TakeContent::Markers(markers),
        })
    }

    pub(crate) fn frames(&self) -> MarkerFrames<'_> {
        MarkerFrames { positions: &self.positions, columns: self.labels.len() }
    }

    fn front_end(
        &self,
        operators: &Operators,
        spec: &MethodSpec,
    ) -> Result<(FrontEnd, Vec<RigidMotion>), SolveError> {
        let lowpass = lowpass(spec, self.rate_hz)?;
        let poses = FrontEnd::head_poses(self.frames(), &self.columns, lowpass.as_ref())?;
        let avatar_markers = &operators.parts().marker_positions;
        let depth = (self.depth == Depth::Surface)
            .then(|| SurfaceDepth::of(&self.skin.mesh, &self.markers));
        let front_end = FrontEnd::fit_with(
            self.frames(),
            &self.columns,
            &poses,
            self.neutral.clone(),
            avatar_markers,
            depth,
        )
        .map_err(|e| self.by_label(e))?;
        let scales = self.scales(&front_end, &poses, operators, spec)?;
        Ok((front_end.with_scales(scales)?, poses))
    }

    /// The front end's errors with the markers' labels.
    fn by_label(&self, error: FrontEndError) -> SolveError {
        let label = |m: usize| self.markers[m].label.clone();
        match error {
            FrontEndError::Rbf(RbfError::Coincident(a, b)) => {
                SolveError::OnePlace { first: label(a), second: label(b) }
            }
            FrontEndError::NeutralUnseen { marker } => SolveError::NeutralUnseen(label(marker)),
            other => other.into(),
        }
    }

    /// The places of the markers as numbers: the vertex, or corners and coordinates.
    fn site_numbers(&self) -> Vec<f64> {
        let mut numbers = Vec::new();
        for site in &self.markers {
            let parts: Vec<(usize, f64)> = site.parts().collect();
            match parts[..] {
                [(vertex, _)] => numbers.push(vertex as f64),
                _ => numbers.extend(parts.iter().flat_map(|&(v, w)| [v as f64, w])),
            }
        }
        numbers
    }

    fn head_labels(&self) -> Vec<String> {
        let head = self.columns.head.as_deref().unwrap_or_default();
        head.iter().map(|&c| self.labels[c].clone()).collect()
    }

    /// Avatar, capture, map and method: everything that the weights follow from.
    pub fn provenance(&self, spec: &MethodSpec) -> Provenance {
        let mesh = &self.skin.mesh;
        let corners: Vec<f64> = mesh.triangles.iter().flatten().map(|&v| f64::from(v)).collect();
        let mut shapes = Vec::new();
        for shape in &mesh.shapes {
            shapes.push(shape.vertices.len() as f64);
            shapes.extend(shape.vertices.iter().map(|&v| f64::from(v)));
            shapes.extend(shape.deltas.iter().flatten());
        }
        let lids: Vec<String> = (self.lids.iter())
            .map(|l| format!("{} {:?} {} {:?}", l.label, l.edge, l.closed, l.wide))
            .collect();
        let provenance = match &self.repair {
            Some(repair) => Provenance::new().text("capture.repair", repair),
            None => Provenance::new(),
        };
        let provenance = match lids.len() {
            0 => provenance,
            _ => provenance.text("map.lids", &lids.join("\n")),
        };
        let provenance = provenance
            .numbers("avatar.positions", mesh.positions.as_flattened())
            .numbers("avatar.triangles", &corners)
            .numbers("avatar.shapes", &shapes)
            .text("avatar.shapeNames", &self.skin.shape_names.join("\n"))
            .numbers("capture.positions", &self.positions)
            .numbers("capture.rate", &[self.rate_hz])
            .text("capture.labels", &self.labels.join("\n"))
            .numbers("map.vertices", &self.site_numbers())
            .text("map.head", &self.head_labels().join("\n"))
            .numbers("map.neutral", &[self.neutral.start as f64, self.neutral.end as f64])
            .method(spec);
        self.adjustments(provenance)
    }
}

/// Vertical displacement of a vertex by a shape at weight 1, metres; `None` without such a shape.
fn travel_of(skin: &AvatarSkin, shape: &str, vertex: usize) -> Option<f64> {
    let shape = skin.shape_names.iter().position(|n| n == shape)?;
    let moved = &skin.mesh.shapes[shape];
    let place = moved.vertices.iter().position(|v| *v as usize == vertex);
    Some(place.map_or(0.0, |p| moved.deltas[p][1]))
}

/// The neutral where none is named: the stillest second of the face, its head held still; and what
/// is to be said of it. The first `face` labels are those of the face.
fn found_neutral(
    capture: &Capture,
    labels: &[String],
    face: usize,
    head: &[String],
) -> (Range<usize>, String) {
    let columns: Vec<usize> = labels.iter().filter_map(|l| capture.marker_index(l)).collect();
    let mut part = Capture {
        labels: labels.to_vec(),
        positions: (0..capture.frames())
            .flat_map(|frame| columns.iter().map(move |&c| capture.frame(frame)[c]))
            .collect(),
        notes: Vec::new(),
        ..*capture
    };
    let mut held = "";
    if !head.is_empty() && stabilise(&mut part, head).is_err() {
        held = ", the head not held still";
    }
    let width = part.labels.len();
    part.positions = part.positions.chunks(width).flat_map(|row| row[..face].to_vec()).collect();
    part.labels.truncate(face);
    match stillest(&part, 1.0) {
        Some(found) => {
            let Range { start, end } = found.frames;
            let mm = found.deviation * capture.unit.metres() * 1e3;
            let said = format!(
                "no neutral is named: frames {start}:{end} are taken, the stillest second \
                 ({mm:.2} mm rms{held}); see whether the face is neutral there, or name it"
            );
            (start..end, said)
        }
        None => (
            0..NEUTRAL_FRAMES.min(capture.frames()),
            "no neutral is named and no marker is seen: the first frames are taken".to_owned(),
        ),
    }
}

/// The named columns of a capture in metres; what is not finite is NaN in all three coordinates.
fn metres(capture: &Capture, labels: &[String]) -> Vec<f64> {
    let columns: Vec<usize> = labels.iter().filter_map(|l| capture.marker_index(l)).collect();
    let unit = capture.unit.metres();
    (0..capture.frames())
        .flat_map(|frame| {
            let row = capture.frame(frame);
            columns.iter().flat_map(|&c| {
                let p = row[c];
                if p.iter().all(|x| x.is_finite()) { p.map(|x| x * unit) } else { [f64::NAN; 3] }
            })
        })
        .collect()
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
