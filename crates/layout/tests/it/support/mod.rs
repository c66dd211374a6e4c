//! The built-in head, its range of motion and the usual places.

use mimique_actor::{Density, HeadSpec, build_head, range_of_motion};
use mimique_layout::{
    Candidates, Conditions, Effort, Face, FaceMotion, Rehearsal, Silent, Spacing, Take,
    TakeContent, Task, Units, Where, unseen_shapes,
};
use mimique_solver::{Method, MethodSpec};
use mimique_stimulus::AvatarSkin;

/// Noise and slip of the simulated takes, metres.
pub const PUT: Conditions = Conditions { noise: 1e-4, slip: 1.5e-3, others: true };
/// Markers where they are meant to be, without noise.
pub const EXACT: Conditions = Conditions { noise: 0.0, slip: 0.0, others: false };

/// The built-in head, coarsely.
pub fn skin() -> AvatarSkin {
    let spec = HeadSpec { density: Density::nearest(4_000), ..HeadSpec::default() };
    AvatarSkin::of(&build_head(&spec)).unwrap()
}

/// A range of motion as the built-in actor plays it, at 10 frames per second.
pub fn range(skin: &AvatarSkin, name: &str, seed: u64) -> Take {
    let played = range_of_motion(&skin.shape_names, seed, 10.0);
    let content = TakeContent::Weights(played.weights);
    Take { name: name.to_owned(), rate_hz: Some(10.0), content }
}

/// What layouts of a face are sought on.
pub struct Ground<'a> {
    pub face: &'a Face<'a>,
    pub candidates: Candidates,
    pub motion: FaceMotion,
    pub rehearsal: Rehearsal<'a>,
}

impl<'a> Ground<'a> {
    pub fn of(face: &'a Face<'a>) -> Self {
        Self::with(face, &Where::default(), &[range(face.skin, "range", 1)])
    }

    pub fn with(face: &'a Face<'a>, place: &Where, takes: &[Take]) -> Self {
        let candidates = Candidates::of(face, place);
        let unseen = unseen_shapes(face, &candidates.vertices);
        let motion = FaceMotion::of(face, takes, &unseen).unwrap();
        let mut spec = MethodSpec::new(Method::Lsts);
        spec.rbf_smoothing = Some(0.1);
        let rehearsal = Rehearsal::new(face, &motion, None, &spec, PUT, Effort::SEARCH, 1);
        Self { face, candidates, motion, rehearsal }
    }

    pub fn units(&self, symmetric: bool, kept: &[usize], distance: f64) -> Units<'a> {
        let spacing = Spacing::of(self.face, &self.motion, &self.candidates.vertices, distance);
        Units::of(self.face, &self.candidates, spacing, symmetric, kept).unwrap()
    }

    pub fn task<'t>(&'t self, units: &'t Units<'a>) -> Task<'t, 'a> {
        Task {
            units,
            motion: &self.motion,
            rehearsal: &self.rehearsal,
            noise: PUT.noise,
            slip: PUT.slip,
            seed: 1,
            progress: &Silent,
        }
    }
}
