//! A solved take looked over: head markers that move, labels that are not what they say.

use mimique_solver::{Fit, FrontEnd, FrontEndError, Method, MethodSpec, Operators, RigidMotion};

use crate::head_check::{HeadMarker, head_markers, moving_skin};
use crate::label_check::{LabelCheck, LabelProblem};
use crate::{JoinedTake, SolveError};

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
    pub fn head_warning(&self) -> Result<Option<String>, FrontEndError> {
        Ok(moving_skin(&self.head_markers()?))
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
    ) -> Result<Vec<String>, SolveError> {
        if !is_fitted(spec) {
            return Ok(Vec::new());
        }
        let fit = Fit::new(operators, spec)?;
        let (front_end, poses) = self.front_end(operators, spec)?;
        let displacements = front_end.take_displacements(self.frames(), &poses)?;
        let weights = fit.solve_take(&displacements)?.weights;
        let front = (&front_end, poses.as_slice());
        let problems = self.label_problems(operators, &fit, front, &displacements, &weights);
        Ok(problems.iter().map(LabelProblem::sentence).collect())
    }

    /// Labels that are swapped or stand at one place. Not looked for where displacements are
    /// scaled: points and displacements then do not belong together.
    pub(crate) fn label_problems(
        &self,
        operators: &Operators,
        fit: &Fit,
        (front_end, poses): (&FrontEnd, &[RigidMotion]),
        displacements: &[f64],
        weights: &[f64],
    ) -> Vec<LabelProblem> {
        let p = operators.marker_count();
        if front_end.scales().is_some() || displacements.len() / (3 * p) != poses.len() {
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
                front_end.depth().cloned(),
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
