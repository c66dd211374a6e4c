//! The built-in head, made wholly by code: a control cage with edge loops is shrink-wrapped onto a
//! sculpt of blended volumes, lids and lips are laid into its holes, muscles act on the cage, and
//! Catmull-Clark subdivision carries neutral and blendshapes to the wanted density, onto its smooth
//! surface.

mod clothes;
mod colour;
mod ear;
mod eyeball;
mod eyelids;
mod hair;
mod identity;
mod lashes;
mod layout;
mod lines;
mod lips;
mod mouth_parts;
mod muscles;
mod nose;
mod resample;
pub(crate) mod rng;
mod sculpt;
mod sites;
mod subdivide;
mod topology;
pub(crate) mod vec3;

pub use identity::Identity;
pub use lines::{FaceLine, FaceLinePart, face_lines};
use muscles::HEAD_SHAPES;
pub use muscles::SHAPE_NAMES;
pub use sites::{MarkerSites, marker_sites};

use eyelids::Eye;
use hair::SkinLayer;
use mimique_avatar::{Avatar, Mesh, Part, SparseShape};
use resample::Resampled;
use sculpt::{Landmarks, Sculpt};
use subdivide::Step;
use topology::Topology;
use vec3::Vec3;

/// What to build.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HeadSpec {
    /// Who it is.
    pub identity: Identity,
    /// How finely.
    pub density: Density,
}

/// Actors are other people than the persons of the same number.
const ACTORS: u64 = 0x6163_746f_7273_0000;

impl HeadSpec {
    /// The built-in person of that number, at the default density.
    pub fn person(number: u64) -> Self {
        Self { identity: Identity::from_seed(number), density: Density::default() }
    }

    /// The built-in actor of that number, who is nobody of [`HeadSpec::person`].
    pub fn actor(number: u64) -> Self {
        Self::person(number ^ ACTORS)
    }
}

/// Density of the mesh: one topology, each quad of the cage in `k x k`, `k` from 1 to 8.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Density(u8);

impl Density {
    /// The cage's quads: about 2,300 skin vertices.
    pub const COARSE: Density = Density(1);
    /// 2 x 2: about 9,200. The solver runs on this one.
    pub const STANDARD: Density = Density(2);
    /// 4 x 4: about 37,000.
    pub const FINE: Density = Density(4);
    /// 8 x 8: about 146,000.
    pub const FINEST: Density = Density(8);

    /// All densities, coarsest first.
    pub const ALL: [Density; 8] = [
        Density(1),
        Density(2),
        Density(3),
        Density(4),
        Density(5),
        Density(6),
        Density(7),
        Density(8),
    ];

    /// The density whose number of skin vertices comes nearest in ratio to `vertices`.
    pub fn nearest(vertices: usize) -> Density {
        let topology = Topology::new();
        let off = |density: &Density| {
            let count = topology.skin_vertices(density.across()) as f64;
            (count / vertices.max(1) as f64).ln().abs()
        };
        Density::ALL.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or_default()
    }

    /// Quads along the side of a quad of the cage.
    fn across(self) -> usize {
        usize::from(self.0)
    }

    /// Halvings of the cage's quads: as many as it takes, or all where none leads there.
    fn steps(self) -> usize {
        let across = self.across();
        (if across.is_power_of_two() { self } else { Density::FINEST }).across().ilog2() as usize
    }
}

impl Default for Density {
    fn default() -> Density {
        Density::STANDARD
    }
}

/// A cage with everything that the parts of the head are made from.
pub(crate) struct Cage {
    pub topology: Topology,
    pub at: Landmarks,
    pub sculpt: Sculpt,
    pub eye: Eye,
    /// Wanted surface positions of the cage's vertices, millimetres.
    pub surface: Vec<Vec3>,
    /// Control points.
    pub control: Vec<Vec3>,
}

impl Cage {
    fn new(who: &Identity) -> Cage {
        let topology = Topology::new();
        let at = Landmarks::new(who);
        let sculpt = Sculpt::new(who, &at);
        let placed = layout::place(&topology, &sculpt, &at, Eye::new(who, &at));
        Cage {
            topology,
            at,
            sculpt,
            eye: placed.eye,
            surface: placed.surface,
            control: placed.control,
        }
    }
}

/// The cage's connectivity carried to a density.
pub(crate) struct Subdivided {
    steps: Vec<Step>,
    /// The step after the last: where the smooth surface passes for the last one's vertices. They
    /// stand off it, and pinch where that is bent.
    next: Step,
    quads: Vec<[u32; 4]>,
    is_socket: Vec<bool>,
    cage_vertices: usize,
    /// Where the quads' sides are no halvings of the cage's: how to get from those to these.
    resampled: Option<Resampled>,
}

impl Subdivided {
    pub(crate) fn new(topology: &Topology, density: Density) -> Subdivided {
        let cage_vertices = topology.sites.len();
        let mut quads = topology.quads.clone();
        let mut is_socket = topology.quad_is_socket.clone();
        let mut steps: Vec<Step> = Vec::new();
        for _ in 0..density.steps() {
            let step = Step::new(steps.last().map_or(cage_vertices, Step::len), &quads);
            quads = step.quads.clone();
            is_socket = is_socket.iter().flat_map(|&s| [s; 4]).collect();
            steps.push(step);
        }
        let next = Step::new(steps.last().map_or(cage_vertices, Step::len), &quads);
        let across = density.across();
        let halved = 1 << density.steps();
        let resampled = (across != halved).then(|| {
            let resampled = Resampled::new(cage_vertices, &topology.quads, &quads, halved, across);
            quads.clone_from(&resampled.quads);
            is_socket = (topology.quad_is_socket.iter())
                .flat_map(|&socket| std::iter::repeat_n(socket, across * across))
                .collect();
            resampled
        });
        Subdivided { steps, next, quads, is_socket, cage_vertices, resampled }
    }

    /// A channel of the cage on the finest vertices, which lie on the smooth surface.
    pub(crate) fn refine(&self, values: &[Vec3]) -> Vec<Vec3> {
        let halved = self.steps.iter().fold(values.to_vec(), |values, step| step.refine(&values));
        let smooth = self.next.limit(&halved);
        match &self.resampled {
            Some(resampled) => resampled.values(&smooth),
            None => smooth,
        }
    }

    /// Number of finest vertices.
    fn len(&self) -> usize {
        match &self.resampled {
            Some(resampled) => resampled.len(),
            None => self.steps.last().map_or(self.cage_vertices, Step::len),
        }
    }

    /// Vertices of one part, in the order in which its quads name them.
    fn part_vertices(&self, want_socket: bool) -> Vec<u32> {
        let mut seen = vec![false; self.len()];
        let mut from = Vec::new();
        for (quad, _) in self.quads.iter().zip(&self.is_socket).filter(|q| *q.1 == want_socket) {
            for &v in quad {
                if !std::mem::replace(&mut seen[v as usize], true) {
                    from.push(v);
                }
            }
        }
        from
    }

    /// Skin vertex of each cage vertex (subdivision keeps cage vertices first);
    /// `u32::MAX` for those that only line the mouth.
    pub(crate) fn skin_vertex_of_cage(&self) -> Vec<u32> {
        let mut own = vec![u32::MAX; self.cage_vertices];
        for (k, v) in self.part_vertices(false).into_iter().enumerate() {
            if let Some(slot) = own.get_mut(v as usize) {
                *slot = k as u32;
            }
        }
        own
    }

    /// One part as a mesh: triangles along the shorter diagonal of each quad.
    fn mesh(&self, want_socket: bool, neutral: &[Vec3], shapes: &[Vec<Vec3>]) -> (Mesh, Vec<u32>) {
        let from = self.part_vertices(want_socket);
        let mut own = vec![u32::MAX; neutral.len()];
        for (k, &v) in from.iter().enumerate() {
            own[v as usize] = k as u32;
        }
        let mut triangles = Vec::new();
        for (quad, _) in self.quads.iter().zip(&self.is_socket).filter(|q| *q.1 == want_socket) {
            let q = quad.map(|v| own[v as usize]);
            triangles.extend(split(q, quad.map(|v| neutral[v as usize])));
        }
        let pick = |values: &[Vec3]| from.iter().map(|&v| values[v as usize]).collect::<Vec<_>>();
        let mesh = Mesh {
            positions: pick(neutral).into_iter().map(Vec3::metres).collect(),
            triangles,
            shapes: shapes.iter().map(|d| sparse(pick(d).into_iter())).collect(),
            ..Mesh::default()
        };
        (mesh, from)
    }
}

/// The two triangles of a quad with these corners, along its shorter diagonal.
fn split(q: [u32; 4], at: [Vec3; 4]) -> [[u32; 3]; 2] {
    // A small bias makes nearly equal diagonals fall alike on both sides of the face.
    if (at[0] - at[2]).length() < 0.9999 * (at[1] - at[3]).length() {
        [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]
    } else {
        [[q[0], q[1], q[3]], [q[1], q[2], q[3]]]
    }
}

/// Build the head. The same spec gives the same bytes on every platform.
pub fn build_head(spec: &HeadSpec) -> Avatar {
    let who = &spec.identity;
    let cage = Cage::new(who);
    let fine = Subdivided::new(&cage.topology, spec.density);
    let neutral = fine.refine(&cage.control);
    let actions = muscles::all(&cage);
    let shapes: Vec<Vec<Vec3>> = actions.iter().map(|d| fine.refine(d)).collect();
    let (mut skin, from) = fine.mesh(false, &neutral, &shapes);
    let tints = fine.refine(&colour::cage_tints(&cage, who));
    skin.name = "skin".to_string();
    skin.part = Part::Skin;
    skin.base_colour = who.skin_colour;
    skin.vertex_colours = from.iter().map(|&v| tints[v as usize].linear_rgb()).collect();
    let (mut lining, _) = fine.mesh(true, &neutral, &shapes);
    lining.name = "mouth_socket".to_string();
    lining.part = Part::Socket;
    lining.base_colour = [0.16, 0.035, 0.03];
    let mut avatar = Avatar {
        name: "Built-in head".to_string(),
        shape_names: HEAD_SHAPES.iter().map(|s| s.to_string()).collect(),
        meshes: vec![skin, lining],
        eyeballs: Vec::new(),
        ..Avatar::default()
    };
    mouth_parts::add(&mut avatar, &cage);
    let layer = SkinLayer::new(&neutral, &fine.quads, &shapes);
    hair::add_brows(&mut avatar, &layer, who, &cage.at);
    hair::add_cap(&mut avatar, &layer, &fine, &cage.topology, who);
    if who.masculinity < 0.5 {
        hair::add_knot(&mut avatar, who);
    }
    clothes::add(&mut avatar, cage.at.chin_y, cage.at.neck);
    lashes::add(&mut avatar, &cage, &actions, who);
    eyeball::add(&mut avatar, &cage.eye, who);
    avatar
}

/// Displacements of a mesh's vertices, without those below a micrometre.
pub(crate) fn sparse(deltas: impl Iterator<Item = Vec3>) -> SparseShape {
    let mut shape = SparseShape::default();
    for (v, d) in deltas.enumerate() {
        if d.length() > 1e-3 {
            shape.vertices.push(v as u32);
            shape.deltas.push(d.metres());
        }
    }
    shape
}
