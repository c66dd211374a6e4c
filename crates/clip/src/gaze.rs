//! Shapes that turn the eyes: at rest where no gaze is given, both eyes as one gaze where markers tell it.
//!
//! No marker sits on an eyeball. A marker on a lid moves with the lid, and a least-squares fit explains
//! a part of that by lids that follow the eyes: by turned eyes, each method by other ones. So the shapes
//! rest, unless the method's own parameters say otherwise.

use mimique_avatar::{GazeAngles, GazeShapes, VERGENCE_DEGREES, turns_eyes};
use mimique_solver::{Gaze, Group, MethodSpec};

/// The method with the shapes that turn the eyes held at 0, for a bank of these shapes.
///
/// They stay free where the method asks for that by `gaze`, and those that its `bounds` name stay free.
/// Patterns of `locked` and `bounds` are the names that they match ([`MethodSpec::with_names_of`]).
/// What is locked already stays so; a method that does not solve for shapes is left as it is.
pub fn with_gaze_at_rest(spec: &MethodSpec, shape_names: &[String]) -> MethodSpec {
    let mut spec = spec.with_names_of(shape_names, &[]);
    if !spec.method.uses(Group::Shapes) || spec.gaze() != Gaze::Rest {
        return spec;
    }
    for name in shape_names.iter().filter(|name| turns_eyes(name)) {
        if !spec.bounds.contains_key(name) && !spec.locked.contains(name) {
            spec.locked.push(name.clone());
        }
    }
    spec
}

/// The shapes that turn the eyes and are held at 0 by a method, in the order of the bank. What is `driven` by a
/// given gaze is not held.
pub(crate) fn gaze_at_rest(
    spec: &MethodSpec,
    shape_names: &[String],
    driven: &[String],
) -> Vec<String> {
    let held =
        |name: &&String| turns_eyes(name) && spec.locked.contains(name) && !driven.contains(name);
    shape_names.iter().filter(held).cloned().collect()
}

/// Brings both eyes of each row of weights together to one gaze: the mean of their azimuths and elevations, and
/// their vergence from parallel to the nearest that eyes converge on. Rows of a bank that turns one eye, or
/// none, stay as they are.
pub(crate) fn bring_eyes_together(weights: &mut [f64], shape_names: &[String]) {
    let shapes = GazeShapes::of(shape_names);
    let columns = shapes.shapes();
    for row in weights.chunks_exact_mut(shape_names.len()) {
        let eyes = shapes.eyes(row);
        let (Some(_), Some(_), Some(gaze)) = (eyes.left, eyes.right, eyes.gaze()) else { return };
        let vergence = gaze.vergence.clamp(0.0, VERGENCE_DEGREES[1]);
        let one = shapes.weights(GazeAngles { vergence, ..gaze });
        columns.iter().zip(one).for_each(|(&shape, weight)| row[shape] = weight);
    }
}
