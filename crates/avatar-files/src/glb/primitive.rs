//! One glTF mesh in: a surface a primitive out, in world coordinates, with sparse named shapes.

use std::collections::HashMap;

use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;
use gltf_json::{Accessor, Index};
use serde::Deserialize;

use super::container::Container;
use super::material::Paint;
use super::skeleton::{Placement, VertexTransforms};
use super::transform::Transform;
use crate::ReadError;
use mimique_avatar::SparseShape;

/// A primitive, placed.
pub(super) struct Surface {
    /// Index of its node.
    pub node: usize,
    pub node_name: String,
    pub mesh_name: String,
    pub material_name: String,
    pub positions: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub base_colour: [f32; 3],
    /// A colour per vertex, linear, the base colour in it; none where the file has none.
    pub colours: Vec<[f32; 3]>,
    /// Whether it is placed inside out, so that its triangles are turned.
    pub mirrored: bool,
    /// As many as `shapes`.
    pub shape_names: Vec<String>,
    pub shapes: Vec<SparseShape>,
    /// Its base-colour texture, where it has one.
    pub paint: Option<Paint>,
}

/// Numbers that a file may still bring: many nodes or primitives can name one large accessor.
pub(super) struct Budget {
    left: usize,
}

impl Default for Budget {
    fn default() -> Self {
        Self { left: 1 << 27 }
    }
}

impl Budget {
    fn take(&mut self, numbers: usize, place: &str) -> Result<(), ReadError> {
        match self.left.checked_sub(numbers) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(ReadError::broken(
                place,
                format!("{numbers} more numbers, {} fit", self.left),
                "export a head that a browser can draw",
            )),
        }
    }
}

/// Colour of a surface without material, as the glTF specification has it: white would glare.
const NO_MATERIAL: [f32; 3] = [0.8, 0.8, 0.8];

/// The surfaces of mesh `index`, which hangs on node `node`. Primitives that share their vertices
/// become one surface.
pub(super) fn surfaces(
    container: &Container,
    node: usize,
    index: usize,
    placement: &Placement,
    budget: &mut Budget,
) -> Result<Vec<Surface>, ReadError> {
    let root = &container.root;
    let place = format!("meshes[{index}]");
    let mesh = root.meshes.get(index).ok_or_else(|| {
        ReadError::damaged(format!("nodes[{node}]"), format!("mesh {index} does not exist"))
    })?;
    let node_name = root.nodes[node].name.clone().unwrap_or_default();
    let mesh_name = mesh.name.clone().unwrap_or_else(|| match node_name.as_str() {
        "" => format!("mesh{index}"),
        name => name.to_owned(),
    });
    let targets = mesh.primitives.iter().map(|p| p.targets.as_ref().map_or(0, Vec::len));
    let shape_names = target_names(mesh, targets.max().unwrap_or(0), &place)?;

    let drawn = PlacedMesh { container, placement, node, node_name, mesh_name, shape_names };
    let mut out: Vec<Surface> = Vec::new();
    let mut by_vertices: HashMap<(usize, Option<usize>), usize> = HashMap::new();
    for (k, primitive) in mesh.primitives.iter().enumerate() {
        let place = format!("{place}.primitives[{k}]");
        let extensions = primitive.extensions.as_ref();
        if extensions.is_some_and(|e| e.others.contains_key("KHR_draco_mesh_compression")) {
            return Err(ReadError::broken(
                place,
                "compressed with KHR_draco_mesh_compression, which is not read",
                "export without Draco compression",
            ));
        }
        let attributes = &primitive.attributes;
        let Some(vertices) = attributes.get(&Checked::Valid(Semantic::Positions)) else {
            return Err(ReadError::damaged(place, "no POSITION"));
        };
        let key = (vertices.value(), primitive.material.map(|m| m.value()));
        if let Some(&earlier) = by_vertices.get(&key) {
            let count = out[earlier].positions.len();
            let more = triangles(container, primitive, count, out[earlier].mirrored, &place)?;
            budget.take(3 * more.len(), &place)?;
            out[earlier].triangles.extend(more);
            continue;
        }
        by_vertices.insert(key, out.len());
        out.push(drawn.surface(primitive, *vertices, budget, &place)?);
    }
    Ok(out)
}

/// A mesh on its node.
struct PlacedMesh<'a> {
    container: &'a Container,
    placement: &'a Placement,
    node: usize,
    node_name: String,
    mesh_name: String,
    shape_names: Vec<String>,
}

impl PlacedMesh<'_> {
    /// The surface of a primitive, whose vertices lie in the accessor `vertices`.
    fn surface(
        &self,
        primitive: &Primitive,
        vertices: Index<Accessor>,
        budget: &mut Budget,
        place: &str,
    ) -> Result<Surface, ReadError> {
        let container = self.container;
        let local = container.floats::<3>(vertices, &format!("{place}.attributes.POSITION"))?;
        let targets = primitive.targets.as_ref().map_or(0, Vec::len);
        budget.take(3 * local.len() * (1 + targets), place)?;
        let at = self.placement.of_vertices(container, primitive, local.len(), place)?;
        let mirrored = at.mirrors();
        let shapes = shapes(container, primitive, local.len(), &at, place)?;
        let triangles = triangles(container, primitive, local.len(), mirrored, place)?;
        budget.take(3 * triangles.len(), place)?;
        let material = primitive.material.and_then(|m| container.root.materials.get(m.value()));
        let paint = Paint::of(container, primitive, material, local.len(), place)?;
        let base_colour = material.map_or(NO_MATERIAL, |m| {
            let [r, g, b, _] = m.pbr_metallic_roughness.base_color_factor.0;
            [r, g, b].map(|c| if c.is_finite() { c.clamp(0.0, 1.0) } else { 1.0 })
        });
        // Colours stand for themselves where there is no material.
        let factor = if material.is_some() { base_colour } else { [1.0; 3] };
        let colours = colours(container, primitive, local.len(), factor, budget, place)?;
        Ok(Surface {
            node: self.node,
            node_name: self.node_name.clone(),
            mesh_name: self.mesh_name.clone(),
            material_name: material.and_then(|m| m.name.clone()).unwrap_or_default(),
            positions: moved(local, &at, Transform::point, place)?,
            mirrored,
            paint,
            triangles,
            base_colour,
            colours,
            shape_names: self.shape_names[..shapes.len()].to_vec(),
            shapes,
        })
    }
}

/// `COLOR_0` times the material's colour, each from 0 to 1; its alpha is not read.
fn colours(
    container: &Container,
    primitive: &Primitive,
    count: usize,
    factor: [f32; 3],
    budget: &mut Budget,
    place: &str,
) -> Result<Vec<[f32; 3]>, ReadError> {
    let Some(accessor) = primitive.attributes.get(&Checked::Valid(Semantic::Colors(0))) else {
        return Ok(Vec::new());
    };
    let place = format!("{place}.attributes.COLOR_0");
    budget.take(3 * count, &place)?;
    let colours: Vec<[f32; 3]> = match container.components(*accessor) {
        Some(4) => {
            let four = container.floats::<4>(*accessor, &place)?;
            four.into_iter().map(|[r, g, b, _]| [r, g, b]).collect()
        }
        _ => container.floats::<3>(*accessor, &place)?,
    };
    if colours.len() != count {
        let what = format!("{} colours of {count} vertices", colours.len());
        return Err(ReadError::damaged(place, what));
    }
    let of = |colour: [f32; 3]| [0, 1, 2].map(|c| colour[c].clamp(0.0, 1.0) * factor[c]);
    Ok(colours.into_iter().map(of).collect())
}

/// The names of a mesh's morph targets: `extras.targetNames`, or `shape_0`, `shape_1`...
pub(super) fn target_names(
    mesh: &gltf_json::Mesh,
    count: usize,
    place: &str,
) -> Result<Vec<String>, ReadError> {
    #[derive(Deserialize)]
    struct Extras {
        #[serde(rename = "targetNames")]
        target_names: Option<Vec<String>>,
    }
    let extras = mesh.extras.iter().chain(mesh.primitives.iter().flat_map(|p| p.extras.iter()));
    let names = extras
        .filter_map(|raw| serde_json::from_str::<Extras>(raw.get()).ok())
        .find_map(|extras| extras.target_names);
    let Some(names) = names else {
        return Ok((0..count).map(|k| format!("shape_{k}")).collect());
    };
    let place = format!("{place}.extras.targetNames");
    if names.len() < count {
        return Err(ReadError::damaged(
            place,
            format!("{} names for {count} morph targets", names.len()),
        ));
    }
    if let Some(k) = (0..count).find(|&k| names[..k].contains(&names[k])) {
        return Err(ReadError::broken(
            place,
            format!("{:?} names two morph targets", names[k]),
            "give every shape a name of its own",
        ));
    }
    Ok(names)
}

fn shapes(
    container: &Container,
    primitive: &Primitive,
    vertices: usize,
    at: &VertexTransforms,
    place: &str,
) -> Result<Vec<SparseShape>, ReadError> {
    let mut out = Vec::new();
    for (k, target) in primitive.targets.iter().flatten().enumerate() {
        let place = format!("{place}.targets[{k}]");
        let Some(positions) = target.positions else {
            out.push(SparseShape::default());
            continue;
        };
        let deltas = container.floats::<3>(positions, &place)?;
        if deltas.len() != vertices {
            return Err(ReadError::damaged(
                place,
                format!("{} displacements for {vertices} vertices", deltas.len()),
            ));
        }
        let deltas = moved(deltas, at, Transform::direction, &place)?;
        out.push(SparseShape::from_dense(&deltas));
    }
    Ok(out)
}

fn moved(
    mut values: Vec<[f32; 3]>,
    at: &VertexTransforms,
    apply: fn(&Transform, [f64; 3]) -> [f64; 3],
    place: &str,
) -> Result<Vec<[f32; 3]>, ReadError> {
    if at.is_identity() {
        return Ok(values);
    }
    for (v, value) in values.iter_mut().enumerate() {
        *value = apply(at.of(v), value.map(f64::from)).map(|x| x as f32);
        if value.iter().any(|x| !x.is_finite()) {
            return Err(ReadError::damaged(place, "leaves the number range when placed"));
        }
    }
    Ok(values)
}

fn triangles(
    container: &Container,
    primitive: &Primitive,
    vertices: usize,
    mirrored: bool,
    place: &str,
) -> Result<Vec<[u32; 3]>, ReadError> {
    let corners = match primitive.indices {
        Some(index) => container.indices(index, &format!("{place}.indices"))?,
        None => (0..vertices as u32).collect(),
    };
    if let Some(at) = corners.iter().position(|&v| v as usize >= vertices) {
        return Err(ReadError::damaged(
            format!("{place}.indices, element {at}"),
            format!("vertex {} of {vertices}", corners[at]),
        ));
    }
    let mut out: Vec<[u32; 3]> = match primitive.mode {
        Checked::Valid(Mode::Triangles) => {
            if corners.len() % 3 != 0 {
                return Err(ReadError::damaged(
                    format!("{place}.indices"),
                    format!("{} corners are not whole triangles", corners.len()),
                ));
            }
            corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect()
        }
        Checked::Valid(Mode::TriangleStrip) => corners
            .windows(3)
            .enumerate()
            .map(|(i, t)| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] })
            .collect(),
        Checked::Valid(Mode::TriangleFan) => match corners.split_first() {
            Some((&hub, rim)) => rim.windows(2).map(|t| [hub, t[0], t[1]]).collect(),
            None => vec![],
        },
        _ => {
            return Err(ReadError::broken(
                place,
                "not made of triangles",
                "export surfaces only, without points and lines",
            ));
        }
    };
    out.retain(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
    if mirrored {
        out.iter_mut().for_each(|t| t.swap(1, 2));
    }
    Ok(out)
}
