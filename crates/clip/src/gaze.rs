//! Shapes that turn the eyes, where no gaze is given.
//!
//! No marker sits on an eyeball. A marker on a lid moves with the lid, and a least-squares fit explains
//! a part of that by lids that follow the eyes: by turned eyes, each method by other ones. So the shapes
//! rest, unless the method's own parameters say otherwise.

use mimique_avatar::turns_eyes;
use mimique_solver::{Gaze, Group, MethodSpec};

/// The method with the shapes that turn the eyes held at 0, for a bank of these shapes.
///
/// They stay free where the method asks for that by `gaze`, and those that its `bounds` name stay free.
/// Patterns of `locked` and `bounds` are the names that they match ([`MethodSpec::with_names_of`]).
/// What is locked already stays so; a method that does not solve for shapes is left as it is.
pub fn with_gaze_at_rest(spec: &MethodSpec, shape_names: &[String]) -> MethodSpec {
    let mut spec = spec.with_names_of(shape_names, &[]);
    if !spec.method.uses(Group::Shapes) || spec.gaze() == Gaze::Markers {
        return spec;
    }
    for name in shape_names.iter().filter(|name| turns_eyes(name)) {
        if !spec.bounds.contains_key(name) && !spec.locked.contains(name) {
            spec.locked.push(name.clone());
        }
    }
    spec
}

/// The shapes that turn the eyes and are held at 0 by a method, in the order of the bank.
pub(crate) fn gaze_at_rest(spec: &MethodSpec, shape_names: &[String]) -> Vec<String> {
    let held = |name: &&String| turns_eyes(name) && spec.locked.contains(name);
    shape_names.iter().filter(held).cloned().collect()
}
