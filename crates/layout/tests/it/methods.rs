//! Every method gives as many markers as are wanted, apart, in pairs, the same from any number of threads.

use mimique_layout::{
    Camera, Candidates, Choice, Distance, Face, FaceMotion, LayoutError, Method, Spacing, Units,
    Where, choose_heads, mixed,
};
use rayon::ThreadPoolBuilder;

use crate::support::{self, Ground};

fn choice(face: &Face<'_>) -> Choice {
    let rehearse = mimique_layout::RehearseOptions { clusterings: 2, rounds: 1 };
    Choice { rehearse, start: mixed(face).vertices, ..Choice::default() }
}

#[test]
fn every_method_gives_the_number_apart_and_in_pairs() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    for (symmetric, count) in [(true, 21), (false, 16)] {
        let units = ground.units(symmetric, &[], 0.008);
        for method in Method::ALL {
            let chosen = method.choose(&ground.task(&units), count, &choice(&face)).unwrap();
            let vertices = chosen.vertices();
            assert_eq!(vertices.len(), count, "{method}");
            let mut each = vertices.clone();
            each.sort_unstable();
            each.dedup();
            assert_eq!(each.len(), count, "{method}: a vertex twice");
            if method == Method::Reduce {
                continue; // What it thins was put by others.
            }
            for (i, &a) in vertices.iter().enumerate() {
                assert!(ground.candidates.vertices.contains(&a), "{method}");
                assert!(units.spacing.apart_from_all(a, &vertices[..i]), "{method}");
            }
            for unit in chosen.units.iter().filter(|unit| unit.len() == 2) {
                assert_eq!(face.mirror.of[unit[0]], unit[1], "{method}");
            }
            let alone = chosen.units.iter().filter(|unit| unit.len() == 1);
            let off = |v: usize| face.mirror.from_middle[v] != 0.0;
            assert!(!symmetric || alone.clone().all(|unit| !off(unit[0])), "{method}");
        }
    }
}

#[test]
fn threads_change_nothing() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let layouts = |threads: usize| -> Vec<Vec<usize>> {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let ground = Ground::of(&face);
            let units = ground.units(true, &[], 0.008);
            [Method::Rehearse, Method::Kmeans, Method::Greedy, Method::Reduce]
                .iter()
                .map(|method| {
                    let task = ground.task(&units);
                    method.choose(&task, 18, &choice(&face)).unwrap().vertices()
                })
                .collect()
        })
    };
    let one = layouts(1);
    assert_eq!(one, layouts(3));
    assert_ne!(one[1], one[2], "K-means and greedy choose differently");
}

#[test]
fn a_crowded_face_is_packed_and_more_than_fits_is_refused() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let units = ground.units(true, &[], 0.030);
    let refused =
        |count: usize| Method::Farthest.choose(&ground.task(&units), count, &choice(&face));
    let Err(LayoutError::TooMany { fit, wanted: 60, millimetres }) = refused(60) else {
        panic!("60 markers 30 mm apart fit on no face")
    };
    assert!((5..40).contains(&fit), "{fit}");
    assert!((millimetres - 30.0).abs() < 1e-9);
    let text = refused(60).unwrap_err().to_string();
    assert!(text.starts_with(&format!("markers: {fit} of 60 fit at 30 mm; ")), "{text}");
    // As many as it says do fit, by every method.
    for method in [Method::Farthest, Method::Greedy, Method::Kmeans] {
        let found = method.choose(&ground.task(&units), fit, &choice(&face)).unwrap().vertices();
        assert_eq!(found.len(), fit, "{method}");
        for (i, &v) in found.iter().enumerate() {
            assert!(units.spacing.apart_from_all(v, &found[..i]), "{method}");
        }
    }
}

#[test]
fn kept_markers_stay_first_and_others_keep_away_from_them() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let free = ground.units(true, &[], 0.008);
    let kept = Method::Farthest.choose(&ground.task(&free), 6, &choice(&face)).unwrap().vertices();
    let units = ground.units(true, &kept, 0.008);
    for method in [Method::Kmeans, Method::Greedy, Method::Qr, Method::Shell, Method::Farthest] {
        let found = method.choose(&ground.task(&units), 15, &choice(&face)).unwrap().vertices();
        assert_eq!((&found[..6], found.len()), (&kept[..], 15), "{method}");
        for (i, &v) in found.iter().enumerate().skip(6) {
            assert!(units.spacing.apart_from_all(v, &found[..i]), "{method}");
        }
    }
    let fewer = Method::Greedy.choose(&ground.task(&units), 5, &choice(&face));
    assert!(matches!(fewer, Err(LayoutError::Kept { .. })));
}

#[test]
fn thinning_keeps_what_it_was_given_and_loses_least() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let units = ground.units(true, &[], 0.008);
    let start = mixed(&face).vertices;
    let found = Method::Reduce.choose(&ground.task(&units), 30, &choice(&face)).unwrap().vertices();
    assert!(found.iter().all(|v| start.contains(v)));
    let error = |vertices: &[usize]| ground.rehearsal.mean_square(vertices).unwrap();
    // Better than leaving out every other one.
    let other: Vec<usize> = start.iter().copied().take(30).collect();
    assert!(error(&found) < error(&other));
    let more = Choice { start: start[..10].to_vec(), ..Choice::default() };
    let refused = Method::Reduce.choose(&ground.task(&units), 30, &more);
    assert!(matches!(refused, Err(LayoutError::Kept { .. })));
}

#[test]
fn distances_hold_at_rest_and_in_the_frames_of_the_motion() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let vertices = &ground.candidates.vertices;
    let moving = Spacing::of(&face, &ground.motion, vertices, 0.008);
    let still = Spacing::at_rest(&face, 0.008);
    // Lips that touch when the mouth is shut by a shape, or any other pair that closes up in motion.
    let (mut closed, mut checked) = (0, 0);
    let frames: Vec<&[f64]> = ground.motion.frames().collect();
    for (i, &a) in vertices.iter().enumerate().step_by(7) {
        for &b in vertices[..i].iter().step_by(5) {
            let rest = (face.place(a) - face.place(b)).length();
            assert_eq!(still.apart(a, b), rest >= 0.008);
            if !(0.008..0.016).contains(&rest) || checked > 400 {
                continue;
            }
            checked += 1;
            let basis = &ground.motion.basis;
            let nearest = frames.iter().step_by(4).map(|frame| {
                let p = face.place(a) + basis.displacement(a, frame);
                (p - (face.place(b) + basis.displacement(b, frame))).length()
            });
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            if nearest < 0.0079 {
                closed += 1;
                // The frames that are held against are the largest of each shape and some between.
                assert!(!moving.apart(a, b) || nearest > 0.006, "{nearest}");
            }
            assert!(!moving.apart(a, b) || still.apart(a, b));
        }
    }
    assert!(closed > 5, "{closed} pairs close up in motion");
}

#[test]
fn a_camera_and_a_diameter_give_a_distance() {
    let camera = Camera { distance: 1.5, focal_length: 0.016, pixel: 5.5e-6 };
    let seen = |diameter: f64, camera| Distance::Seen { diameter, camera }.metres();
    // Two diameters, where they are more than a diameter and three pixels of 0.516 mm.
    assert!((seen(0.004, Some(camera)) - 0.008).abs() < 1e-12);
    assert!((seen(0.001, Some(camera)) - (0.001 + 3.0 * 0.000_515_625)).abs() < 1e-12);
    assert!((seen(0.004, None) - 0.008).abs() < 1e-12);
    assert!((Distance::Given(0.005).metres() - 0.005).abs() < 1e-12);
}

#[test]
fn what_cannot_be_is_refused_with_numbers() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let spacing = || Spacing::at_rest(&face, 0.008);
    let of = |place: &Where| Candidates::of(&face, place);
    let nowhere = of(&Where { only: Some(vec![0]), ..Where::default() });
    let refused = Units::of(&face, &nowhere, spacing(), true, &[]).unwrap_err();
    assert!(matches!(refused, LayoutError::EmptyRegion { named: 0, .. }), "{refused}");
    let text = refused.to_string();
    assert!(text.contains(&format!("none of {} moved", nowhere.counts.moved)), "{text}");

    // One half of the face alone is not symmetric.
    let left = |v: &usize| face.mirror.from_middle[*v] >= 0.0;
    let half: Vec<usize> = ground.candidates.vertices.iter().copied().filter(left).collect();
    let one = of(&Where { only: Some(half), ..Where::default() });
    assert!(
        Units::of(&face, &one, spacing(), true, &[]).unwrap().each.iter().all(|u| u.len() == 1)
    );
    assert!(Units::of(&face, &one, spacing(), false, &[]).unwrap().each.len() > 100);

    let heads = |count: usize| choose_heads(&face, &spacing(), &[], count, 3e-4);
    assert!(matches!(heads(2), Err(LayoutError::TooFewHeads(2))));
    let wide = Spacing::at_rest(&face, 0.5);
    let refused = choose_heads(&face, &wide, &[], 4, 3e-4);
    assert!(matches!(refused, Err(LayoutError::NoHead { wanted: 4, .. })));
    assert!(matches!(
        Method::Greedy.choose(&ground.task(&ground.units(true, &[], 0.008)), 3, &choice(&face)),
        Err(LayoutError::TooFew(3))
    ));
}

#[test]
fn a_lopsided_face_asks_for_free_markers() {
    let mut skin = support::skin();
    // Every other vertex of the left half is pushed about: nothing has a mirror image any more.
    for (v, p) in skin.mesh.positions.iter_mut().enumerate() {
        if p.x > 0.001 {
            p.y += if v % 2 == 0 { 0.0035 } else { -0.0035 };
        }
    }
    let face = Face::of(&skin).unwrap();
    let candidates = Candidates::of(&face, &Where::default());
    let motion = FaceMotion::of(&face, &[], &[]).unwrap();
    let spacing = || Spacing::of(&face, &motion, &candidates.vertices, 0.008);
    let refused = Units::of(&face, &candidates, spacing(), true, &[]);
    assert!(
        matches!(refused, Err(LayoutError::Asymmetric { .. })),
        "{:?}",
        refused.map(|u| u.each.len())
    );
    assert!(refused.unwrap_err().to_string().ends_with("take --free"));
    assert!(Units::of(&face, &candidates, spacing(), false, &[]).is_ok());
}

#[test]
fn heads_sit_on_still_skin_around_the_head_and_more_of_them_tell_more() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let spacing = Spacing::at_rest(&face, 0.008);
    let error = |count: usize| choose_heads(&face, &spacing, &[], count, 3e-4).unwrap();
    let (four, six, eight) = (error(4), error(6), error(8));
    assert!(four.error > six.error && six.error > eight.error);
    assert!(six.vertices.iter().all(|&v| face.reach[v] < 2e-4));
    let left = six.vertices.iter().filter(|&&v| face.place(v).x > 0.02).count();
    let right = six.vertices.iter().filter(|&&v| face.place(v).x < -0.02).count();
    assert!(left >= 2 && right >= 2, "{left} left, {right} right");
    // The noise goes through linearly.
    let twice = choose_heads(&face, &spacing, &[], 6, 6e-4).unwrap();
    assert!((twice.error / six.error - 2.0).abs() < 1e-9);
}
