//! glTF 2.0 in (`.glb`, `.gltf`), an [`Avatar`] out.
//!
//! Read: every mesh of the scene with its morph targets (sparse accessors, normalised integers),
//! node transforms, base colours, `extras.targetNames`. Not read: textures, animations, joints (a
//! skinned mesh is taken as it stands in the file), compressed geometry (refused by name).

mod accessor;
mod container;
mod primitive;
mod transform;

use std::collections::HashMap;
use std::path::Path;

use gltf::json::Node;

use self::container::Container;
use self::primitive::Surface;
use self::transform::Transform;
use crate::parts::{PartName, assign_parts};
use crate::{Avatar, Mesh, ReadAvatar, ReadError, SparseShape};

/// Reads a GLB file, or a glTF file whose buffers are inside it.
///
/// `name` becomes [`Avatar::name`]; `folder` is where a `.gltf` file's buffers are looked for.
///
/// # Errors
/// [`ReadError`] with the place in the file: truncated, an index out of range, a number that is
/// not finite, a required extension, no mesh, morph targets that contradict one another.
pub fn read_gltf(bytes: &[u8], name: &str, folder: Option<&Path>) -> Result<ReadAvatar, ReadError> {
    let container = container::open(bytes, folder)?;
    let mut notes = Vec::new();
    let mut surfaces = Vec::new();
    for (node, world_from_node) in placed_nodes(&container)? {
        let Some(mesh) = container.root.nodes[node].mesh else { continue };
        surfaces.extend(primitive::surfaces(&container, node, mesh.value(), &world_from_node)?);
        if container.root.nodes[node].skin.is_some() {
            notes.push(format!("nodes[{node}] has a skeleton: taken as it stands in the file"));
        }
    }
    if surfaces.is_empty() {
        return Err(ReadError::broken(
            "scene",
            "no mesh in it",
            "export the head's meshes into the scene",
        ));
    }
    if !container.root.images.is_empty() {
        notes.push(format!(
            "{} textures are not read: materials keep their base colour",
            container.root.images.len()
        ));
    }
    let (shape_names, meshes) = joined(surfaces)?;
    let name = name.to_owned();
    ReadAvatar::finish(Avatar { name, shape_names, meshes, eyeballs: vec![] }, notes)
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
fn joined(surfaces: Vec<Surface>) -> Result<(Vec<String>, Vec<Mesh>), ReadError> {
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
            moved: s.shapes.iter().map(|shape| shape.vertices.len()).sum(),
        })
        .collect();
    let parts = assign_parts(&named);
    let mut meshes: Vec<(usize, Mesh)> = Vec::new();
    for (surface, part) in surfaces.into_iter().zip(parts) {
        let mut shapes = vec![SparseShape::default(); shape_names.len()];
        for (name, shape) in surface.shape_names.iter().zip(surface.shapes) {
            shapes[index_of[name]] = shape;
        }
        let mesh = Mesh {
            name: surface.mesh_name,
            part,
            positions: surface.positions,
            triangles: surface.triangles,
            vertex_colours: vec![],
            base_colour: surface.base_colour,
            shapes,
        };
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
    mesh.positions.extend(other.positions);
    mesh.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + first)));
    for (shape, more) in mesh.shapes.iter_mut().zip(other.shapes) {
        shape.vertices.extend(more.vertices.iter().map(|v| v + first));
        shape.deltas.extend(more.deltas);
    }
}
