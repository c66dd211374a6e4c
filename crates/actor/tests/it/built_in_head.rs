//! The built-in head: its surface, its symmetry, its blendshapes, and what they must do to a face.

use mimique_actor::{
    Clip, Density, Emotion, HeadSpec, Identity, SHAPE_NAMES, build_head, marker_sites,
    performance_weights,
};
use mimique_avatar::{Avatar, BODY_SHAPES, Mesh, Part};
use std::collections::{BTreeMap, BTreeSet};

fn head() -> Avatar {
    build_head(&HeadSpec::default())
}

fn pose(avatar: &Avatar, weights: &[(&str, f64)]) -> Vec<f64> {
    let mut out = vec![0.0; avatar.shape_names.len()];
    for (name, w) in weights {
        out[avatar.shape_index(name).expect("shape exists")] = *w;
    }
    out
}

fn sub(a: [f32; 3], b: [f32; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| f64::from(a[k]) - f64::from(b[k]))
}

fn length(a: [f64; 3]) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

fn area(p: &[[f32; 3]], t: [u32; 3]) -> f64 {
    let [a, b, c] = t.map(|v| p[v as usize]);
    let (u, v) = (sub(b, a), sub(c, a));
    0.5 * length([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])
}

/// Directed edges, each with the number of triangles that run along it.
fn directed_edges(mesh: &Mesh) -> BTreeMap<(u32, u32), usize> {
    let mut edges = BTreeMap::new();
    for t in &mesh.triangles {
        for k in 0..3 {
            *edges.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
        }
    }
    edges
}

/// Closed chains of edges that only one triangle has.
fn boundary_loops(mesh: &Mesh) -> usize {
    let edges = directed_edges(mesh);
    let mut next = BTreeMap::new();
    for &(a, b) in edges.keys() {
        if !edges.contains_key(&(b, a)) {
            assert!(next.insert(a, b).is_none(), "two boundaries meet in vertex {a}");
        }
    }
    let mut loops = 0;
    while let Some((&start, _)) = next.first_key_value() {
        let mut at = start;
        while let Some(to) = next.remove(&at) {
            at = to;
        }
        assert_eq!(at, start, "a boundary does not close");
        loops += 1;
    }
    loops
}

#[test]
fn skin_is_one_oriented_manifold_open_at_neck_eyes_and_lips() {
    for density in &Density::ALL[..7] {
        let avatar = build_head(&HeadSpec { density: *density, ..HeadSpec::default() });
        let skin = avatar.skin().expect("a skin");
        let edges = directed_edges(skin);
        assert!(edges.values().all(|&n| n == 1), "an edge is run twice in one direction");
        assert_eq!(boundary_loops(skin), 4, "neck, two eyes, the lips' lining");
        let undirected: BTreeSet<_> = edges.keys().map(|&(a, b)| (a.min(b), a.max(b))).collect();
        let euler =
            skin.positions.len() as i64 - undirected.len() as i64 + skin.triangles.len() as i64;
        // One connected sphere with four holes.
        assert_eq!(euler, 2 - 4);
        let mut reached = vec![false; skin.positions.len()];
        let mut around = vec![Vec::new(); skin.positions.len()];
        for &(a, b) in &undirected {
            around[a as usize].push(b as usize);
            around[b as usize].push(a as usize);
        }
        let mut stack = vec![0];
        while let Some(v) = stack.pop() {
            if !std::mem::replace(&mut reached[v], true) {
                stack.extend(&around[v]);
            }
        }
        assert!(reached.iter().all(|&r| r), "skin is not connected");
    }
}

#[test]
fn no_triangle_is_degenerate_on_any_person() {
    for seed in 0..6 {
        let avatar =
            build_head(&HeadSpec { identity: Identity::from_seed(seed), ..HeadSpec::default() });
        for mesh in &avatar.meshes {
            let smallest = mesh
                .triangles
                .iter()
                .map(|&t| area(&mesh.positions, t))
                .fold(f64::INFINITY, f64::min);
            // 1e-4 mm^2: a sliver of 0.1 mm by 2 micrometres.
            assert!(smallest > 1e-10, "seed {seed}, {}: {smallest:e} m^2", mesh.name);
            assert!(mesh.positions.iter().flatten().all(|c| c.is_finite()));
        }
    }
}

/// For each skin vertex the one on the other side.
fn mirror_of(mesh: &Mesh) -> Vec<usize> {
    let key = |p: [f32; 3]| p.map(|c| (c * 1e5).round() as i64);
    let mut cells: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    for (v, &p) in mesh.positions.iter().enumerate() {
        cells.entry(key(p)).or_default().push(v);
    }
    mesh.positions
        .iter()
        .map(|p| {
            let q = [-p[0], p[1], p[2]];
            let k = key(q);
            let mut best = (f64::INFINITY, 0);
            for dx in -1..=1 {
                for dy in -1..=1 {
                    for dz in -1..=1 {
                        for &v in
                            cells.get(&[k[0] + dx, k[1] + dy, k[2] + dz]).into_iter().flatten()
                        {
                            let d = length(sub(mesh.positions[v], q));
                            if d < best.0 {
                                best = (d, v);
                            }
                        }
                    }
                }
            }
            assert!(best.0 < 1e-6, "no mirror image of {p:?}, nearest at {} m", best.0);
            best.1
        })
        .collect()
}

#[test]
fn face_and_shapes_are_mirror_symmetric() {
    let avatar = head();
    let skin = avatar.skin().expect("a skin");
    let mirror = mirror_of(skin);
    let dense = |name: &str| {
        let shape = &skin.shapes[avatar.shape_index(name).expect("shape exists")];
        let mut out = vec![[0f32; 3]; skin.positions.len()];
        for (&v, &d) in shape.vertices.iter().zip(&shape.deltas) {
            out[v as usize] = d;
        }
        out
    };
    for name in SHAPE_NAMES {
        let twin = match (name.strip_suffix("Left"), name.strip_suffix("Right")) {
            (Some(stem), _) => format!("{stem}Right"),
            (_, Some(stem)) => format!("{stem}Left"),
            _ => name.to_string(),
        };
        let (own, other) = (dense(name), dense(&twin));
        for (v, &m) in mirror.iter().enumerate() {
            let image = [-own[v][0], own[v][1], own[v][2]];
            let error = length(sub(image, other[m]));
            assert!(error < 2e-6, "{name} against {twin}, vertex {v}: {error} m");
        }
    }
}

#[test]
fn every_shape_moves_the_skin_within_four_centimetres() {
    for seed in [0, 1, 2, 3] {
        let avatar =
            build_head(&HeadSpec { identity: Identity::from_seed(seed), ..HeadSpec::default() });
        let names: BTreeSet<_> = SHAPE_NAMES.iter().collect();
        assert_eq!(names.len(), 51);
        assert_eq!(avatar.face_shapes(), SHAPE_NAMES);
        assert_eq!(avatar.shape_names[51..], BODY_SHAPES);
        for mesh in &avatar.meshes {
            assert_eq!(mesh.shapes.len(), 51 + BODY_SHAPES.len(), "{}", mesh.name);
            for shape in &mesh.shapes {
                assert!(shape.vertices.is_sorted_by(|a, b| a < b));
                assert_eq!(shape.vertices.len(), shape.deltas.len());
            }
        }
        let skin = avatar.skin().expect("a skin");
        for (name, shape) in SHAPE_NAMES.iter().zip(&skin.shapes) {
            let largest =
                shape.deltas.iter().map(|&d| length(sub(d, [0.0; 3]))).fold(0.0, f64::max);
            assert!(largest > 4e-4, "{name} moves nothing: {largest} m");
            assert!(largest < 0.04, "{name} moves {largest} m");
        }
    }
}

/// What is seen from the front, a depth for every cell of a grid (metres): the nearest surface.
struct Front {
    x0: f64,
    y0: f64,
    step: f64,
    width: usize,
    depth: Vec<f64>,
}

impl Front {
    fn new(centre: [f64; 2], half: [f64; 2], step: f64) -> Front {
        let width = (2.0 * half[0] / step) as usize;
        let height = (2.0 * half[1] / step) as usize;
        Front {
            x0: centre[0] - half[0],
            y0: centre[1] - half[1],
            step,
            width,
            depth: vec![f64::NEG_INFINITY; width * height],
        }
    }

    fn draw(mut self, mesh: &Mesh, positions: &[[f32; 3]]) -> Front {
        let height = self.depth.len() / self.width;
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|v| positions[v as usize].map(f64::from));
            let det = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if det.abs() < 1e-16 {
                continue;
            }
            let cell = |v: f64, o: f64, n: usize| (((v - o) / self.step).max(0.0) as usize).min(n);
            let lo = |k: usize| a[k].min(b[k]).min(c[k]);
            let hi = |k: usize| a[k].max(b[k]).max(c[k]) + self.step;
            for j in cell(lo(1), self.y0, height)..cell(hi(1), self.y0, height) {
                for i in cell(lo(0), self.x0, self.width)..cell(hi(0), self.x0, self.width) {
                    let x = self.x0 + (i as f64 + 0.5) * self.step;
                    let y = self.y0 + (j as f64 + 0.5) * self.step;
                    let u = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / det;
                    let v = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / det;
                    if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
                        let z = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]);
                        let slot = &mut self.depth[j * self.width + i];
                        *slot = slot.max(z);
                    }
                }
            }
        }
        self
    }

    /// Cells in which `behind` shows before `self`, in square millimetres.
    fn shows(&self, behind: &Front) -> f64 {
        let cells = self.depth.iter().zip(&behind.depth).filter(|(a, b)| b > a).count();
        cells as f64 * self.step * self.step * 1e6
    }
}

/// Area of an eyeball that is seen from the front, mm^2.
fn eye_area(avatar: &Avatar, part: Part, weights: &[f64]) -> f64 {
    let ball = avatar.meshes.iter().find(|m| m.part == part).expect("an eyeball");
    let skin = avatar.skin().expect("a skin");
    let c = avatar
        .eyeballs
        .iter()
        .find(|e| avatar.meshes[e.mesh].part == part)
        .expect("an eyeball")
        .centre
        .map(f64::from);
    let window = || Front::new([c[0], c[1]], [0.022, 0.018], 0.0002);
    let lids = window().draw(skin, &skin.posed(weights));
    let eye = window().draw(ball, &ball.positions);
    lids.shows(&eye)
}

#[test]
fn blink_hides_the_eyeball_and_leaves_the_other_open() {
    for seed in [0, 3, 5] {
        let identity = if seed == 0 { Identity::default() } else { Identity::from_seed(seed) };
        let avatar = build_head(&HeadSpec { identity, ..HeadSpec::default() });
        let open = eye_area(&avatar, Part::EyeLeft, &pose(&avatar, &[]));
        assert!(open > 120.0, "eye is hardly open: {open} mm^2");
        let half = eye_area(&avatar, Part::EyeLeft, &pose(&avatar, &[("eyeBlinkLeft", 0.5)]));
        assert!(half > 0.25 * open && half < 0.8 * open, "half a blink shows {half} of {open}");
        let shut = pose(&avatar, &[("eyeBlinkLeft", 1.0)]);
        let left = eye_area(&avatar, Part::EyeLeft, &shut);
        let right = eye_area(&avatar, Part::EyeRight, &shut);
        assert!(left < 0.5, "seed {seed}: a shut eye shows {left} mm^2");
        assert!((right - open).abs() < 0.02 * open, "the other eye shows {right} of {open}");
        let squinting = pose(&avatar, &[("eyeBlinkLeft", 1.0), ("eyeSquintLeft", 1.0)]);
        let left = eye_area(&avatar, Part::EyeLeft, &squinting);
        assert!(left < 0.5, "seed {seed}: blink with squint shows {left} mm^2");
    }
}

#[test]
fn wide_and_squint_change_the_opening_of_the_eye() {
    let avatar = head();
    let area = |w: &[(&str, f64)]| eye_area(&avatar, Part::EyeLeft, &pose(&avatar, w));
    let rest = area(&[]);
    assert!(area(&[("eyeWideLeft", 1.0)]) > 1.2 * rest);
    assert!(area(&[("eyeSquintLeft", 1.0)]) < 0.75 * rest);
    assert!(area(&[("eyeLookDownLeft", 1.0)]) < 0.8 * rest);
    assert!(area(&[("eyeLookUpLeft", 1.0)]) > 1.1 * rest);
}

/// Area between the lips through which the inside of the mouth is seen, mm^2.
fn mouth_area(avatar: &Avatar, weights: &[f64]) -> f64 {
    let skin = avatar.skin().expect("a skin");
    let window = || Front::new([0.0, -0.075], [0.04, 0.05], 0.00025);
    let lips = window().draw(skin, &skin.posed(weights));
    avatar
        .meshes
        .iter()
        .filter(|m| matches!(m.part, Part::Socket | Part::Teeth | Part::Tongue))
        .map(|m| lips.shows(&window().draw(m, &m.posed(weights))))
        .fold(0.0, f64::max)
}

#[test]
fn jaw_opens_a_mouth_and_mouth_close_shuts_it() {
    for seed in [0, 2, 7] {
        let identity = if seed == 0 { Identity::default() } else { Identity::from_seed(seed) };
        let avatar = build_head(&HeadSpec { identity, ..HeadSpec::default() });
        let area = |w: &[(&str, f64)]| mouth_area(&avatar, &pose(&avatar, w));
        let rest = area(&[]);
        assert!(rest < 2.0, "seed {seed}: lips at rest show {rest} mm^2");
        let open = area(&[("jawOpen", 1.0)]);
        assert!(open > 600.0, "seed {seed}: an open mouth shows {open} mm^2");
        let shut = area(&[("jawOpen", 1.0), ("mouthClose", 1.0)]);
        assert!(shut < 6.0, "seed {seed}: lips shut over the open jaw show {shut} mm^2");
        let half = area(&[("jawOpen", 0.5), ("mouthClose", 0.5)]);
        assert!(half < 6.0, "seed {seed}: lips shut over the half open jaw show {half} mm^2");
    }
}

#[test]
fn shapes_move_what_they_are_named_for() {
    let avatar = head();
    let skin = avatar.skin().expect("a skin");
    let sites = marker_sites(&HeadSpec::default());
    let moved = |shape: &str, site: &str| {
        let v = sites.vertices[sites.labels.iter().position(|l| l == site).expect("a label")];
        let posed = skin.posed(&pose(&avatar, &[(shape, 1.0)]));
        sub(posed[v as usize], skin.positions[v as usize]).map(|c| c * 1e3)
    };
    assert!(moved("browInnerUp", "brow_inner_left")[1] > 4.0);
    assert!(moved("browInnerUp", "brow_inner_right")[1] > 4.0);
    assert!(moved("browOuterUpRight", "brow_outer_right")[1] > 4.0);
    assert!(moved("browDownLeft", "brow_inner_left")[1] < -3.0);
    assert!(length(moved("browDownLeft", "brow_inner_right")) < 1.0, "one side alone");
    assert!(moved("mouthSmileLeft", "mouth_corner_left")[1] > 5.0);
    assert!(moved("mouthSmileLeft", "mouth_corner_left")[0] > 4.0, "left is +X");
    assert!(length(moved("mouthSmileLeft", "mouth_corner_right")) < 0.5);
    assert!(moved("mouthFrownRight", "mouth_corner_right")[1] < -4.0);
    let stretched = moved("mouthStretchLeft", "mouth_corner_left");
    assert!(stretched[0] > 6.0 && stretched[1] < -1.0, "aside, not up: {stretched:?}");
    assert!(moved("mouthLeft", "lip_upper")[0] > 4.0);
    assert!(moved("jawLeft", "chin")[0] > 4.0);
    assert!(moved("jawOpen", "chin")[1] < -15.0);
    assert!(moved("jawForward", "chin")[2] > 3.0);
    assert!(moved("mouthPucker", "lip_upper")[2] > 4.0);
    assert!(moved("mouthUpperUpLeft", "lip_upper_left")[1] > 3.0);
    assert!(moved("mouthLowerDownLeft", "lip_lower_left")[1] < -3.0);
    assert!(moved("noseSneerLeft", "nose_wing_left")[1] > 2.0);
    assert!(moved("cheekPuff", "cheek_lower_left")[0] > 1.5);
    assert!(moved("mouthStretchLeft", "mouth_corner_left")[0] > 5.0);
}

fn normal(p: &[[f32; 3]], t: [u32; 3]) -> [f64; 3] {
    let [a, b, c] = t.map(|v| p[v as usize]);
    let (u, v) = (sub(b, a), sub(c, a));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

#[test]
fn strong_expressions_do_not_turn_the_skin_inside_out() {
    let avatar = head();
    let skin = avatar.skin().expect("a skin");
    let total: f64 = skin.triangles.iter().map(|&t| area(&skin.positions, t)).sum();
    for emotion in Emotion::ALL {
        let clip = Clip { emotion, intensity: 3, seed: 2 };
        let played = performance_weights(&avatar.shape_names, &clip, 10.0, 4.0);
        let mut worst: f64 = 0.0;
        for f in 0..played.frames() {
            let posed = skin.posed(played.frame(f));
            let turned: f64 = skin
                .triangles
                .iter()
                .filter(|&&t| {
                    let (n, m) = (normal(&skin.positions, t), normal(&posed, t));
                    n[0] * m[0] + n[1] * m[1] + n[2] * m[2] < 0.0
                })
                .map(|&t| area(&skin.positions, t))
                .sum();
            worst = worst.max(turned / total);
        }
        // The rims inside lips and lids may roll over; a fold in the open skin would be far more.
        assert!(worst < 0.0015, "{emotion:?}: {worst} of the skin is turned over");
    }
}

#[test]
fn teeth_ride_on_the_right_jaw() {
    let avatar = head();
    let open = pose(&avatar, &[("jawOpen", 1.0)]);
    for mesh in avatar.meshes.iter().filter(|m| m.part == Part::Teeth || m.part == Part::Tongue) {
        let drop = mesh
            .posed(&open)
            .iter()
            .zip(&mesh.positions)
            .map(|(p, q)| f64::from(q[1] - p[1]))
            .fold(0.0, f64::max);
        if mesh.name == "teeth_upper" {
            assert_eq!(drop, 0.0);
        } else {
            assert!(drop > 0.008, "{} drops {drop} m", mesh.name);
        }
    }
}

#[test]
fn eyeballs_turn_the_way_the_looks_say() {
    let avatar = head();
    assert_eq!(avatar.eyeballs.len(), 2);
    for eyeball in &avatar.eyeballs {
        let side = eyeball.centre[0].signum();
        for look in &eyeball.looks {
            // The line of sight +Z turned by a small angle moves along axis x Z.
            let [ax, ay, _] = look.axis;
            let sight = [ay, -ax];
            let name = avatar.shape_names[look.shape].as_str();
            assert_eq!(name.ends_with("Left"), side > 0.0);
            match name.trim_end_matches("Left").trim_end_matches("Right") {
                "eyeLookUp" => assert!(sight[1] > 0.9),
                "eyeLookDown" => assert!(sight[1] < -0.9),
                "eyeLookOut" => assert!(sight[0] * side > 0.9),
                "eyeLookIn" => assert!(sight[0] * side < -0.9),
                other => panic!("{other} is not a look"),
            }
        }
        assert_eq!(eyeball.looks.len(), 4);
    }
}

#[test]
fn density_follows_one_topology_rule() {
    let counts: Vec<usize> = Density::ALL
        .iter()
        .map(|&density| {
            let avatar = build_head(&HeadSpec { density, ..HeadSpec::default() });
            avatar.skin().expect("a skin").positions.len()
        })
        .collect();
    // Each quad of the cage in k x k: for so many vertices a number of quads is a square.
    let standard = counts[1] as f64;
    for (k, &count) in (1..).zip(&counts) {
        let ratio = count as f64 / standard / (f64::from(k) / 2.0).powi(2);
        assert!((0.95..1.1).contains(&ratio), "{k}: {counts:?}");
    }
    assert!((1_500..3_000).contains(&counts[0]), "{counts:?}");
    assert!((105_000..115_000).contains(&counts[6]), "{counts:?}");
    for (density, &count) in Density::ALL.iter().zip(&counts) {
        assert_eq!(Density::nearest(count), *density);
    }
    assert_eq!(Density::nearest(0), Density::COARSE);
    assert_eq!(Density::nearest(usize::MAX), Density::FINEST);
}

/// Densities that are fewer halvings of the cage than the finest.
const HALVED: [Density; 3] = [Density::COARSE, Density::STANDARD, Density::FINE];

#[test]
fn every_density_has_the_same_surface() {
    let of = |density| {
        let spec = HeadSpec { density, ..HeadSpec::default() };
        (build_head(&spec), marker_sites(&spec).vertices)
    };
    let whole = |mesh: &Mesh| mesh.triangles.iter().map(|&t| area(&mesh.positions, t)).sum::<f64>();
    let (finest, sites) = of(Density::FINEST);
    let fine = finest.skin().expect("a skin");
    for density in &Density::ALL[..7] {
        let (head, own) = of(*density);
        let skin = head.skin().expect("a skin");
        // The cage's own vertices, where markers stand, are where the finest has them, in every shape:
        // to the bit where both come by the same halvings, else to the rounding of single floats.
        let most = if HALVED.contains(density) { 1.5e-8 } else { 0.0 };
        let posed = |mesh: &Mesh, shape: usize, v: u32| {
            let at = mesh.shapes[shape].vertices.binary_search(&v);
            at.map_or([0.0; 3], |k| mesh.shapes[shape].deltas[k])
        };
        for (&v, &w) in own.iter().zip(&sites) {
            let off = length(sub(skin.positions[v as usize], fine.positions[w as usize]));
            assert!(off <= most, "{density:?}: vertex {v} is {off} m off");
            for shape in 0..skin.shapes.len() {
                let off = length(sub(posed(skin, shape, v), posed(fine, shape, w)));
                assert!(off <= most, "{density:?}: shape {shape} moves vertex {v} {off} m more");
            }
        }
        let ratio = whole(skin) / whole(fine);
        let least = if *density == Density::COARSE { 0.96 } else { 0.99 };
        assert!((least..1.001).contains(&ratio), "{density:?}: {ratio} of the finest's area");
    }
}

/// FNV-1a over the bits of everything that is drawn.
fn fingerprint(avatar: &Avatar) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    let mut eat = |bits: u32| {
        for byte in bits.to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    };
    for mesh in &avatar.meshes {
        mesh.positions.iter().flatten().for_each(|c| eat(c.to_bits()));
        mesh.triangles.iter().flatten().for_each(|&v| eat(v));
        mesh.vertex_colours.iter().flatten().for_each(|c| eat(c.to_bits()));
        for shape in &mesh.shapes {
            shape.vertices.iter().for_each(|&v| eat(v));
            shape.deltas.iter().flatten().for_each(|c| eat(c.to_bits()));
        }
    }
    hash
}

#[test]
fn the_same_spec_is_the_same_head() {
    assert_eq!(fingerprint(&head()), fingerprint(&head()));
    let someone = HeadSpec { identity: Identity::from_seed(11), ..HeadSpec::default() };
    assert_eq!(fingerprint(&build_head(&someone)), fingerprint(&build_head(&someone)));
}

/// The same bits on every platform. A deliberate change of the head changes this number: the failing
/// test prints the new one.
#[test]
fn default_head_has_the_recorded_fingerprint() {
    assert_eq!(format!("{:016x}", fingerprint(&head())), "ed1a7aa4ebd4267b");
}

#[test]
fn different_seeds_are_different_people() {
    let people: Vec<Avatar> = (0..5)
        .map(|seed| {
            build_head(&HeadSpec { identity: Identity::from_seed(seed), ..HeadSpec::default() })
        })
        .collect();
    for (i, a) in people.iter().enumerate() {
        for b in &people[i + 1..] {
            let (a, b) = (a.skin().expect("a skin"), b.skin().expect("a skin"));
            assert_eq!(a.positions.len(), b.positions.len(), "one topology for everyone");
            let apart: Vec<f64> =
                a.positions.iter().zip(&b.positions).map(|(p, q)| length(sub(*p, *q))).collect();
            let mean = apart.iter().sum::<f64>() / apart.len() as f64;
            assert!(mean > 6e-4, "two people are only {mean} m apart on average");
            assert!(apart.iter().all(|&d| d < 0.04));
        }
    }
}

#[test]
fn marker_sites_name_the_same_places_on_everyone() {
    for density in [Density::COARSE, Density::STANDARD, Density::nearest(19_000)] {
        let spec = HeadSpec { density, ..HeadSpec::default() };
        let sites = marker_sites(&spec);
        assert_eq!(sites.face_labels().len(), 40);
        assert_eq!(sites.head_labels().len(), 6);
        let labels: BTreeSet<_> = sites.labels.iter().collect();
        let vertices: BTreeSet<_> = sites.vertices.iter().collect();
        assert_eq!((labels.len(), vertices.len()), (46, 46), "a label or a vertex is used twice");
        for seed in 0..3 {
            let identity = Identity::from_seed(seed);
            let other = HeadSpec { identity, density };
            assert_eq!(marker_sites(&other), sites);
            let avatar = build_head(&other);
            let skin = avatar.skin().expect("a skin");
            let at = |label: &str| {
                let k = sites.labels.iter().position(|l| l == label).expect("a label");
                skin.positions[sites.vertices[k] as usize]
            };
            assert!(at("nose_tip")[2] > at("chin")[2] && at("nose_tip")[0].abs() < 1e-6);
            assert!(at("mouth_corner_left")[0] > 0.015 && at("mouth_corner_right")[0] < -0.015);
            assert!(at("brow_inner_left")[1] > at("cheek_left")[1]);
            assert!(at("head_top")[1] > 0.08);
        }
    }
}

#[test]
fn the_docs_give_every_shape_its_unit_and_muscle() {
    let table = include_str!("../../src/facs.md");
    let docs = include_str!("../../../../docs/guide/avatars.md");
    assert!(
        docs.contains(table),
        "docs/guide/avatars.md lacks the table of crates/actor/src/facs.md"
    );
    let mut named: Vec<String> = Vec::new();
    for row in table.lines().skip(2) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [names, unit, muscle] = cells[..] else { panic!("{row}") };
        let of_the_body = names.split(", ").all(|name| BODY_SHAPES.contains(&name));
        assert!(of_the_body || unit.starts_with("AU ") || unit.starts_with("AD "), "{row}");
        assert!(!muscle.is_empty(), "{row}");
        for name in names.split(", ") {
            match (name.strip_suffix("Left/Right"), name.strip_suffix('*')) {
                (Some(stem), _) => named.extend([format!("{stem}Left"), format!("{stem}Right")]),
                (_, Some(stem)) => {
                    let all = SHAPE_NAMES.iter().filter(|n| n.starts_with(stem));
                    named.extend(all.map(|n| (*n).to_owned()));
                }
                _ => named.push(name.to_owned()),
            }
        }
    }
    named.sort_unstable();
    let mut all = [&SHAPE_NAMES[..], &BODY_SHAPES].concat();
    all.sort_unstable();
    assert_eq!(named, all);
}
