//! Motions that are planted: what is told of them is what was put in.

use mimique_actor::{Clip, Density, Emotion, HeadSpec, build_head, marker_sites, synthetic_take};
use mimique_comparison::{
    ComparedFace, Difference, FaceMotion, LipClosures, NotComparable, difference,
    marker_correlation, measures,
};
use mimique_solver::{Method, MethodSpec};
use mimique_stimulus::{
    AvatarSkin, JoinedTake, TakeOptions, built_in_capture, built_in_map, solve_take,
};

fn skin() -> AvatarSkin {
    AvatarSkin::of(&build_head(&HeadSpec { density: Density::COARSE, ..HeadSpec::actor(2) }))
        .unwrap()
}

/// A frame's weights of some shapes, over `frames` frames.
fn weights(
    skin: &AvatarSkin,
    frames: usize,
    of: impl Fn(usize) -> Vec<(&'static str, f64)>,
) -> Vec<f64> {
    let n = skin.shape_names.len();
    let mut out = vec![0.0; frames * n];
    for (frame, row) in out.chunks_exact_mut(n).enumerate() {
        for (name, weight) in of(frame) {
            row[skin.shape_names.iter().position(|s| s == name).unwrap()] = weight;
        }
    }
    out
}

fn part(difference: &Difference, name: &str) -> (f64, f64, usize) {
    let part = difference.parts.iter().find(|part| part.part == name).unwrap();
    (part.rms_mm, part.largest_mm, part.largest_frame)
}

#[test]
fn distances_are_those_of_the_skin_and_in_the_frame_where_they_are() {
    let skin = skin();
    let face = ComparedFace::of(&skin);
    let still = weights(&skin, 20, |_| vec![]);
    let brows = weights(&skin, 20, |f| {
        vec![("browOuterUpLeft", if f == 13 { 1.0 } else { 0.25 }), ("browOuterUpRight", 0.25)]
    });
    let of = |weights: &[f64]| FaceMotion::of(&skin, &face, weights, 60.0);
    let apart = difference(&face, &of(&still), &of(&brows)).unwrap();
    // The largest distance is that of the vertex which the shape moves most.
    let shape = skin.shape_names.iter().position(|s| s == "browOuterUpLeft").unwrap();
    let most = skin.mesh.shapes[shape].deltas.iter().map(|d| 1e3 * d.length()).fold(0.0, f64::max);
    let (_, largest, frame) = part(&apart, "Face");
    assert!((largest - most).abs() < 1e-3 && frame == 13, "{largest} {most} {frame}");
    let [brow, chin] = ["Brow", "Chin"].map(|name| part(&apart, name).0);
    assert!(brow > 0.5 && chin < 0.01, "{brow} {chin}");
    // Nothing between the same, and the same whichever way it is measured.
    let back = difference(&face, &of(&brows), &of(&still)).unwrap();
    assert_eq!(back.parts, apart.parts);
    let none = difference(&face, &of(&brows), &of(&brows)).unwrap();
    assert!(none.parts.iter().all(|part| part.rms_mm == 0.0));
    assert_eq!(none.lip_vertex_error_mm, Some(0.0));
}

#[test]
fn lips_that_should_be_shut_and_are_not_are_counted() {
    let skin = skin();
    let face = ComparedFace::of(&skin);
    let of = |weights: &[f64]| FaceMotion::of(&skin, &face, weights, 60.0);
    // Open, shut, open; the other never shuts them in frames 10 to 14.
    let speech =
        weights(&skin, 30, |f| vec![("jawOpen", if (10..20).contains(&f) { 0.0 } else { 0.5 })]);
    let slack =
        weights(&skin, 30, |f| vec![("jawOpen", if (15..20).contains(&f) { 0.0 } else { 0.5 })]);
    let apart = difference(&face, &of(&speech), &of(&slack)).unwrap();
    assert_eq!(apart.lip_closures, Some(LipClosures { shut: 10, kept: 5 }));
    assert_eq!(apart.lip_closures.unwrap().share_kept(), Some(0.5));
    assert!(apart.lip_vertex_error_mm.unwrap() > 1.0 && apart.lip_gap_error_mm.unwrap() > 1.0);
    let open = weights(&skin, 30, |_| vec![("jawOpen", 0.5)]);
    let never = difference(&face, &of(&open), &of(&speech)).unwrap().lip_closures.unwrap();
    assert_eq!((never, never.share_kept()), (LipClosures { shut: 0, kept: 0 }, None));
    assert!(measures(&face, &of(&open)).widest_mouth_mm.unwrap() > 5.0);
}

#[test]
fn a_sine_has_the_jerk_of_its_third_derivative() {
    let skin = skin();
    let face = ComparedFace::of(&skin);
    let (rate, hertz) = (200.0, 2.0);
    let turn = |f: usize| std::f64::consts::TAU * hertz * f as f64 / rate;
    let sine = weights(&skin, 401, |f| vec![("jawOpen", 0.5 + 0.5 * turn(f).sin())]);
    let motion = FaceMotion::of(&skin, &face, &sine, rate);
    // The amplitude of each vertex by (2 pi f)^3, root mean square over a sine and over the vertices.
    let shape = skin.shape_names.iter().position(|s| s == "jawOpen").unwrap();
    let squares: f64 = (face.vertices.iter())
        .filter_map(|&v| skin.mesh.shapes[shape].vertices.binary_search(&(v as u32)).ok())
        .map(|place| (0.5 * skin.mesh.shapes[shape].deltas[place].length()).powi(2))
        .sum();
    let amplitude = (squares / face.vertices.len() as f64).sqrt();
    let expected = amplitude * (std::f64::consts::TAU * hertz).powi(3) / 2.0_f64.sqrt();
    let jerk = measures(&face, &motion).jerk;
    // Differences of single precision carry some noise of rounding.
    assert!((jerk / expected - 1.0).abs() < 0.03, "{jerk} {expected}");
    // The same motion at half the size has half of everything.
    let half: Vec<f64> = sine.iter().map(|w| 0.5 * w).collect();
    let half = measures(&face, &FaceMotion::of(&skin, &face, &half, rate));
    let range = |m: &mimique_comparison::Measures| m.range_mm.last().unwrap().1;
    let whole = range(&measures(&face, &motion));
    assert!((range(&half) / whole - 0.5).abs() < 1e-3);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let skin = skin();
    let face = ComparedFace::of(&skin);
    let of = |frames, rate| FaceMotion::of(&skin, &face, &weights(&skin, frames, |_| vec![]), rate);
    let refused = |a, b| difference(&face, &a, &b).unwrap_err();
    assert_eq!(refused(of(5, 60.0), of(6, 60.0)), NotComparable::Frames(5, 6));
    assert_eq!(refused(of(5, 60.0), of(5, 30.0)), NotComparable::Rates(60.0, 30.0));
    // Rates that files write with few digits are one.
    assert!(difference(&face, &of(5, 59.94), &of(5, 59.9401)).is_ok());
}

#[test]
fn an_avatar_without_landmarks_is_compared_as_a_whole() {
    let mut skin = skin();
    skin.shape_names = (0..skin.shape_names.len()).map(|k| format!("target{k}")).collect();
    let face = ComparedFace::of(&skin);
    assert!(face.parts.is_empty() && face.lips.is_empty() && !face.vertices.is_empty());
    let motion = FaceMotion::of(&skin, &face, &vec![0.0; 3 * skin.shape_names.len()], 60.0);
    let apart = difference(&face, &motion, &motion).unwrap();
    assert_eq!(apart.parts.iter().map(|p| p.part.as_str()).collect::<Vec<_>>(), ["Face"]);
    assert_eq!((apart.lip_vertex_error_mm, apart.lip_closures), (None, None));
}

#[test]
fn a_face_that_follows_its_markers_correlates_with_them_and_another_does_not() {
    let spec = HeadSpec { density: Density::COARSE, ..HeadSpec::actor(2) };
    let (head, sites) = (build_head(&spec), marker_sites(&spec));
    let clip = |emotion| Clip { emotion, intensity: 3, seed: 1 };
    let take =
        synthetic_take(&head, &sites, &[clip(Emotion::Joy), clip(Emotion::Surprise)], 5, 0.02);
    let skin = AvatarSkin::of(&head).unwrap();
    let (capture, map) = (built_in_capture(&take), built_in_map(&sites));
    let [first, end] = take.neutral;
    let options = TakeOptions {
        neutral: Some(first..end),
        head: Some(take.head_labels.clone()),
        ..TakeOptions::default()
    };
    let spec = MethodSpec::new(Method::Box);
    let solved = solve_take(&skin, &capture, &map, &spec, &options, &mut || 0.0).unwrap();
    let joined = JoinedTake::new(&skin, &capture, &map, &options).unwrap();
    let operators = joined.operators(&spec).unwrap();
    let rows = joined.motion(&operators, &spec.at_rate(capture.rate_hz)).unwrap().displacements;
    let r = |weights: &[f64]| {
        let mut all: Vec<f64> = marker_correlation(&skin.mesh, joined.sites(), &rows, weights)
            .into_iter()
            .filter_map(|marker| marker.r)
            .collect();
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    };
    let own = r(&solved.table.weights);
    assert!(own > 0.98, "{own}");
    // The same frames backwards are another performance.
    let n = skin.shape_names.len();
    let backwards: Vec<f64> =
        solved.table.weights.chunks_exact(n).rev().flat_map(<[f64]>::to_vec).collect();
    let other = r(&backwards);
    assert!(other < 0.6, "{other}");
    // Gain does not change it.
    let half: Vec<f64> = solved.table.weights.iter().map(|w| 0.5 * w).collect();
    assert!((r(&half) - own).abs() < 1e-9);
}
