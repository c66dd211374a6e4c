//! An avatar with an animation of its weights as a binary glTF 2.0 file, for other programs.
//!
//! | glTF | from |
//! |---|---|
//! | a node and a mesh each | the avatar's meshes; an eyeball's node stands in its centre |
//! | morph targets (sparse accessors), `extras.targetNames` | the shapes |
//! | `weights` channels, linear | the frames |
//! | `rotation` channels | eyeballs, which turn and are not morphed |
//! | base colour, vertex colours, JPEG pictures | the same |

use std::ops::Range;

use serde_json::{Value, json};

use mimique_avatar::{Avatar, Mesh, SparseShape};

/// Why an animation cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GlbWriteError {
    /// Not a whole number of frames.
    #[error("weights: {weights} for {shapes} shapes; give frames x shapes")]
    Weights {
        /// Weights given.
        weights: usize,
        /// Shapes of the avatar.
        shapes: usize,
    },
    /// No time between frames.
    #[error("rate: {0} Hz; give frames per second")]
    Rate(f64),
    /// Larger than a binary glTF file may be.
    #[error("the file would have {0} bytes, a GLB has 4 GiB at most; write fewer frames")]
    TooLarge(usize),
}

const FLOAT: u32 = 5126;
const UINT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Writes `avatar` and, where there are weights, their animation: `weights` frames x shapes,
/// `rate_hz` frames per second. Metres, as glTF has them.
///
/// # Errors
/// [`GlbWriteError`]: weights that are no whole frames, no rate, too large a file.
pub fn write_glb(avatar: &Avatar, weights: &[f32], rate_hz: f64) -> Result<Vec<u8>, GlbWriteError> {
    let shapes = avatar.shape_names.len();
    if !weights.len().is_multiple_of(shapes) {
        return Err(GlbWriteError::Weights { weights: weights.len(), shapes });
    }
    if !(rate_hz.is_finite() && rate_hz > 0.0) {
        return Err(GlbWriteError::Rate(rate_hz));
    }
    let mut file = Writer::default();
    for texture in &avatar.textures {
        let view = file.view(&texture.jpeg, None);
        file.images.push(json!({"bufferView": view, "mimeType": "image/jpeg"}));
    }
    let (mut meshes, mut nodes) = (Vec::new(), Vec::new());
    for (index, mesh) in avatar.meshes.iter().enumerate() {
        let eyeball = avatar.eyeballs.iter().find(|e| e.mesh == index);
        let centre = eyeball.map_or([0.0; 3], |e| e.centre);
        meshes.push(file.mesh(mesh, &avatar.shape_names, centre));
        let mut node = json!({"name": mesh.name, "mesh": index});
        if eyeball.is_some() {
            node["translation"] = json!(centre);
        }
        nodes.push(node);
    }
    let animation = animation(&mut file, avatar, weights, rate_hz);
    let roots: Vec<usize> = (0..nodes.len()).collect();
    let mut document = json!({
        "asset": {"version": "2.0", "generator": concat!("Mimique ", env!("CARGO_PKG_VERSION"))},
        "scene": 0,
        "scenes": [{"name": avatar.name, "nodes": roots}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": file.materials,
        "accessors": file.accessors,
        "bufferViews": file.views,
        "buffers": [{"byteLength": file.bytes.len()}],
    });
    if let Some(animation) = animation {
        document["animations"] = json!([animation]);
    }
    if !file.images.is_empty() {
        document["textures"] =
            (0..file.images.len()).map(|i| json!({"source": i, "sampler": 0})).collect();
        document["samplers"] = json!([{}]);
        document["images"] = json!(file.images);
    }
    envelope(&document, file.bytes)
}

/// The file: a header and two chunks, each padded to four bytes.
fn envelope(document: &Value, mut binary: Vec<u8>) -> Result<Vec<u8>, GlbWriteError> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let total = u32::try_from(length).map_err(|_| GlbWriteError::TooLarge(length))?;
    let mut out = Vec::with_capacity(length);
    out.extend(b"glTF");
    out.extend(2_u32.to_le_bytes());
    out.extend(total.to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
        // Shorter than the whole, which fits.
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    Ok(out)
}

fn animation(file: &mut Writer, avatar: &Avatar, weights: &[f32], rate_hz: f64) -> Option<Value> {
    let shapes = avatar.shape_names.len();
    let frames = weights.len().checked_div(shapes).unwrap_or(0);
    if frames == 0 {
        return None;
    }
    let times: Vec<f32> = (0..frames).map(|f| (f as f64 / rate_hz) as f32).collect();
    let end = times[frames - 1];
    let input = file.floats(&times, "SCALAR", 1, Some(([0.0].into(), [end].into())), None);
    let output = file.floats(weights, "SCALAR", 1, None, None);
    let mut samplers = vec![json!({"input": input, "output": output})];
    let mut channels = Vec::new();
    for (node, mesh) in avatar.meshes.iter().enumerate() {
        if moves(mesh) {
            channels.push(json!({"sampler": 0, "target": {"node": node, "path": "weights"}}));
        }
    }
    for eyeball in avatar.eyeballs.iter().filter(|e| !e.looks.is_empty()) {
        let turns: Vec<f32> = weights
            .chunks_exact(shapes)
            .flat_map(|row| {
                let mut turn = [0.0_f32; 3];
                for look in &eyeball.looks {
                    (0..3).for_each(|a| turn[a] += row[look.shape] * look.radians * look.axis[a]);
                }
                quaternion(turn)
            })
            .collect();
        let output = file.floats(&turns, "VEC4", 4, None, None);
        channels.push(json!({
            "sampler": samplers.len(), "target": {"node": eyeball.mesh, "path": "rotation"},
        }));
        samplers.push(json!({"input": input, "output": output}));
    }
    (!channels.is_empty())
        .then(|| json!({"name": "take", "samplers": samplers, "channels": channels}))
}

fn moves(mesh: &Mesh) -> bool {
    mesh.shapes.iter().any(|s| !s.vertices.is_empty())
}

/// x, y, z, w of a turn by the length of `turn` about it.
fn quaternion(turn: [f32; 3]) -> [f32; 4] {
    let angle = turn.iter().map(|x| x * x).sum::<f32>().sqrt();
    let (sin, cos) = (0.5 * angle).sin_cos();
    let part = if angle > 1e-9 { sin / angle } else { 0.5 };
    [turn[0] * part, turn[1] * part, turn[2] * part, cos]
}

/// The binary chunk and what names its parts.
#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    images: Vec<Value>,
}

impl Writer {
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view =
            json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    fn floats(
        &mut self,
        values: &[f32],
        kind: &str,
        width: usize,
        bounds: Option<(Vec<f32>, Vec<f32>)>,
        target: Option<u32>,
    ) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes, target);
        let mut accessor = json!({
            "bufferView": view, "componentType": FLOAT, "type": kind, "count": values.len() / width,
        });
        if let Some((low, high)) = bounds {
            accessor["min"] = json!(low);
            accessor["max"] = json!(high);
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn mesh(&mut self, mesh: &Mesh, shape_names: &[String], centre: [f32; 3]) -> Value {
        let places: Vec<f32> = (mesh.positions.iter())
            .flat_map(|p| [p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]])
            .collect();
        let bounds = bounds(&places);
        let position = self.floats(&places, "VEC3", 3, Some(bounds), Some(ARRAY_BUFFER));
        let mut attributes = json!({"POSITION": position});
        if mesh.vertex_colours.len() == mesh.positions.len() && !mesh.positions.is_empty() {
            let colours = mesh.vertex_colours.as_flattened();
            attributes["COLOR_0"] =
                json!(self.floats(colours, "VEC3", 3, None, Some(ARRAY_BUFFER)));
        }
        if mesh.uvs.len() == mesh.positions.len() && !mesh.textured.is_empty() {
            let uvs = mesh.uvs.as_flattened();
            attributes["TEXCOORD_0"] = json!(self.floats(uvs, "VEC2", 2, None, Some(ARRAY_BUFFER)));
        }
        let targets: Vec<Value> = if moves(mesh) {
            let count = mesh.positions.len();
            let sparse = mesh.shapes.iter().map(|s| json!({"POSITION": self.target(s, count)}));
            sparse.collect()
        } else {
            Vec::new()
        };
        let primitives: Vec<Value> = (runs(mesh).into_iter())
            .map(|(triangles, texture)| {
                let indices: Vec<u8> = (mesh.triangles[triangles].iter().flatten())
                    .flat_map(|v| v.to_le_bytes())
                    .collect();
                let count = indices.len() / 4;
                let view = self.view(&indices, Some(ELEMENT_ARRAY_BUFFER));
                self.accessors.push(json!({
                    "bufferView": view, "componentType": UINT, "type": "SCALAR", "count": count,
                }));
                let mut primitive = json!({
                    "attributes": attributes,
                    "indices": self.accessors.len() - 1,
                    "material": self.material(mesh, texture),
                });
                if !targets.is_empty() {
                    primitive["targets"] = json!(targets);
                }
                primitive
            })
            .collect();
        let mut out = json!({"name": mesh.name, "primitives": primitives});
        if !targets.is_empty() {
            out["weights"] = json!(vec![0.0; shape_names.len()]);
            out["extras"] = json!({"targetNames": shape_names});
        }
        out
    }

    /// A shape as a sparse accessor over zeros.
    fn target(&mut self, shape: &SparseShape, count: usize) -> usize {
        let dense = || shape.deltas.as_flattened();
        let (mut low, mut high) = bounds(dense());
        if shape.vertices.len() < count {
            low.iter_mut().for_each(|x| *x = x.min(0.0));
            high.iter_mut().for_each(|x| *x = x.max(0.0));
        }
        let mut accessor = json!({
            "componentType": FLOAT, "type": "VEC3", "count": count, "min": low, "max": high,
        });
        // A shape that moves nothing here says so of one vertex: some readers take no accessor
        // without values.
        let (vertices, deltas): (&[u32], &[f32]) =
            if shape.vertices.is_empty() { (&[0], &[0.0; 3]) } else { (&shape.vertices, dense()) };
        let indices: Vec<u8> = vertices.iter().flat_map(|v| v.to_le_bytes()).collect();
        let values: Vec<u8> = deltas.iter().flat_map(|x| x.to_le_bytes()).collect();
        let (indices, values) = (self.view(&indices, None), self.view(&values, None));
        accessor["sparse"] = json!({
            "count": vertices.len(),
            "indices": {"bufferView": indices, "componentType": UINT},
            "values": {"bufferView": values},
        });
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn material(&mut self, mesh: &Mesh, texture: Option<usize>) -> usize {
        // Vertex colours are multiplied with the base colour.
        let colour = if mesh.vertex_colours.is_empty() { mesh.base_colour } else { [1.0; 3] };
        let mut surface = json!({
            "baseColorFactor": [colour[0], colour[1], colour[2], 1.0],
            "metallicFactor": 0.0, "roughnessFactor": 0.6,
        });
        if let Some(texture) = texture {
            surface["baseColorTexture"] = json!({"index": texture});
        }
        let material = json!({"name": mesh.name, "pbrMetallicRoughness": surface});
        match self.materials.iter().position(|m| *m == material) {
            Some(known) => known,
            None => {
                self.materials.push(material);
                self.materials.len() - 1
            }
        }
    }
}

/// The triangles in runs of one picture or none.
fn runs(mesh: &Mesh) -> Vec<(Range<usize>, Option<usize>)> {
    let mut out = Vec::new();
    let mut at = 0;
    for textured in &mesh.textured {
        out.push((at..textured.triangles.start, None));
        out.push((textured.triangles.clone(), Some(textured.texture)));
        at = textured.triangles.end;
    }
    out.push((at..mesh.triangles.len(), None));
    out.retain(|(run, _)| !run.is_empty());
    out
}

/// Lowest and highest x, y, z; zeros of nothing.
fn bounds(values: &[f32]) -> (Vec<f32>, Vec<f32>) {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for p in values.chunks_exact(3) {
        for a in 0..3 {
            low[a] = low[a].min(p[a]);
            high[a] = high[a].max(p[a]);
        }
    }
    if values.is_empty() { (vec![0.0; 3], vec![0.0; 3]) } else { (low.to_vec(), high.to_vec()) }
}
