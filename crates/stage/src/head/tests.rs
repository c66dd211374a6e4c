//! What the passes compute, read back from the GPU.

use glam::{Vec3, Vec4};
use mimique_avatar::{Avatar, Eyeball, Look as EyeLook, Mesh, Part, SparseShape};

use crate::offscreen::Offscreen;
use crate::{Look, View};

const ROWS: usize = 24;

/// A sphere of 8 cm whose first and last meridian lie in one place, with a shape that grows it
/// by a tenth and one that moves its upper half, and an eye that turns.
fn planted() -> Avatar {
    let mut skin = sphere(Vec3::ZERO, 0.08);
    let all: Vec<u32> = (0..skin.positions.len() as u32).collect();
    let grow = SparseShape {
        deltas: skin.positions.iter().map(|p| p.map(|x| 0.1 * x)).collect(),
        vertices: all.clone(),
    };
    let upper: Vec<u32> =
        all.into_iter().filter(|&v| skin.positions[v as usize][1] > 0.01).collect();
    let lift = SparseShape { deltas: vec![[0.001, 0.002, 0.02]; upper.len()], vertices: upper };
    skin.shapes = vec![grow, lift, SparseShape::default()];
    let mut eye = sphere(Vec3::new(0.03, 0.02, 0.07), 0.012);
    eye.part = Part::EyeLeft;
    eye.shapes = vec![SparseShape::default(); 3];
    Avatar {
        name: "planted".to_owned(),
        shape_names: ["grow", "lift", "look"].map(str::to_owned).to_vec(),
        meshes: vec![skin, eye],
        eyeballs: vec![Eyeball {
            mesh: 1,
            centre: [0.03, 0.02, 0.07],
            looks: vec![EyeLook { shape: 2, axis: [0.0, 1.0, 0.0], radians: 0.6 }],
        }],
        ..Avatar::default()
    }
}

fn sphere(centre: Vec3, radius: f32) -> Mesh {
    let columns = 2 * ROWS;
    let mut mesh = Mesh::default();
    for i in 0..=ROWS {
        let (sin, cos) = (std::f32::consts::PI * i as f32 / ROWS as f32).sin_cos();
        for j in 0..=columns {
            let turn = std::f32::consts::TAU * (j % columns) as f32 / columns as f32;
            let unit = Vec3::new(sin * turn.sin(), cos, sin * turn.cos());
            mesh.positions.push((centre + radius * unit).into());
        }
    }
    let at = |i: usize, j: usize| (i * (columns + 1) + j) as u32;
    for (i, j) in (0..ROWS).flat_map(|i| (0..columns).map(move |j| (i, j))) {
        mesh.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        mesh.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    mesh
}

/// The tables of positions and surfaces as the passes left them, skin first.
fn tables(name: &str, avatar: &Avatar, weights: &[f32]) -> Option<(Vec<Vec4>, Vec<Vec4>)> {
    let stage = match Offscreen::new(true) {
        Ok(stage) => stage,
        Err(error) => {
            mimique_test_support::skip(name, &error.to_string());
            return None;
        }
    };
    let renderer = stage.renderer([16, 16], Look::STIMULUS);
    let head = renderer.load(avatar).expect("the avatar loads");
    stage.picture(&renderer, &head, View::FRONT, weights).expect("a picture");
    let table = |view: &wgpu::TextureView| -> Vec<Vec4> {
        let bytes = stage.read(view.texture()).expect("a table");
        bytemuck::cast_slice(&bytes).iter().map(|&t: &[f32; 4]| t.into()).collect()
    };
    Some((table(&head.positions), table(&head.surfaces)))
}

/// Positions and normals as the passes computed them, skin first.
fn computed(name: &str, avatar: &Avatar, weights: &[f32]) -> Option<(Vec<Vec3>, Vec<Vec3>)> {
    let (positions, surfaces) = tables(name, avatar, weights)?;
    let directions = |table: Vec<Vec4>| table.into_iter().map(Vec4::truncate).collect();
    Some((directions(positions), directions(surfaces)))
}

#[test]
fn positions_are_neutral_plus_weighted_deltas() {
    let avatar = planted();
    let weights = [0.7, 1.3, 0.0];
    let name = "positions_are_neutral_plus_weighted_deltas";
    let Some((positions, _)) = computed(name, &avatar, &weights) else { return };
    let expected = avatar.meshes[0].posed(&weights.map(f64::from));
    for (v, (found, expected)) in positions.iter().zip(expected).enumerate() {
        let off = found.distance(expected.into());
        assert!(off < 1e-7, "vertex {v}: {off} m off");
    }
}

#[test]
fn eyeball_turns_rigidly_about_its_centre() {
    let avatar = planted();
    let name = "eyeball_turns_rigidly_about_its_centre";
    let Some((positions, _)) = computed(name, &avatar, &[0.0, 0.0, 0.5]) else { return };
    let skin = avatar.meshes[0].positions.len();
    let centre = Vec3::from(avatar.eyeballs[0].centre);
    let (sin, cos) = 0.3_f32.sin_cos();
    for (v, &p) in avatar.meshes[1].positions.iter().enumerate() {
        let arm = Vec3::from(p) - centre;
        let turned = Vec3::new(cos * arm.x + sin * arm.z, arm.y, cos * arm.z - sin * arm.x);
        let off = positions[skin + v].distance(centre + turned);
        assert!(off < 1e-7, "vertex {v}: {off} m off");
    }
}

#[test]
fn normals_follow_the_deformed_surface_across_the_seam() {
    let avatar = planted();
    let name = "normals_follow_the_deformed_surface_across_the_seam";
    let Some((positions, normals)) = computed(name, &avatar, &[1.0, 0.0, 0.0]) else { return };
    let columns = 2 * ROWS;
    for i in 1..ROWS {
        for j in 0..=columns {
            let v = i * (columns + 1) + j;
            // A grown sphere is a sphere: Max's weights give its normals exactly.
            let lean = normals[v].angle_between(positions[v]);
            assert!(lean < 2e-3, "vertex {v}: {lean} rad off");
        }
        let (first, last) = (i * (columns + 1), i * (columns + 1) + columns);
        assert_eq!(normals[first], normals[last], "the seam shows in row {i}");
    }
    // The upper half moved forward leaves a shelf: its normals are no sphere's.
    let Some((_, lifted)) = computed(name, &avatar, &[0.0, 1.0, 0.0]) else { return };
    assert!(normals.iter().zip(&lifted).any(|(a, b)| a.distance(*b) > 0.3));
}

#[test]
fn shadow_edge_spreads_over_coarse_triangles() {
    let name = "shadow_edge_spreads_over_coarse_triangles";
    let mut avatar = planted();
    // A ball between the key light and the front of the sphere, whose rows are 10 mm apart:
    // as wide as the light's own penumbra.
    let ball = sphere(Vec3::new(-0.06, 0.075, 0.1), 0.025);
    avatar.meshes.push(Mesh { part: Part::Hair, shapes: vec![SparseShape::default(); 3], ..ball });
    let Some((_, surfaces)) = tables(name, &avatar, &[0.0; 3]) else { return };
    let columns = 2 * ROWS;
    // The half of the sphere that faces the light, away from the eye.
    let key = Vec3::new(-0.4364, 0.5455, 0.7155);
    let lit = |v: &usize| surfaces[*v].truncate().dot(key) > 0.3;
    let (mut darkest, mut brightest, mut steepest) = (1.0_f32, 0.0_f32, 0.0_f32);
    for (i, j) in (2..ROWS - 2).flat_map(|i| (0..columns).map(move |j| (i, j))) {
        let at = |i: usize, j: usize| i * (columns + 1) + j;
        let here = at(i, j);
        for next in [at(i + 1, j), at(i, j + 1)].iter().filter(|v| lit(v) && lit(&here)) {
            let (a, b) = (surfaces[here].w, surfaces[*next].w);
            darkest = darkest.min(a);
            brightest = brightest.max(a);
            steepest = steepest.max((a - b).abs());
        }
    }
    assert!(brightest > 0.8, "nothing is lit: {brightest}");
    assert!(darkest < 0.3, "nothing is in shadow: {darkest}");
    assert!(steepest < 0.3, "a step of {steepest} from vertex to vertex");
    let (first, last) = (8 * (columns + 1), 8 * (columns + 1) + columns);
    assert_eq!(surfaces[first], surfaces[last], "the seam shows");
}

/// A half float, IEEE 754 binary16.
fn half(bits: u16) -> f32 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f32::from(bits & 0x3ff) / 1024.0);
    let size = match exponent {
        0 => fraction * 2_f32.powi(-14),
        _ => (1.0 + fraction) * 2_f32.powi(exponent - 15),
    };
    if bits >> 15 == 1 { -size } else { size }
}

#[test]
fn strains_are_those_of_the_planted_stretch() {
    let name = "strains_are_those_of_the_planted_stretch";
    let stage = match Offscreen::new(true) {
        Ok(stage) => stage,
        Err(error) => return mimique_test_support::skip(name, &error.to_string()),
    };
    let mut avatar = planted();
    // In place of the lift: pressed together along y by a fifth.
    let skin = &mut avatar.meshes[0];
    skin.shapes[1] = SparseShape {
        vertices: (0..skin.positions.len() as u32).collect(),
        deltas: skin.positions.iter().map(|p| [0.0, -0.2 * p[1], 0.0]).collect(),
    };
    let renderer = stage.renderer([16, 16], Look::STIMULUS);
    let head = renderer.load(&avatar).expect("the avatar loads");
    let strains = |weights: [f32; 3]| -> Vec<Vec3> {
        stage.picture(&renderer, &head, View::FRONT, &weights).expect("a picture");
        let bytes = stage.read(head.strains.texture()).expect("a table");
        let halves: &[[u16; 4]] = bytemuck::cast_slice(&bytes);
        halves.iter().map(|t| Vec3::new(half(t[0]), half(t[1]), half(t[2]))).collect()
    };
    let columns = 2 * ROWS;
    let rest = strains([0.0; 3]);
    let (grown, pressed) = (strains([1.0, 0.0, 0.0]), strains([0.0, 1.0, 0.0]));
    for i in 1..ROWS {
        for v in (0..columns).map(|j| i * (columns + 1) + j) {
            assert!(rest[v].abs().max_element() < 1e-3, "vertex {v} at rest: {}", rest[v]);
            // Grown by a tenth in all directions: (1.1^2 - 1) / 2 along each, nothing between them.
            let off = grown[v].distance(Vec3::new(0.105, 0.105, 0.0));
            assert!(off < 1e-3, "vertex {v}, grown: {}", grown[v]);
        }
    }
    // On the equator upwards is y: (0.8^2 - 1) / 2, and nothing across.
    for v in (0..columns).map(|j| ROWS / 2 * (columns + 1) + j) {
        let off = pressed[v].distance(Vec3::new(0.0, -0.18, 0.0));
        assert!(off < 5e-3, "vertex {v}, pressed: {}", pressed[v]);
    }
}

#[test]
fn a_head_turns_about_its_neck_and_its_shoulders_do_not() {
    let mut avatar = planted().with_head_pose_shapes();
    let mut body = sphere(Vec3::new(0.0, -0.60, 0.0), 0.08);
    body.part = Part::Other;
    body.shapes = vec![SparseShape::default(); avatar.shape_names.len()];
    avatar.meshes.push(body);
    let mut weights = vec![0.0; avatar.shape_names.len()];
    let name = "a_head_turns_about_its_neck_and_its_shoulders_do_not";
    let rest = computed(name, &avatar, &weights);
    // 10 degrees to the person's left.
    weights[avatar.shape_index("headTurn").unwrap()] = 1.0;
    let (Some((rest, _)), Some((turned, _))) = (rest, computed(name, &avatar, &weights)) else {
        return;
    };
    let skin = avatar.meshes[0].positions.len();
    // A turn keeps heights, and all above the chin turn by one angle about one vertical line.
    let foremost = (0..skin).max_by(|&a, &b| rest[a].z.total_cmp(&rest[b].z)).unwrap();
    assert!(turned[foremost].x > rest[foremost].x + 0.01, "to the person's left");
    let body: Vec<usize> = (0..rest.len()).filter(|&k| rest[k].y < -0.5).collect();
    assert!(body.len() == avatar.meshes[2].positions.len());
    assert!(body.iter().all(|&k| turned[k].distance(rest[k]) < 1e-6), "shoulders stay");
    for k in (0..skin).filter(|&k| rest[k].y > 0.02) {
        assert!((turned[k].y - rest[k].y).abs() < 1e-6);
        let apart = |of: &[Vec3]| of[k].distance(of[foremost]);
        assert!((apart(&turned) - apart(&rest)).abs() < 2e-6, "rigid: {k}");
    }
}
