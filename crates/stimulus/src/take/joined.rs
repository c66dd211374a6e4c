//! Avatar, marker map and capture brought together.

use std::ops::Range;

use mimique_geometry::RigidMotion;
use mimique_mocap::Capture;
use mimique_solver::{
    Adaptation, FitError, FrontEnd, FrontEndError, Hold, MarkerColumns, MarkerFrames, MarkerSite,
    Method, MethodSpec, OperatorError, OperatorOptions, Operators, RbfError, SurfaceDepth,
    SurfaceResponse,
};

use super::adjustments::{refuse_flat, scale_rule};
use super::found_neutral::found_neutral;
use super::gaze::{JoinedGaze, given_gaze};
use super::lids::JoinedLid;
use super::{SolveError, TakeOptions, Training};
use crate::warning::some;
use crate::{AvatarSkin, Depth, MapOrigin, MarkerMap, ScaleRule, TakeWarning};

/// Frames that a neutral should be the mean of.
pub(crate) const NEUTRAL_FRAMES: usize = 60;
/// A vertex that no shape moves by more is at rest, metres.
const UNMOVED_M: f64 = 1e-4;

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
    pub(crate) repair: Option<String>,
    pub(crate) lids: Vec<JoinedLid>,
    pub(crate) gaze: Option<JoinedGaze>,
    /// Share of the head's own motion that is shown.
    pub(crate) head_motion: f64,
    pub(crate) map_origin: MapOrigin,
    pub(crate) warnings: Vec<TakeWarning>,
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
        let FaceSites { lid_places, markers, absent } = face_sites(skin, capture, map)?;
        if !absent.is_empty() {
            let labels = absent.into_iter().map(|site| site.label).collect();
            warnings.push(TakeWarning::MarkersAbsent { labels });
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
        joined.head_motion = options.head_motion;
        if options.head_motion > 0.0 && joined.columns.head.is_none() {
            joined.warnings.push(TakeWarning::HeadShownStill);
        }
        joined.map_origin = map.origin;
        joined.add_lids(capture, map, &lid_places);
        if let Some(given) = &options.gaze {
            joined.add_gaze(capture, given)?;
            joined.warnings.extend(joined.gaze_beyond_eyes());
        }
        Ok(joined)
    }

    /// All that is wrong with map, capture and avatar together, each part looked at by itself; nothing where
    /// they can be joined.
    pub(crate) fn faults(
        skin: &AvatarSkin,
        capture: &Capture,
        map: &MarkerMap,
        options: &TakeOptions,
    ) -> Vec<SolveError> {
        if capture.frames() == 0 {
            return vec![SolveError::NoFrames];
        }
        let mut found = Vec::new();
        match face_sites(skin, capture, map) {
            Err(fault) => found.push(fault),
            Ok(FaceSites { markers, .. }) => {
                let labels: Vec<String> = markers.into_iter().map(|site| site.label).collect();
                if options.depth.unwrap_or(map.depth) == Depth::Measured {
                    found.extend(refuse_flat(&metres(capture, &labels)).err());
                }
                found.extend(fits(&scale_rule(options, map), &labels, capture.frames()).err());
            }
        }
        found.extend(head_is_there(options.head.as_ref().unwrap_or(&map.head), capture).err());
        found.extend(options.gaze.as_ref().and_then(|gaze| given_gaze(skin, capture, gaze).err()));
        found
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
        mut warnings: Vec<TakeWarning>,
    ) -> Result<Self, SolveError> {
        let frames = capture.frames();
        if frames == 0 {
            return Err(SolveError::NoFrames);
        }
        let (labels, columns) = columns_of(&markers, head, capture)?;
        let head_columns = columns.head.as_deref().unwrap_or_default();
        if head_columns.is_empty() {
            warnings.push(TakeWarning::NoHeadMarkers);
        }
        let neutral = neutral.unwrap_or_else(|| {
            let head: Vec<String> = head_columns.iter().map(|&c| labels[c].clone()).collect();
            let (found, said) = found_neutral(capture, &labels, markers.len(), &head);
            warnings.push(said);
            found
        });
        if neutral.start < neutral.end && neutral.len() < NEUTRAL_FRAMES {
            let (frames, better) = (neutral.len(), NEUTRAL_FRAMES);
            warnings.push(TakeWarning::FewNeutralFrames { frames, better });
        }
        let positions = metres(capture, &labels);
        if depth == Depth::Measured {
            refuse_flat(&positions)?;
        }
        fits(&scale, &labels[..markers.len()], frames)?;
        Ok(Self {
            skin,
            markers,
            positions,
            labels,
            columns,
            neutral,
            scale,
            depth,
            rate_hz: capture.rate_hz,
            first_frame: capture.first_frame,
            repair: None,
            lids: Vec::new(),
            gaze: None,
            head_motion: 0.0,
            map_origin: MapOrigin::Unknown,
            warnings,
        })
    }

    /// What should be said of map, capture and avatar together.
    pub fn warnings(&self) -> &[TakeWarning] {
        &self.warnings
    }

    /// The face markers on the welded skin, in the order of operators and displacements.
    pub fn sites(&self) -> &[MarkerSite] {
        &self.markers
    }

    /// Whether scale factors come from the bank's range of motion.
    pub(crate) fn scales_by_bank(&self) -> bool {
        self.scale.automatic.is_some()
    }

    /// Number of frames.
    pub fn frame_count(&self) -> usize {
        self.frames().len()
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

    /// D, H and l of the avatar's shapes for a method.
    ///
    /// # Errors
    /// [`OperatorError`] for a skin or markers that cannot be used.
    pub fn operators(&self, spec: &MethodSpec) -> Result<Operators, OperatorError> {
        let options = OperatorOptions::of(spec);
        Operators::build_at(&self.skin.mesh, &self.skin.shape_names, &self.markers, &options)
    }

    pub(crate) fn frames(&self) -> MarkerFrames<'_> {
        MarkerFrames { positions: &self.positions, columns: self.labels.len() }
    }

    pub(crate) fn front_end(
        &self,
        operators: &Operators,
        spec: &MethodSpec,
    ) -> Result<(FrontEnd, Vec<RigidMotion>), SolveError> {
        let lowpass = spec.head_lowpass(self.rate_hz).map_err(FrontEndError::Lowpass)?;
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
            Adaptation { depth, smoothing: spec.rbf_smoothing() },
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

    pub(crate) fn head_labels(&self) -> Vec<String> {
        let head = self.columns.head.as_deref().unwrap_or_default();
        head.iter().map(|&c| self.labels[c].clone()).collect()
    }
}

/// The labels of a take's columns, the face markers and then the head markers that are none, and which
/// columns are what.
fn columns_of(
    markers: &[MarkerSite],
    head: &[String],
    capture: &Capture,
) -> Result<(Vec<String>, MarkerColumns), SolveError> {
    let mut labels: Vec<String> = markers.iter().map(|site| site.label.clone()).collect();
    let face = (0..labels.len()).collect();
    head_is_there(head, capture)?;
    let mut head_columns = Vec::new();
    for label in head {
        let column = labels.iter().position(|l| l == label).unwrap_or_else(|| {
            labels.push(label.clone());
            labels.len() - 1
        });
        head_columns.push(column);
    }
    let head = (!head_columns.is_empty()).then_some(head_columns);
    Ok((labels, MarkerColumns { face, head }))
}

/// A map's markers on the skin.
struct FaceSites {
    /// Of the lids' markers.
    lid_places: Vec<MarkerSite>,
    /// Of the face markers that the capture has.
    markers: Vec<MarkerSite>,
    /// Of those that it has not.
    absent: Vec<MarkerSite>,
}

/// Where the map's markers are on the skin, and which of them are in the capture.
fn face_sites(
    skin: &AvatarSkin,
    capture: &Capture,
    map: &MarkerMap,
) -> Result<FaceSites, SolveError> {
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
    Ok(FaceSites { lid_places, markers, absent })
}

/// Whether the capture has all of the head's markers.
fn head_is_there(head: &[String], capture: &Capture) -> Result<(), SolveError> {
    let absent: Vec<String> =
        head.iter().filter(|label| capture.marker_index(label).is_none()).cloned().collect();
    if absent.is_empty() {
        return Ok(());
    }
    let capture = some(capture.labels.iter().map(String::as_str));
    Err(SolveError::NoHeadMarker { labels: absent, capture })
}

/// Whether scale factors are of markers and frames that there are.
fn fits(scale: &ScaleRule, face: &[String], frames: usize) -> Result<(), SolveError> {
    if let Some(label) = scale.markers.keys().find(|l| !face.contains(l)) {
        let markers = some(face.iter().map(String::as_str));
        return Err(SolveError::NoScaledMarker { label: label.clone(), markers });
    }
    match scale.automatic {
        Some(Range { start: first, end }) if first >= end || end > frames => {
            Err(SolveError::ScaleFrames { first, end, frames })
        }
        _ => Ok(()),
    }
}

/// The named columns of a capture in metres; what is not finite is NaN in all three coordinates.
pub(crate) fn metres(capture: &Capture, labels: &[String]) -> Vec<f64> {
    let columns: Vec<usize> = labels.iter().filter_map(|l| capture.marker_index(l)).collect();
    let unit = capture.unit.metres();
    (0..capture.frames())
        .flat_map(|frame| {
            let row = capture.frame(frame);
            columns.iter().flat_map(|&c| {
                let p = row[c];
                if p.is_finite() { p.map(|x| x * unit).to_array() } else { [f64::NAN; 3] }
            })
        })
        .collect()
}
