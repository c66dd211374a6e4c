//! A solved take looked over: head markers that move, labels that are not what they say.

use mimique_clip::{MarkerMotion, MarkerSolution, solve_markers};
use mimique_solver::{FrontEnd, FrontEndError, Method, MethodSpec, Operators};

use super::head::{HeadMarker, head_markers, moving_skin};
use super::labels::{LabelCheck, LabelProblem};
use crate::{JoinedTake, SolveError, TakeWarning};

/// Whether a method is fitted to the markers: only then a residual tells of labels.
pub(crate) fn is_fitted(spec: &MethodSpec) -> bool {
    !matches!(spec.method, Method::ThinShellSurface | Method::Regression | Method::Recorded)
}

impl JoinedTake<'_> {
    /// How still each head marker is on the head, without low-pass.
    ///
    /// # Errors
    /// [`FrontEndError`] naming the frame where the head's pose cannot be told.
    pub fn head_markers(&self) -> Result<Vec<HeadMarker>, FrontEndError> {
        let Some(head) = &self.columns.head else { return Ok(Vec::new()) };
        let poses = FrontEnd::head_poses(self.frames(), &self.columns, None)?;
        Ok(head_markers(&self.labels, head, &self.positions, self.labels.len(), &poses))
    }

    /// The warning of head markers that sit on skin that moves.
    ///
    /// # Errors
    /// As [`JoinedTake::head_markers`].
    pub fn head_warning(&self) -> Result<Option<TakeWarning>, FrontEndError> {
        Ok(moving_skin(&self.head_markers()?))
    }

    /// The warning of a head that is not filtered, where a method leaves the low-pass to the default
    /// and the rate has no room for it.
    pub(crate) fn unfiltered_head(&self, spec: &MethodSpec) -> Option<TakeWarning> {
        let wanted = self.columns.head.is_some()
            && spec.head_lowpass_hz.is_none()
            && spec.head_lowpass_hz(self.rate_hz).is_none();
        wanted.then(|| TakeWarning::head_unfiltered(self.rate_hz))
    }

    /// The warnings of labels that are swapped or stand at one place, found by solving the whole take
    /// by a method; none where the method is not fitted to the markers.
    ///
    /// # Errors
    /// [`SolveError`]: a head or neutral that cannot be found, operators of another method.
    pub fn label_warnings(
        &self,
        operators: &Operators,
        spec: &MethodSpec,
    ) -> Result<Vec<TakeWarning>, SolveError> {
        if !is_fitted(spec) {
            return Ok(Vec::new());
        }
        let markers = self.markers_of(operators, spec, 0..self.frame_count())?;
        let solved = solve_markers(operators, &self.whole(&markers), spec, &mut || 0.0)?;
        let problems = self.label_problems(operators, &solved);
        Ok(problems.into_iter().map(TakeWarning::Labels).collect())
    }

    /// Labels that are swapped or stand at one place. Not looked for where displacements are
    /// scaled: points and displacements then do not belong together.
    pub(crate) fn label_problems(
        &self,
        operators: &Operators,
        solution: &MarkerSolution,
    ) -> Vec<LabelProblem> {
        let MarkerSolution { motion, fit, weights, .. } = solution;
        let MarkerMotion { front_end, poses, displacements, .. } = motion;
        let p = operators.marker_count();
        if front_end.scales().is_some() {
            return Vec::new();
        }
        let exchanged = |a: usize, b: usize, frames: &[usize]| {
            let mut columns = self.columns.clone();
            columns.face.swap(a, b);
            let mut neutral = front_end.neutral().to_vec();
            neutral.swap(a, b);
            let other = FrontEnd::from_parts(
                columns,
                front_end.head_reference().to_vec(),
                neutral,
                operators.parts().marker_positions.clone(),
                front_end.adaptation(),
            )
            .ok()?;
            let mut rows = vec![0.0; frames.len() * 3 * p];
            let mut scratch = mimique_solver::FrontEndScratch::default();
            for (&frame, row) in frames.iter().zip(rows.chunks_exact_mut(3 * p)) {
                other.displacements(&poses[frame], self.frames().frame(frame), row, &mut scratch);
            }
            Some(rows)
        };
        LabelCheck {
            operators,
            fit,
            front_end,
            displacements,
            weights,
            first_frame: self.first_frame,
            exchanged: &exchanged,
        }
        .problems()
    }
}
