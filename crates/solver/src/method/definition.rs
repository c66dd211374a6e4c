//! What the file of a method says of it.

use crate::fit::problem::FitError;
use crate::fit::setup::{Engine, Setup};
use crate::parameters::group::Group;

/// A method.
#[derive(Debug)]
pub(crate) struct Definition {
    /// What it minimises, in a few words.
    pub(crate) summary: &'static str,
    /// What it is set up with.
    pub(crate) needs: Needs,
    /// The parameters that it uses.
    pub(crate) uses: &'static [Group],
    /// Defaults that are not the same for all methods.
    pub(crate) defaults: Defaults,
    /// How it is set up.
    pub(crate) engine: fn(&Setup<'_>) -> Result<Engine, FitError>,
}

/// What a method is set up with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// The operators of the avatar's shapes.
    Shapes,
    /// The same, and a take with known weights to learn from.
    Training,
    /// The operators of the skin itself, whose "shapes" are its markers.
    Surface,
    /// Weights from a file: there is nothing to solve.
    Weights,
}

/// Defaults that differ from method to method.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Defaults {
    /// Of `alpha`.
    pub(crate) alpha: f64,
    /// Of `eps`: in units of l, or in metres for a method that measures in a unit.
    pub(crate) eps: f64,
}

impl Defaults {
    /// Those of most methods.
    pub(crate) const USUAL: Defaults = Defaults { alpha: 0.5, eps: 0.0 };
}
