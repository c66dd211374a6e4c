//! What a layout is judged on: the skin's neighbours and mirror image, allowed places, a motion and its curve.

use mimique_layout::{
    Candidates, Conditions, ExpectedCurve, Face, FaceMotion, MirrorVertices, Take, TakeContent,
    Where, unseen_shapes,
};
use mimique_solver::SkinGradients;
use mimique_stimulus::RecordedWeights;

use super::WHAT;
use crate::problem::Problem;
use crate::workspace::{Take as StudioTake, Workspace};

/// What stays while markers are dragged.
#[derive(Debug)]
pub(super) struct Ground {
    pub(super) gradients: SkinGradients,
    pub(super) mirror: MirrorVertices,
    pub(super) candidates: Candidates,
    pub(super) motion: FaceMotion,
    /// Follows the markers as they are.
    pub(super) curve: ExpectedCurve,
    /// Of the markers as they were made or opened.
    pub(super) first_curve: ExpectedCurve,
}

impl Ground {
    fn of(face: &Face<'_>, takes: &[Take]) -> Result<Self, Problem> {
        let candidates = Candidates::of(face, &Where::default());
        let unseen = unseen_shapes(face, &candidates.vertices);
        let motion = FaceMotion::of(face, takes, &unseen).map_err(|e| Problem::of(WHAT, e))?;
        let Conditions { noise, slip, .. } = Conditions::BY_HAND;
        let curve = ExpectedCurve::new(&motion, noise, slip);
        Ok(Self {
            gradients: face.gradients.clone(),
            mirror: face.mirror.clone(),
            first_curve: curve.clone(),
            curve,
            candidates,
            motion,
        })
    }

    /// Whether markers may be at a vertex: moved, seen, off lids, inner lips, nostrils, ears, neck and hair.
    pub(super) fn allows(&self, vertex: usize) -> bool {
        self.candidates.vertices.binary_search(&vertex).is_ok()
    }

    /// The vertex on the other side, where there is one.
    pub(super) fn partner(&self, vertex: usize) -> Option<usize> {
        let partner = self.mirror.of[vertex];
        let aside = self.mirror.from_middle[vertex] != 0.0 && partner != vertex;
        (aside && self.mirror.has_partner(vertex)).then_some(partner)
    }
}

impl Workspace {
    /// The face of the avatar.
    pub(super) fn layout_face(&self) -> Result<Face<'_>, Problem> {
        Face::of(&self.face()?.skin).map_err(|e| Problem::of(WHAT, e))
    }

    /// Sets up what layouts are judged on, where it is not: another avatar or other motion takes it away.
    pub(super) fn prepare_ground(&mut self) -> Result<(), Problem> {
        if self.layout.ground.is_none() {
            let ground = Ground::of(&self.layout_face()?, &self.layout_takes()?)?;
            self.layout.ground = Some(ground);
        }
        Ok(())
    }

    /// The motion that layouts are for: the weights of the training take, else the recorded weights that are
    /// open, else none.
    fn layout_takes(&self) -> Result<Vec<Take>, Problem> {
        let opened = match &self.take {
            Some(StudioTake::Weights { name, table, .. }) => Some((name, table)),
            _ => None,
        };
        let Some((name, table)) = self.training.weights().or(opened) else { return Ok(Vec::new()) };
        let recorded = RecordedWeights::of(table, &self.face()?.skin.shape_names)
            .map_err(|e| Problem::of(name, e))?;
        if recorded.names.driven.is_empty() {
            let what = "no column is a shape of the avatar; open weights whose columns are named as its shapes";
            return Err(Problem::of(name, what));
        }
        let rate_hz = recorded.table.rate_hz();
        let content = TakeContent::Weights(recorded.table.weights);
        Ok(vec![Take { name: name.clone(), rate_hz, content }])
    }
}
