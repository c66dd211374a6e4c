//! Avatar files in, checked avatars out, whatever the format.

use std::path::Path;

use crate::ReadError;
use crate::eye_pairs::part_eyes;
use crate::files::Files;
use crate::lids_follow::let_lids_follow;
use crate::parts::find_eyeballs;
use crate::settings::{AvatarSettings, avatar_name, fits};
use mimique_avatar::{Avatar, MOST_EYEBALLS, MOST_SHAPES, Mesh, Part, arkit_shapes};

/// An avatar as read, in metres, and what the reader found worth saying.
#[derive(Debug, Clone)]
pub struct ReadAvatar {
    /// The avatar.
    pub avatar: Avatar,
    /// The unit that the file's numbers are taken to be in, in metres (1, 0.01 or 0.001).
    pub unit_metres: f64,
    /// Shapes that stay at 0 when weights are solved, as the JSON beside the avatar asks.
    pub locked: Vec<String>,
    /// What was assumed or left out, a sentence each.
    pub notes: Vec<String>,
}

/// Reads an avatar: a `.glb` or `.gltf` file, or a folder or archive (zip, tar, tar.gz, tar.xz) of
/// OBJ poses; with the settings beside it ([`AvatarSettings`]), if there are any.
///
/// # Errors
/// [`ReadError`]: the file is absent, of another format, damaged, or holds no face.
pub fn read_avatar(path: &Path) -> Result<ReadAvatar, ReadError> {
    let name = avatar_name(path);
    let settings = settings_beside(path)?;
    if path.is_dir() {
        let files = Files::Folder(path.to_owned());
        let name = path.file_name().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        return crate::obj::read_obj_poses(&files, &name, settings);
    }
    let bytes = std::fs::read(path)
        .map_err(|source| ReadError::Io { place: "the avatar file".to_owned(), source })?;
    read_avatar_bytes(bytes, &name, path.parent(), settings)
}

/// Reads an avatar from the bytes of a file: GLB, glTF, or an archive of OBJ poses.
///
/// `name` becomes [`Avatar::name`]; `folder` is where a `.gltf` file's buffers and pictures are
/// looked for.
///
/// # Errors
/// As [`read_avatar`].
pub fn read_avatar_bytes(
    bytes: Vec<u8>,
    name: &str,
    folder: Option<&Path>,
    settings: Option<AvatarSettings>,
) -> Result<ReadAvatar, ReadError> {
    match Files::of_archive(&bytes) {
        Some(archive) => crate::obj::read_obj_poses(&archive(bytes), name, settings),
        None => crate::glb::read_with(&bytes, name, folder, &settings.unwrap_or_default()),
    }
}

/// `head.avatar.json` beside `head.glb`.
fn settings_beside(path: &Path) -> Result<Option<AvatarSettings>, ReadError> {
    let beside = AvatarSettings::path_beside(path);
    if !beside.is_file() {
        return Ok(None);
    }
    let file = beside.file_name().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let bytes =
        std::fs::read(&beside).map_err(|source| ReadError::Io { place: file.clone(), source })?;
    AvatarSettings::from_json(&file, &bytes).map(Some)
}

impl ReadAvatar {
    /// Checks, converts to metres, names the shapes and finds the eyeballs of an avatar in its
    /// file's own unit.
    pub(crate) fn finish(
        mut avatar: Avatar,
        mut notes: Vec<String>,
        settings: &AvatarSettings,
    ) -> Result<Self, ReadError> {
        name_shapes(&mut avatar, settings)?;
        settings.driven.apply(&mut avatar).map_err(|e| {
            ReadError::broken(format!("avatar.json: {}", e.pointer), e.what, e.remedy)
        })?;
        if avatar.shape_names.is_empty() {
            return Err(ReadError::broken(
                "meshes",
                "no blendshapes",
                "export the head with its morph targets (shape keys), or one OBJ file per pose",
            ));
        }
        within_most(
            "meshes, blendshapes",
            avatar.shape_names.len(),
            MOST_SHAPES,
            "leave unused ones out by \"leaveOut\" in the JSON beside the avatar",
        )?;
        let extent = skin_extent(&avatar).filter(|extent| *extent > 0.0).ok_or_else(|| {
            ReadError::broken(
                "meshes",
                "no skin: every mesh is empty or a named part (eyes, teeth, lashes...)",
                "name the face's mesh with the word skin, head or face",
            )
        })?;
        let unit_metres = settings.unit_metres.unwrap_or_else(|| unit_of(extent));
        notes.push(unit_note(extent, unit_metres, settings.unit_metres.is_some()));
        if unit_metres != 1.0 {
            scale(&mut avatar, unit_metres);
        }
        within_reach(&avatar)?;
        let face = avatar.face_shapes();
        let known = face.iter().filter(|n| !arkit_shapes(n).is_empty()).count();
        if known < face.len() {
            let all = face.len();
            notes.push(format!("{known} of {all} shapes are ARKit's by name, the rest are kept"));
        }
        let pairs = part_eyes(&mut avatar);
        if !pairs.is_empty() {
            let pairs = pairs.join(", ");
            notes.push(format!("both eyes in one mesh, parted into left and right: {pairs}"));
        }
        within_most(
            "meshes, eyeballs",
            avatar.meshes.iter().filter(|mesh| mesh.part.is_eye()).count(),
            MOST_EYEBALLS,
            "leave layers out, or call them eyeOverlay, under \"parts\" in the JSON beside the avatar",
        )?;
        avatar.eyeballs = find_eyeballs(&avatar);
        notes.extend(let_lids_follow(&mut avatar));
        let locked = locked(&avatar.shape_names, settings)?;
        Ok(Self { avatar, unit_metres, locked, notes })
    }
}

/// Refuses more of something than can be drawn.
fn within_most(place: &str, found: usize, most: usize, remedy: &str) -> Result<(), ReadError> {
    if found <= most {
        return Ok(());
    }
    Err(ReadError::broken(place, format!("{found} of them, at most {most} can be drawn"), remedy))
}

/// Leaves shapes out and renames shapes as the settings ask.
fn name_shapes(avatar: &mut Avatar, settings: &AvatarSettings) -> Result<(), ReadError> {
    for (name, _) in &settings.shapes {
        if !avatar.shape_names.contains(name) {
            return Err(no_shape("shapes", name, &avatar.shape_names));
        }
    }
    let stays = |name: &String| !settings.leave_out.iter().any(|p| fits(p, name));
    let stay: Vec<bool> = avatar.shape_names.iter().map(stays).collect();
    for mesh in &mut avatar.meshes {
        let shapes = std::mem::take(&mut mesh.shapes).into_iter().zip(&stay);
        mesh.shapes = shapes.filter(|(_, stay)| **stay).map(|(shape, _)| shape).collect();
    }
    avatar.shape_names.retain(stays);
    let shares = avatar.expressions.iter_mut().flat_map(|own| &mut own.shares).map(|(s, _)| s);
    for name in avatar.shape_names.iter_mut().chain(shares) {
        if let Some((_, new)) = settings.shapes.iter().find(|(old, _)| old == name) {
            name.clone_from(new);
        }
    }
    let names = &avatar.shape_names;
    match (0..names.len()).find(|&k| names[..k].contains(&names[k])) {
        Some(k) => Err(ReadError::broken(
            "avatar.json: /shapes",
            format!("{:?} is the name of two shapes", names[k]),
            "give each its own name",
        )),
        None => Ok(()),
    }
}

/// The shapes that the patterns of `locked` fit.
fn locked(names: &[String], settings: &AvatarSettings) -> Result<Vec<String>, ReadError> {
    for pattern in &settings.locked {
        if !names.iter().any(|name| fits(pattern, name)) {
            return Err(no_shape("locked", pattern, names));
        }
    }
    let fitting = |name: &&String| settings.locked.iter().any(|p| fits(p, name));
    Ok(names.iter().filter(fitting).cloned().collect())
}

fn no_shape(key: &str, pattern: &str, names: &[String]) -> ReadError {
    let remedy = format!("the file has {}", names.join(", "));
    ReadError::broken(format!("avatar.json: /{key}"), format!("no shape {pattern:?}"), remedy)
}

fn unit_note(extent: f64, unit_metres: f64, said: bool) -> String {
    match (said, unit_metres) {
        (true, _) => format!("unit: {unit_metres} m, as the JSON beside the avatar says"),
        (false, 1.0) => format!("unit: metres, since the skin measures {extent:.3} units"),
        (false, 0.01) => format!("unit: centimetres, since the skin measures {extent:.1} units"),
        (false, _) => format!("unit: millimetres, since the skin measures {extent:.0} units"),
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
pub(crate) fn unit_of(extent: f64) -> f64 {
    match extent {
        e if e < 5.0 => 1.0,
        e if e < 100.0 => 0.01,
        _ => 0.001,
    }
}

/// Farthest that a vertex may lie or be moved, metres: beyond are damaged numbers, and more than what
/// a pack's 32 bits hold in steps of a micrometre.
const FARTHEST: f32 = 1000.0;

/// Refuses positions and displacements that no avatar has.
fn within_reach(avatar: &Avatar) -> Result<(), ReadError> {
    let beyond = |v: &[f32; 3]| v.iter().any(|x| x.is_nan() || x.abs() > FARTHEST);
    let refused = |mesh: &Mesh, what: String, v: &[f32; 3]| {
        let length = v.iter().fold(0f32, |most, x| most.max(x.abs()));
        ReadError::broken(
            format!("mesh {:?}", mesh.name),
            format!("{what} {length:e} m, more than {FARTHEST} m"),
            "re-export the avatar, or give its unit in the JSON beside it",
        )
    };
    for mesh in &avatar.meshes {
        if let Some(v) = mesh.positions.iter().position(beyond) {
            return Err(refused(mesh, format!("vertex {v} lies at"), &mesh.positions[v]));
        }
        for (shape, name) in mesh.shapes.iter().zip(&avatar.shape_names) {
            if let Some(k) = shape.deltas.iter().position(beyond) {
                let what = format!("shape {name:?} moves vertex {} by", shape.vertices[k]);
                return Err(refused(mesh, what, &shape.deltas[k]));
            }
        }
    }
    Ok(())
}

fn scale(avatar: &mut Avatar, factor: f64) {
    let scaled = |v: &mut [f32; 3]| *v = v.map(|x| (f64::from(x) * factor) as f32);
    for mesh in &mut avatar.meshes {
        mesh.positions.iter_mut().for_each(scaled);
        mesh.shapes.iter_mut().flat_map(|s| &mut s.deltas).for_each(scaled);
    }
}
