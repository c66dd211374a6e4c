//! From an avatar to the flat tables that the shaders read. No GPU here.
//!
//! | table | one entry a | holds |
//! |---|---|---|
//! | `neutral` | vertex | position; how far along a lash, or in from the hair's border |
//! | `vertices` | vertex | where its deltas and its ring start, how many, its eyeball |
//! | `entries` | (vertex, blendshape) that is not zero | displacement, blendshape |
//! | `rings` | (vertex, triangle round it) | the triangle's other two corners, in order |
//!
//! Vertices of a mesh that lie in one place and move alike (texture seams) share one ring, so that
//! normals are smooth across seams; lips that merely touch do not move alike and stay apart.

use std::collections::HashMap;

use glam::Vec3;
use mimique_avatar::{Avatar, MOST_EYEBALLS, MOST_SHAPES, Mesh, Part};

use crate::StageError;
use crate::along_hair::along_hair;
use crate::framing::{Landmarks, bounds_centre};
use crate::layouts::Material;

/// Everything the GPU needs of an avatar.
#[derive(Debug, Default)]
pub(crate) struct Geometry {
    pub neutral: Vec<[f32; 4]>,
    pub vertices: Vec<[u32; 4]>,
    pub entries: Vec<[f32; 4]>,
    pub rings: Vec<[u32; 2]>,
    /// Square root of the base colour, 8 bits a channel; the material in the fourth.
    pub colours: Vec<[u8; 4]>,
    /// Place of each vertex in its picture.
    pub uvs: Vec<[f32; 2]>,
    pub indices: Vec<u32>,
    /// Ranges of `indices`, one per mesh, in the order to draw.
    pub draws: Vec<Draw>,
    pub eyes: Vec<Eye>,
    pub shape_count: usize,
}

/// One mesh to draw.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Draw {
    pub indices: std::ops::Range<u32>,
    pub layer: Layer,
    /// Index of the avatar's texture that colours it.
    pub texture: Option<usize>,
    /// Hair-thin and transparent meshes cast none.
    pub casts_shadow: bool,
}

/// How a mesh meets what is behind it; also the order of drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Layer {
    /// Closed surfaces: their back is never seen.
    Closed,
    /// Open sheets: both sides are seen.
    Sheet,
    /// Lashes: hairs thinner than a pixel.
    Blended,
}

/// An eyeball, measured.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Eye {
    pub centre: Vec3,
    pub radius: f32,
    /// Direction of the pupil in the neutral pose.
    pub forward: Vec3,
    pub looks: Vec<mimique_avatar::Look>,
    /// Colours of iris and white, where the mesh is coloured.
    pub iris: Option<[f32; 3]>,
    pub white: Option<[f32; 3]>,
}

impl Geometry {
    /// Checks the avatar and lays it out.
    pub fn new(avatar: &Avatar, landmarks: &Landmarks) -> Result<Self, StageError> {
        let shape_count = avatar.shape_names.len();
        if shape_count > MOST_SHAPES {
            return Err(StageError::TooManyShapes { found: shape_count, most: MOST_SHAPES });
        }
        let mut out = Self { shape_count, ..Self::default() };
        let eye_of_mesh = out.measure_eyes(avatar)?;
        // Closed surfaces first and the skin first of all: it hides most of what follows. Shading shells
        // over the eye belong to other renderers; this one shades the eye itself.
        let turn = |part: Part| 2 * layer(part) as usize + usize::from(part != Part::Skin);
        for now in 0..=turn(Part::Lashes) {
            for (mesh, &eye) in avatar.meshes.iter().zip(&eye_of_mesh) {
                if mesh.part != Part::EyeOverlay && turn(mesh.part) == now {
                    out.add_mesh(avatar, mesh, eye, landmarks)?;
                }
            }
        }
        if out.indices.is_empty() {
            return Err(StageError::NothingToDraw);
        }
        Ok(out)
    }

    /// Measures each eyeball; a mesh of an eye that has no [`mimique_avatar::Eyeball`] gets one that
    /// stays still. Answers the eye of each mesh.
    fn measure_eyes(&mut self, avatar: &Avatar) -> Result<Vec<Option<usize>>, StageError> {
        let mut eye_of_mesh = vec![None; avatar.meshes.len()];
        for (m, mesh) in avatar.meshes.iter().enumerate() {
            let declared = avatar.eyeballs.iter().find(|e| e.mesh == m);
            let is_eye = matches!(mesh.part, Part::EyeLeft | Part::EyeRight) || declared.is_some();
            if !is_eye || mesh.positions.is_empty() {
                continue;
            }
            let centre = declared.map_or_else(|| bounds_centre(mesh), |e| Vec3::from(e.centre));
            let looks = declared.map_or_else(Vec::new, |e| e.looks.clone());
            if let Some(look) = looks.iter().find(|l| l.shape >= self.shape_count) {
                let what = format!(
                    "eyeball look of blendshape {}, the avatar has {}",
                    look.shape, self.shape_count
                );
                return Err(StageError::Malformed { mesh: mesh.name.clone(), what });
            }
            eye_of_mesh[m] = Some(self.eyes.len());
            self.eyes.push(measure_eye(mesh, centre, looks));
        }
        match self.eyes.len() {
            n if n > MOST_EYEBALLS => {
                Err(StageError::TooManyEyeballs { found: n, most: MOST_EYEBALLS })
            }
            _ => Ok(eye_of_mesh),
        }
    }

    fn add_mesh(
        &mut self,
        avatar: &Avatar,
        mesh: &Mesh,
        eye: Option<usize>,
        landmarks: &Landmarks,
    ) -> Result<(), StageError> {
        check_mesh(avatar, mesh)?;
        let base = self.neutral.len() as u32;
        let count = mesh.positions.len();
        self.neutral.extend(mesh.positions.iter().map(|p| [p[0], p[1], p[2], 1.0]));

        let (starts, entries) = entries_by_vertex(mesh);
        let first_entry = self.entries.len() as u32;
        self.entries.extend_from_slice(&entries);

        let twins = weld(mesh, &starts, &entries);
        let first_ring = self.rings.len() as u32;
        let ring_starts = self.add_rings(mesh, &twins, base);

        let eye_code = eye.map_or(0, |e| e as u32 + 1);
        for v in 0..count {
            let twin = twins[v] as usize;
            self.vertices.push([
                first_entry + starts[v],
                (starts[v + 1] - starts[v]) | (eye_code << 16),
                first_ring + ring_starts[twin],
                ring_starts[twin + 1] - ring_starts[twin],
            ]);
        }

        let material = material_code(mesh, eye);
        let lengths = along_hair(mesh, landmarks);
        for v in 0..count {
            let own = mesh.vertex_colours.get(v).copied();
            // The iris of an eye is drawn a pixel, not a vertex.
            let own = eye.map_or(own, |e| self.eyes[e].white);
            let colour = own.unwrap_or(mesh.base_colour);
            let root = colour.map(|c| (c.clamp(0.0, 1.0).sqrt() * 255.0).round() as u8);
            self.colours.push([root[0], root[1], root[2], material]);
            if let Some(&length) = lengths.get(v) {
                self.neutral[base as usize + v][3] = length;
            }
        }

        let uv = |v: usize| mesh.uvs.get(v).copied().unwrap_or_default();
        self.uvs.extend((0..count).map(uv));
        let casts_shadow = !matches!(mesh.part, Part::Lashes | Part::EyeLeft | Part::EyeRight);
        for (triangles, texture) in runs(mesh) {
            let first = self.indices.len() as u32;
            self.indices.extend(mesh.triangles[triangles].iter().flatten().map(|&i| base + i));
            let indices = first..self.indices.len() as u32;
            self.draws.push(Draw { indices, layer: layer(mesh.part), texture, casts_shadow });
        }
        Ok(())
    }

    /// Appends the triangles round each vertex (of its twin, for vertices welded together) and
    /// answers where each starts, relative to the first appended.
    fn add_rings(&mut self, mesh: &Mesh, twins: &[u32], base: u32) -> Vec<u32> {
        let mut starts = vec![0_u32; mesh.positions.len() + 1];
        for &corner in mesh.triangles.iter().flatten() {
            starts[twins[corner as usize] as usize + 1] += 1;
        }
        for v in 0..mesh.positions.len() {
            starts[v + 1] += starts[v];
        }
        let first = self.rings.len();
        self.rings.resize(first + starts[mesh.positions.len()] as usize, [0, 0]);
        let mut next = starts.clone();
        for t in &mesh.triangles {
            for k in 0..3 {
                let slot = &mut next[twins[t[k] as usize] as usize];
                self.rings[first + *slot as usize] = [base + t[(k + 1) % 3], base + t[(k + 2) % 3]];
                *slot += 1;
            }
        }
        starts
    }
}

/// The triangles of a mesh in runs of one picture or none.
fn runs(mesh: &Mesh) -> Vec<(std::ops::Range<usize>, Option<usize>)> {
    let mut out = Vec::new();
    let mut next = 0;
    for run in &mesh.textured {
        out.push((next..run.triangles.start, None));
        out.push((run.triangles.clone(), Some(run.texture)));
        next = run.triangles.end;
    }
    out.push((next..mesh.triangles.len(), None));
    out.retain(|(triangles, _)| !triangles.is_empty());
    out
}

fn layer(part: Part) -> Layer {
    match part {
        Part::Skin | Part::EyeLeft | Part::EyeRight => Layer::Closed,
        Part::Lashes => Layer::Blended,
        _ => Layer::Sheet,
    }
}

fn material_code(mesh: &Mesh, eye: Option<usize>) -> u8 {
    if let Some(eye) = eye {
        return Material::Eye as u8 + eye as u8;
    }
    (match mesh.part {
        Part::Skin if mesh.vertex_colours.is_empty() && mesh.textured.is_empty() => {
            Material::PaintedSkin
        }
        Part::Skin => Material::Skin,
        Part::Teeth => Material::Teeth,
        Part::Tongue => Material::Tongue,
        Part::Socket => Material::Socket,
        Part::Lashes => Material::Lashes,
        Part::Hair => Material::Hair,
        Part::EyeLeft | Part::EyeRight | Part::EyeOverlay | Part::Other => Material::Cloth,
    }) as u8
}

fn check_mesh(avatar: &Avatar, mesh: &Mesh) -> Result<(), StageError> {
    let malformed = |what: String| Err(StageError::Malformed { mesh: mesh.name.clone(), what });
    let count = mesh.positions.len();
    if mesh.shapes.len() != avatar.shape_names.len() {
        return malformed(format!(
            "{} blendshapes, the avatar has {}",
            mesh.shapes.len(),
            avatar.shape_names.len()
        ));
    }
    if !mesh.vertex_colours.is_empty() && mesh.vertex_colours.len() != count {
        return malformed(format!("{} colours for {count} vertices", mesh.vertex_colours.len()));
    }
    if let Some(i) = mesh.triangles.iter().flatten().find(|&&i| i as usize >= count) {
        return malformed(format!("a triangle uses vertex {i}, the mesh has {count}"));
    }
    if !mesh.uvs.is_empty() && mesh.uvs.len() != count {
        return malformed(format!("{} places in pictures for {count} vertices", mesh.uvs.len()));
    }
    let mut free = 0;
    for run in &mesh.textured {
        let (start, end) = (run.triangles.start, run.triangles.end);
        if start < free || end < start || end > mesh.triangles.len() {
            let most = mesh.triangles.len();
            return malformed(format!("a picture on triangles {start} to {end} of {most}"));
        }
        if run.texture >= avatar.textures.len() {
            let textures = avatar.textures.len();
            return malformed(format!("texture {}, the avatar has {textures}", run.texture));
        }
        free = end;
    }
    for (k, shape) in mesh.shapes.iter().enumerate() {
        if shape.vertices.len() != shape.deltas.len() {
            return malformed(format!(
                "blendshape {k}: {} vertices, {} deltas",
                shape.vertices.len(),
                shape.deltas.len()
            ));
        }
        if let Some(v) = shape.vertices.iter().find(|&&v| v as usize >= count) {
            return malformed(format!("blendshape {k} moves vertex {v}, the mesh has {count}"));
        }
    }
    Ok(())
}

/// Deltas sorted by vertex, then blendshape: `entries[starts[v]..starts[v + 1]]` belong to `v`.
fn entries_by_vertex(mesh: &Mesh) -> (Vec<u32>, Vec<[f32; 4]>) {
    let count = mesh.positions.len();
    let mut starts = vec![0_u32; count + 1];
    for &v in mesh.shapes.iter().flat_map(|s| &s.vertices) {
        starts[v as usize + 1] += 1;
    }
    for v in 0..count {
        starts[v + 1] += starts[v];
    }
    let mut entries = vec![[0.0; 4]; starts[count] as usize];
    let mut next = starts.clone();
    for (k, shape) in mesh.shapes.iter().enumerate() {
        for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
            let slot = &mut next[v as usize];
            entries[*slot as usize] = [d[0], d[1], d[2], k as f32];
            *slot += 1;
        }
    }
    (starts, entries)
}

/// For each vertex the first one that lies in the same place and moves alike.
fn weld(mesh: &Mesh, starts: &[u32], entries: &[[f32; 4]]) -> Vec<u32> {
    let moves = |v: usize| &entries[starts[v] as usize..starts[v + 1] as usize];
    let mut here: HashMap<[u32; 3], Vec<u32>> = HashMap::with_capacity(mesh.positions.len());
    (0..mesh.positions.len())
        .map(|v| {
            let place = here.entry(mesh.positions[v].map(f32::to_bits)).or_default();
            let twin = place.iter().copied().find(|&t| moves(t as usize) == moves(v));
            twin.unwrap_or_else(|| {
                place.push(v as u32);
                v as u32
            })
        })
        .collect()
}

fn measure_eye(mesh: &Mesh, centre: Vec3, looks: Vec<mimique_avatar::Look>) -> Eye {
    // Lengths have the order of their bits.
    let mut lengths: Vec<u64> = (mesh.positions.iter())
        .map(|&p| (Vec3::from(p) - centre).length().to_bits().into())
        .collect();
    lengths.sort_unstable();
    let length = |rank: usize| f32::from_bits(lengths[rank] as u32);
    let radius = length(lengths.len() / 2).max(1e-5);
    // A cornea bulges: the pupil looks towards the mean of the farthest points. A plain ball looks ahead.
    let far = length(lengths.len() - 1 - lengths.len() / 50);
    let bulge: Vec3 = (mesh.positions.iter().map(|&p| Vec3::from(p) - centre))
        .filter(|d| d.length() >= far)
        .fold(Vec3::ZERO, |sum, d| sum + d.normalize_or_zero());
    let seen = bulge.normalize_or_zero();
    let forward = if far > 1.03 * radius && seen.z > 0.8 { seen } else { Vec3::Z };
    let within = |low: f32, high: f32| {
        let of_vertex = |(p, c): (&[f32; 3], &[f32; 3])| {
            let lean = 1.0 - (Vec3::from(*p) - centre).normalize_or_zero().dot(forward);
            (low..high).contains(&lean).then_some(Vec3::from(*c))
        };
        let colours: Vec<Vec3> =
            mesh.positions.iter().zip(&mesh.vertex_colours).filter_map(of_vertex).collect();
        let count = colours.len() as f32;
        (count > 0.0).then(|| (colours.iter().sum::<Vec3>() / count).to_array())
    };
    // 1 - cosine: the iris lies between 11 and 22 degrees off the axis, the white beyond 40.
    let (iris, white) = (within(0.018, 0.073), within(0.25, 0.7));
    Eye { centre, radius, forward, looks, iris, white }
}
