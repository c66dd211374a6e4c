//! Frames that are not solved: the take is refused, or they are held from the frames around them.
//! Never a row of weights that nobody is told of.

use mimique_solver::{FrameReport, FrameWarning, TakeSolution, Unsolved};

/// Frames of a take that are not solved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnsolvedFrames {
    /// How many there are.
    pub count: usize,
    /// Of how many.
    pub frames: usize,
    /// The first of them, counted from the first played frame.
    pub first: usize,
    /// What is wrong with it.
    pub why: FrameWarning,
}

impl UnsolvedFrames {
    /// The sentence and the remedy; frames are counted from `first_frame`.
    pub fn sentence(&self, first_frame: u64) -> String {
        let Self { count, frames, first, why } = self;
        format!(
            "frame {}: {why}; {count} of {frames} frames are not solved; look at the capture there, \
             lock or bound the shapes that the markers hardly tell, or take --unsolved hold \
             (\"unsolved\": \"hold\") to hold such frames from those around them",
            *first as u64 + first_frame
        )
    }
}

/// Refuses a solution with frames that are not solved, or fills them in place: their weights are
/// interpolated between the nearest solved frames (copied at the ends), and their reports say
/// [`FrameWarning::Held`]. `residual` gives a frame's residual with other weights, metres.
///
/// # Errors
/// [`UnsolvedFrames`] where `choice` is to refuse, or where no frame is solved.
pub(crate) fn settle(
    solution: &mut TakeSolution,
    choice: Unsolved,
    residual: impl Fn(usize, &[f64]) -> f64,
) -> Result<(), UnsolvedFrames> {
    let TakeSolution { weights, reports } = solution;
    let is_unsolved = |r: &FrameReport| r.warning.is_some_and(FrameWarning::is_unsolved);
    let unsolved: Vec<usize> = (0..reports.len()).filter(|&f| is_unsolved(&reports[f])).collect();
    let Some(&first) = unsolved.first() else { return Ok(()) };
    if choice == Unsolved::Refuse || unsolved.len() == reports.len() {
        let why = reports[first].warning.unwrap_or(FrameWarning::NotConverged);
        return Err(UnsolvedFrames { count: unsolved.len(), frames: reports.len(), first, why });
    }
    let n = weights.len() / reports.len();
    let solved: Vec<usize> = (0..reports.len()).filter(|&f| !is_unsolved(&reports[f])).collect();
    for &frame in &unsolved {
        // The solved frames on both sides; at an end of the take the only one there is.
        let after = solved.partition_point(|&f| f < frame);
        let from = solved[after.saturating_sub(1)];
        let to = solved[after.min(solved.len() - 1)];
        let inside = from < frame && frame < to;
        let share = if inside { (frame - from) as f64 / (to - from) as f64 } else { 0.0 };
        for k in 0..n {
            let (a, b) = (weights[from * n + k], weights[to * n + k]);
            weights[frame * n + k] = a + share * (b - a);
        }
    }
    for frame in unsolved {
        reports[frame].residual = residual(frame, &weights[frame * n..(frame + 1) * n]);
        reports[frame].warning = Some(FrameWarning::Held);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solution(wrong: &[usize]) -> TakeSolution {
        let mut reports = vec![FrameReport::default(); 6];
        let mut weights: Vec<f64> = (0..6).flat_map(|f| [f64::from(f), 1.0]).collect();
        for &frame in wrong {
            reports[frame].warning = Some(FrameWarning::BeyondSense);
            weights[2 * frame..2 * frame + 2].fill(21_787.0);
        }
        TakeSolution { weights, reports }
    }

    #[test]
    fn frames_that_are_not_solved_are_refused_by_name() {
        let error = settle(&mut solution(&[2, 4]), Unsolved::Refuse, |_, _| 0.0).unwrap_err();
        assert_eq!((error.count, error.frames, error.first), (2, 6, 2));
        let said = error.sentence(700);
        assert!(said.starts_with("frame 702: no face does this"), "{said}");
        assert!(settle(&mut solution(&[]), Unsolved::Refuse, |_, _| 0.0).is_ok());
        // Nothing to hold them from.
        assert!(settle(&mut solution(&[0, 1, 2, 3, 4, 5]), Unsolved::Hold, |_, _| 0.0).is_err());
    }

    #[test]
    fn frames_are_held_from_those_around_them_and_marked() {
        let mut held = solution(&[0, 2, 3, 5]);
        settle(&mut held, Unsolved::Hold, |frame, _| frame as f64).unwrap();
        let first: Vec<f64> = held.weights.chunks_exact(2).map(|w| w[0]).collect();
        assert_eq!(first, [1.0, 1.0, 2.0, 3.0, 4.0, 4.0]);
        for frame in 0..6 {
            let marked = held.reports[frame].warning == Some(FrameWarning::Held);
            assert_eq!(marked, [0, 2, 3, 5].contains(&frame), "{frame}");
            assert_eq!(held.reports[frame].residual, if marked { frame as f64 } else { 0.0 });
        }
    }
}
