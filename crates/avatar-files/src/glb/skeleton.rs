//! Where vertices stand: with their node, or with the joints of a skeleton (linear blend skinning
//! at the pose that the file has its nodes in, which is the bind pose as exporters write it).

use gltf_json::mesh::{Primitive, Semantic};
use gltf_json::validation::Checked;

use super::container::Container;
use super::transform::Transform;
use crate::ReadError;

/// How a mesh is placed in the world.
pub(super) enum Placement {
    /// With its node.
    Rigid(Transform),
    /// World-from-mesh of each joint.
    Skeleton(Vec<Transform>),
}

/// World-from-mesh of the vertices of one primitive.
pub(super) enum VertexTransforms {
    All(Transform),
    Each(Vec<Transform>),
}

/// World-from-mesh of each joint of a skin: its node's place times its inverse bind matrix. The
/// node that carries the mesh has no say (glTF 2.0, 3.7.3.3).
pub(super) fn joints(
    container: &Container,
    skin: usize,
    placed: &[(usize, Transform)],
) -> Result<Vec<Transform>, ReadError> {
    let place = format!("skins[{skin}]");
    let skin = container.root.skins.get(skin);
    let skin = skin.ok_or_else(|| ReadError::damaged(&place, "the skin does not exist"))?;
    let bind: Vec<[f32; 16]> = match skin.inverse_bind_matrices {
        Some(index) => container.floats(index, &format!("{place}.inverseBindMatrices"))?,
        None => Vec::new(),
    };
    if skin.joints.is_empty() || (!bind.is_empty() && bind.len() < skin.joints.len()) {
        let what = format!("{} joints, {} inverse bind matrices", skin.joints.len(), bind.len());
        return Err(ReadError::damaged(place, what));
    }
    let mut world = vec![None; container.root.nodes.len()];
    placed.iter().for_each(|(node, transform)| world[*node] = Some(*transform));
    skin.joints
        .iter()
        .enumerate()
        .map(|(i, joint)| {
            let node = world.get(joint.value()).copied().flatten();
            let node = node.ok_or_else(|| {
                let what =
                    format!("joint {i} is node {}, which is not in the scene", joint.value());
                ReadError::damaged(&place, what)
            })?;
            Ok(bind.get(i).map_or(node, |m| node.then(&Transform::of_matrix(m))))
        })
        .collect()
}

impl Placement {
    /// Where the `count` vertices of a primitive stand.
    pub fn of_vertices(
        &self,
        container: &Container,
        primitive: &Primitive,
        count: usize,
        place: &str,
    ) -> Result<VertexTransforms, ReadError> {
        let joints = match self {
            Self::Rigid(transform) => return Ok(VertexTransforms::All(*transform)),
            Self::Skeleton(joints) => joints,
        };
        let mut shares: Vec<Vec<(f64, usize)>> = vec![Vec::new(); count];
        for set in 0.. {
            let get = |s| primitive.attributes.get(&Checked::Valid(s));
            let (Some(of), Some(weights)) =
                (get(Semantic::Joints(set)), get(Semantic::Weights(set)))
            else {
                break;
            };
            let of = container.floats::<4>(*of, &format!("{place}.attributes.JOINTS_{set}"))?;
            let at = format!("{place}.attributes.WEIGHTS_{set}");
            let weights = container.floats::<4>(*weights, &at)?;
            if of.len() != count || weights.len() != count {
                let what =
                    format!("{} joints, {} weights, {count} vertices", of.len(), weights.len());
                return Err(ReadError::damaged(at, what));
            }
            for (v, share) in shares.iter_mut().enumerate() {
                for k in 0..4 {
                    let (joint, weight) = (of[v][k] as usize, f64::from(weights[v][k]));
                    if weight > 0.0 && joint >= joints.len() {
                        let what = format!("vertex {v}: joint {joint} of {}", joints.len());
                        return Err(ReadError::damaged(at, what));
                    }
                    if weight > 0.0 {
                        share.push((weight, joint));
                    }
                }
            }
        }
        let transform = |share: &Vec<(f64, usize)>| {
            let sum: f64 = share.iter().map(|(weight, _)| weight).sum();
            if share.is_empty() {
                return joints[0];
            }
            Transform::blend(share.iter().map(|(weight, j)| (weight / sum, &joints[*j])))
        };
        let each: Vec<Transform> = shares.iter().map(transform).collect();
        Ok(match each.split_first() {
            Some((first, rest)) if rest.iter().all(|t| t == first) => VertexTransforms::All(*first),
            _ => VertexTransforms::Each(each),
        })
    }
}

impl VertexTransforms {
    /// Whether nothing is moved.
    pub fn is_identity(&self) -> bool {
        matches!(self, Self::All(t) if *t == Transform::IDENTITY)
    }

    /// World-from-mesh of a vertex.
    pub fn of(&self, vertex: usize) -> &Transform {
        match self {
            Self::All(transform) => transform,
            Self::Each(each) => &each[vertex],
        }
    }

    /// Whether it turns the surface inside out.
    pub fn mirrors(&self) -> bool {
        match self {
            Self::All(transform) => transform.mirrors(),
            Self::Each(each) => 2 * each.iter().filter(|t| t.mirrors()).count() > each.len(),
        }
    }
}
