//! Lashes of the upper lids: thin blades rooted on the lid's margin, which turn with it about the
//! ball.

use super::eyelids::along;
use super::identity::Identity;
use super::subdivide::Step;
use super::topology::{Feature, Topology};
use super::vec3::{Vec3, mix, v3};
use super::{Cage, sparse};
use mimique_avatar::{Avatar, Mesh, Part};
use std::f64::consts::PI;

/// Lashes an eye.
const COUNT: usize = 34;

/// Add the lashes of both eyes as one mesh.
pub(crate) fn add(avatar: &mut Avatar, cage: &Cage, shapes: &[Vec<Vec3>], who: &Identity) {
    let step = Step::new(cage.control.len(), &cage.topology.quads);
    let rest = Margin::new(&cage.topology, &step.limit(&cage.control));
    let moved: Vec<Margin> =
        shapes.iter().map(|d| Margin::new(&cage.topology, &step.limit(d))).collect();
    let mut out = Blades::new(shapes.len());
    for eye in 0..2 {
        let side = if eye == 0 { 1.0 } else { -1.0 };
        let centre = v3(side * cage.eye.centre.x, cage.eye.centre.y, cage.eye.centre.z);
        for i in 0..COUNT {
            let u = mix(0.06, 0.985, i as f64 / (COUNT - 1) as f64);
            let length = mix(3.4, 6.6, u)
                * libm::pow(libm::sin(PI * mix(0.1, 0.95, u)), 0.35)
                * mix(1.0, 0.7, who.masculinity);
            let root = rest.at(eye, u);
            let beside = (rest.at(eye, u + 0.012) - root).unit() * 0.44;
            let radial = (root - centre).unit();
            // Forward, then curled up; splayed towards the temple at the outer end.
            let splay = v3(side * mix(-0.45, 0.85, u), 0.0, 0.0);
            let dip = v3(0.0, -0.12, 0.0);
            let knee = root + (radial + splay * 0.5 + dip).unit() * (0.5 * length);
            let tip =
                knee + (radial * 0.6 + splay * 0.6 + v3(0.0, 0.75, 0.0)).unit() * (0.55 * length);
            let points =
                [root - beside, root + beside, knee - beside * 0.7, knee + beside * 0.7, tip];
            // The whole lash swings with its root about the ball: further out, further moved.
            let reach = points.map(|p| (p - centre).length() / (root - centre).length());
            out.push(points, reach, &|k| moved[k].at(eye, u), side);
        }
    }
    avatar.meshes.push(out.mesh());
}

/// The upper lid's outer margin of both eyes, as polylines over `u`.
struct Margin {
    stations: [Vec<(f64, Vec3)>; 2],
}

impl Margin {
    fn new(topology: &Topology, values: &[Vec3]) -> Margin {
        let mut left = Vec::new();
        let mut right = Vec::new();
        for k in 18..=28 {
            let v = topology.ring(Feature::EyeLeft, 5, k);
            let (_, u) = along(k.rem_euclid(20));
            left.push((u, values[v]));
            right.push((u, values[topology.mirror[v] as usize]));
        }
        Margin { stations: [left, right] }
    }

    fn at(&self, eye: usize, u: f64) -> Vec3 {
        let stations = &self.stations[eye];
        for pair in stations.windows(2) {
            let ((a, p), (b, q)) = (pair[0], pair[1]);
            if u <= b {
                return p.lerp(q, (u - a) / (b - a));
            }
        }
        stations.last().map_or(Vec3::default(), |s| s.1)
    }
}

struct Blades {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    deltas: Vec<Vec<Vec3>>,
}

impl Blades {
    fn new(shapes: usize) -> Blades {
        Blades { positions: Vec::new(), triangles: Vec::new(), deltas: vec![Vec::new(); shapes] }
    }

    /// Two faces of one blade, each with its own vertices so that both are lit.
    fn push(
        &mut self,
        points: [Vec3; 5],
        reach: [f64; 5],
        root_delta: &dyn Fn(usize) -> Vec3,
        side: f64,
    ) {
        for flip in [side < 0.0, side > 0.0] {
            let base = self.positions.len() as u32;
            self.positions.extend(points);
            for t in [[0, 1, 3], [0, 3, 2], [2, 3, 4]] {
                let t = if flip { [t[0], t[2], t[1]] } else { t };
                self.triangles.push(t.map(|k| base + k));
            }
            for (k, deltas) in self.deltas.iter_mut().enumerate() {
                let d = root_delta(k);
                deltas.extend(reach.map(|r| d * r));
            }
        }
    }

    fn mesh(self) -> Mesh {
        Mesh {
            name: "lashes".to_string(),
            part: Part::Lashes,
            positions: self.positions.iter().map(|p| p.metres()).collect(),
            triangles: self.triangles,
            vertex_colours: Vec::new(),
            base_colour: [0.012, 0.009, 0.008],
            shapes: self.deltas.into_iter().map(|d| sparse(d.into_iter())).collect(),
            ..Mesh::default()
        }
    }
}
