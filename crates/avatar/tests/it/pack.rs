//! The avatar pack: what goes in comes out, within the bound; damage is refused, never a panic.

use mimique_actor::{Density, HeadSpec, build_head};
use mimique_avatar::pack::{decode_pack, encode_pack};
use mimique_avatar::{Avatar, Eyeball, Look, Mesh, Part, SparseShape, Texture, Textured};
use proptest::prelude::*;

/// A curved sheet with `n` shapes, and a ball that turns.
fn avatar(width: u32, height: u32, n: usize, size: f32) -> Avatar {
    let at = |v: u32| ((v % width) as f32, (v / width) as f32);
    let positions: Vec<[f32; 3]> = (0..width * height)
        .map(|v| {
            let (x, y) = at(v);
            [x * 0.003, y * 0.004, 0.02 * (0.3 * x).sin() + 0.01 * (0.2 * y).cos()]
        })
        .collect();
    let mut triangles = Vec::new();
    for v in (0..width * (height - 1)).filter(|v| v % width + 1 < width) {
        triangles.extend([[v, v + 1, v + width + 1], [v, v + width + 1, v + width]]);
    }
    let shapes = (0..n)
        .map(|k| {
            let dense: Vec<[f32; 3]> = (0..width * height)
                .map(|v| {
                    let (x, y) = at(v);
                    let far = (x - 3.0 * k as f32).powi(2) + (y - 2.0).powi(2);
                    let d = if far > 60.0 { 0.0 } else { size * (-far / 20.0).exp() };
                    [d, -0.5 * d, 0.1 * d * (x * 1.7).sin()]
                })
                .collect();
            SparseShape::from_dense(&dense)
        })
        .collect();
    let vertex_colours = positions.iter().map(|p| p.map(|x| x.abs().min(1.0))).collect();
    let skin = Mesh {
        name: "skin".into(),
        part: Part::Skin,
        positions: positions.clone(),
        triangles,
        vertex_colours,
        base_colour: [0.8, 0.6, 0.5],
        shapes,
        uvs: positions.iter().map(|p| [p[0] * 30.0, -p[1] * 20.0]).collect(),
        textured: vec![
            Textured { triangles: 2..5, texture: 1 },
            Textured { triangles: 9..11, texture: 0 },
        ],
    };
    let eye = Mesh {
        name: "eye".into(),
        part: Part::EyeLeft,
        positions: positions[..4].to_vec(),
        triangles: vec![[0, 1, 2], [1, 3, 2]],
        shapes: vec![SparseShape::default(); n],
        ..Mesh::default()
    };
    let looks = vec![Look { shape: n - 1, axis: [-1.0, 0.0, 0.0], radians: 0.4 }];
    Avatar {
        name: "Sheet \u{e9}".into(),
        shape_names: (0..n).map(|k| format!("shape{k}")).collect(),
        meshes: vec![skin, eye],
        eyeballs: vec![Eyeball { mesh: 1, centre: [0.03, 0.02, 0.01], looks }],
        textures: vec![
            Texture { jpeg: vec![1, 2, 3], mask_jpeg: vec![] },
            Texture { jpeg: vec![4; 300], mask_jpeg: vec![5] },
        ],
        expressions: Vec::new(),
    }
}

/// The largest distance between two poses of two avatars.
fn apart(a: &Avatar, b: &Avatar, weights: &[f64]) -> f64 {
    let mut most = 0f64;
    for (a, b) in a.meshes.iter().zip(&b.meshes) {
        for (p, q) in a.posed(weights).iter().zip(&b.posed(weights)) {
            let square: f64 = (0..3).map(|k| f64::from(p[k] - q[k]).powi(2)).sum();
            most = most.max(square.sqrt());
        }
    }
    most
}

#[test]
fn everything_but_rounding_comes_back() {
    let avatar = avatar(23, 17, 7, 0.03);
    let pack = encode_pack(&avatar);
    assert_eq!(encode_pack(&avatar).bytes, pack.bytes, "the same avatar, the same bytes");
    let back = decode_pack(&pack.bytes).unwrap();
    assert_eq!(back.name, avatar.name);
    assert_eq!(back.shape_names, avatar.shape_names);
    assert_eq!(back.eyeballs, avatar.eyeballs);
    assert_eq!(back.textures, avatar.textures);
    assert_eq!(back.meshes[0].textured, avatar.meshes[0].textured);
    for (p, q) in back.meshes[0].uvs.iter().zip(&avatar.meshes[0].uvs) {
        assert!((0..2).all(|a| (p[a] - q[a]).abs() < 4e-5), "{p:?} {q:?}");
    }
    for (a, b) in avatar.meshes.iter().zip(&back.meshes) {
        assert_eq!((&a.name, a.part, &a.triangles), (&b.name, b.part, &b.triangles));
        assert_eq!(a.base_colour, b.base_colour);
        for (p, q) in a.vertex_colours.iter().zip(&b.vertex_colours) {
            assert!((0..3).all(|k| (p[k] - q[k]).abs() < 0.004), "{p:?} {q:?}");
        }
    }
    assert!(pack.error_bound <= 1e-5);
    for k in 0..7 {
        let mut weights = vec![0.0; 7];
        weights[k] = 1.0;
        // Poses are summed in single precision: 2e-8 m of their own rounding.
        assert!(apart(&avatar, &back, &weights) <= pack.error_bound + 2e-8);
    }
    assert!(apart(&avatar, &back, &[1.0; 7]) <= pack.error_bound + 1e-7);
}

#[test]
fn large_motions_and_loose_vertices_are_kept() {
    let mut big = avatar(9, 9, 2, 40.0);
    // A vertex that no triangle uses, a mesh without triangles, a mesh without vertices.
    big.meshes[0].positions.push([0.5, -0.5, 0.25]);
    big.meshes[0].vertex_colours.clear();
    let shapes = vec![SparseShape::default(); 2];
    let points = Mesh { positions: vec![[1.0; 3]], shapes: shapes.clone(), ..Mesh::default() };
    big.meshes.push(points);
    big.meshes.push(Mesh { shapes, ..Mesh::default() });
    let pack = encode_pack(&big);
    let back = decode_pack(&pack.bytes).unwrap();
    assert_eq!(back.meshes.len(), 4);
    assert!(apart(&big, &back, &[1.0, 1.0]) < 1e-4);
}

#[test]
fn another_kind_or_version_is_refused() {
    let bytes = encode_pack(&avatar(5, 5, 1, 0.01)).bytes;
    for (at, value, says) in [(0, b'X', "opens with"), (4, 9, "version 9"), (8, 1, "inflated")] {
        let mut damaged = bytes.clone();
        damaged[at] = value;
        let error = decode_pack(&damaged).unwrap_err().to_string();
        assert!(error.contains(says) || error.contains("body"), "{error}");
    }
    assert!(decode_pack(&[]).is_err());
}

/// A pack around a body, so that damage goes past its length.
fn sealed(body: &[u8]) -> Vec<u8> {
    let mut bytes = mimique_avatar::pack::seal_plain("MMAV", 4, body);
    bytes.extend([0; 4]);
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn damage_is_refused_or_harmless(at in 0usize..4000, value: u8, cut: bool) {
        let bytes = encode_pack(&avatar(8, 7, 3, 0.02)).bytes;
        // Behind the body lie pictures of 304 bytes, four lengths and their number.
        let sealed_end = bytes.len() - 304 - 16 - 4;
        let body = mimique_avatar::pack::open_plain("MMAV", 4, &bytes[..sealed_end]).unwrap().to_vec();
        for whole in [bytes, body] {
            let mut damaged = whole.clone();
            let at = at % damaged.len();
            if cut { damaged.truncate(at) } else { damaged[at] = value }
            let _ = decode_pack(&damaged);
            if let Ok(avatar) = decode_pack(&sealed(&damaged)) {
                // What is let through is whole: no index leads outside.
                for mesh in &avatar.meshes {
                    let count = mesh.positions.len() as u32;
                    prop_assert!(mesh.triangles.iter().flatten().all(|v| *v < count));
                    prop_assert_eq!(mesh.shapes.len(), avatar.shape_names.len());
                    let _ = mesh.posed(&vec![1.0; mesh.shapes.len()]);
                }
            }
        }
    }

    #[test]
    fn noise_is_refused(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        prop_assert!(decode_pack(&bytes).is_err());
        let _ = decode_pack(&sealed(&bytes));
    }
}

/// The built-in head, small.
fn head() -> Avatar {
    let spec = HeadSpec { density: Density::COARSE, ..HeadSpec::default() };
    build_head(&spec)
}

#[test]
fn no_pose_of_a_head_is_further_off_than_the_pack_says() {
    let head = head();
    let pack = encode_pack(&head);
    let back = decode_pack(&pack.bytes).unwrap();
    assert!(pack.error_bound <= 1e-5, "{}", pack.error_bound);
    let mut seed = 1u32;
    let mut most = 0f64;
    for pose in 0..40 {
        let mut weight = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let w = f64::from(seed >> 8) / f64::from(1 << 24);
            // Half of the poses at the corners, where the bound is met.
            if pose % 2 == 0 { w.round() } else { w }
        };
        let weights: Vec<f64> = head.shape_names.iter().map(|_| weight()).collect();
        most = most.max(apart(&head, &back, &weights));
    }
    // Poses are summed in single precision: 1e-7 m of their own rounding.
    assert!(most <= pack.error_bound + 1e-7, "{most}");
    assert!(most > 1e-6, "nothing was rounded: {most}");
}

#[test]
fn the_other_half_of_a_face_costs_little() {
    let head = head();
    let whole = encode_pack(&head).bytes.len() as f64;
    let changed = |change: &dyn Fn(usize, &mut [f32; 3])| {
        let mut changed = head.clone();
        for mesh in &mut changed.meshes {
            for (v, p) in mesh.positions.iter_mut().enumerate() {
                change(v, p);
            }
            for shape in &mut mesh.shapes {
                for (&v, d) in shape.vertices.iter().zip(&mut shape.deltas) {
                    change(v as usize, d);
                }
            }
        }
        encode_pack(&changed).bytes.len() as f64
    };
    // Half of its vertices moved to where no other is the image, a tenth of a millimetre about.
    let scatter = |v: usize, p: &mut [f32; 3]| {
        if p[0] < 0.0 {
            p[1] += 2e-4 * ((v as f32 * 0.7).sin() + 0.5 * p[0].signum());
        }
    };
    let alone = changed(&scatter);
    assert!(whole < 0.7 * alone, "{whole} and {alone} bytes");

    // The mirror need not stand at 0: the first mesh says where it is.
    let mut beside = head.clone();
    for mesh in &mut beside.meshes {
        mesh.positions.iter_mut().for_each(|p| p[0] += 0.25);
    }
    let beside = encode_pack(&beside).bytes.len() as f64;
    assert!(beside < 1.1 * whole, "{beside} and {whole} bytes");
}

#[test]
fn shapes_find_their_twins_in_any_order() {
    let head = head();
    let mut turned = head.clone();
    for mesh in &mut turned.meshes {
        mesh.shapes.reverse();
    }
    let (a, b) = (encode_pack(&head), encode_pack(&turned));
    let ratio = a.bytes.len() as f64 / b.bytes.len() as f64;
    assert!((0.95..1.05).contains(&ratio), "{ratio}");
    let (a, b) = (decode_pack(&a.bytes).unwrap(), decode_pack(&b.bytes).unwrap());
    for (a, b) in a.meshes.iter().zip(&b.meshes) {
        assert_eq!(a.positions, b.positions);
        assert!(a.shapes.iter().eq(b.shapes.iter().rev()));
    }
}
