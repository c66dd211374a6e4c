//! What is told of each shape of a bank: whether the markers find its weight, and how well.

use mimique_avatar::turns_eyes;
use mimique_solver::{
    Group, MethodSpec, Operators, ShapeSensitivity, ToldBy, error_alone, is_told,
    shape_sensitivities,
};
use serde::Serialize;

use super::JoinedTake;
use crate::TakeWarning;

/// How a shape gets its weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum ShapeState {
    /// The markers tell it.
    Solved,
    /// The markers tell it together with another shape: the method's prior divides it between them.
    Shared,
    /// The method asks for it though the markers do not tell it: its weight is the method's prior.
    Untold,
    /// It stays at 0 since the markers do not tell it.
    Held,
    /// It turns the eyes, and no gaze is given.
    AtRest,
    /// Lid markers or a given gaze drive it.
    Driven,
    /// The method, or the avatar's settings, lock it at 0.
    Locked,
}

/// A shape, how it gets its weight, and the standard errors of that at 1 mm of noise on each coordinate.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ShapeRow {
    /// Its name.
    pub shape: String,
    /// How it gets its weight.
    pub state: ShapeState,
    /// Where all other weights are known; none where no marker moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alone: Option<f64>,
    /// Where the markers tell all weights that are solved.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub together: Option<f64>,
    /// Where the thin shell helps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<f64>,
    /// The shape that it is confused with most, and their correlation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub confused_with: Option<(String, f64)>,
}

impl JoinedTake<'_> {
    /// Names of the shapes that noise of 1 mm on each coordinate of the face markers moves from 0 to 1 and
    /// beyond, even if all other weights are known.
    pub(crate) fn untold(&self) -> impl Iterator<Item = &String> {
        let mesh = &self.skin.mesh;
        let square = move |shape: usize| -> f64 {
            self.markers.iter().map(|site| site.delta(mesh, shape).length_squared()).sum()
        };
        let names = self.skin.shape_names.iter().enumerate();
        names.filter(move |(shape, _)| !is_told(square(*shape))).map(|(_, name)| name)
    }

    /// Every shape of the bank in its order; none of a method that does not solve for shapes. `asked` is the
    /// method as its user wrote it, `spec` with the shapes that are held.
    pub(crate) fn shape_rows(
        &self,
        asked: &MethodSpec,
        spec: &MethodSpec,
        operators: &Operators,
    ) -> Vec<ShapeRow> {
        if !spec.method.uses(Group::Shapes) {
            return Vec::new();
        }
        let names = &operators.parts().shape_names;
        let free: Vec<usize> =
            (0..names.len()).filter(|&k| !spec.locked.contains(&names[k])).collect();
        let told = shape_sensitivities(operators, &free);
        let asked = asked.with_names_of(names, &[]);
        let driven: Vec<&String> = self.driven_shapes().collect();
        let squares = operators.marker_squares();
        (names.iter().enumerate())
            .map(|(k, name)| match told.iter().find(|told| told.shape == k) {
                Some(told) => free_row(names, told),
                None => {
                    let state = match () {
                        () if driven.contains(&name) => ShapeState::Driven,
                        () if asked.locked.contains(name) => ShapeState::Locked,
                        () if turns_eyes(name) => ShapeState::AtRest,
                        () => ShapeState::Held,
                    };
                    ShapeRow {
                        shape: name.clone(),
                        state,
                        alone: Some(error_alone(squares[k])).filter(|alone| alone.is_finite()),
                        together: None,
                        standard_error: None,
                        confused_with: None,
                    }
                }
            })
            .collect()
    }
}

/// The row of a shape that is solved for.
fn free_row(names: &[String], told: &ShapeSensitivity) -> ShapeRow {
    ShapeRow {
        shape: names[told.shape].clone(),
        state: match told.by {
            ToldBy::Markers => ShapeState::Solved,
            ToldBy::Shared => ShapeState::Shared,
            ToldBy::Nothing => ShapeState::Untold,
        },
        alone: Some(told.alone).filter(|alone| alone.is_finite()),
        together: Some(told.together),
        standard_error: Some(told.standard_error),
        confused_with: told.partner.map(|(k, correlation)| (names[k].clone(), correlation)),
    }
}

/// What is to be said of the shapes that stay at 0 since the markers do not tell them; none where there are none.
pub(crate) fn held_shapes(rows: &[ShapeRow]) -> Option<TakeWarning> {
    let held = rows.iter().filter(|row| row.state == ShapeState::Held);
    let shapes: Vec<String> = held.map(|row| row.shape.clone()).collect();
    (!shapes.is_empty()).then_some(TakeWarning::ShapesHeld { shapes })
}
