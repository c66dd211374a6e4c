//! glTF 2.0 in (`.glb`, `.gltf`), an [`Avatar`] out.
//!
//! Read: every mesh of the scene with its morph targets (sparse accessors, normalised integers),
//! node transforms, skeletons at the pose that the file has them in, base colours and their
//! textures, `extras.targetNames`; KHR_mesh_quantization, KHR_texture_transform and, in native
//! builds, EXT_meshopt_compression; the expressions of VRM 1.0; by itself, the animation of the morph targets. Not read: other
//! textures; other compressions are refused by name.

mod accessor;
mod animation;
mod container;
mod material;
mod meshopt;
mod primitive;
mod skeleton;
mod transform;
mod vrm;
mod write;

pub use animation::{WeightAnimation, read_weight_animation};
pub use write::{GlbWriteError, write_glb};

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

use gltf_json::Node;

use self::container::Container;
use self::material::Pictures;
use self::primitive::Surface;
use self::skeleton::Placement;
use self::transform::Transform;
use crate::parts::{PartName, assign_parts};
use crate::settings::AvatarSettings;
use crate::{ReadAvatar, ReadError};
use mimique_avatar::{Avatar, Mesh, Part, SparseShape, Textured};

/// Reads a GLB file, or a glTF file whose buffers are inside it.
///
/// `name` becomes [`Avatar::name`]; `folder` is where a `.gltf` file's buffers are looked for.
///
/// # Errors
/// [`ReadError`] with the place in the file: truncated, an index out of range, a number that is
/// not finite, a required extension, no mesh, morph targets that contradict one another.
pub fn read_gltf(bytes: &[u8], name: &str, folder: Option<&Path>) -> Result<ReadAvatar, ReadError> {
    read_with(bytes, name, folder, &AvatarSettings::default())
}

/// The same, with what the user says of the avatar.
pub(crate) fn read_with(
    bytes: &[u8],
    name: &str,
    folder: Option<&Path>,
    settings: &AvatarSettings,
) -> Result<ReadAvatar, ReadError> {
    let (avatar, notes) = as_in_the_file(bytes, name, folder, settings)?;
    ReadAvatar::finish(avatar, notes, settings)
}

/// The avatar as it stands in the file, in the file's unit and unchecked, and what is to be said of it.
pub(crate) fn as_in_the_file(
    bytes: &[u8],
    name: &str,
    folder: Option<&Path>,
    settings: &AvatarSettings,
) -> Result<(Avatar, Vec<String>), ReadError> {
    let container = container::open(bytes, folder)?;
    let mut notes = Vec::new();
    let mut surfaces = Vec::new();
    let mut budget = primitive::Budget::default();
    let placed = placed_nodes(&container)?;
    for (node, world_from_node) in &placed {
        let Some(mesh) = container.root.nodes[*node].mesh else { continue };
        let pose = match container.root.nodes[*node].skin {
            Some(skin) => {
                notes.push(format!("nodes[{node}] has a skeleton: taken in the pose of the file"));
                Placement::Skeleton(skeleton::joints(&container, skin.value(), &placed)?)
            }
            None => Placement::Rigid(*world_from_node),
        };
        surfaces.extend(primitive::surfaces(&container, *node, mesh.value(), &pose, &mut budget)?);
    }
    if surfaces.is_empty() {
        return Err(ReadError::broken(
            "scene",
            "no mesh in it",
            "export the head's meshes into the scene",
        ));
    }
    let mut pictures = Pictures::new(&container, folder);
    let (shape_names, meshes) = joined(surfaces, &mut pictures, settings)?;
    notes.append(&mut pictures.notes);
    let (name, textures) = (name.to_owned(), pictures.textures);
    let expressions = vrm::expressions(&container)?;
    Ok((Avatar { name, shape_names, meshes, eyeballs: vec![], textures, expressions }, notes))
}

/// Every node of the scene with its world-from-node transform, parents first.
fn placed_nodes(container: &Container) -> Result<Vec<(usize, Transform)>, ReadError> {
    let root = &container.root;
    let get = |index: usize, place: &str| -> Result<&Node, ReadError> {
        root.nodes
            .get(index)
            .ok_or_else(|| ReadError::damaged(place, format!("node {index} does not exist")))
    };
    let scene = root.scene.map_or(0, |s| s.value());
    let mut waiting: Vec<(usize, Transform)> = match root.scenes.get(scene) {
        Some(scene) => scene.nodes.iter().map(|n| (n.value(), Transform::IDENTITY)).collect(),
        None if root.scene.is_some() => {
            return Err(ReadError::damaged("scene", format!("scene {scene} does not exist")));
        }
        // No scene at all: whatever is nobody's child.
        None => {
            let children: Vec<usize> = root
                .nodes
                .iter()
                .flat_map(|n| n.children.iter().flatten())
                .map(|c| c.value())
                .collect();
            (0..root.nodes.len())
                .filter(|n| !children.contains(n))
                .map(|n| (n, Transform::IDENTITY))
                .collect()
        }
    };
    waiting.reverse();
    let mut seen = vec![false; root.nodes.len()];
    let mut placed = Vec::new();
    while let Some((index, world_from_parent)) = waiting.pop() {
        let place = format!("nodes[{index}]");
        let node = get(index, &place)?;
        if std::mem::replace(&mut seen[index], true) {
            return Err(ReadError::damaged(place, "the node hangs below two others or itself"));
        }
        let parent_from_node = Transform::of_node(node)
            .ok_or_else(|| ReadError::damaged(&place, "a transform that is not finite"))?;
        let world_from_node = world_from_parent.then(&parent_from_node);
        placed.push((index, world_from_node));
        for child in node.children.iter().flatten().rev() {
            waiting.push((child.value(), world_from_node));
        }
    }
    Ok(placed)
}

/// Surfaces to meshes: parts named, surfaces of one node and part made one mesh, shapes of all
/// meshes brought to one list of names (in the order in which they first appear).
fn joined(
    surfaces: Vec<Surface>,
    pictures: &mut Pictures<'_>,
    settings: &AvatarSettings,
) -> Result<(Vec<String>, Vec<Mesh>), ReadError> {
    let mut shape_names: Vec<String> = Vec::new();
    let mut index_of: HashMap<String, usize> = HashMap::new();
    for surface in &surfaces {
        for name in &surface.shape_names {
            if !index_of.contains_key(name) {
                index_of.insert(name.clone(), shape_names.len());
                shape_names.push(name.clone());
            }
        }
    }
    let named: Vec<PartName<'_>> = surfaces
        .iter()
        .map(|s| PartName {
            names: [&s.node_name, &s.mesh_name, &s.material_name],
            positions: &s.positions,
            shapes: s.shapes.iter().filter(|shape| !shape.vertices.is_empty()).count(),
            moved: s.shapes.iter().map(|shape| shape.vertices.len()).sum(),
        })
        .collect();
    let parts = assign_parts(&named, settings)?;
    let mut meshes: Vec<(usize, Mesh)> = Vec::new();
    for (surface, part) in surfaces.into_iter().zip(parts) {
        let Some(part) = part else { continue };
        let mut shapes = vec![SparseShape::default(); shape_names.len()];
        for (name, shape) in surface.shape_names.iter().zip(surface.shapes) {
            shapes[index_of[name]] = shape;
        }
        let mut mesh = Mesh {
            name: surface.mesh_name,
            part,
            positions: surface.positions,
            triangles: surface.triangles,
            base_colour: surface.base_colour,
            vertex_colours: surface.colours,
            shapes,
            ..Mesh::default()
        };
        if let (Some(paint), false) = (surface.paint, part == Part::EyeOverlay) {
            pictures.lay_on(&mut mesh, paint)?;
        }
        match meshes.last_mut() {
            Some((node, last)) if *node == surface.node && last.part == part => append(last, mesh),
            _ => meshes.push((surface.node, mesh)),
        }
    }
    Ok((shape_names, meshes.into_iter().map(|(_, mesh)| mesh).collect()))
}

/// Adds the vertices and triangles of `other`, another material of the same mesh.
fn append(mesh: &mut Mesh, other: Mesh) {
    let colours = |m: &Mesh| match m.vertex_colours.is_empty() {
        true => vec![m.base_colour; m.positions.len()],
        false => m.vertex_colours.clone(),
    };
    if other.base_colour != mesh.base_colour || !mesh.vertex_colours.is_empty() {
        mesh.vertex_colours = [colours(mesh), colours(&other)].concat();
    }
    let first = mesh.positions.len() as u32;
    if !(mesh.uvs.is_empty() && other.uvs.is_empty()) {
        mesh.uvs.resize(mesh.positions.len(), [0.0; 2]);
        mesh.uvs.extend(&other.uvs);
        mesh.uvs.resize(mesh.positions.len() + other.positions.len(), [0.0; 2]);
        let moved = |range: &Range<usize>| {
            let by = mesh.triangles.len();
            range.start + by..range.end + by
        };
        let runs = other.textured.iter();
        mesh.textured.extend(runs.map(|t| Textured { triangles: moved(&t.triangles), ..*t }));
    }
    mesh.positions.extend(other.positions);
    mesh.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + first)));
    for (shape, more) in mesh.shapes.iter_mut().zip(other.shapes) {
        shape.vertices.extend(more.vertices.iter().map(|v| v + first));
        shape.deltas.extend(more.deltas);
    }
}
