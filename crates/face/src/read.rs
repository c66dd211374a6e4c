//! Avatar files in, checked avatars out, whatever the format.

use std::path::Path;

use crate::parts::find_eyeballs;
use crate::{Avatar, Part, ReadError};

/// An avatar as read, in metres, and what the reader found worth saying.
#[derive(Debug, Clone)]
pub struct ReadAvatar {
    /// The avatar.
    pub avatar: Avatar,
    /// The unit that the file's numbers are taken to be in, in metres (1, 0.01 or 0.001).
    pub unit_metres: f64,
    /// What was assumed or left out, a sentence each.
    pub notes: Vec<String>,
}

/// Reads an avatar file: `.glb` or `.gltf`.
///
/// # Errors
/// [`ReadError`]: the file is absent, of another format, damaged, or holds no face.
pub fn read_avatar(path: &Path) -> Result<ReadAvatar, ReadError> {
    let bytes = std::fs::read(path)
        .map_err(|source| ReadError::Io { place: "the avatar file".to_owned(), source })?;
    let name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    crate::read_gltf(&bytes, &name, path.parent())
}

impl ReadAvatar {
    /// Checks, converts to metres and finds the eyeballs of an avatar in its file's own unit.
    pub(crate) fn finish(mut avatar: Avatar, mut notes: Vec<String>) -> Result<Self, ReadError> {
        if avatar.shape_names.is_empty() {
            return Err(ReadError::broken(
                "meshes",
                "no blendshapes",
                "export the head with its morph targets (shape keys)",
            ));
        }
        let extent = skin_extent(&avatar).filter(|extent| *extent > 0.0).ok_or_else(|| {
            ReadError::broken(
                "meshes",
                "no skin: every mesh is empty or a named part (eyes, teeth, lashes...)",
                "name the face's mesh with the word skin, head or face",
            )
        })?;
        let unit_metres = unit_of(extent);
        if unit_metres == 1.0 {
            notes.push("unit: metres, as glTF says".to_owned());
        } else {
            let unit = if unit_metres == 0.01 { "centimetres" } else { "millimetres" };
            notes.push(format!("unit: {unit}, since the skin measures {extent:.1} units"));
            scale(&mut avatar, unit_metres);
        }
        avatar.eyeballs = find_eyeballs(&avatar);
        Ok(Self { avatar, unit_metres, notes })
    }
}

/// Longest side of the skin's bounding box.
fn skin_extent(avatar: &Avatar) -> Option<f64> {
    let points =
        || avatar.meshes.iter().filter(|m| m.part == Part::Skin).flat_map(|m| &m.positions);
    (0..3)
        .map(|a| {
            let (low, high) = points()
                .fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), p| (l.min(p[a]), h.max(p[a])));
            f64::from(high) - f64::from(low)
        })
        .reduce(f64::max)
        .filter(|extent| extent.is_finite())
}

/// A face is 0.15 m high, a person 2 m: below 5 units metres, below 100 centimetres (a head and
/// its shoulders), above it millimetres.
fn unit_of(extent: f64) -> f64 {
    match extent {
        e if e < 5.0 => 1.0,
        e if e < 100.0 => 0.01,
        _ => 0.001,
    }
}

fn scale(avatar: &mut Avatar, factor: f64) {
    let scaled = |v: &mut [f32; 3]| *v = v.map(|x| (f64::from(x) * factor) as f32);
    for mesh in &mut avatar.meshes {
        mesh.positions.iter_mut().for_each(scaled);
        mesh.shapes.iter_mut().flat_map(|s| &mut s.deltas).for_each(scaled);
    }
}
