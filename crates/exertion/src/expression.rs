//! What makes curves of a frame: rules, a model, or the heart alone.

use crate::model::{ExpressionModel, Scratch};
use crate::rules::{Curves, Features, rules};

/// What makes the four curves.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Expression {
    /// The rules (E14).
    #[default]
    Rules,
    /// All curves are 100 rcn, as games do it.
    Linear,
    /// Support vectors.
    Model(Box<ExpressionModel>),
}

impl Expression {
    /// The curves of every frame, for a level of training.
    pub fn curves(&self, frames: &[Features], level: f64) -> Vec<Curves> {
        let mut scratch = Scratch::default();
        frames
            .iter()
            .map(|features| match self {
                Self::Rules => rules(features, level),
                Self::Linear => Curves::of_array([100.0 * features.rcn; 4]),
                Self::Model(model) => model.curves(features, &mut scratch),
            })
            .collect()
    }
}
