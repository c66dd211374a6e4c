//! Swapped labels, labels at one place, head markers on moving skin: planted and found, and never
//! found where nothing was planted.

use std::path::Path;

use mimique_actor::{
    Clip, Density, Emotion, HeadSpec, Identity, build_head, marker_sites, synthetic_take,
};
use mimique_mocap::{Capture, LengthUnit};
use mimique_solver::{Method, MethodSpec};
use mimique_stimulus::{
    AvatarSkin, LabelFault, MappedMarker, MarkerMap, MarkerPlace, SolveReport, TakeOptions,
    solve_take,
};
use mimique_test_support::real_data;

/// A skin with its map, and a capture of somebody.
struct Scene {
    skin: AvatarSkin,
    map: MarkerMap,
    capture: Capture,
}

/// The built-in head, and three performances of another person.
fn built_in() -> Scene {
    let head = |seed, vertices| HeadSpec {
        identity: Identity::from_seed(seed),
        density: Density::nearest(vertices),
    };
    let (avatar, actor) = (head(3, 2000), head(77, 2000));
    let sites = marker_sites(&avatar);
    let face = sites.face_labels().iter().zip(&sites.vertices).map(|(label, &vertex)| {
        MappedMarker { label: label.clone(), place: MarkerPlace::Vertex(vertex) }
    });
    let clip = |emotion, intensity| Clip { emotion, intensity, seed: 5 };
    let clips = [clip(Emotion::Joy, 3), clip(Emotion::Surprise, 3), clip(Emotion::Anger, 2)];
    let take = synthetic_take(&build_head(&actor), &marker_sites(&actor), &clips, 9, 0.1);
    let map = MarkerMap {
        face: face.collect(),
        head: take.head_labels.clone(),
        neutral: Some(take.neutral[0]..take.neutral[1]),
        ..MarkerMap::default()
    };
    let capture = Capture::new(take.labels, take.rate_hz, LengthUnit::Millimetre, take.positions);
    Scene { skin: AvatarSkin::of(&build_head(&avatar)).unwrap(), map, capture }
}

fn animface(root: &Path, take: &str) -> Scene {
    let avatar =
        mimique_avatar_files::read_avatar(&root.join("ict-facekit/ict-facekit.glb")).unwrap();
    let text = std::fs::read_to_string(root.join("animface/markers-ict-facekit.json")).unwrap();
    Scene {
        skin: AvatarSkin::of(&avatar.avatar).unwrap(),
        map: MarkerMap::from_text(&text).unwrap(),
        capture: mimique_mocap::read(&root.join("animface").join(take)).unwrap(),
    }
}

fn planted_take(root: &Path) -> Scene {
    let avatar = mimique_avatar_files::read_avatar(&root.join("lsts/avatar_skin.glb")).unwrap();
    let text = std::fs::read_to_string(root.join("lsts/mapping.csv")).unwrap();
    Scene {
        skin: AvatarSkin::of(&avatar.avatar).unwrap(),
        map: MarkerMap::from_text(&text).unwrap(),
        capture: mimique_mocap::read(&root.join("lsts/take_n01.csv")).unwrap(),
    }
}

impl Scene {
    fn solve(&self, capture: &Capture) -> SolveReport {
        let spec = MethodSpec::new(Method::Lsts);
        // All of these takes begin with a neutral face.
        let options = TakeOptions { neutral: Some(0..60), ..TakeOptions::default() };
        solve_take(&self.skin, capture, &self.map, &spec, &options, &mut || 0.0).unwrap().report
    }

    /// The capture with two labels exchanged in some frames.
    fn swapped(&self, [a, b]: [usize; 2], frames: std::ops::Range<usize>) -> Capture {
        let mut capture = self.capture.clone();
        let p = capture.labels.len();
        for frame in frames {
            capture.positions.swap(frame * p + a, frame * p + b);
        }
        capture
    }

    /// Face markers that are not in the head set, each with its nearest neighbour of them.
    fn neighbours(&self) -> Vec<[usize; 2]> {
        let at = |label: &str| self.capture.marker_index(label);
        let face: Vec<usize> = (self.map.face_labels())
            .filter(|l| !self.map.head.iter().any(|h| h == l))
            .filter_map(at)
            .collect();
        let place = |m: usize| self.capture.positions[m];
        let square = |a: usize, b: usize| -> f64 {
            (0..3).map(|k| (place(a)[k] - place(b)[k]).powi(2)).sum()
        };
        let nearest = |a: usize| {
            let others = face.iter().copied().filter(|b| *b != a);
            others.min_by(|&x, &y| square(a, x).total_cmp(&square(a, y))).unwrap()
        };
        face.iter().map(|&a| [a, nearest(a)]).collect()
    }
}

/// Plants swaps of neighbours, for a stretch and for all frames. What is named is always the planted
/// pair and its frames; `shares` of them (stretch, whole take) must be named: a swap of two markers
/// that hardly move, or that a bank of shapes explains either way, leaves no residual to tell by.
fn plant_and_find(scene: &Scene, stretch: std::ops::Range<usize>, step: usize, shares: [f64; 2]) {
    let (mut tried, mut named) = (0, [0, 0]);
    let first = scene.capture.first_frame;
    let frames = [first + stretch.start as u64, first + stretch.end as u64];
    for pair in scene.neighbours().into_iter().step_by(step) {
        tried += 1;
        let mut labels = pair.map(|m| scene.capture.labels[m].clone());
        labels.sort();
        let spans = [(stretch.clone(), Some(frames)), (0..scene.capture.frames(), None)];
        for (count, (span, frames)) in named.iter_mut().zip(spans) {
            let report = scene.solve(&scene.swapped(pair, span));
            let swaps: Vec<_> =
                report.label_problems.iter().filter(|p| p.fault == LabelFault::Swapped).collect();
            for problem in &swaps {
                let mut found = problem.labels.clone();
                found.sort();
                assert_eq!((found, problem.frames), (labels.clone(), frames), "{swaps:?}");
                assert!(problem.residual_if_mended_mm < problem.residual_mm, "{problem:?}");
            }
            let warned = report.warnings.iter().any(|w| w.to_string().contains("look swapped"));
            assert_eq!(warned, !swaps.is_empty(), "{:?}", report.warnings);
            *count += swaps.len();
        }
    }
    eprintln!("{tried} pairs: {named:?} named (stretch, whole take)");
    for (named, share) in named.into_iter().zip(shares) {
        assert!(named as f64 >= share * f64::from(tried), "{named} of {tried} named");
    }
}

#[test]
fn clean_performances_raise_no_alarm() {
    let scene = built_in();
    let report = scene.solve(&scene.capture);
    assert_eq!(report.label_problems, []);
    assert!(
        !report.warnings.iter().any(|w| w.to_string().contains("head markers")),
        "{:?}",
        report.warnings
    );
    assert!(report.head_markers.len() >= 3);
    assert!(report.head_markers.iter().all(|m| m.residual_mm < 0.3), "{:?}", report.head_markers);
}

#[test]
fn swaps_planted_in_built_in_performances_are_named() {
    let scene = built_in();
    plant_and_find(&scene, 300..420, 8, [0.8, 1.0]);
}

#[test]
fn two_labels_at_one_place_are_named_with_the_one_that_does_not_belong() {
    let scene = built_in();
    let p = scene.capture.labels.len();
    for [a, b] in scene.neighbours().into_iter().step_by(9) {
        let mut capture = scene.capture.clone();
        for frame in 200..260 {
            let mut ghost = capture.positions[frame * p + a];
            ghost[0] += 0.02;
            capture.positions[frame * p + b] = ghost;
        }
        let report = scene.solve(&capture);
        let found: Vec<_> =
            report.label_problems.iter().filter(|q| q.fault == LabelFault::OnePlace).collect();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].labels, [a, b].map(|m| capture.labels[m].clone()));
        assert_eq!(found[0].frames, Some([200, 260]));
        assert!(
            report
                .warnings
                .iter()
                .any(|w| w.to_string().contains("at one place in frames 200:260"))
        );
    }
}

#[test]
fn labels_at_one_place_on_the_neutral_are_refused_by_name() {
    let scene = built_in();
    let p = scene.capture.labels.len();
    let [a, b] = scene.neighbours()[4];
    let mut capture = scene.capture.clone();
    for frame in 0..capture.frames() {
        capture.positions[frame * p + b] = capture.positions[frame * p + a];
    }
    let spec = MethodSpec::new(Method::Lsts);
    let error =
        solve_take(&scene.skin, &capture, &scene.map, &spec, &TakeOptions::default(), &mut || 0.0)
            .unwrap_err()
            .to_string();
    for m in [a, b] {
        assert!(error.contains(&capture.labels[m]), "{error}");
    }
}

#[test]
fn face_markers_as_head_markers_are_named_with_their_residual() {
    let scene = built_in();
    let brows: Vec<String> = (scene.map.face_labels())
        .filter(|l| l.to_lowercase().contains("brow"))
        .map(str::to_owned)
        .collect();
    assert!(brows.len() >= 2, "{:?}", scene.map.face_labels().collect::<Vec<_>>());
    let mut head = scene.map.head.clone();
    head.extend(brows.iter().take(2).cloned());
    let options = TakeOptions { head: Some(head), ..TakeOptions::default() };
    let spec = MethodSpec::new(Method::Lsts);
    let report = solve_take(&scene.skin, &scene.capture, &scene.map, &spec, &options, &mut || 0.0)
        .unwrap()
        .report;
    let warning = report
        .warnings
        .iter()
        .map(ToString::to_string)
        .find(|w| w.contains("head markers move"))
        .unwrap();
    assert!(brows.iter().take(2).any(|b| warning.contains(b.as_str())), "{warning}");
    assert!(warning.contains("mm rms"), "{warning}");
}

#[test]
fn clean_real_takes_raise_no_alarm() {
    let Some(root) = real_data("clean_real_takes_raise_no_alarm") else { return };
    for scene in
        [planted_take(&root), animface(&root, "JawMoCap.c3d"), animface(&root, "CheeksMoCap.c3d")]
    {
        let report = scene.solve(&scene.capture);
        assert_eq!(report.label_problems, [], "{}", report.avatar);
        eprintln!("{:?}", report.head_markers);
    }
}

#[test]
fn swaps_planted_in_real_takes_are_named() {
    let Some(root) = real_data("swaps_planted_in_real_takes_are_named") else { return };
    let mut planted = planted_take(&root);
    planted.capture.positions.truncate(900 * planted.capture.labels.len());
    plant_and_find(&planted, 300..420, 13, [1.0, 1.0]);
    plant_and_find(&animface(&root, "JawMoCap.c3d"), 700..800, 13, [1.0, 0.6]);
}

#[test]
fn head_markers_on_the_skin_of_a_real_take_are_said_to_move() {
    let Some(root) = real_data("head_markers_on_the_skin_of_a_real_take_are_said_to_move") else {
        return;
    };
    let scene = animface(&root, "CheeksMoCap.c3d");
    let report = scene.solve(&scene.capture);
    let warning =
        report.warnings.iter().map(ToString::to_string).find(|w| w.contains("head markers move"));
    assert!(warning.is_some_and(|w| w.contains("NoseTop (1.")), "{:?}", report.head_markers);
    // The planted take's are on a skull.
    let planted = planted_take(&root);
    let report = planted.solve(&planted.capture);
    assert!(!report.warnings.iter().any(|w| w.to_string().contains("head markers move")));
}
