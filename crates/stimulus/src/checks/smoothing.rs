//! Whether a take would gain by a smoothed adaptation of shape: markers that were put by hand sit 1 to 2 mm
//! beside the places that a map names, and radial basis functions that meet every marker turn that into
//! motion.

use std::fmt;

use mimique_clip::{FrameStatistics, solve_markers};
use mimique_solver::{Group, MethodSpec, Operators};
use serde::Serialize;

use super::take::is_fitted;
use crate::{JoinedTake, MapOrigin, SolveError};

/// The smoothing that is advised: it costs nothing where places are exact.
pub const ADVISED_SMOOTHING: f64 = 0.1;
/// An actor whose neutral markers are farther than this from the avatar's, root mean square after they are laid
/// on each other, has another face, or markers at other places, metres.
const OTHER_FACE_M: f64 = 1e-3;
/// Less gain than this share of the residual is not worth a word.
const WORTH: f64 = 0.02;

/// Why a smoothed adaptation is advised.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "why")]
pub enum SmoothingReason {
    /// The map was suggested by the program.
    MapSuggested,
    /// The map is a layout, by which markers are put on by hand.
    MapOfALayout,
    /// The actor's neutral markers are elsewhere than the avatar's.
    OtherFace {
        /// Root mean square distance after they are laid on each other, millimetres.
        distance_mm: f64,
    },
}

/// What a smoothed adaptation gains in a take.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SmoothingAdvice {
    /// Why it was tried.
    #[serde(flatten)]
    pub reason: SmoothingReason,
    /// Residual of the take as it is solved, millimetres.
    pub residual_mm: f64,
    /// The same with [`ADVISED_SMOOTHING`].
    pub smoothed_mm: f64,
}

impl fmt::Display for SmoothingReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MapSuggested => f.write_str("the marker map was suggested"),
            Self::MapOfALayout => f.write_str("markers are put by hand where a layout says"),
            Self::OtherFace { distance_mm } => write!(
                f,
                "the actor's markers lie {distance_mm:.1} mm (rms) from the avatar's on the neutral face"
            ),
        }
    }
}

impl SmoothingAdvice {
    /// How much of the residual goes, percent.
    pub fn gain_percent(&self) -> f64 {
        100.0 * (1.0 - self.smoothed_mm / self.residual_mm)
    }

    /// What was measured.
    fn measured(&self) -> String {
        format!(
            "{}: rbfSmoothing {ADVISED_SMOOTHING} lowers the residual of this take from {:.3} to {:.3} mm ({:.0} %)",
            self.reason,
            self.residual_mm,
            self.smoothed_mm,
            self.gain_percent()
        )
    }

    /// The advice for a take that is solved, by the command or in the studio.
    pub fn sentence(&self) -> String {
        format!(
            "{}; set rbfSmoothing (--rbf-smoothing) to {ADVISED_SMOOTHING}, or to 0 to keep the adaptation exact",
            self.measured()
        )
    }

    /// The advice for a method of a study file.
    pub fn in_a_study(&self) -> String {
        format!(
            "{}; add \"rbfSmoothing\": {ADVISED_SMOOTHING} to the method, or 0 to keep it exact",
            self.measured()
        )
    }
}

impl JoinedTake<'_> {
    /// Whether a smoothed adaptation lowers the residual of the whole take, where the map or the actor's face
    /// gives reason to ask and the method does not say what it wants. `residual_mm` is that of the take as it
    /// is solved; it is solved here where none is given.
    ///
    /// # Errors
    /// [`SolveError`]: a head or neutral that cannot be found, operators of another method.
    pub fn smoothing_advice(
        &self,
        operators: &Operators,
        spec: &MethodSpec,
        residual_mm: Option<f64>,
    ) -> Result<Option<SmoothingAdvice>, SolveError> {
        if spec.rbf_smoothing.is_some() || !is_fitted(spec) || !spec.method.uses(Group::FrontEnd) {
            return Ok(None);
        }
        let Some(reason) = self.reason_to_smooth(operators, spec)? else { return Ok(None) };
        let residual_mm = match residual_mm {
            Some(residual) => residual,
            None => self.residual_mm(operators, spec)?,
        };
        let smoothed = MethodSpec { rbf_smoothing: Some(ADVISED_SMOOTHING), ..spec.clone() };
        let smoothed_mm = self.residual_mm(operators, &smoothed)?;
        let advice = SmoothingAdvice { reason, residual_mm, smoothed_mm };
        Ok((smoothed_mm < (1.0 - WORTH) * residual_mm).then_some(advice))
    }

    /// What gives reason to ask.
    fn reason_to_smooth(
        &self,
        operators: &Operators,
        spec: &MethodSpec,
    ) -> Result<Option<SmoothingReason>, SolveError> {
        match self.map_origin {
            MapOrigin::Suggested => return Ok(Some(SmoothingReason::MapSuggested)),
            MapOrigin::Layout => return Ok(Some(SmoothingReason::MapOfALayout)),
            MapOrigin::Unknown => {}
        }
        let (front_end, _) = self.front_end(operators, spec)?;
        let laid = front_end.neutral().iter().map(|&p| front_end.avatar_from_actor().apply(p));
        let avatar = &operators.parts().marker_positions;
        let square: f64 = laid.zip(avatar).map(|(p, q)| (p - *q).length_squared()).sum();
        let distance = (square / avatar.len().max(1) as f64).sqrt();
        let reason = SmoothingReason::OtherFace { distance_mm: 1e3 * distance };
        Ok((distance > OTHER_FACE_M).then_some(reason))
    }

    /// Residual of the whole take, millimetres.
    fn residual_mm(&self, operators: &Operators, spec: &MethodSpec) -> Result<f64, SolveError> {
        let markers = self.markers_of(operators, spec, 0..self.frame_count())?;
        let solved = solve_markers(operators, &self.whole(&markers), spec, &mut || 0.0)?;
        Ok(FrameStatistics::of(&solved.reports).residual_rms_mm)
    }
}
