//! Motion from weights, from dense takes, of several people, and of nobody.

use mimique_layout::{
    DenseTake, DenseTakeError, Face, FaceMotion, MotionSource, Take, TakeContent,
};
use mimique_test_support::Random;

use crate::support;

/// Frames of weights: one shape after the other, and some together.
fn weights(n: usize, frames: usize) -> Vec<f64> {
    let mut random = Random::new(5);
    (0..frames * n).map(|_| if random.uniform() < 0.2 { random.uniform() } else { 0.0 }).collect()
}

fn dense(name: &str, vertices: usize, positions: Vec<f32>) -> Take {
    let content = TakeContent::Dense(DenseTake { vertices, positions });
    Take { name: name.to_owned(), rate_hz: Some(60.0), content }
}

/// Positions of the welded skin for frames of weights; `more` moves vertices beside the shapes.
fn positions(face: &Face<'_>, weights: &[f64], more: impl Fn(usize, usize) -> f64) -> Vec<f32> {
    let n = face.shape_count();
    let mut out = Vec::new();
    for (f, row) in weights.chunks_exact(n).enumerate() {
        for v in 0..face.skin.mesh.positions.len() {
            for axis in 0..3 {
                let deltas = &face.deltas_of(v)[axis * n..(axis + 1) * n];
                let moved: f64 = deltas.iter().zip(row).map(|(d, w)| d * w).sum();
                let added = if axis == 2 { more(f, v) } else { 0.0 };
                out.push((face.place(v)[axis] + moved + added) as f32);
            }
        }
    }
    out
}

#[test]
fn a_dense_take_of_the_bank_is_its_weights() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let n = face.shape_count();
    let mut played = weights(n, 30);
    played[..n].fill(0.0);
    let take = dense("scan", skin.mesh.positions.len(), positions(&face, &played, |_, _| 0.0));
    let motion = FaceMotion::of(&face, &[take], &[]).unwrap();
    assert_eq!(motion.basis.width, n, "nothing is left beside the shapes");
    let of_weights = Take {
        name: "weights".to_owned(),
        rate_hz: None,
        content: TakeContent::Weights(played.clone()),
    };
    let known = FaceMotion::of(&face, &[of_weights], &[]).unwrap();
    // Shapes that depend on each other may share their motion: what counts is where vertices go.
    for v in (0..skin.mesh.positions.len()).step_by(97) {
        for (a, b) in motion.frames().zip(known.frames()) {
            let (a, b) = (motion.basis.displacement(v, a), known.basis.displacement(v, b));
            assert!((a - b).length() < 2e-6, "{v}: {a:?} {b:?}");
        }
    }
}

#[test]
fn what_no_shape_does_becomes_modes() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let n = face.shape_count();
    let mut played = weights(n, 40);
    played[..n].fill(0.0);
    let count = skin.mesh.positions.len();
    // A vein that no shape knows, 2 mm, around the middle of the forehead.
    let centre = face.landmarks.glabella;
    let vein = |f: usize, v: usize| {
        let near = (face.place(v) - centre).length() / 0.012;
        2e-3 * (-near * near).exp() * (f as f64 / 6.0).sin()
    };
    let take = dense("scan", count, positions(&face, &played, vein));
    let motion = FaceMotion::of(&face, &[take], &[]).unwrap();
    assert!(motion.basis.width > n, "no mode was found");
    assert!(motion.basis.width < n + 6, "{} modes for one motion", motion.basis.width - n);
    let mut worst: f64 = 0.0;
    for v in (0..count).filter(|&v| (face.place(v) - centre).length() < 0.015) {
        for (f, row) in motion.frames().enumerate() {
            let along = |axis: usize| -> f64 {
                let deltas = &face.deltas_of(v)[axis * n..(axis + 1) * n];
                deltas.iter().zip(&played[f * n..(f + 1) * n]).map(|(d, w)| d * w).sum()
            };
            let found = motion.basis.displacement(v, row);
            let rest = (found.x - along(0)).hypot(found.y - along(1));
            worst = worst.max(rest.hypot(found.z - along(2) - vein(f, v)));
        }
    }
    assert!(worst < 1e-4, "{worst}");
}

#[test]
fn another_mesh_and_numbers_that_are_none_are_refused() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let count = skin.mesh.positions.len();
    let other = dense("scan", 500, vec![0.0; 1500]);
    let refused = FaceMotion::of(&face, &[other], &[]).unwrap_err();
    assert!(
        matches!(refused, DenseTakeError::Topology { found: 500, welded, .. } if welded == count)
    );
    assert!(refused.to_string().contains("500 vertices in a frame"), "{refused}");
    let mut broken = positions(&face, &vec![0.0; 2 * face.shape_count()], |_, _| 0.0);
    broken[3 * count + 5] = f32::NAN;
    let refused = FaceMotion::of(&face, &[dense("scan", count, broken)], &[]).unwrap_err();
    assert!(matches!(refused, DenseTakeError::Frame { frame: 1, .. }), "{refused}");
}

#[test]
fn several_people_count_alike_whatever_the_length_of_their_takes() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let (long, short) = (support::range(&skin, "a", 1), support::range(&skin, "b", 2));
    let TakeContent::Weights(all) = &short.content else { panic!("weights") };
    let n = face.shape_count();
    let half = all[..all.len() / n / 2 * n].to_vec();
    let cut = Take { content: TakeContent::Weights(half), ..short };
    let of = |takes: &[Take]| FaceMotion::of(&face, takes, &[]).unwrap().second_moment();
    let (one, two, both) =
        (of(std::slice::from_ref(&long)), of(std::slice::from_ref(&cut)), of(&[long, cut]));
    for ((a, b), c) in one.iter().zip(&two).zip(&both) {
        assert!((0.5 * (a + b) - c).abs() < 1e-12);
    }
}

#[test]
fn without_motion_every_shape_counts_by_itself_and_rested_ones_do_not() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let motion = FaceMotion::of(&face, &[], &[3]).unwrap();
    assert_eq!(motion.source, MotionSource::IndependentShapes);
    let n = face.shape_count();
    let prior = motion.prior();
    for i in 0..n {
        for j in 0..n {
            let wanted = if i != j {
                0.0
            } else if i == 3 {
                0.02 * 0.02
            } else {
                0.0625
            };
            assert!((prior[i * n + j] - wanted).abs() < 1e-15);
        }
    }
    assert!(motion.telling_frames(24).iter().all(|frame| frame[3] == 0.0));
    // With motion the frames of a rested shape are still.
    let rested = FaceMotion::of(&face, &[support::range(&skin, "a", 1)], &[3]).unwrap();
    assert!(rested.frames().all(|frame| frame[3] == 0.0));
    assert!(rested.top_speed(&[0]).is_some() && motion.top_speed(&[0]).is_none());
}
