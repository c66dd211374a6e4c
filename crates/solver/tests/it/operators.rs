//! Laplacian, thin shell, D, H and their scales against closed forms; `mimique verify` holds them
//! against stored matrices.

use mimique_geometry::{Displacement, Point};
use mimique_solver::{
    Laplacian, LaplacianKind, OperatorOptions, OperatorParts, Operators, SkinMesh, SparseDeltas,
    VertexAssociation, apply_shell, mixed_voronoi_areas, shell_gram,
};
use mimique_test_support::real_data;

use crate::support;

/// A width x height grid in the plane, each square cut along the same diagonal.
fn grid(width: usize, height: usize) -> (Vec<Point>, Vec<[u32; 3]>) {
    let at = |x: usize, y: usize| (y * width + x) as u32;
    let positions = (0..width * height)
        .map(|i| Point::new((i % width) as f64, (i / width) as f64, 0.0))
        .collect();
    let triangles = (0..(width - 1) * (height - 1))
        .flat_map(|i| {
            let (x, y) = (i % (width - 1), i / (width - 1));
            [[at(x, y), at(x + 1, y), at(x + 1, y + 1)], [at(x, y), at(x + 1, y + 1), at(x, y + 1)]]
        })
        .collect();
    (positions, triangles)
}

/// Vertices two rings inside the border.
fn inside(width: usize, height: usize) -> impl Iterator<Item = usize> {
    (0..width * height).filter(move |i| {
        let (x, y) = (i % width, i / width);
        x >= 2 && y >= 2 && x + 2 < width && y + 2 < height
    })
}

#[test]
fn shell_of_an_affine_field_vanishes_inside() {
    let (p, t) = grid(12, 10);
    let l = Laplacian::new(&p, &t, LaplacianKind::Uniform);
    let field: Vec<f64> = p.iter().map(|p| 3.0 * p[0] - 2.0 * p[1] + 7.0).collect();
    let a = apply_shell(&l, 1.0, 1.0, &field);
    assert!(inside(12, 10).all(|i| a[i].abs() < 1e-12));
}

#[test]
fn shell_of_a_wave_has_the_closed_eigenvalue() {
    let (p, t) = grid(14, 13);
    let l = Laplacian::new(&p, &t, LaplacianKind::Uniform);
    for [kx, ky] in [[0.3_f64, 0.2_f64], [1.1, -0.7], [2.0, 1.3]] {
        let field: Vec<f64> = p.iter().map(|p| (kx * p[0] + ky * p[1]).cos()).collect();
        let lambda = 2.0 * kx.cos() + 2.0 * ky.cos() + 2.0 * (kx + ky).cos() - 6.0;
        let a = apply_shell(&l, 1.0, 1.0, &field);
        for i in inside(14, 13) {
            // The sign matters: with k_s L instead of -k_s L this is off by 2 lambda.
            let error = (a[i] - (-lambda + lambda * lambda) * field[i]).abs();
            // The entries of a row of A add up to some 100 in size: 1e-13 is their rounding.
            assert!(error < 1e-13, "vertex {i}: {error:e}");
        }
    }
}

#[test]
fn cotangent_laplacian_of_an_affine_field_on_a_plane_vanishes() {
    let (mut p, t) = grid(9, 9);
    for (i, p) in p.iter_mut().enumerate() {
        p[0] += 0.3 * ((i * 37 % 11) as f64 / 11.0 - 0.5);
        p[1] += 0.3 * ((i * 53 % 13) as f64 / 13.0 - 0.5);
    }
    let l = Laplacian::cotangent_over_areas(&p, &t);
    let field: Vec<f64> = p.iter().map(|p| 0.4 * p[0] + 1.7 * p[1] - 3.0).collect();
    let lf = l.apply(&field);
    assert!((0..81).filter(|i| i % 9 % 8 != 0 && i / 9 % 8 != 0).all(|i| lf[i].abs() < 1e-13));
    let total: f64 = mixed_voronoi_areas(&p, &t).iter().sum();
    let surface: f64 = t.iter().map(|t| area(t.map(|v| p[v as usize]))).sum();
    assert!((total - surface).abs() < 1e-12 * surface);
}

#[test]
fn cotangent_laplacian_of_a_sphere_is_its_curvature() {
    let radius = 2.5;
    let (p, t) = sphere(radius, 3);
    let l = Laplacian::cotangent_over_areas(&p, &t);
    for axis in 0..3 {
        let field: Vec<f64> = p.iter().map(|p| p[axis]).collect();
        let lf = l.apply(&field);
        for (i, p) in p.iter().enumerate() {
            let expected = -2.0 * p[axis] / (radius * radius);
            assert!((lf[i] - expected).abs() < 0.03 * 2.0 / radius, "{} for {expected}", lf[i]);
        }
    }
    let total: f64 = mixed_voronoi_areas(&p, &t).iter().sum();
    let surface: f64 = t.iter().map(|t| area(t.map(|v| p[v as usize]))).sum();
    assert!((total - surface).abs() < 1e-12 * surface);
}

#[test]
fn clamped_cotangent_rows_are_means() {
    let (p, t) = sphere(1.0, 2);
    let l = Laplacian::new(&p, &t, LaplacianKind::CotanClamped);
    for i in 0..p.len() {
        assert!((l.row(i).map(|(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-14);
        assert!(l.row(i).all(|(_, w)| (0.0..=1.0).contains(&w)));
    }
}

#[test]
fn energy_of_a_translation_is_zero_and_of_a_rotation_is_not() {
    let (p, t) = sphere(0.1, 2);
    let shape = |delta: &dyn Fn(Point) -> [f64; 3]| SparseDeltas {
        vertices: (0..p.len() as u32).collect(),
        deltas: p.iter().map(|&p| delta(p).into()).collect(),
    };
    let shapes = vec![
        shape(&|_| [0.01, -0.02, 0.03]),
        shape(&|p| [-0.1 * p[1], 0.1 * p[0], 0.0]),
        shape(&|p| p.to_array().map(|x| 0.1 * x)),
    ];
    let mesh = SkinMesh { positions: p, triangles: t, shapes };
    let l = Laplacian::new(&mesh.positions, &mesh.triangles, LaplacianKind::Uniform);
    let h = shell_gram(&mesh, &l, 1.0, 1.0, &[]);
    assert!(h[0].abs() < 1e-30);
    assert!(h[4] > 1e-6 && h[8] > 1e-6, "{h:?}");
}

#[test]
fn welding_closes_the_seams_of_an_exported_head() {
    let Some(data) = real_data("welding_closes_the_seams_of_an_exported_head") else { return };
    let (mesh, _) = support::read_skin(&data.join("ict-facekit/ict-facekit.glb"));
    // 11,925 vertices in the file; every place holds one vertex afterwards.
    let mut places: Vec<[u64; 3]> =
        mesh.positions.iter().map(|p| p.to_array().map(|x| (x + 0.0).to_bits())).collect();
    places.sort_unstable();
    places.dedup();
    assert_eq!((mesh.positions.len(), places.len()), (11_382, 11_382));
}

#[test]
fn welding_keeps_touching_lips_apart() {
    let mesh = SkinMesh {
        positions: points([
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, -1.0, -0.0],
        ]),
        triangles: vec![[0, 1, 2], [3, 5, 4]],
        shapes: vec![SparseDeltas {
            vertices: vec![0, 1],
            deltas: vec![Displacement::ZERO, Displacement::new(0.1, 0.0, 0.0)],
        }],
    };
    let welded = mesh.weld().unwrap();
    // 0 and 3 are one (a delta of 0 is none), 1 and 4 move differently.
    assert_eq!(welded.index_of, [0, 1, 2, 0, 3, 4]);
    assert_eq!(welded.mesh.triangles, [[0, 1, 2], [0, 4, 3]]);
    assert_eq!(welded.mesh.shapes[0].vertices, [1]);
}

/// An exporter rounds the deltas of a seam's two sides each by itself.
#[test]
fn welding_closes_a_seam_whose_deltas_differ_in_the_last_bit() {
    let next = |x: f64| f64::from(f32::from_bits((x as f32).to_bits() + 1));
    let mesh = |other: f64| SkinMesh {
        positions: points([
            [0.0; 3],
            [0.1, 0.0, 0.0],
            [0.0, 0.2, 0.0],
            [0.0; 3],
            [0.1, 0.0, 0.0],
            [0.0, -0.2, 0.0],
        ]),
        triangles: vec![[0, 1, 2], [3, 5, 4]],
        shapes: vec![
            SparseDeltas {
                vertices: vec![1, 4],
                deltas: [[0.01, 0.0, 0.02], [0.01, 0.0, other]].map(Displacement::from).to_vec(),
            },
            // What one side rounds to nothing is no movement of the other.
            SparseDeltas { vertices: vec![4], deltas: vec![Displacement::new(0.0, 1e-12, 0.0)] },
        ],
    };
    let close = mesh(next(0.02)).weld().unwrap();
    assert!(next(0.02) != 0.02 && (next(0.02) - 0.02).abs() < 1e-8);
    assert_eq!(close.index_of, [0, 1, 2, 0, 1, 3]);
    assert_eq!(close.mesh.triangles, [[0, 1, 2], [0, 3, 1]]);
    // The first of the twins counts, with the bits that it has.
    assert_eq!(close.mesh.shapes[0].deltas, [[0.01, 0.0, 0.02]]);
    // A micrometre on 0.41 m is more than a millionth: such a seam is meant.
    let open = mesh(0.02 + 1e-6).weld().unwrap();
    assert_eq!(open.index_of, [0, 1, 2, 0, 3, 4]);
}

#[test]
fn wrong_meshes_and_parts_are_refused_in_words() {
    let mut mesh = SkinMesh {
        positions: points([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
        triangles: vec![[0, 1, 7]],
        shapes: vec![SparseDeltas { vertices: vec![1], deltas: vec![[0.1; 3].into()] }],
    };
    let say = |mesh: &SkinMesh, names: &[&str], marker: usize| {
        let names: Vec<String> = names.iter().map(|n| (*n).to_owned()).collect();
        let markers = [("M0".to_owned(), marker)];
        Operators::build(mesh, &names, &markers, &OperatorOptions::default())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(say(&mesh, &["a"], 1), "skin, triangle 0: vertex 7 of 3; re-export the mesh");
    mesh.triangles = vec![[0, 1, 2]];
    assert_eq!(say(&mesh, &["a"], 9), "marker M0: vertex 9 of 3; correct the marker map");
    assert_eq!(say(&mesh, &[], 1), "shape names: 0 of them, 1 expected; name every shape");
    assert_eq!(
        say(&mesh, &["a"], 2),
        "the motion of all shapes at all markers is 0; place markers where the blendshapes move \
         the skin"
    );
    mesh.shapes[0].deltas[0][1] = f64::NAN;
    assert_eq!(
        say(&mesh, &["a"], 1),
        "skin, blendshape 0: a number is not finite; re-export the mesh"
    );
}

#[test]
fn parts_restore_the_same_bits() {
    let Some(data) = real_data("parts_restore_the_same_bits") else { return };
    let options = OperatorOptions {
        association: Some(VertexAssociation::Zones { sigma: 0.012 }),
        ..OperatorOptions::default()
    };
    let built = support::operators(&data, &options);
    let parts: OperatorParts = built.parts().clone();
    let restored = Operators::from_parts(parts).unwrap();
    assert_eq!(restored.data_scale().to_bits(), built.data_scale().to_bits());
    assert_eq!(restored.shell_scale().to_bits(), built.shell_scale().to_bits());
    let mut short = built.parts().clone();
    short.shell_gram.pop();
    let error = Operators::from_parts(short).unwrap_err().to_string();
    assert_eq!(
        error,
        "numbers of H: 2808 of them, 2809 expected; build the operators again from the avatar"
    );
}

fn points<const N: usize>(places: [[f64; 3]; N]) -> Vec<Point> {
    places.map(Point::from).to_vec()
}

fn area([a, b, c]: [Point; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// An octahedron cut in four `levels` times and pushed out to the sphere.
fn sphere(radius: f64, levels: usize) -> (Vec<Point>, Vec<[u32; 3]>) {
    let mut points: Vec<[f64; 3]> = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let mut triangles: Vec<[u32; 3]> = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    for _ in 0..levels {
        let mut middle = std::collections::BTreeMap::new();
        let mut finer = Vec::new();
        for t in triangles {
            let m: [u32; 3] = std::array::from_fn(|k| {
                let (a, b) = (t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3]));
                *middle.entry((a, b)).or_insert_with(|| {
                    let sum: [f64; 3] =
                        std::array::from_fn(|x| points[a as usize][x] + points[b as usize][x]);
                    let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                    points.push(sum.map(|x| x / length));
                    (points.len() - 1) as u32
                })
            });
            finer.extend([[t[0], m[0], m[2]], [t[1], m[1], m[0]], [t[2], m[2], m[1]], m]);
        }
        triangles = finer;
    }
    (points.iter().map(|p| p.map(|x| radius * x).into()).collect(), triangles)
}
