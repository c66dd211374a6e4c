//! A layout made by a method, and rehearsed.

use mimique_layout::{
    Choice, Conditions, DISTANCE_M, Effort, Face, FaceMotion, HEAD_NOISE_M, Layout, LayoutError,
    Method, Rehearsal, Silent, Spacing, Task, Units, choose_heads, missed,
};
use mimique_solver::{Method as Solver, MethodSpec};
use mimique_stimulus::ADVISED_SMOOTHING;
use serde_json::{Value, json};

use super::{OnHead, Rehearsed, WHAT, none};
use crate::problem::Problem;
use crate::workspace::Workspace;

/// Seed of everything that is drawn.
const SEED: u64 = 1;

impl Workspace {
    /// Makes a layout of `count` face and `heads` head markers (0 for none) by a method; in mirrored pairs
    /// where it is `symmetric`.
    ///
    /// # Errors
    /// [`Problem`]: no avatar or no face, no such method, markers that do not fit.
    pub fn make_layout(
        &mut self,
        method: &str,
        count: usize,
        heads: usize,
        symmetric: bool,
    ) -> Result<Value, Problem> {
        let method: Method = method.parse().map_err(|e| Problem::of(WHAT, e))?;
        self.prepare_ground()?;
        let layout = self.made(method, count, heads, symmetric)?;
        self.layout.put(layout);
        self.layout_state()
    }

    fn made(
        &self,
        method: Method,
        count: usize,
        heads: usize,
        symmetric: bool,
    ) -> Result<OnHead, Problem> {
        let ground = self.layout.ground.as_ref().ok_or_else(none)?;
        let face = self.layout_face()?;
        let (motion, candidates) = (&ground.motion, &ground.candidates);
        let spacing = Spacing::of(&face, motion, &candidates.vertices, DISTANCE_M);
        let units = Units::of(&face, candidates, spacing, symmetric, &[]).map_err(problem)?;
        let Conditions { noise, slip, .. } = Conditions::BY_HAND;
        let task = Task {
            units: &units,
            motion,
            rehearsal: &rehearsal(&face, motion),
            noise,
            slip,
            seed: SEED,
            progress: &Silent,
        };
        let chosen = method.choose(&task, count, &Choice::default()).map_err(problem)?;
        let vertices = chosen.vertices();
        let heads = match heads {
            0 => Vec::new(),
            _ => {
                choose_heads(&face, &units.spacing, &vertices, heads, HEAD_NOISE_M)
                    .map_err(problem)?
                    .vertices
            }
        };
        let layout = Layout::named(&face, &chosen.units, &heads);
        let heads = (layout.head.iter())
            .map(|marker| (marker.label.clone(), face.place(marker.vertex)))
            .collect();
        let origin = json!({"method": method, "seed": SEED, "symmetric": symmetric});
        Ok(OnHead { map: layout.to_map(&face), vertices, heads, origin })
    }

    /// Rehearses the layout as it is, and without each of its markers: what dropping each costs.
    ///
    /// # Errors
    /// [`Problem`]: there is no layout.
    pub fn rehearse_layout(&mut self) -> Result<Value, Problem> {
        self.prepare_ground()?;
        let ground = self.layout.ground.as_ref().ok_or_else(none)?;
        let vertices = &self.layout.now.as_ref().ok_or_else(none)?.vertices;
        let face = self.layout_face()?;
        let (all_mm, missed_mm) = missed(&rehearsal(&face, &ground.motion), vertices);
        self.layout.rehearsed = Some(Rehearsed { all_mm, missed_mm });
        self.layout_state()
    }
}

/// Simulated takes as `mimique layout` has them by itself: `lsts`, markers put on by hand, smoothing.
fn rehearsal<'a>(face: &'a Face<'a>, motion: &FaceMotion) -> Rehearsal<'a> {
    let mut spec = MethodSpec::new(Solver::Lsts);
    spec.rbf_smoothing = Some(ADVISED_SMOOTHING);
    let by_hand = Conditions::BY_HAND;
    Rehearsal::new(face, motion, Some(motion), &spec, by_hand, Effort::SEARCH, SEED)
}

/// An error with the page's own remedy, where the command's names an option.
fn problem(error: LayoutError) -> Problem {
    match error {
        LayoutError::Asymmetric { without, of, millimetres } => Problem::of(
            WHAT,
            format!(
                "{without} of {of} allowed vertices have no partner within {millimetres} mm on the other side; \
                 untick mirrored pairs"
            ),
        ),
        LayoutError::TooMany { fit, wanted, millimetres } => Problem::of(
            WHAT,
            format!("{fit} of {wanted} markers fit at {millimetres} mm; ask for fewer"),
        ),
        LayoutError::NoHead { found, wanted } => Problem::of(
            WHAT,
            format!(
                "{found} places for head markers on skin that moves less than 0.2 mm where {wanted} are wanted; ask \
                 for fewer, or for 0 where the actor wears a headband"
            ),
        ),
        other => Problem::of(WHAT, other),
    }
}
